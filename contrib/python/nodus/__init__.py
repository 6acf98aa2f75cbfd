"""Cases, runs and results of nodus: contact of 3D bodies at large deformation (contrib/doc/python.md).

    case = nodus.Case.read("prm/first_case.prm")
    case["Contact pair 1/Friction coefficient"] = 0.3
    results = case.run("results/sticky", ranks=2)
    results.contact["slave force z"], results.surface().field("CPRESS"), results.plot_force()

Needs numpy; figures need matplotlib, frame() pandas."""

from . import references
from .case import Case
from .errors import InputError, NodusError, ResultsError, RunError
from .formulas import evaluate
from .mesh import Mesh, read_mesh
from .program import Program, Run
from .results import Results
from .tables import Table


def run(file, ranks=1, *, program=None, **options):
    """Runs a .prm or .json file; see Program.run()."""
    return Program(program).run(file, ranks, **options)


__all__ = ["Case", "InputError", "Mesh", "NodusError", "Program", "Results", "ResultsError", "Run", "RunError", "Table",
           "evaluate", "read_mesh", "references", "run"]
