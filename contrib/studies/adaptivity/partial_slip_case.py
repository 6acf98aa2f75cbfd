"""The case of cattaneo_mindlin.py: a paraboloid pressed on a block of the same material, then sheared; half model."""

import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))
import common  # noqa: E402

RADIUS, YOUNG, FRICTION = 100.0, 1000.0, 0.3  # Poisson's ratio 0: the theory is exact
SIZE, BLOCK = 8.0, 9.0
FORCE = 4 * YOUNG / 2 / (3 * RADIUS)  # of the full model: contact radius 1
RATIO = 0.5  # tangential force over friction times normal force
# six steps; of twelve increments every other one holds the load, and shows what a new mesh has changed
STEPS = "floor(6*min(max(t-1,0),1)+1e-6)/6"
APPROACH, SHIFT = 0.0104, 0.0012  # about the same by displacement


def mesh(name, axis_1, depth_1, axis_2, depth_2):
    """Corner positions, from 0, of the cells of paraboloid and block, in the radial directions and over the depth."""

    def lattice(points):
        return np.interp(np.arange(0, len(points) - 0.9, 0.5), np.arange(len(points)), points)

    bodies = []
    for axis, depth, sign in ((axis_1, depth_1, 1), (axis_2, depth_2, -1)):
        axis, depth = lattice(axis), lattice(depth)
        x = np.concatenate([-axis[:0:-1], axis])
        x, y, z = np.meshgrid(x, axis, depth if sign > 0 else -depth[::-1], indexing="ij")
        gap = (x**2 + y**2) / (2 * RADIUS)
        bodies.append(np.stack([x, y, gap + z * (1 - gap / SIZE) if sign > 0 else z], axis=-1))
    os.makedirs(os.path.join(common.SCRATCH, "adaptivity"), exist_ok=True)
    return common.write_mesh("adaptivity/" + name, bodies)


def boxes(name="boxes"):
    """Cells of size 4 on the paraboloid, 4.5 on the block."""
    axis = np.linspace(0, 1, 3)
    return mesh(name, SIZE * axis, SIZE * axis, BLOCK * axis, BLOCK * axis)


def graded(name="graded"):
    """Cells of size 0.6 in the contact on the paraboloid, 0.7 on the block, and larger outside."""
    axis = np.array([0, 0.6, 1.2, 2, 4, 8])
    depth = np.array([0, 0.6, 1.5, 3.5, 8])
    block = np.array([0, 0.7, 1.4, 2.4, 4.5, 9])
    return mesh(name, axis, depth, block, depth * BLOCK / SIZE)


BY_FORCE = f"""
subsection Boundary condition 2
  set Name         = middle
  set Body         = 1
  set Boundary ids = 15
  set Components   = z
  set Value        = 0
end
subsection Boundary condition 3
  set Name         = guide
  set Body         = 2
  set Boundary ids = 20, 21
  set Components   = x
  set Value        = 0
end
subsection Boundary condition 4
  set Name         = normal
  set Type         = traction
  set Body         = 2
  set Boundary ids = 24
  set Components   = z
  set Value        = {FORCE / (2 * BLOCK) ** 2}*min(t,1)
end
subsection Boundary condition 5
  set Name         = tangential
  set Type         = traction
  set Body         = 1
  set Boundary ids = 15
  set Components   = x
  set Value        = {RATIO * FRICTION * FORCE / (2 * SIZE) ** 2}*{STEPS}
end
"""

BY_DISPLACEMENT = f"""
subsection Boundary condition 2
  set Name         = support
  set Body         = 2
  set Boundary ids = 24
  set Components   = x, y, z
  set Value        = 0
end
subsection Boundary condition 3
  set Name         = approach
  set Body         = 1
  set Boundary ids = 15
  set Components   = x, y, z
  set Value        = {SHIFT}*{STEPS}; 0; -{APPROACH}*min(t,1)
end
"""


def write(name, mesh_file, loads, increments="2, 6"):
    bodies = "".join(
        f"""subsection Body {number}
  set Name       = {body}
  set Mesh file  = {os.path.basename(mesh_file)}
  set Volume ids = {number}
  subsection Material
    set Law             = linear elastic
    set Young's modulus = {YOUNG}
    set Poisson's ratio = 0
  end
end
"""
        for number, body in ((1, "paraboloid"), (2, "block"))
    )
    text = f"""set Title = Partial slip on an adaptive mesh
{bodies}subsection Boundary condition 1
  set Name         = symmetry
  set Boundary ids = 12, 22
  set Components   = y
  set Value        = 0
end
{loads}subsection Contact pair 1
  set Name                 = contact
  set Slave body           = 1
  set Slave boundary ids   = 14
  set Master body          = 2
  set Master boundary ids  = 25
  set Friction coefficient = {FRICTION}
end
subsection Load stepping
  set Interval ends = 1, 2
  set Increments    = {increments}
end
subsection Newton
  set Force tolerance   = 1e-7
  set Contact tolerance = 1e-7
end
subsection Linear solver
  set Type = condensed
end
"""
    return common.write_case("adaptivity/" + name, text)
