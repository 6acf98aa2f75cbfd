// The indenter of the shallow ironing: 1.2 wide, 1.2 high, its lower end an arc of radius 0.75 (0.3 high) that meets the
// sides at an edge; a slice of thickness 1. The tip is at (0.8, 4.2).
// gmsh -setnumber n 12: cells along the arc.
//
// Volume:   1 indenter
// Surfaces: 11 arc (master)   12 sides   13 top   14 z = 0 and z = 1

DefineConstant[ n = 12 ];
x = 0.8; y = 4.2;

Point(1) = {x - 0.6, y + 0.3, 0};
Point(2) = {x, y + 0.75, 0};
Point(3) = {x + 0.6, y + 0.3, 0};
Point(4) = {x + 0.6, y + 1.2, 0};
Point(5) = {x - 0.6, y + 1.2, 0};
Circle(1) = {1, 2, 3};
Line(2) = {3, 4};
Line(3) = {4, 5};
Line(4) = {5, 1};
Transfinite Curve {1, 3} = n + 1;
Transfinite Curve {2, -4} = n / 2 + 1 Using Progression 1.15;
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Transfinite Surface {1};
Recombine Surface {1};
slice[] = Extrude {0, 0, 1} { Surface{1}; Layers{1}; Recombine; };

Physical Volume("indenter", 1) = {slice[1]};
Physical Surface("arc", 11)    = {slice[2]};
Physical Surface("sides", 12)  = {slice[3], slice[5]};
Physical Surface("top", 13)    = {slice[4]};
Physical Surface("faces", 14)  = {1, slice[0]};

Mesh.MshFileVersion = 4.1;
