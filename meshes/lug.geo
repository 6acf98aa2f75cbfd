// A lug of aluminium and the hollow steel pin that pulls at it; mm; a quarter of both, y > 0 and z > 0.
//
// Volumes:  1 lug, 2 pin
// Surfaces: 11 hole and 12 clamped end of the lug, 13 mantle (bolt) and 14 end (pulled) of the pin,
//           15 middle: z = 0, 16 symmetry: y = 0

hole = 10; clearance = 0.1; bore = 4; // radius of the hole, how much less that of the pin is, the pin's inner radius
outer = 22; shank = 60;               // radius of the lug's head, and how far its clamped end is from the hole's centre
thickness = 6; overhang = 4;          // half of the lug, and how far the pin stands out

// The lug: corners on the hole, the same ones outside, and the clamped end.
Point(1) = {0, 0, 0};
Point(2) = {hole, 0, 0};
Point(3) = {0, hole, 0};
Point(4) = {-hole * Sqrt(0.5), hole * Sqrt(0.5), 0};
Point(5) = {-hole, 0, 0};
Point(6) = {outer, 0, 0};
Point(7) = {0, outer, 0};
Point(8) = {-outer, outer, 0};
Point(9) = {-outer, 0, 0};
Point(10) = {-shank, outer, 0};
Point(11) = {-shank, 0, 0};

Circle(1) = {2, 1, 3};   // the hole, three arcs
Circle(2) = {3, 1, 4};
Circle(3) = {4, 1, 5};
Circle(4) = {6, 1, 7};   // the outside
Line(5) = {7, 8};
Line(6) = {8, 9};
Line(7) = {8, 10};
Line(8) = {10, 11};      // the clamped end
Line(9) = {11, 9};
Line(10) = {2, 6};       // from the hole outwards
Line(11) = {3, 7};
Line(12) = {4, 8};
Line(13) = {5, 9};

Curve Loop(1) = {10, 4, -11, -1};  Plane Surface(1) = {1};
Curve Loop(2) = {11, 5, -12, -2};  Plane Surface(2) = {2};
Curve Loop(3) = {12, 6, -13, -3};  Plane Surface(3) = {3};
Curve Loop(4) = {7, 8, 9, -6};     Plane Surface(4) = {4};

// The pin, where it touches the hole at x > 0.
Point(21) = {clearance, 0, 0};
Point(22) = {hole, 0, 0};
Point(23) = {clearance, hole - clearance, 0};
Point(24) = {2 * clearance - hole, 0, 0};
Point(25) = {clearance + bore, 0, 0};
Point(26) = {clearance, bore, 0};
Point(27) = {clearance - bore, 0, 0};
Circle(21) = {22, 21, 23};  // the mantle
Circle(22) = {23, 21, 24};
Circle(23) = {25, 21, 26};  // the bore
Circle(24) = {26, 21, 27};
Line(25) = {25, 22};        // outwards
Line(26) = {26, 23};
Line(27) = {27, 24};
Curve Loop(21) = {25, 21, -26, -23};  Plane Surface(21) = {21};
Curve Loop(22) = {26, 22, -27, -24};  Plane Surface(22) = {22};

// Cells along each curve, plus one.
Transfinite Curve {1, 4} = 13;
Transfinite Curve {2, 3, 5, 6, 8} = 7;
Transfinite Curve {10 : 13} = 7 Using Progression 1.2;
Transfinite Curve {7, -9} = 8 Using Progression 1.2;
Transfinite Curve {21, 22, 23, 24} = 11;
Transfinite Curve {25 : 27} = 5;
Transfinite Surface {:};
Recombine Surface {:};
Mesh.ElementOrder = 2; // curved cells, so that the hole is round however fine the mesh becomes
Mesh.SecondOrderIncomplete = 1;

// Layers of hexahedra. Of each extruded surface e[0] is the far face, e[1] the volume, e[2], ... the sides in the order of its loop.
For s In {1 : 4}
  e[] = Extrude {0, 0, thickness} { Surface{s}; Layers{4}; Recombine; };
  lug[] += e[1];
  If (s < 4)
    surface_of_the_hole[] += e[5];
  Else
    clamped[] = e[3];
    below[] += e[4];
  EndIf
  If (s == 1)
    below[] += e[2];
  ElseIf (s == 3)
    below[] += e[4];
  EndIf
EndFor
For s In {21 : 22}
  e[] = Extrude {0, 0, thickness + overhang} { Surface{s}; Layers{6}; Recombine; };
  pin[] += e[1];
  pulled[] += e[0];
  bolt[] += e[3];
  If (s == 21)
    below[] += e[2];
  Else
    below[] += e[4];
  EndIf
EndFor

Physical Volume("lug", 1) = {lug[]};
Physical Volume("pin", 2) = {pin[]};
Physical Surface("hole", 11) = {surface_of_the_hole[]};
Physical Surface("clamped", 12) = {clamped[]};
Physical Surface("bolt", 13) = {bolt[]};
Physical Surface("pulled", 14) = {pulled[]};
Physical Surface("middle", 15) = {1 : 4, 21 : 22};
Physical Surface("symmetry", 16) = {below[]};
