// A cylinder of radius 1 and height 1: a square block in the middle and four around it, `n` x `n` cells per block, one
// cell in height. make-cylinders makes the .msh files from it, named by the nodes of a cell and by n.
//
// Volume 1; surfaces 1 bottom, 2 top, 3 mantle.
DefineConstant[ n = 1 ];

a = 0.45;             // half diagonal of the square block
Point(5) = {0, 0, 0};
For i In {0:3}
  Point(1 + i)  = {Cos(i * Pi / 2), Sin(i * Pi / 2), 0};
  Point(11 + i) = {a * Cos(i * Pi / 2), a * Sin(i * Pi / 2), 0};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  Circle(1 + i) = {1 + i, 5, 1 + j};
  Line(11 + i)  = {11 + i, 11 + j};
  Line(21 + i)  = {11 + i, 1 + i};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  Curve Loop(1 + i)    = {21 + i, 1 + i, -(21 + j), -(11 + i)};
  Plane Surface(1 + i) = {1 + i};
EndFor
Curve Loop(5)    = {11, 12, 13, 14};
Plane Surface(5) = {5};
Transfinite Curve{:} = n + 1;
Transfinite Surface{:};
Recombine Surface{:};

mantle[] = {};
top[]    = {};
For i In {1:5}
  made[] = Extrude{0, 0, 1}{ Surface{i}; Layers{1}; Recombine; };
  top[] += made[0];
  If (i < 5)
    mantle[] += made[3]; // after the top, the volume and the radial line: the arc
  EndIf
EndFor

Physical Surface(1) = {1:5};
Physical Surface(2) = top[];
Physical Surface(3) = mantle[];
Physical Volume(1)  = {1:5};
