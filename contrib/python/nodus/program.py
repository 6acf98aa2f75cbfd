"""The program nodus: where it is, what it says about its keys, and runs of it."""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import warnings
from functools import cached_property

from . import prm
from .errors import InputError, RunError
from .html import table
from .reference import Reference
from .results import Results

LIBRARIES = "Additional shared libraries"  # the key
# The build folder of contrib/build, where this package stands in a source tree.
_SOURCE_TREE = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))),
                            "build-release", "nodus")


def _found(path):
    """The program that is named, or of NODUS, PATH or the source tree."""
    for name, where in ((path, "program"), (os.environ.get("NODUS"), "the environment variable NODUS")):
        if name:
            found = shutil.which(os.fspath(name))
            if not found:
                raise InputError(f"there is no program '{name}', which {where} names")
            return os.path.abspath(found)
    found = shutil.which("nodus") or (_SOURCE_TREE if os.path.exists(_SOURCE_TREE) else None)
    if not found:
        raise InputError("nodus is not found: give its path (program=...), set NODUS, or put it in PATH; "
                         "contrib/build makes build-release/nodus")
    return os.path.abspath(found)


def environment():
    """As contrib/run sets it: containers run as root, and ranks that wait must not slow down those that work."""
    ours = {"HWLOC_HIDE_ERRORS": "2", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
            "OMPI_MCA_mpi_yield_when_idle": "1"}
    return {**ours, **os.environ}


class Program:
    """nodus at a path, or of the environment variable NODUS, of PATH, or of the source tree that this package stands in."""

    def __init__(self, path=None):
        self.path = _found(path)

    def _answer(self, option, *file):
        done = subprocess.run([self.path, *file, option], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False,
                              env=environment())
        if done.returncode != 0 and file:
            raise InputError(re.sub(re.escape(file[0]) + r"(:\d+)?: ", "", _message(done.stderr)))
        if done.returncode != 0:
            raise InputError(f"{self.path} does not know {option}: it is no nodus, or one that is older than this package")
        return done.stdout

    @cached_property
    def reference(self):
        """Its keys."""
        return Reference(self._answer("--document-json"))

    def reference_with(self, libraries):
        """Its keys and those of plug-ins, shared libraries. @throws InputError with what is wrong with one of them"""
        if not libraries:
            return self.reference
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "case.prm")
            with open(path, "w", encoding="utf-8") as file:
                file.write(f"set {LIBRARIES} = {', '.join(map(os.path.abspath, libraries))}\n")
            return Reference(self._answer("--document-json", path))

    @cached_property
    def version(self):
        """Versions of nodus and its libraries, as text."""
        return self._answer("--version")

    def _command(self, file, ranks, launcher, arguments, sets):
        command = [self.path, os.fspath(file), *arguments]
        for key, value in (sets or {}).items():
            command += ["--set", f"{key}={value}"]
        if launcher:
            return [word.format(ranks=ranks) for word in launcher.split()] + command
        if ranks == 1:
            return command
        too_many = ranks > len(os.sched_getaffinity(0))
        return ["mpirun", "-n", str(ranks)] + ["--oversubscribe"] * too_many + command

    def validate(self, file, ranks=1, sets=None, surfaces=None):
        """What a run of a file would start from; surfaces: a .vtu file to be written, for `nodus.surfaces.picture`.
        @throws InputError"""
        arguments = ["--validate"] + (["--surfaces", os.fspath(surfaces)] if surfaces else [])
        done = subprocess.run(self._command(file, ranks, None, arguments, sets), stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, check=False, env=environment())
        if done.returncode != 0:
            raise InputError(_message(done.stdout))
        return done.stdout

    def run(self, file, ranks=1, *, sets=None, restart=False, profile=False, echo=False, check=True, launcher=None):
        """Runs a .prm or .json file and waits for its end. Returns a Run.

        sets: {"Section/Key": value} in place of those of the file; restart: goes on from the last checkpoint; profile:
        Results.profile has where the time went; echo: prints the log as it comes; check: @throws InputError for a case that
        is refused and RunError for a run that fails, both with what the program says (False: the Run tells);
        launcher: what starts `ranks` processes, such as "srun -n {ranks}", by default mpirun where they are several.

        A run that is interrupted (Ctrl-C, the stop button of a notebook) writes a checkpoint at its next Newton iteration and
        ends; interrupted again, ranks end at once."""
        if "build type Debug" in self.version:
            warnings.warn(f"{self.path} is built as Debug, which is some ten times slower than Release", stacklevel=2)
        folder = prm.results_folder(file, sets or {})
        diagnosis = os.path.join(folder, "diagnosis.md")
        before = _stamp(diagnosis)
        arguments = ["--restart"] * bool(restart) + ["--profile"] * bool(profile)
        code, log, usage = _watched(self._command(file, ranks, launcher, arguments, sets), echo, launcher or ranks > 1)
        diagnosis = _text(diagnosis) if _stamp(diagnosis) != before else ""
        if os.path.isdir(folder) and not (code and _is_refused(log)):
            prm.write_complete(os.path.join(folder, "log"), log)
        if check and code:
            if _is_refused(log):
                raise InputError(_message(log))
            raise RunError(_message(log, code), code, log, folder, diagnosis)
        return Run(folder, code, log, usage, diagnosis)


class Run(Results):
    """The results of a run that has just ended, and `code` of its exit, `log`, `cpu` seconds of all its processes, `memory`
    (MiB at the peak of the largest process), `diagnosis` (text of diagnosis.md, where it has failed, or "")."""

    def __init__(self, folder, code, log, usage, diagnosis=""):
        super().__init__(folder)
        self.code, self.log, self.diagnosis = code, log, diagnosis
        self.cpu, self.memory = usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024

    @property
    def converged(self):
        return self.code == 0

    @property
    def message(self):
        """What the program says about its failure, in a line; empty where it has none."""
        return _message(self.log, self.code) if self.code else ""

    def _repr_html_(self):
        rows = [["exit code", self.code], ["CPU", f"{self.cpu:.1f} s"], ["memory", f"{self.memory:.0f} MiB"]]
        rows += [["failed", self.message]] if self.code else []
        return table([], rows) + super()._repr_html_()


def _watched(command, echo, launched):
    """Exit code, output and usage of resources of a program, or of one that has launched several."""
    # A session of its own: what interrupts us reaches it once, through us.
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                             env=environment(), start_new_session=True)
    lines = []
    try:
        for line in child.stdout:
            lines.append(line)
            if echo:
                sys.stdout.write(line)
                sys.stdout.flush()
    except BaseException:
        _end(child, launched)
        raise
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    child.stdout.close()
    return child.returncode, "".join(lines), usage


def _end(child, launched):
    """Ends a run with a checkpoint. A launcher hands SIGUSR1 on, but kills its ranks too soon after SIGTERM."""
    try:
        if launched:
            child.send_signal(signal.SIGUSR1)
            for line in child.stdout:
                if "checkpoint written" in line or "no checkpoint" in line:
                    break
    finally:
        child.send_signal(signal.SIGTERM)
        child.communicate()


def _message(log, code=1):
    """The error of the program in its output, which is in one line, or else the last line."""
    lines = [line for line in log.splitlines() if line.strip()]
    ours = [line for line in lines if line.startswith("nodus: ")]
    if code < 0 and not ours:
        return f"the program was ended by {signal.Signals(-code).name}" + (f" after: {lines[-1]}" if lines else "")
    text = (ours or lines or [f"nodus: it ended with exit code {code} and said nothing"])[-1]
    for start in ("nodus: input error: ", "nodus: "):
        if text.startswith(start):
            return text[len(start):]
    return text


def _is_refused(log):
    return any(line.startswith("nodus: input error: ") for line in log.splitlines())


def _stamp(path):
    """Tells whether a file has been written again; None: there is none."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_ino, found.st_mtime_ns


def _text(path):
    if not os.path.exists(path):
        return ""
    with open(path, encoding="utf-8") as file:
        return file.read()
