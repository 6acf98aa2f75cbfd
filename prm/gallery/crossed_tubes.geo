// A quarter of two tubes that cross at right angles and touch: outer radius 12, wall 0.8, length 100. The lower one lies along z, the
// upper one along x above it, planes of symmetry are x = 0 and z = 0.
// gmsh -setnumber n 2: cells through the wall; m 16: cells along half a tube; around it, half a circle, 24 of them.
//
// Volumes:  1 lower, 2 upper
// Surfaces: lower_end, upper_end, x_symmetry, z_symmetry; what is left may touch

DefineConstant[ n = 2, m = 16, k = 24 ];
outer = 12; inner = 11.2; half = 50;

// Half a ring in the plane through its axis: its axis points along t = 0: z, 1: x.
For t In {0 : 1}
  y = 2 * outer * t;
  c = newp; Point(c) = {0, y, 0};
  For s In {0 : 2}
    angle = -Pi / 2 + s * Pi / 2;
    For r In {0 : 1}
      radius = r == 0 ? inner : outer;
      p = newp;
      side = radius * Cos(angle);
      If (t == 0)
        Point(p) = {side, y + radius * Sin(angle), 0};
      Else
        Point(p) = {0, y + radius * Sin(angle), side};
      EndIf
      at[2 * s + r] = p;
    EndFor
    wall[s] = newc; Line(wall[s]) = {at[2 * s], at[2 * s + 1]};
  EndFor
  Transfinite Curve {wall[]} = n + 1;
  For s In {0 : 1}
    in = newc; Circle(in) = {at[2 * s], c, at[2 * s + 2]};
    out = newc; Circle(out) = {at[2 * s + 1], c, at[2 * s + 3]};
    Transfinite Curve {in, out} = k / 2 + 1;
    f = news; Curve Loop(f) = {in, wall[s + 1], -out, -wall[s]}; Plane Surface(f) = {f};
    Transfinite Surface {f}; Recombine Surface {f};
    If (t == 0)
      e[] = Extrude {0, 0, half} { Surface{f}; Layers{m}; Recombine; };
    Else
      e[] = Extrude {half, 0, 0} { Surface{f}; Layers{m}; Recombine; };
    EndIf
    middle[2 * t + s] = f;
    end[2 * t + s] = e[0];
    volume[2 * t + s] = e[1];
    cut[2 * t + s] = s == 0 ? e[5] : e[3];
  EndFor
EndFor
Physical Volume("lower", 1) = {volume[0], volume[1]};
Physical Volume("upper", 2) = {volume[2], volume[3]};
Physical Surface("lower_end", 11) = {end[0], end[1]};
Physical Surface("upper_end", 12) = {end[2], end[3]};
Physical Surface("x_symmetry", 13) = {cut[0], cut[1], middle[2], middle[3]};
Physical Surface("z_symmetry", 14) = {middle[0], middle[1], cut[2], cut[3]};
s() = Boundary{ Volume{volume[]}; };
