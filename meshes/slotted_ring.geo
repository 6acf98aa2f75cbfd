// A ring with a slot at its top: mean radius 10, thickness 0.5, a slot with parallel sides 0.35 apart, a slice of 0.5 in z.
// gmsh -setnumber n 4: cells through the thickness, m 40: along half of it.
//
// Volume:   1 ring
// Surfaces: right (side of the slot at x > 0), left, slice (z = 0)

DefineConstant[ n = 2, m = 24 ];
radius = 10; half = 0.25; slot = 0.35; width = 0.5;

c = newp; Point(c) = {0, 0, 0};
For s In {0 : 2} // the right side, the bottom, the left side
  For r In {0 : 1}
    distance = radius + (2 * r - 1) * half;
    p = newp;
    If (s == 1)
      Point(p) = {0, -distance, 0};
    Else
      Point(p) = {(1 - s) * slot / 2, Sqrt(distance^2 - slot^2 / 4), 0};
    EndIf
    at[2 * s + r] = p;
  EndFor
EndFor
For s In {0 : 1}
  // circles of less than half a turn: over a point at the side
  For r In {0 : 1}
    distance = radius + (2 * r - 1) * half;
    p = newp; Point(p) = {(1 - 2 * s) * distance, 0, 0};
    side[2 * s + r] = p;
  EndFor
EndFor
For s In {0 : 2}
  across[s] = newc; Line(across[s]) = {at[2 * s], at[2 * s + 1]};
EndFor
For s In {0 : 1}
  middle[s] = newc; Line(middle[s]) = {side[2 * s], side[2 * s + 1]};
EndFor
Transfinite Curve {across[], middle[]} = n + 1;
For s In {0 : 1} // half of the ring, upper and lower quarter of the way
  For q In {0 : 1}
    For r In {0 : 1}
      from = q == 0 ? at[2 * s + r] : side[2 * s + r];
      to = q == 0 ? side[2 * s + r] : at[2 * s + 2 + r];
      arc[r] = newc; Circle(arc[r]) = {from, c, to};
    EndFor
    Transfinite Curve {arc[]} = m / 2 + 1;
    first = q == 0 ? across[s] : middle[s];
    last = q == 0 ? middle[s] : across[s + 1];
    f = news; Curve Loop(f) = {first, arc[1], -last, -arc[0]}; Plane Surface(f) = {f};
    Transfinite Surface {f}; Recombine Surface {f};
    e[] = Extrude {0, 0, width} { Surface{f}; Layers{1}; Recombine; };
    slice[] += {f};
    volume[] += e[1];
    If (s == 0 && q == 0)
      right = e[2];
    ElseIf (s == 1 && q == 1)
      left = e[4];
    EndIf
  EndFor
EndFor
Mesh.ElementOrder = 2; // round, with elements of degree 2
Mesh.SecondOrderIncomplete = 1;
Physical Volume("ring", 1) = {volume[]};
Physical Surface("right", 11) = {right};
Physical Surface("left", 12) = {left};
Physical Surface("slice", 13) = {slice[]};
