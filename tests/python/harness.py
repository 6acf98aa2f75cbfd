"""What the tests of contrib/python share: <test>.py SOURCE_FOLDER NODUS, run in an empty folder; prints what is measured beside
what it should be."""

import contextlib
import os
import sys
import tempfile

sys.dont_write_bytecode = True  # no __pycache__ in the sources
SOURCE, NODUS = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
sys.path.insert(0, os.path.join(SOURCE, "contrib", "python"))
import nodus  # noqa: E402

failures = []


def check(what, value, reference, tolerance=0.):
    """Prints a number or text beside what it should be; tolerance: relative."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        good = abs(value - reference) <= tolerance * abs(reference)
        within = f" within {tolerance:g}" if tolerance else ""
        print(f"{what}: {value:.8g} for {reference:.8g}{within}" + ("" if good else "   NO"))
    else:
        good = value == reference
        print(f"{what}: {value}" + ("" if good else f"   NO, should be {reference}"))
    if not good:
        failures.append(what)


def below(what, value, bound):
    good = value <= bound
    print(f"{what}: {value:.2e}, at most {bound:g}" + ("" if good else "   NO"))
    if not good:
        failures.append(what)


def refused(expected, function, *arguments, kind=nodus.InputError, **options):
    """An error with this message (a part of it); returns the error."""
    try:
        function(*arguments, **options)
    except kind as error:
        good = expected in str(error)
        print(f"refused: {error}" + ("" if good else f"   NO, should be: {expected}"))
        if not good:
            failures.append(expected)
        return error
    print(f"NO error: {expected}")
    failures.append(expected)
    return None


def run(*tests):
    """Runs the tests, each in an empty folder; ends the program."""
    for test in tests:
        print(f"\n{test.__name__[len('test_'):].replace('_', ' ')}")
        with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
            stack.callback(os.chdir, os.getcwd())
            os.chdir(folder)
            test()
    print("\n" + (f"{len(failures)} NOT as it should be: " + "; ".join(failures) if failures else "all as it should be"))
    sys.exit(1 if failures else 0)
