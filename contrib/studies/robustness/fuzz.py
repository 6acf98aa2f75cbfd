#!/usr/bin/python3
"""Inputs that are damaged, absurd or merely strange: does nodus run them or refuse them in words?

    fuzz.py [--seed N] [--inputs N] [--kinds KIND ...] [--only N ...] [--time-limit S] [--memory-limit GB] [--verbose]

Makes inputs 1 to N of a seed (fuzz_inputs.py), runs each with one process, and prints a line for each fault and a table.
Kinds: prm, json, msh, checkpoint, expression, set; input n is of kind (n - 1) modulo 6. Inputs of faults stay in the scratch
folder (NODUS_STUDIES), in fuzz/seed_<seed>/<number>/, with the command, stdout and stderr. --only makes and runs some again and
keeps what they leave. The exit code is 1 where there is a fault. NODUS names the program.

A fault is
  - an end by a signal, or an exit code other than 0 and 1;
  - no end within the CPU time (or three times that on the clock), or more memory than the limit;
  - exit code 1 without exactly one line, "nodus: input error: ..." or "nodus: no solution: ...", on standard error, or with
    words of the implementation in it (exceptions, std::, names of source files);
  - exit code 0 with nan or inf in a table, or with *.incomplete left that was not there before;
  - an input error that leaves files behind, or changes those that were there. One that the solution alone can show (a friction
    factor that is negative at a slip rate) may leave what was written before it, if that is complete.
"""

import argparse
import hashlib
import os
import re
import resource
import shlex
import shutil
import signal
import subprocess
import time

import fuzz_inputs

SCRATCH = fuzz_inputs.common.SCRATCH
INTERNALS = re.compile(r"exception|\bassert|\b\w+\.(?:cc|cpp|h|hpp|c)\b:\d+|std::|dealii::|boost::|bad_alloc|"
                       r"\bterminate|filesystem error|basic_string|vector::|\bstoul?\b|violated condition|<unspecified",
                       re.IGNORECASE)  # fmt: skip
NO_NUMBER = re.compile(r"(?:^|,)[-+]?(?:nan|inf)(?=,|$)", re.IGNORECASE | re.MULTILINE)
OUTCOMES = ("accepted", "refused", "no solution", "fault")


class Ended:
    """How a run ended: exit code (negative: signal), or why it was stopped, and what it said on standard error."""

    def __init__(self, code, stopped, cpu, errors):
        self.code, self.stopped, self.cpu, self.errors = code, stopped, cpu, errors


def memory_of(process):
    """Resident bytes, 0 once it has ended."""
    try:
        with open(f"/proc/{process}/statm") as file:
            return int(file.read().split()[1]) * resource.getpagesize()
    except (OSError, IndexError):
        return 0


def run(arguments, folder, log, options):
    """Runs nodus in a folder; log: begin of the names of the files for its output."""

    def limit():
        resource.setrlimit(resource.RLIMIT_CPU, (options.time_limit, options.time_limit + 1))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (2**30, 2**30))
        os.nice(10)

    environment = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    begin, stopped, largest = time.monotonic(), "", options.memory_limit * 2**30
    with open(log + "stdout", "wb") as out, open(log + "stderr", "wb") as err:
        child = subprocess.Popen([fuzz_inputs.NODUS] + arguments, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                 env=environment, start_new_session=True, preexec_fn=limit)  # fmt: skip
        while True:
            ended, status, usage = os.wait4(child.pid, os.WNOHANG)
            if ended:
                break
            if not stopped and memory_of(child.pid) > largest:
                stopped = f"more than {options.memory_limit:g} GB"
            elif not stopped and time.monotonic() - begin > 3 * options.time_limit:
                stopped = f"no end within {3 * options.time_limit} s"
            if stopped:
                os.killpg(child.pid, signal.SIGKILL)
            time.sleep(0.01)
    try:
        os.killpg(child.pid, signal.SIGKILL)  # what MPI may have started with it
    except ProcessLookupError:
        pass
    child.returncode = os.waitstatus_to_exitcode(status)
    if not stopped and child.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        stopped = f"no end within {options.time_limit} s of CPU time"
    with open(log + "stderr", errors="replace") as file:
        errors = file.read(2**20)
    return Ended(child.returncode, stopped, usage.ru_utime + usage.ru_stime, errors)


def contents(folder):
    """Paths of all files below a folder and checksums of them."""
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            path = os.path.join(place, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = hashlib.sha1(file.read()).hexdigest()
    return found


def nonsense(folder, before):
    """What should not be in the results of a run that ended well, or of the part of it that did."""
    for place, folders, names in os.walk(folder):
        for name in folders + names:
            path = os.path.relpath(os.path.join(place, name), folder)
            if name.endswith(".incomplete") and path not in before:
                return f"{path} is left"
            if name.endswith(".csv"):
                with open(os.path.join(place, name), errors="replace") as file:
                    found = NO_NUMBER.search(re.sub(r'"(?:[^"]|"")*"', "", file.read()))
                if found:
                    return f"{found[0].strip(',')} in {path}"
    return ""


def judge(ended, folder, before):
    """@returns the outcome, and for a fault what is wrong."""
    if ended.stopped:
        return "fault", ended.stopped
    if ended.code < 0:
        return "fault", f"death by {signal.Signals(-ended.code).name}: {ended.errors.strip()[:200]}"
    if ended.code == 0:
        wrong = nonsense(folder, before)
        return ("fault", "exit code 0, but " + wrong) if wrong else ("accepted", "")
    lines = [line for line in ended.errors.split("\n") if line.strip()]
    if ended.code != 1:
        return "fault", f"exit code {ended.code}: {' '.join(lines)[:200]}"
    if len(lines) != 1:
        return "fault", f"{len(lines)} lines on standard error: {' / '.join(lines)[:300]}"
    found = re.match(r"nodus: (input error|no solution): \S", lines[0])
    if not found:
        return "fault", f"not explained: {lines[0][:300]}"
    internal = INTERNALS.search(lines[0])
    if internal:
        return "fault", f"'{internal[0]}' in: {lines[0][:400]}"
    if found[1] == "no solution":
        return "no solution", ""
    if "for the slip rate" in lines[0]:
        wrong = nonsense(folder, before)
        return ("fault", "an error at a slip rate, and " + wrong) if wrong else ("refused", "")
    after = contents(folder)
    changed = sorted(path for path in after.keys() | before.keys() if after.get(path) != before.get(path))
    return ("fault",
            f"input error that left or changed {', '.join(changed)[:200]}: {lines[0][:200]}") if changed else ("refused", "")


def write(files, folder):
    """Files of an input: path -> bytes, None for a folder. A file where another one needs a folder is left out."""
    for path, data in sorted(files.items()):
        full = os.path.join(folder, path)
        try:
            os.makedirs(full if data is None else os.path.dirname(full), exist_ok=True)
            if data is not None:
                with open(full, "wb") as file:
                    file.write(data)
        except (FileExistsError, IsADirectoryError, NotADirectoryError):
            pass


class Finished:
    """Files of the runs that the restarts begin with; these are made once, when they are asked for."""

    def __init__(self, folder, options):
        self.folder, self.options, self.files = folder, options, None

    def __call__(self):
        if self.files is None:
            self.files = {}
            for name, tree in fuzz_inputs.checkpoint_cases().items():
                place = os.path.join(self.folder, name)
                shutil.rmtree(place, ignore_errors=True)
                write({"case.prm": fuzz_inputs.prm(tree).encode()}, place)
                ended = run(["case.prm"], place, os.path.join(self.folder, name + "."), self.options)
                if ended.code != 0:
                    raise SystemExit(f"the run that restarts are made from, {name}, ends with {ended.code}: {ended.errors}")
                self.files[name] = {}
                for path in contents(place):
                    with open(os.path.join(place, path), "rb") as file:
                        self.files[name][path] = file.read()
            shutil.rmtree(self.folder)
        return self.files


def table(counts):
    print("\n| kind | inputs | accepted | refused | no solution | faults |\n|---|---|---|---|---|---|")
    rows = [(kind, [counts.get((kind, outcome), 0) for outcome in OUTCOMES]) for kind in fuzz_inputs.KINDS]
    rows = [(kind, row) for kind, row in rows if sum(row)]
    for kind, row in rows + [("all", [sum(column) for column in zip(*(row for _, row in rows))])]:
        print(f"| {kind} | {sum(row)} | " + " | ".join(map(str, row)) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--inputs", type=int, default=300)
    parser.add_argument("--first", type=int, default=1, help="number of the first input")
    parser.add_argument("--kinds", nargs="+", choices=fuzz_inputs.KINDS, default=fuzz_inputs.KINDS)
    parser.add_argument("--only", type=int, nargs="+", help="numbers of inputs")
    parser.add_argument("--time-limit", type=int, default=20, help="CPU seconds of one run")
    parser.add_argument("--memory-limit", type=float, default=2, help="GB of one run")
    parser.add_argument("--verbose", action="store_true", help="a line for each input")
    options = parser.parse_args()

    top = os.path.join(SCRATCH, "fuzz", f"seed_{options.seed}")
    finished = Finished(os.path.join(top, "finished"), options)
    n_kinds, counts = len(fuzz_inputs.KINDS), {}
    numbers = options.only or [n for n in range(options.first, options.first + options.inputs * n_kinds)
                               if fuzz_inputs.KINDS[(n - 1) % n_kinds] in options.kinds][: options.inputs]  # fmt: skip
    for number in numbers:
        case = fuzz_inputs.make(number, options.seed, finished)
        place = os.path.join(top, str(number))
        folder = os.path.join(place, "run")
        shutil.rmtree(place, ignore_errors=True)
        write(case.files, folder)
        with open(os.path.join(place, "command"), "wb") as file:
            file.write(os.fsencode(f"cd {folder} && {shlex.join([fuzz_inputs.NODUS] + case.arguments)}\n"))
        before = contents(folder)
        ended = run(case.arguments, folder, os.path.join(place, ""), options)
        outcome, wrong = judge(ended, folder, before)
        counts[case.kind, outcome] = counts.get((case.kind, outcome), 0) + 1
        if outcome == "fault" or options.verbose or options.only:
            said = wrong or ended.errors.strip()[:300]
            print(f"{number} {case.kind}: {case.change!r}: {'FAULT' if outcome == 'fault' else outcome}, {ended.cpu:.1f} CPU s"
                  f"{': ' + said if said else ''}", flush=True)  # fmt: skip
        if outcome != "fault" and not options.only:
            shutil.rmtree(place)
    table(counts)
    if any(outcome == "fault" for _, outcome in counts):
        raise SystemExit(1)
    if not options.only and os.path.isdir(top):
        os.rmdir(top)


if __name__ == "__main__":
    main()
