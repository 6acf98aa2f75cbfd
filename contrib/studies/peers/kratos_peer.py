"""A case of nodus in Kratos on the same mesh: mortar contact with augmented Lagrangian multipliers, total Lagrangian hexahedra.

run() puts what plain_case takes into a folder and starts this file there with a Python that has Kratos (the environment variable
KRATOS_PYTHON, default python3; PyPI: KratosStructuralMechanicsApplication, KratosContactStructuralMechanicsApplication,
KratosConstitutiveLawsApplication, KratosLinearSolversApplication), so that its CPU and memory can be measured. Kratos has the law
whose shape is that of CalculiX's neo-Hookean law and whose volume term is Simo and Taylor's: equal to the first order of the change of volume.
"""

import json
import os

import numpy as np

LAWS = {True: "LinearElastic3DLaw", False: "HyperElasticSimoTaylorNeoHookean3DLaw"}
# AMG as in Kratos' own contact examples, with scalar blocks for the multipliers; without the prefix its settings are refused.
SOLVERS = {
    "direct": {"solver_type": "LinearSolversApplication.sparse_lu"},
    "AMG": {"solver_type": "KratosMultiphysics.amgcl", "smoother_type": "ilu0", "krylov_type": "lgmres", "coarsening_type": "aggregation",
            "max_iteration": 500, "gmres_krylov_space_dimension": 100, "tolerance": 1e-9, "scaling": False, "block_size": 1,
            "use_block_matrices_if_possible": False, "coarse_enough": 1000, "verbosity": 0},
}  # fmt: skip
# Relative, of residuals and corrections; its default of 1e-9 for absolute ones stops too early in small units.
TOLERANCE, ABSOLUTE, ITERATIONS = 1e-6, 1e-14, 30
# Parts of an increment of nodus, all of them: the second where an increment fails with the first.
DIVISIONS = (1, 4)


def run(case, solver, folder, time_limit=3600):
    """solver: one of SOLVERS. Returns what calculix.run() returns, for the first of DIVISIONS that finishes, otherwise for that which gets
    the furthest."""
    from plain_case import Unsupported, solved

    if case.degree != 1 or case.ties() or case.probe:
        raise Unsupported("elements of degree 2, tied pairs, displacements of a point")
    best = None
    for division in DIVISIONS:
        content = {
            "points": case.points.tolist(),
            "bodies": {str(b): {"elements": case.elements[case.body == b].tolist(), "law": law} for b, law in case.laws().items()},
            "pairs": [[case.corners_of(slave), case.corners_of(master), friction] for slave, master, friction in case.pairs().values()],
            "conditions": {str(number): [list(map(int, case.nodes_of(faces))), [[c, history.tolist()] for c, history in components]]
                           for number, (faces, components) in case.conditions().items()},
            "times": case.times().tolist(), "division": division, "solver": SOLVERS[solver],
        }  # fmt: skip
        result = solved(os.environ.get("KRATOS_PYTHON", "python3"), __file__, content, folder, time_limit)
        if best is None or result["finished"] or result["time"] > best["time"]:
            best = result
        if best["finished"] or best["out of time"]:
            break
    return best


def parameters(content):
    """Of a static analysis whose model part is there already."""
    contact_settings = {"mortar_type": "ALMContactFrictional" if any(pair[2] for pair in content["pairs"]) else "ALMContactFrictionless"}
    kinds = ["contact_displacement", "contact_residual"]
    kinds += [f"frictional_{status}_contact_{what}" for status in ("stick", "slip") for what in ("displacement", "residual")]
    for kind in kinds:
        contact_settings[kind + "_relative_tolerance"] = TOLERANCE
        contact_settings[kind + "_absolute_tolerance"] = ABSOLUTE
    numbers = [str(p) for p in range(len(content["pairs"]))]
    process = {
        "model_part_name": "Structure",
        "contact_model_part": {p: [f"Slave{p}", f"Master{p}"] for p in numbers},
        "assume_master_slave": {p: [f"Slave{p}"] for p in numbers},
        "contact_type": contact_settings["mortar_type"].removeprefix("ALMContact"),
    }
    if process["contact_type"] == "Frictional":
        process["friction_coefficients"] = {p: content["pairs"][int(p)][2] for p in numbers}
    return {
        "problem_data": {"problem_name": "case", "parallel_type": "OpenMP", "echo_level": 0, "start_time": 0.0, "end_time": content["times"][-1]},
        "solver_settings": {
            "solver_type": "Static",
            "model_part_name": "Structure",
            "domain_size": 3,
            "analysis_type": "non_linear",
            # Friction with a buffer of 3, which its log asks for, ends with forces off the friction cone.
            "buffer_size": 2,
            "model_import_settings": {"input_type": "use_input_model_part"},
            "material_import_settings": {"materials_filename": "materials.json"},
            "time_stepping": {"time_step": 1.0},
            "convergence_criterion": "contact_residual_criterion",
            "displacement_relative_tolerance": TOLERANCE,
            "displacement_absolute_tolerance": ABSOLUTE,
            "residual_relative_tolerance": TOLERANCE,
            "residual_absolute_tolerance": ABSOLUTE,
            "max_iteration": ITERATIONS,
            "contact_settings": contact_settings,
            "linear_solver_settings": content["solver"],
        },
        "processes": {
            "contact_process_list": [{
                "python_module": "alm_contact_process",
                "kratos_module": "KratosMultiphysics.ContactStructuralMechanicsApplication",
                "process_name": "ALMContactProcess",
                "Parameters": process,
            }]
        },
    }  # fmt: skip


def fill(part, content):
    """Nodes, elements, surfaces and the nodes of the conditions; laws into materials.json."""
    for number, x in enumerate(content["points"], 1):
        part.CreateNewNode(number, *x)
    materials, elements, faces = [], 0, 0
    for body, data in content["bodies"].items():
        linear, modulus, ratio = data["law"]
        body_part, properties = part.CreateSubModelPart("Body" + body), part.CreateNewProperties(int(body))
        body_part.AddNodes(sorted({node for nodes in data["elements"] for node in nodes}))
        for nodes in data["elements"]:
            elements += 1
            body_part.CreateNewElement("SmallDisplacementElement3D8N" if linear else "TotalLagrangianElement3D8N", elements, nodes, properties)
        variables = {"DENSITY": 1.0, "YOUNG_MODULUS": modulus, "POISSON_RATIO": ratio}
        materials.append({"model_part_name": "Structure.Body" + body, "properties_id": int(body),
                          "Material": {"constitutive_law": {"name": LAWS[linear]}, "Variables": variables, "Tables": {}}})  # fmt: skip
    for p, (slave, master, _) in enumerate(content["pairs"]):
        for side, chosen in (("Slave", slave), ("Master", master)):
            surface = part.CreateSubModelPart(f"{side}{p}")
            surface.AddNodes(sorted({node + 1 for _, nodes in chosen for node in nodes}))
            for _, nodes in chosen:
                faces += 1
                surface.CreateNewCondition("SurfaceCondition3D4N", faces, [node + 1 for node in reversed(nodes)], part.GetProperties(1))
    for number, (nodes, _) in content["conditions"].items():
        part.CreateSubModelPart("Condition" + number).AddNodes(nodes)
    with open("materials.json", "w", encoding="utf-8") as file:
        json.dump({"properties": materials}, file)


def main():
    import KratosMultiphysics as Kratos
    import KratosMultiphysics.ConstitutiveLawsApplication
    import KratosMultiphysics.ContactStructuralMechanicsApplication
    import KratosMultiphysics.LinearSolversApplication
    import KratosMultiphysics.StructuralMechanicsApplication  # noqa: F401
    from KratosMultiphysics.StructuralMechanicsApplication import structural_mechanics_analysis

    Kratos.ParallelUtilities.SetNumThreads(1)
    with open("case.json", encoding="utf-8") as file:
        content = json.load(file)
    knots, division = np.array(content["times"]), content["division"]
    targets = np.interp(np.arange(1, division * (len(knots) - 1) + 1) / division, np.arange(len(knots)), knots)
    components = [Kratos.DISPLACEMENT_X, Kratos.DISPLACEMENT_Y, Kratos.DISPLACEMENT_Z]
    result = {"finished": False, "time": 0.0, "increments": 0, "iterations": 0, "cut-backs": 0, "forces": {number: [] for number in content["conditions"]}}

    class Analysis(structural_mechanics_analysis.StructuralMechanicsAnalysis):
        def ApplyBoundaryConditions(self):
            super().ApplyBoundaryConditions()
            for number, (_, prescribed) in content["conditions"].items():
                for component, history in prescribed:
                    value = float(np.interp(self.time, knots, history))
                    for node in self.model["Structure.Condition" + number].Nodes:
                        node.Fix(components[component])
                        node.SetSolutionStepValue(components[component], value)

        def RunSolutionLoop(self):
            part = self.model["Structure"]
            for target in targets:
                self.time = float(target)
                part.CloneTimeStep(self.time)
                part.ProcessInfo[Kratos.STEP] += 1
                self.InitializeSolutionStep()
                self._GetSolver().Predict()
                converged = self._GetSolver().SolveSolutionStep()
                self.FinalizeSolutionStep()
                result["iterations"] += part.ProcessInfo[Kratos.NL_ITERATION_NUMBER]
                if not converged:
                    break
                result.update(time=self.time, increments=result["increments"] + 1, finished=bool(target == targets[-1]))
                for number, rows in result["forces"].items():
                    nodes = self.model["Structure.Condition" + number].Nodes
                    total = np.sum([list(node.GetSolutionStepValue(Kratos.REACTION)) for node in nodes], axis=0)
                    rows.append([self.time, *total.tolist()])
                if result["finished"]:
                    result["displacements"] = [list(node.GetSolutionStepValue(Kratos.DISPLACEMENT)) for node in part.Nodes]
                print(f"t = {self.time:g}, {result['iterations']} iterations", flush=True)
                write()

    def write():
        with open("result.json", "w", encoding="utf-8") as file:
            json.dump(result, file)

    write()
    model = Kratos.Model()
    part = model.CreateModelPart("Structure")
    analysis = Analysis(model, Kratos.Parameters(json.dumps(parameters(content))))
    fill(part, content)
    analysis.Run()


if __name__ == "__main__":
    main()
