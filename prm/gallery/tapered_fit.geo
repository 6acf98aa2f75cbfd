// A quarter of a tapered pin in its hub for prm/gallery/tapered_fit.prm: radius 20 + z/50 where they touch, hub from z = 0 to 10 with outer
// radius 40, pin a shell, as it is rigid, and long enough to be pushed in by 12. Axis z, planes of symmetry x = 0 and y = 0.
// gmsh -setnumber r 6: cells of the hub along the radius; t 8: around the quarter; h 1: through its height
//
// Volumes:  hub, pin
// Surfaces: of the hub bore, ends, x_symmetry, y_symmetry; of the pin outside

DefineConstant[ r = 6, t = 8, h = 1 ];
// of hub and pin: bottom, top, radii inside and outside there; cells along the radius, up, around; ratio of neighbours
z[] = {0, 10, -2, 24};
inside[] = {20, 20.2, 18, 18};
outside[] = {40, 40, 19.96, 20.48};
n[] = {r, 1}; m[] = {h, 2}; around[] = {t, 12}; grading[] = {1.2, 1};

For body In {0 : 1}
  For end In {0 : 1}
    i = 2 * body + end;
    a[end] = newp; Point(a[end]) = {inside[i], 0, z[i]};
    b[end] = newp; Point(b[end]) = {outside[i], 0, z[i]};
    along[end] = newc; Line(along[end]) = {a[end], b[end]};
  EndFor
  in = newc; Line(in) = {a[0], a[1]};
  out = newc; Line(out) = {b[0], b[1]};
  Transfinite Curve {along[]} = n[body] + 1 Using Progression grading[body];
  Transfinite Curve {in, out} = m[body] + 1;
  f = news; Curve Loop(f) = {along[0], out, -along[1], -in}; Plane Surface(f) = {f};
  Transfinite Surface {f}; Recombine Surface {f};
  e[] = Extrude {{0, 0, 1}, {0, 0, 0}, Pi / 2} { Surface{f}; Layers{around[body]}; Recombine; };
  If (body == 0)
    Physical Volume("hub", 1) = {e[1]};
    Physical Surface("bore", 1) = {e[5]};
    Physical Surface("ends", 2) = {e[2], e[4]};
    Physical Surface("y_symmetry", 3) = {f};
    Physical Surface("x_symmetry", 4) = {e[0]};
  Else
    Physical Volume("pin", 2) = {e[1]};
    Physical Surface("outside", 5) = {e[3]};
  EndIf
EndFor
Mesh.ElementOrder = 2;
