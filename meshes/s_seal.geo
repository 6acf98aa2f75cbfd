// Section of a seal in the shape of an S: three legs of thickness 0.4, one above the other with gaps of 0.6, joined by two bends;
// the lowest and the highest leg are longer than the S is wide. A slice of thickness 0.1 in z.
// gmsh -setnumber n 4: cells through the thickness.
//
// Volume:   1 seal
// Surfaces: outside (all that may touch), below (of the lowest leg), above (of the highest leg), slice (z = 0 and 0.1)

DefineConstant[ n = 4 ];
half = 0.2; radius = 0.5; leg = 2; more = 1; // half of the thickness; length of the middle leg, of the others beyond it

// Where the S begins, and where a part of it ends: beginning, two halves of a bend, and so on. The normal is to the left of the way.
x[]  = {-more, leg, leg + radius, leg, 0, -radius, 0, leg + more};
y[]  = {0, 0, radius, 2 * radius, 2 * radius, 3 * radius, 4 * radius, 4 * radius};
nx[] = {0, 0, -1, 0, 0, -1, 0, 0};
ny[] = {1, 1, 0, -1, -1, 0, 1, 1};
first = newp; Point(first) = {leg, radius, 0};
second = newp; Point(second) = {0, 3 * radius, 0};
For i In {0 : 7}
  right[i] = newp; Point(right[i]) = {x[i] - half * nx[i], y[i] - half * ny[i], 0};
  left[i]  = newp; Point(left[i])  = {x[i] + half * nx[i], y[i] + half * ny[i], 0};
  across[i] = newc; Line(across[i]) = {right[i], left[i]};
EndFor
For i In {0 : 6}
  r[i] = newc;
  If (i % 3 == 0)
    Line(r[i]) = {right[i], right[i + 1]};
    l[i] = newc; Line(l[i]) = {left[i], left[i + 1]};
  Else
    centre = i < 3 ? first : second;
    Circle(r[i]) = {right[i], centre, right[i + 1]};
    l[i] = newc; Circle(l[i]) = {left[i], centre, left[i + 1]};
  EndIf
  Transfinite Curve {r[i], l[i]} = (i % 6 == 0 ? 6 * n : i == 3 ? 4 * n : 2 * n) + 1;
  part[i] = news; Curve Loop(part[i]) = {r[i], across[i + 1], -l[i], -across[i]}; Plane Surface(part[i]) = {part[i]};
EndFor
Transfinite Curve {across[]} = n + 1;
Transfinite Surface {part[]};
Recombine Surface {part[]};

For i In {0 : 6}
  e[] = Extrude {0, 0, 0.1} { Surface{part[i]}; Layers{1}; Recombine; };
  slice[] += {part[i], e[0]};
  volume[] += e[1];
  If (i == 0)
    below[] += e[2];
    outside[] += e[4]; ends[] += e[5];
  ElseIf (i == 6)
    above[] += e[4];
    outside[] += e[2]; ends[] += e[3];
  Else
    outside[] += {e[2], e[4]};
  EndIf
EndFor
Physical Volume("seal", 1) = {volume[]};
Physical Surface("outside", 11) = {outside[]};
Physical Surface("below", 12) = {below[]};
Physical Surface("above", 13) = {above[]};
Physical Surface("ends", 14) = {ends[]};
Physical Surface("slice", 5) = {slice[]};
