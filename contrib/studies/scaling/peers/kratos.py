#!/usr/bin/python3
"""The case `hertz` in Kratos (PyPI: KratosMultiphysics with its structural, contact and linear-solvers applications):
mortar contact without friction by augmented Lagrangian multipliers, small-displacement linear elastic hexahedra, one
increment, one thread.

    kratos.py N [--solver amgcl|sparse_lu] [--keep FOLDER]

The environment variable KRATOS_PYTHON names the Python that has Kratos (default: python3). The settings of amgcl are
those of Kratos' own contact examples, with scalar blocks. What is measured is a process of its own that reads the written case, solves it
and writes the pressures. Prints one line of JSON.
"""

import argparse
import json
import os
import shutil
import sys
import tempfile

SOLVERS = {
    "sparse_lu": {"solver_type": "LinearSolversApplication.sparse_lu"},
    # scalar blocks: the multipliers are scalars of the slave nodes only
    "amgcl": {"solver_type": "amgcl", "smoother_type": "ilu0", "krylov_type": "lgmres",
              "coarsening_type": "aggregation", "max_iteration": 500, "gmres_krylov_space_dimension": 100,
              "tolerance": 1e-9, "scaling": False, "block_size": 1, "use_block_matrices_if_possible": False,
              "coarse_enough": 1000, "verbosity": 0},
}  # fmt: skip


def write_mesh(mesh, parts, surfaces, path):
    with open(path, "w") as file:
        file.write("Begin ModelPartData\nEnd ModelPartData\n\nBegin Properties 0\nEnd Properties\n\nBegin Nodes\n")
        file.writelines(f"{i} {x:.17g} {y:.17g} {z:.17g}\n" for i, (x, y, z) in enumerate(mesh.nodes.tolist(), 1))
        file.write("End Nodes\n\n")
        number, elements = 0, {}
        for body, cells in mesh.cells.items():
            file.write("Begin Elements SmallDisplacementElement3D8N\n")
            elements[body] = range(number, number + len(cells))
            for nodes in (cells + 1).tolist():
                number += 1
                file.write(f"{number} 0 {' '.join(map(str, nodes))}\n")
            file.write("End Elements\n\n")
        number, conditions = 0, {}
        for name, (_, faces) in surfaces.items():
            file.write("Begin Conditions SurfaceCondition3D4N\n")
            conditions[name] = range(number, number + len(faces))
            for nodes in (faces + 1).tolist():
                number += 1
                file.write(f"{number} 0 {' '.join(map(str, nodes))}\n")
            file.write("End Conditions\n\n")

        def part(name, nodes, elements=(), conditions=()):
            file.write(f"Begin SubModelPart {name}\n")
            for kind, numbers in (("Nodes", nodes), ("Elements", elements), ("Conditions", conditions)):
                file.write(f"Begin SubModelPart{kind}\n")
                file.writelines(f"{i + 1}\n" for i in numbers)
                file.write(f"End SubModelPart{kind}\n")
            file.write("End SubModelPart\n\n")

        for body, cells in mesh.cells.items():
            part(f"Body{body}", sorted(set(cells.ravel().tolist())), elements[body])
        for name, nodes in parts.items():
            part(name, nodes)
        for name, (_, faces) in surfaces.items():
            part(name, sorted(set(faces.ravel().tolist())), (), conditions[name])


def fix(part, values):
    return {
        "python_module": "assign_vector_variable_process",
        "kratos_module": "KratosMultiphysics",
        "Parameters": {
            "model_part_name": "Structure." + part,
            "variable_name": "DISPLACEMENT",
            "constrained": [value is not None for value in values],
            "value": values,
            "interval": [0.0, "End"],
        },
    }


def write(mesh, folder, solver):
    import hertz_case

    parts = {
        "SymX": mesh.nodes_of((1, "x-"), (2, "x-")),
        "SymY": mesh.nodes_of((1, "y-"), (2, "y-")),
        "Base": mesh.nodes_of((2, "z-")),
        "Top": mesh.nodes_of((1, "z+")),
    }
    write_mesh(
        mesh, parts, {"ContactSlave": mesh.slave, "ContactMaster": mesh.master}, os.path.join(folder, "case.mdpa")
    )
    # Kratos' default of 1e-9 for absolute tolerances stops too early in these units
    relative, absolute = 1e-6, 1e-14
    contact_settings = {"mortar_type": "ALMContactFrictionless"}
    for kind in ("contact_displacement", "contact_residual"):
        contact_settings[kind + "_relative_tolerance"] = relative
        contact_settings[kind + "_absolute_tolerance"] = absolute
    parameters = {
        "problem_data": {"problem_name": "hertz", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0,
                         "end_time": 1 - 1e-9},
        "solver_settings": {
            "solver_type": "Static",
            "model_part_name": "Structure",
            "domain_size": 3,
            "echo_level": 0,
            "analysis_type": "non_linear",
            "buffer_size": 2,
            "model_import_settings": {"input_type": "mdpa", "input_filename": os.path.join(folder, "case")},
            "material_import_settings": {"materials_filename": os.path.join(folder, "materials.json")},
            "time_stepping": {"time_step": 1.0},
            "solving_strategy_settings": {"type": "newton_raphson"},
            "convergence_criterion": "contact_residual_criterion",
            "displacement_relative_tolerance": relative,
            "displacement_absolute_tolerance": absolute,
            "residual_relative_tolerance": relative,
            "residual_absolute_tolerance": absolute,
            "max_iteration": 50,
            "contact_settings": contact_settings,
            "linear_solver_settings": SOLVERS[solver],
        },
        "processes": {
            "constraints_process_list": [
                fix("SymX", [0.0, None, None]),
                fix("SymY", [None, 0.0, None]),
                fix("Base", [0.0, 0.0, 0.0]),
                fix("Top", [None, None, f"-{hertz_case.INDENTATION}*t"]),
            ],
            "loads_process_list": [],
            "contact_process_list": [
                {
                    "python_module": "alm_contact_process",
                    "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
                    "process_name": "ALMContactProcess",
                    "Parameters": {
                        "model_part_name": "Structure",
                        "contact_model_part": {"0": ["ContactSlave", "ContactMaster"]},
                        "assume_master_slave": {"0": ["ContactSlave"]},
                        "contact_type": "Frictionless",
                    },
                }
            ],
        },
        "output_processes": {},
    }  # fmt: skip
    variables = {"DENSITY": 1.0, "YOUNG_MODULUS": hertz_case.E, "POISSON_RATIO": hertz_case.NU}
    material = {"constitutive_law": {"name": "LinearElastic3DLaw"}, "Variables": variables, "Tables": {}}
    materials = {
        "properties": [
            {"model_part_name": f"Structure.Body{b}", "properties_id": b, "Material": material} for b in mesh.cells
        ]
    }
    for name, content in (
        ("parameters", parameters),
        ("materials", materials),
        ("slave", [int(node) for node in mesh.slave_nodes]),
    ):
        with open(os.path.join(folder, name + ".json"), "w") as file:
            json.dump(content, file)


def solve(folder):
    """In Kratos' Python: reads and solves the case that write() left in the folder."""
    import KratosMultiphysics as Kratos
    import KratosMultiphysics.ContactStructuralMechanicsApplication as Contact
    import KratosMultiphysics.StructuralMechanicsApplication  # noqa: F401
    from KratosMultiphysics.StructuralMechanicsApplication import structural_mechanics_analysis

    Kratos.ParallelUtilities.SetNumThreads(1)
    os.chdir(folder)
    with open("parameters.json") as file:
        parameters = Kratos.Parameters(file.read())
    with open("slave.json") as file:
        slave = json.load(file)
    result = {"Newton": 0, "increments": 0, "converged": True}

    class Analysis(structural_mechanics_analysis.StructuralMechanicsAnalysis):
        def RunSolutionLoop(self):
            while self.KeepAdvancingSolutionLoop():
                self.time = self._AdvanceTime()
                self.InitializeSolutionStep()
                result["converged"] &= bool(self._GetSolver().SolveSolutionStep())
                result["Newton"] += self._GetSolver().GetComputingModelPart().ProcessInfo[Kratos.NL_ITERATION_NUMBER]
                result["increments"] += 1
                self.FinalizeSolutionStep()
            structure = self.model["Structure"]
            base = structure.GetSubModelPart("Base").Nodes
            result["force"] = abs(sum(node.GetSolutionStepValue(Kratos.REACTION)[2] for node in base))
            result["pressure"] = [
                -node.GetValue(Contact.AUGMENTED_NORMAL_CONTACT_PRESSURE) if node.Is(Kratos.ACTIVE) else 0.0
                for node in (structure.Nodes[i + 1] for i in slave)
            ]

    Analysis(Kratos.Model(), parameters).Run()
    with open("result.json", "w") as file:
        json.dump(result, file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("n", type=int)
    parser.add_argument("--solver", default="amgcl", choices=list(SOLVERS))
    parser.add_argument("--keep", default="")
    arguments = parser.parse_args()

    sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    import hertz_case

    folder = os.path.abspath(arguments.keep or tempfile.mkdtemp(prefix="kratos_"))
    os.makedirs(folder, exist_ok=True)
    write(hertz_case.Mesh(arguments.n), folder, arguments.solver)
    python = os.environ.get("KRATOS_PYTHON", "python3")
    command = [python, os.path.abspath(__file__), "--solve", folder]
    result = hertz_case.measured(command, os.path.join(folder, "log"), folder, hertz_case.environment())
    result["converged"] = False
    if result["exit"] == 0:
        with open(os.path.join(folder, "result.json")) as file:
            result.update(json.load(file))
    print(json.dumps(result))
    if not arguments.keep:
        shutil.rmtree(folder)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--solve"]:
        solve(sys.argv[2])
    else:
        main()
