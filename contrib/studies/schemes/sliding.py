"""Force ripple of sliding over facets: a soft ring turns on a rigid shaft. The exact torque is constant."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import common
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
STEPS, PERIODS = 16, 3  # increments in a facet period of the shaft, and periods

CASE = """set Title = Soft ring that turns on a rigid shaft
subsection Body 1
  set Name                = shaft
  set Generator           = cylinder_shell
  set Generator arguments = 0.05 : 0.2 : 0.3 : {shaft} : 1
  subsection Material
    set Law             = neo-Hookean
    set Young's modulus = 1e8
  end
end
subsection Body 2
  set Name                = ring
  set Generator           = cylinder_shell
  set Generator arguments = 0.05 : 0.3 : 0.5 : {ring} : 1
  set Global refinement   = {refinement}
  subsection Material
    set Law             = neo-Hookean
    set Young's modulus = 1e6
    set Poisson's ratio = 0.3
  end
end
subsection Boundary condition 1
  set Name         = shaft
  set Body         = 1
  set Boundary ids = 0
  set Components   = x, y, z
  set Value        = 0
end
subsection Boundary condition 2
  set Name         = plane strain
  set Body         = 2
  set Boundary ids = 0
  set Components   = z
  set Value        = 0
end
subsection Boundary condition 3
  set Name         = grip
  set Body         = 2
  set Boundary ids = 0
  set Where        = sqrt(x^2+y^2)>0.499
  set Components   = x, y
  set Value        = (1-0.02*min(t,1))*(x*cos({turn}*max(t-1,0))-y*sin({turn}*max(t-1,0)))-x; \\
    (1-0.02*min(t,1))*(x*sin({turn}*max(t-1,0))+y*cos({turn}*max(t-1,0)))-y
end
subsection Contact pair 1
  set Name                 = bearing
  set Slave body           = 2
  set Slave boundary ids   = 0
  set Slave where          = sqrt(x^2+y^2)<0.301 && abs(z-0.025)<0.0249
  set Master body          = 1
  set Master boundary ids  = 0
  set Master where         = sqrt(x^2+y^2)>0.28 && abs(z-0.025)<0.0249
  set Friction coefficient = 0.3
  set Initial status       = closed
end
subsection Geometry loop
  set Maximum passes = 20
end
subsection Threshold loop
  set Maximum passes = 30
end
subsection Load stepping
  set Interval ends = 1, 2
  set Increments    = 1, {increments}
end
subsection Output
  set VTU interval = 0
end
"""

SHAFTS = (16, 24, 48)


def ripple(run):
    """Largest deviation of the torque from its mean over a facet period, relative; and that mean."""
    torque = np.array([row["slave moment z"] for row in run.contact])[1:]
    slides = torque[STEPS:]  # the first period brings the ring from stick to slip
    if len(slides) < STEPS:
        return float("nan"), float("nan")
    # mean over a centred period, its end points shared
    weights = np.ones(STEPS + 1)
    weights[[0, -1]] = 0.5
    mean = np.convolve(slides, weights / STEPS, mode="valid")
    half = STEPS // 2
    return np.max(np.abs(slides[half : half + len(mean)] / mean - 1.0)), np.mean(mean)


def main():
    kinds = [
        (scheme, surface, normal)
        for scheme in ("nodal", "integration point", "averaged, segment")
        for surface, normal in (
            ("faceted", "master facet"),
            ("faceted", "averaged"),
            ("smoothed", "master facet"),
            ("smoothed", "averaged"),
            ("smoothed", "slave"),
        )
    ]
    rows, curves = [], {}
    for shaft in SHAFTS:
        prm = common.write_case(
            f"sliding_{shaft}",
            CASE.format(
                shaft=shaft,
                ring=shaft // 2,  # as many faces as the shaft: all edges meet at once
                refinement=1,
                turn=repr(PERIODS * 2 * np.pi / shaft),
                increments=PERIODS * STEPS,
            ),
        )
        for scheme, surface, normal in kinds:
            run = common.run(
                prm,
                f"sliding_{shaft}_{scheme}_{surface}_{normal}".replace(" ", "_").replace(",", ""),
                pair=dict(common.keys_of(scheme), Surface=surface, Normal=normal),
            )
            value, torque = ripple(run)
            last = run.contact[-1]
            rows.append(
                [
                    shaft,
                    scheme,
                    surface,
                    normal,
                    "all" if run.converged else f"stopped at increment {int(last['increment'])}",
                    f"{100 * value:.3f} %",
                    f"{torque:.1f}",
                    f"{sum(row['Newton iterations'] for row in run.contact):.0f}",
                ]
            )
            print(rows[-1], flush=True)
            if normal != "slave":
                curves[(shaft, scheme, surface, normal)] = [row["slave moment z"] for row in run.contact]
    figure, axes = common.figure()
    for (shaft, scheme, surface, normal), torque in curves.items():
        if shaft == SHAFTS[1] and scheme != "integration point":
            axes.plot(np.arange(len(torque)) / STEPS, torque, label=f"{scheme}, {surface}, {normal}")
    axes.set_xlabel("angle [facets of the shaft]")
    axes.set_ylabel("torque [force length]")
    axes.legend(fontsize="small")
    figure.savefig(os.path.join(HERE, "sliding.png"), dpi=150)
    header = ["facets around", "scheme", "surface", "normal", "increments", "ripple", "mean torque", "Newton"]
    text = common.table(os.path.join(HERE, "sliding.md"), header, rows)
    with open(os.path.join(HERE, "sliding.md"), "w") as file:
        file.write("## Sliding: force ripple over facets\n\n")
        file.write(
            "A soft ring is shrunk on a rigid shaft of 16, 24 or 48 facets and turned by three of them in 48 increments, "
            "friction 0.3; the exact torque is constant. Ripple: largest deviation from the mean over a facet, after the "
            "first one.\n\n" + text + "\n![torque over angle](sliding.png)\n"
        )


if __name__ == "__main__":
    main()
