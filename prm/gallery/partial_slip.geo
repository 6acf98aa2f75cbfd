// A roller and a block that touch along a line, for prm/gallery/partial_slip.prm: roller of radius 10, a sector of 120 degrees around
// a bore of radius 2, its lowest point at (-0.075, 0); block 16 x 8 below y = 0; a slice of thickness 0.01.
// gmsh -setnumber h 0.003125: size of the faces where they touch, for x = -0.15 to 0.15.
//
// Volumes:  1 block   2 roller
// Surfaces: 11 top of the block   12 base   13 rim of the roller   14 bore   15 z = 0 and z = 0.01

DefineConstant[ h = 0.003125 ];
t = 0.01;

p[] = {newp, newp + 1, newp + 2, newp + 3};
Point(p[0]) = {-8, -8, 0}; Point(p[1]) = {8, -8, 0}; Point(p[2]) = {8, 0, 0}; Point(p[3]) = {-8, 0, 0};
For i In {0 : 3}
  c[i] = newc; Line(c[i]) = {p[i], p[(i + 1) % 4]};
EndFor
block = news; Curve Loop(block) = {c[]}; Plane Surface(block) = {block};

x = -0.075; s = Sin(Pi / 3); k = Cos(Pi / 3);
o = newp; Point(o) = {x, 10, 0};
q0 = newp; Point(q0) = {x - 10 * s, 10 - 10 * k, 0};
q1 = newp; Point(q1) = {x + 10 * s, 10 - 10 * k, 0};
q2 = newp; Point(q2) = {x + 2 * s, 10 - 2 * k, 0};
q3 = newp; Point(q3) = {x - 2 * s, 10 - 2 * k, 0};
rim = newc; Circle(rim) = {q0, o, q1};
right = newc; Line(right) = {q1, q2};
bore = newc; Circle(bore) = {q2, o, q3};
left = newc; Line(left) = {q3, q0};
roller = news; Curve Loop(roller) = {rim, right, bore, left}; Plane Surface(roller) = {roller};

Field[1] = MathEval;
Field[1].F = Sprintf("min(1.5, %g + 0.2 * sqrt(max(0, abs(x) - 0.15)^2 + y^2))", h);
Background Field = 1;
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeFromPoints = 0;
Mesh.Algorithm = 6;
Mesh.RecombinationAlgorithm = 2;
Recombine Surface {block, roller};

a[] = Extrude {0, 0, t} { Surface{block}; Layers{1}; Recombine; };
b[] = Extrude {0, 0, t} { Surface{roller}; Layers{1}; Recombine; };
Physical Volume("block", 1)   = {a[1]};
Physical Volume("roller", 2)  = {b[1]};
Physical Surface("top", 11)   = {a[4]};
Physical Surface("base", 12)  = {a[2]};
Physical Surface("rim", 13)   = {b[2]};
Physical Surface("bore", 14)  = {b[4]};
Physical Surface("sides", 15) = {block, a[0], roller, b[0]};
Mesh.MshFileVersion = 4.1;
