#!/usr/bin/python3
"""Would the tests notice? One line of the sources is changed in its meaning at a time, and the tests named for it must fail.

    mutations.py BUILD_FOLDER [--only N ...]

BUILD_FOLDER is one of a checkout of its own, built with its test programs: the sources of that checkout are changed and
changed back. Prints the table of README.md; ends with 1 where a change passes unseen.
"""

import argparse
import os
import re
import subprocess
import sys

# room, file, line, what it becomes, what that means, tests that are to fail (a regular expression of ctest)
MUTATIONS = [
    ("contact law", "contact/contact_law.cc", "force.noalias() -= Wt * i.slip * i.projector * f.pi;",
     "force.noalias() += Wt * i.slip * i.projector * f.pi;", "sign of the friction force where a node slips",
     "contact/contact_law$|contact/block_pattern"),
    ("contact law", "contact/contact_law.cc", "r(ia) += -W * i.open * f.lambda_o / f.h_n - W * i.contact * f.distance;",
     "r(ia) += -W * i.open * f.lambda_o / f.h_n + W * i.contact * f.distance;", "sign of the gap",
     "contact/contact_law$|contact/block_pattern"),
    ("contact law", "contact/contact_law.cc", "K_B = (Matrix3::Identity() - pi * pi.transpose()) / norm;",
     "K_B = Matrix3::Identity() - pi * pi.transpose();", "derivative of the direction of slip",
     "contact/contact_law$|contact/contact_tangent"),
    ("contact law", "contact/contact_law.cc", "A(ia, jc) -= W / f.h_n * i.open * j.open; // eq. 45",
     "A(ia, jc) -= W / f.h_tau * i.open * j.open; // eq. 45", "row of an open node",
     "contact/contact_law$|contact/block_pattern"),
    ("status rules", "contact/status.cc", "if (now_.stick[site] && norm > 1. + noise)",
     "if (now_.stick[site] && norm > 1.02 + noise)", "sticking nodes may be 2 % beyond the cone",
     "friction/|contact/status_loop"),
    ("status rules", "contact/status.cc", "now_.contact[site] && value > noise * pressure &&",
     "now_.contact[site] && value > 0.01 * pressure &&", "closed nodes may pull by 1 %",
     "contact/status_loop|contact/schemes|contact/stabilisation|patch/|unit/status"),
    ("status rules", "contact/status.cc", "(found[i] == Contradiction::penetration && !opened_[k] && held(k));",
     "found[i] == Contradiction::penetration;", "sites that close after a slide stick",
     "friction/|contact/status_loop|unit/status|solver/ring_as_slave"),
    ("status rules", "contact/status.cc",
     "            frozen_[k] = true;\n", "", "sites that cycle go on changing",
     "contact/status_loop|unit/status|friction/"),
    ("thresholds", "contact/friction_limit.cc", "return limit / lambda;", "return 0.5 * limit / lambda;",
     "derivative of the threshold", "friction/merged_loops|contact/contact_tangent|friction/laws|unit/"),
    ("slip", "contact/status.cc", "now_.slip[k][i] += slip[k][i];", "now_.slip[k][i] -= slip[k][i];", "sign of the accumulated slip",
     "friction/tangent_frame"),
    ("transfer", "run/state_vectors.cc", "interface.stuck[s] = std::abs(sites[n * s + closed] - 1.) < 1e-6;",
     "interface.stuck[s] = std::abs(sites[n * s + closed] - 1.) < 0.6;", "nodes between closed and open ones are taken for stuck",
     "adaptivity/|unit/state"),
    ("transfer", "run/state_vectors.cc", "tangents[1] -= (tangents[1] * tangents[0]) * tangents[0];",
     "tangents[1] -= tangents[0];", "frames of interpolated tangents", "adaptivity/|unit/state"),
    ("transfer", "run/state_vectors.cc", "values[n * k + i] = sum[i] / sum[n];", "values[n * k + i] = sum[i];",
     "means of the integration points around a node", "adaptivity/|unit/state"),
    ("rollback", "run/model.cc", "    states.now = states.committed;", "    states.now.unknowns = states.committed.unknowns;",
     "statuses, thresholds and slips stay as an attempt left them", "restart/cut_back|friction/merged_loops|friction/dragged_far"),
    ("rollback", "run/strategy.cc", "        model_.roll_back(states_);\n", "", "an attempt begins where the one before ended",
     "friction/merged_loops|restart/cut_back"),
    ("rollback", "run/load_path.cc", "parts_.states.committed = now;", "parts_.states.committed.unknowns = now.unknowns;",
     "what a commit takes over", "restart/|friction/"),
    ("exchange", "parallel/ghost_exchange.cc", "owned[std::size_t(i) * n_components + c] += part;",
     "owned[std::size_t(i) * n_components + c] = part;", "sums over ranks", "unit/ghost_exchange"),
    ("exchange", "parallel/ghost_exchange.cc", "    update(values, n_components);\n", "", "ghosts keep their part of a sum",
     "unit/ghost_exchange"),
    ("materials", "bulk/j2_plasticity.cc", "along              = slope / (3. * mu_ + slope);",
     "along              = slope / (2. * mu_ + slope);", "elastoplastic tangent", "unit/material|unit/solid"),
    ("materials", "bulk/neo_hookean.cc", "- mu_ * log_J + lambda_ / 2. * log_J * log_J;",
     "- mu_ * log_J + lambda_ * log_J * log_J;", "stored energy", "unit/material|contact/energy"),
    ("materials", "bulk/mooney_rivlin.cc", "const Lanes isochoric = a * I1 / 9. + b * I2 * (4. / 9.);",
     "const Lanes isochoric = a * I1 / 9. + b * I2 * (2. / 9.);", "tangent of Mooney and Rivlin's law", "unit/material|unit/solid"),
    ("results", "contact/tractions.cc", "result.shear[i] = friction * frame.tangent[i];",
     "result.shear[i] = -(friction * frame.tangent[i]);", "sign of CSHEAR1 and CSHEAR2", "friction/tangent_frame"),
    ("results", "contact/tractions.cc", "      if (nodes[k].status() == ContactStatus::open)\n        continue;\n",
     "", "open nodes count as contact area", "contact/overhang"),
    ("results", "run/energy_audit.cc", "of_increment.contact  = work.normal;", "of_increment.contact  = 0.;",
     "work of contact in energy.csv", "contact/energy"),
    ("results", "run/energy_audit.cc", "of_increment.stabilisation -= forces.drag(i) * moved;",
     "of_increment.stabilisation += forces.drag(i) * moved;", "sign of the work of dashpots in energy.csv", "contact/energy"),
    ("results", "run/load_path.cc", "now.reaction = parts_.equilibrium.reactions();", ";",
     "reactions that are released are those of the interval before", "restart/release|contact/energy"),
    ("checkpoint", "run/state.h", "    visitor.common(stiffness_scale);\n", "", "the stiffness of the first tangent is not kept",
     "unit/state"),
]


def run(*command):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def tests(build, pattern):
    listed = run("ctest", "--test-dir", build, "-N", "-R", pattern).stdout
    return [name for name in re.findall(r"Test +#\d+: (\S+)", listed) if name != "build"]


def first_failure(build, pattern):
    """Name of the first test that fails, or of the target that does not build."""
    names = tests(build, pattern)
    programs = sorted({re.sub(r"\.mpirun=\d+$", "", name).replace("/", ".") for name in names})
    targets = run("cmake", "--build", build, "--target", "help").stdout
    programs = [p for p in programs if re.search(rf"^{re.escape(p)}(\.\w+)?: ", targets, re.MULTILINE)]
    known = [t for t in re.findall(r"^([\w.]+): phony", targets, re.MULTILINE)]
    wanted = [t for t in known if any(t == p or t == p + ".release" or t == p + ".debug" for p in programs)]
    built = run("cmake", "--build", build, "--parallel", "2", "--target", "nodus", *wanted)
    if built.returncode:
        return "does not build"
    for name in names:
        done = run("ctest", "--test-dir", build, "-R", f"^{re.escape(name)}$", "-FA", ".*")
        if done.returncode:
            return name
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("--only", type=int, nargs="+")
    options = parser.parse_args()
    with open(os.path.join(options.build, "CMakeCache.txt")) as cache:
        source = re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", cache.read(), re.MULTILINE).group(1)
    unseen = 0
    print("| | room | change | meaning | first test that fails |\n|---|---|---|---|---|")
    for number, (room, file, line, becomes, meaning, pattern) in enumerate(MUTATIONS, 1):
        if options.only and number not in options.only:
            continue
        path = os.path.join(source, "source", file)
        with open(path) as stream:
            text = stream.read()
        if text.count(line) != 1:
            raise SystemExit(f"{file} has {text.count(line)} lines '{line}'")
        try:
            with open(path, "w") as stream:
                stream.write(text.replace(line, becomes))
            failure = first_failure(options.build, pattern)
        finally:
            with open(path, "w") as stream:
                stream.write(text)
        unseen += failure in (None, "does not build")
        print(f"| {number} | {room} | `{line.strip()}` → `{becomes.strip()}` | {meaning} | {failure or 'NONE'} |", flush=True)
    return 1 if unseen else 0


if __name__ == "__main__":
    sys.exit(main())
