// Right half of the lower half of a ring in two layers of 5, radii 85, 90 and 95, its lowest point at the origin; a slice of
// thickness 2.5, cells of second order.
// gmsh -setnumber n 16: cells along the quarter of a circle.
//
// Volumes:  1 outer layer   2 inner layer
// Surfaces: 11 r = 95 (master)   12 r = 90, of both layers   13 end, y = 95   14 x = 0   15 z = 0 and z = 2.5

DefineConstant[ n = 16 ];
r[] = {95, 90, 85};
o = newp; Point(o) = {0, 95, 0};
For i In {0:2}
  low[i] = newp; Point(low[i]) = {0, 95 - r[i], 0};
  end[i] = newp; Point(end[i]) = {r[i], 95, 0};
  arc[i] = newc; Circle(arc[i]) = {low[i], o, end[i]};
EndFor
Transfinite Curve {arc[]} = n + 1;
For i In {0:1}
  a = newc; Line(a) = {end[i], end[i + 1]};
  b = newc; Line(b) = {low[i + 1], low[i]};
  Transfinite Curve {a, b} = 2;
  loop = newll; Curve Loop(loop) = {arc[i], a, -arc[i + 1], b};
  face[i] = news; Plane Surface(face[i]) = {loop};
  Transfinite Surface {face[i]};
  Recombine Surface {face[i]};
EndFor
outer[] = Extrude {0, 0, 2.5} { Surface{face[0]}; Layers{1}; Recombine; };
inner[] = Extrude {0, 0, 2.5} { Surface{face[1]}; Layers{1}; Recombine; };

Physical Volume("outer layer", 1) = {outer[1]};
Physical Volume("inner layer", 2) = {inner[1]};
Physical Surface("outside", 11)   = {outer[2]};
Physical Surface("interface", 12) = {outer[4]};
Physical Surface("end", 13)       = {outer[3], inner[3]};
Physical Surface("middle", 14)    = {outer[5], inner[5]};
Physical Surface("faces", 15)     = {face[], outer[0], inner[0]};

Mesh.ElementOrder = 2;
Mesh.MshFileVersion = 4.1;
