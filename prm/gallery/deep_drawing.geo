// A quarter of a round blank and of the tools that draw it to a cup, for prm/gallery/deep_drawing.prm (mm): blank of radius 40, 2 thick, on
// the plane z = 0; die of radius 22.5 with an edge of 5; punch of radius 20 with an edge of 6, on the blank; holder, a ring from 27.5 on.
// Tools are shells, as they are rigid. Axis z, planes of symmetry x = 0 and y = 0.
// gmsh -setnumber n 7: cells of the blank around an eighth; r 36: along the radius from 14 on; l 2: through the thickness; o 1: order
//      -setnumber wedge 2: a wedge of so many degrees and one layer of cells from y = 0 on, with r cells from a radius of 0.5 on
//
// Volumes:  blank, die, punch, holder
// Surfaces: of the blank upper, lower, x_symmetry, y_symmetry; of the tools die_side, punch_side, holder_side

DefineConstant[ n = 7, r = 36, l = 2, o = 1, wedge = 0 ];
thickness = 2;
angle = wedge == 0 ? Pi / 2 : wedge * Pi / 180;
layers = wedge == 0 ? 2 * n : 1;

// Blank: a core of three corners, a ring up to where the edge of the punch begins, a ring beyond.
If (wedge == 0)
  half = Sqrt(0.5);
  radius[] = {7, 14, 40};
  core = newp; Point(core) = {0, 0, 0};
  For k In {0 : 2}
    p[3 * k] = newp; Point(p[3 * k]) = {radius[k], 0, 0};
    s = k == 0 ? 0.92 : 1;
    p[3 * k + 1] = newp; Point(p[3 * k + 1]) = {radius[k] * half * s, radius[k] * half * s, 0};
    p[3 * k + 2] = newp; Point(p[3 * k + 2]) = {0, radius[k], 0};
  EndFor
  x = newc; Line(x) = {core, p[0]};
  y = newc; Line(y) = {core, p[2]};
  For k In {0 : 2}
    For i In {0 : 1}
      arc[2 * k + i] = newc;
      If (k == 0)
        Line(arc[i]) = {p[i], p[i + 1]};
      Else
        Circle(arc[2 * k + i]) = {p[3 * k + i], core, p[3 * k + i + 1]};
      EndIf
    EndFor
  EndFor
  Transfinite Curve {x, y, arc[]} = n + 1;
  f = news; Curve Loop(f) = {x, arc[0], arc[1], -y}; Plane Surface(f) = {f};
  Transfinite Surface {f} = {core, p[0], p[1], p[2]};
  flat[0] = f;
  For k In {0 : 1}
    For i In {0 : 2}
      spoke[i] = newc; Line(spoke[i]) = {p[3 * k + i], p[3 * k + 3 + i]};
    EndFor
    Transfinite Curve {spoke[]} = (k == 0 ? Ceil(n / 2) : r) + 1;
    For i In {0 : 1}
      f = news; Curve Loop(f) = {spoke[i], arc[2 * k + 2 + i], -spoke[i + 1], -arc[2 * k + i]}; Plane Surface(f) = {f};
      Transfinite Surface {f};
      flat[2 * k + 1 + i] = f;
    EndFor
  EndFor
  Recombine Surface {flat[]};
  For k In {0 : 4}
    e[] = Extrude {0, 0, thickness} { Surface{flat[k]}; Layers{l}; Recombine; };
    upper[k] = e[0];
    blank[k] = e[1];
    If (k == 0)
      y_symmetry[0] = e[2]; x_symmetry[0] = e[5];
    ElseIf (k % 2 == 1)
      y_symmetry[(k + 1) / 2] = e[2];
    Else
      x_symmetry[k / 2] = e[4];
    EndIf
  EndFor
Else
  corner[] = {0.5, 0, 40, 0, 40, thickness, 0.5, thickness};
  For i In {0 : 3}
    p[i] = newp; Point(p[i]) = {corner[2 * i], 0, corner[2 * i + 1]};
  EndFor
  For i In {0 : 3}
    c = newc; Line(c) = {p[i], p[(i + 1) % 4]};
    Transfinite Curve {c} = (i % 2 == 0 ? r : l) + 1;
    around[i] = c;
  EndFor
  f = news; Curve Loop(f) = {around[]}; Plane Surface(f) = {f};
  Transfinite Surface {f}; Recombine Surface {f};
  e[] = Extrude {{0, 0, 1}, {0, 0, 0}, angle} { Surface{f}; Layers{layers}; Recombine; };
  y_symmetry[0] = f; x_symmetry[0] = e[0]; blank[0] = e[1]; flat[0] = e[2]; upper[0] = e[4];
EndIf

// A tool: its profile flat, edge, side, and the same again inside of it, turned about the axis.
// t = 0: die, 1: punch
flat_r[] = {44, 0.01}; edge_r[] = {27.5, 14}; side_r[] = {22.5, 20}; edge[] = {5, 6}; level[] = {0, thickness}; up[] = {-1, 1}; deep[] = {32, 36};
depth[] = {3, 3}; cells[] = {wedge == 0 ? 10 : 96, wedge == 0 ? 12 : 96}; along_flat[] = {4, 4}; along_side[] = {4, 4};
For t In {0 : 1}
  For m In {0 : 1}
    // towards the inside of the tool: the profile moves off by depth
    d = m * depth[t]; z = level[t] + up[t] * d;
    out = t == 0 ? 1 : -1;
    q[4 * m] = newp; Point(q[4 * m]) = {flat_r[t], 0, z};
    q[4 * m + 1] = newp; Point(q[4 * m + 1]) = {edge_r[t], 0, z};
    q[4 * m + 2] = newp; Point(q[4 * m + 2]) = {side_r[t] + out * d, 0, level[t] + up[t] * edge[t]};
    q[4 * m + 3] = newp; Point(q[4 * m + 3]) = {side_r[t] + out * d, 0, level[t] + up[t] * deep[t]};
    c = newp; Point(c) = {edge_r[t], 0, level[t] + up[t] * edge[t]};
    u[3 * m] = newc; Line(u[3 * m]) = {q[4 * m], q[4 * m + 1]};
    u[3 * m + 1] = newc; Circle(u[3 * m + 1]) = {q[4 * m + 1], c, q[4 * m + 2]};
    u[3 * m + 2] = newc; Line(u[3 * m + 2]) = {q[4 * m + 2], q[4 * m + 3]};
    Transfinite Curve {u[3 * m]} = along_flat[t] + 1;
    Transfinite Curve {u[3 * m + 1]} = cells[t] + 1;
    Transfinite Curve {u[3 * m + 2]} = along_side[t] + 1;
  EndFor
  For i In {0 : 3}
    w[i] = newc; Line(w[i]) = {q[i], q[4 + i]};
  EndFor
  Transfinite Curve {w[]} = 2;
  For i In {0 : 2}
    f = news; Curve Loop(f) = {u[i], w[i + 1], -u[3 + i], -w[i]}; Plane Surface(f) = {f};
    Transfinite Surface {f}; Recombine Surface {f};
    e[] = Extrude {{0, 0, 1}, {0, 0, 0}, angle} { Surface{f}; Layers{layers}; Recombine; };
    tool[3 * t + i] = e[1];
    side[3 * t + i] = e[2];
  EndFor
EndFor
// Holder: a ring.
For m In {0 : 1}
  q[2 * m] = newp; Point(q[2 * m]) = {27.5, 0, thickness + 3 * m};
  q[2 * m + 1] = newp; Point(q[2 * m + 1]) = {44, 0, thickness + 3 * m};
  u[m] = newc; Line(u[m]) = {q[2 * m], q[2 * m + 1]};
EndFor
w[0] = newc; Line(w[0]) = {q[0], q[2]};
w[1] = newc; Line(w[1]) = {q[1], q[3]};
Transfinite Curve {u[0], u[1]} = along_flat[0] + 1;
Transfinite Curve {w[0], w[1]} = 2;
f = news; Curve Loop(f) = {u[0], w[1], -u[1], -w[0]}; Plane Surface(f) = {f};
Transfinite Surface {f}; Recombine Surface {f};
e[] = Extrude {{0, 0, 1}, {0, 0, 0}, angle} { Surface{f}; Layers{layers}; Recombine; };

Physical Volume("blank", 1) = {blank[]};
Physical Volume("die", 2) = {tool[0], tool[1], tool[2]};
Physical Volume("punch", 3) = {tool[3], tool[4], tool[5]};
Physical Volume("holder", 4) = {e[1]};
Physical Surface("upper", 11) = {upper[]};
Physical Surface("lower", 12) = {flat[]};
Physical Surface("x_symmetry", 13) = {x_symmetry[]};
Physical Surface("y_symmetry", 14) = {y_symmetry[]};
Physical Surface("die_side", 21) = {side[0], side[1], side[2]};
Physical Surface("punch_side", 22) = {side[3], side[4], side[5]};
Physical Surface("holder_side", 23) = {e[2]};
Mesh.ElementOrder = o;
Mesh.SecondOrderIncomplete = 0;
