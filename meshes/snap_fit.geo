// Snap-fit: a clamped hook whose tooth rides over the corner of a catch, snaps in behind it and holds. Plane strain:
// one layer of cells. s is a factor of refinement.
s = 2;
Point(1) = {0, 0, 0};       Point(2) = {25.5, 0, 0};   Point(3) = {27, 0, 0};      Point(4) = {30, 0, 0};
Point(5) = {0, 2, 0};       Point(6) = {25.5, 2, 0};   Point(7) = {27, 2, 0};      Point(8) = {30, 2, 0};
Point(9) = {25.6, -1.5, 0}; Point(10) = {27, -1.5, 0}; Point(11) = {30, -0.3, 0};
Point(21) = {31, -3, 0};    Point(22) = {34, -3, 0};   Point(23) = {34, -0.6, 0};  Point(24) = {31, -0.6, 0};
Line(1) = {1, 2};    Line(2) = {2, 3};    Line(3) = {3, 4};
Line(4) = {5, 6};    Line(5) = {6, 7};    Line(6) = {7, 8};
Line(7) = {1, 5};    Line(8) = {2, 6};    Line(9) = {3, 7};    Line(10) = {4, 8};
Line(11) = {9, 10};  Line(12) = {10, 11};
Line(13) = {9, 2};   Line(14) = {10, 3};  Line(15) = {11, 4};
Line(21) = {21, 22}; Line(22) = {22, 23}; Line(23) = {23, 24}; Line(24) = {24, 21};
Curve Loop(1) = {1, 8, -4, -7};     Plane Surface(1) = {1}; // beam
Curve Loop(2) = {2, 9, -5, -8};     Plane Surface(2) = {2};
Curve Loop(3) = {3, 10, -6, -9};    Plane Surface(3) = {3};
Curve Loop(4) = {11, 14, -2, -13};  Plane Surface(4) = {4}; // tooth
Curve Loop(5) = {12, 15, -3, -14};  Plane Surface(5) = {5}; // its ramp
Curve Loop(6) = {21, 22, 23, 24};   Plane Surface(6) = {6}; // catch
Transfinite Curve {1, 4} = 34 * s + 1;
Transfinite Curve {2, 5, 11, 13, 14, 15} = 3 * s + 1;
Transfinite Curve {3, 6, 12} = 6 * s + 1;
Transfinite Curve {7, 8, 9, 10, 22, 24} = 4 * s + 1;
Transfinite Curve {21, 23} = 5 * s + 1;
Transfinite Surface {1 : 6};
Recombine Surface {1 : 6};

For i In {1 : 6}
  e[] = Extrude {0, 0, 0.5} { Surface{i}; Layers{1}; Recombine; };
  slice[] += {i, e[0]};
  volume[] += e[1];
EndFor
Physical Volume("hook", 1) = {volume[{0 : 4}]};
Physical Volume("catch", 2) = {volume[5]};
d = 1e-6;
Physical Surface("root", 11) = Surface In BoundingBox {-d, -d, -d, d, 2 + d, 0.5 + d};
Physical Surface("tooth", 12) = {Surface In BoundingBox {25.5 - d, -1.5 - d, -d, 25.6 + d, d, 0.5 + d},
                                 Surface In BoundingBox {25.6 - d, -1.5 - d, -d, 27 + d, -1.5 + d, 0.5 + d},
                                 Surface In BoundingBox {27 - d, -1.5 - d, -d, 30 + d, -0.3 + d, 0.5 + d}};
Physical Surface("ground", 21) = Surface In BoundingBox {31 - d, -3 - d, -d, 34 + d, -3 + d, 0.5 + d};
Physical Surface("catch", 22) = {Surface In BoundingBox {31 - d, -3 - d, -d, 31 + d, -0.6 + d, 0.5 + d},
                                 Surface In BoundingBox {31 - d, -0.6 - d, -d, 34 + d, -0.6 + d, 0.5 + d},
                                 Surface In BoundingBox {34 - d, -3 - d, -d, 34 + d, -0.6 + d, 0.5 + d}};
Physical Surface("slice", 5) = {slice[]};
