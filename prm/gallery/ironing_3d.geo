// Half of a half cylinder, a shell, for prm/gallery/ironing_3d.prm: outer radius 3, wall 0.2, half width 2.6; axis along y, plane of symmetry y = 0.
// It touches z = 3 at x = 2.5.
// gmsh -setnumber n 16: cells around; m 4: along its half width; w 1: through the wall
//
// Volume:   1
// Surfaces: top (the edges that are driven), symmetry, outside

DefineConstant[ n = 16, m = 4, w = 1 ];
x = 2.5; z = 6;
c = newp; Point(c) = {x, 0, z};
For s In {0 : 2}
  angle = Pi + s * Pi / 2;
  For r In {0 : 1}
    at[2 * s + r] = newp; Point(at[2 * s + r]) = {x + (2.8 + 0.2 * r) * Cos(angle), 0, z + (2.8 + 0.2 * r) * Sin(angle)};
  EndFor
  wall[s] = newc; Line(wall[s]) = {at[2 * s], at[2 * s + 1]};
EndFor
Transfinite Curve {wall[]} = w + 1;
For s In {0 : 1}
  in = newc; Circle(in) = {at[2 * s], c, at[2 * s + 2]};
  out = newc; Circle(out) = {at[2 * s + 1], c, at[2 * s + 3]};
  Transfinite Curve {in, out} = n / 2 + 1;
  f = news; Curve Loop(f) = {in, wall[s + 1], -out, -wall[s]}; Plane Surface(f) = {f};
  Transfinite Surface {f}; Recombine Surface {f};
  e[] = Extrude {0, 2.6, 0} { Surface{f}; Layers{m}; Recombine; };
  side[s] = f;
  volume[s] = e[1];
  outside[s] = e[4];
  top[s] = s == 0 ? e[5] : e[3];
EndFor
Physical Volume("die", 1) = {volume[]};
Physical Surface("top", 1) = {top[]};
Physical Surface("symmetry", 2) = {side[]};
Physical Surface("outside", 3) = {outside[]};
Mesh.ElementOrder = 2;
