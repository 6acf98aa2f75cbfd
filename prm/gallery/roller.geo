// Quarter of a roller of radius 50, x >= 0, below its middle plane y = 50, with its lowest point at the origin; a slice of
// thickness 1, fine at that point.
// gmsh -setnumber n 44: cells along the lower half of the arc.
//
// Volume:   1 roller
// Surfaces: 11 arc (master)   12 x = 0   13 middle plane   14 z = 0 and z = 1

DefineConstant[ n = 44 ];
m = n / 2; k = 8;
growth = 1 + 1.8 / n; deep = 1 + 6.2 / n;
s = 50 * Sqrt(0.5);
Point(1) = {0, 0, 0};
Point(2) = {s, 50 - s, 0};
Point(3) = {50, 50, 0};
Point(4) = {0, 50, 0};
Point(5) = {0, 26, 0};
Point(6) = {20, 32, 0};
Point(7) = {26, 50, 0};
Circle(1) = {1, 4, 2};
Circle(2) = {2, 4, 3};
Line(3) = {3, 7};
Line(4) = {7, 4};
Line(5) = {4, 5};
Line(6) = {5, 1};
Line(7) = {5, 6};
Line(8) = {6, 2};
Line(9) = {6, 7};
Transfinite Curve {1, 7, -4} = n + 1 Using Progression growth;
Transfinite Curve {-6, -8, 3} = m + 1 Using Progression deep;
Transfinite Curve {2, 5, 9} = k + 1;
Curve Loop(1) = {1, -8, -7, 6};
Curve Loop(2) = {2, 3, -9, 8};
Curve Loop(3) = {7, 9, 4, 5};
For i In {1:3}
  Plane Surface(i) = {i};
  Transfinite Surface {i};
  Recombine Surface {i};
  piece[] = Extrude {0, 0, 1} { Surface{i}; Layers{1}; Recombine; };
  For j In {0:5}
    part[6 * (i - 1) + j] = piece[j];
  EndFor
EndFor

Physical Volume("roller", 1)    = {part[{1, 7, 13}]};
Physical Surface("arc", 11)     = {part[2], part[8]};
Physical Surface("axis", 12)    = {part[5], part[17]};
Physical Surface("middle", 13)  = {part[9], part[16]};
Physical Surface("faces", 14)   = {1:3, part[{0, 6, 12}]};

Mesh.MshFileVersion = 4.1;
