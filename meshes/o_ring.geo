// Section of an O-ring of radius 1 in a groove under a lid, a slice of thickness 0.2 in z.
// gmsh -setnumber n 6: cells along an eighth of the ring's circumference.
//
// Volumes:  1 ring    2 groove    3 lid
// Surfaces: ring_outside; groove_inside, groove_below; lid_below, lid_above; slice (z = 0 and 0.2 of all)

DefineConstant[ n = 6 ];
thickness = 0.2;

// ----- ring: a square inside, four blocks around it
o = newp; Point(o) = {0, 0, 0};
For i In {0:3}
  a = Pi / 4 + i * Pi / 2;
  outer[i] = newp; Point(outer[i]) = {Cos(a), Sin(a), 0};
  inner[i] = newp; Point(inner[i]) = {0.5 * Cos(a), 0.5 * Sin(a), 0};
EndFor
For i In {0:3}
  j = (i + 1) % 4;
  arc[i]   = newc; Circle(arc[i]) = {outer[i], o, outer[j]};
  side[i]  = newc; Line(side[i])  = {inner[i], inner[j]};
  spoke[i] = newc; Line(spoke[i]) = {inner[i], outer[i]};
EndFor
Transfinite Curve {arc[], side[]} = 2 * n + 1;
Transfinite Curve {spoke[]} = n + 1;
core = news; Curve Loop(core) = {side[]}; Plane Surface(core) = {core};
For i In {0:3}
  j = (i + 1) % 4;
  block[i] = news; Curve Loop(block[i]) = {spoke[i], arc[i], -spoke[j], -side[i]}; Plane Surface(block[i]) = {block[i]};
EndFor
ring[] = {core, block[]};
Transfinite Surface {ring[]};
Recombine Surface {ring[]};

// ----- groove: floor, two walls and what joins them
x[] = {-2.1, -1.6, 1.2, 1.7};
y[] = {-1.5, -1, 0.55};
For j In {0:2}
  For i In {0:3}
    g[4 * j + i] = newp; Point(g[4 * j + i]) = {x[i], y[j], 0};
  EndFor
EndFor
For j In {0:2}
  For i In {0:2}
    If (j < 2 || i != 1)
      h[3 * j + i] = newc; Line(h[3 * j + i]) = {g[4 * j + i], g[4 * j + i + 1]};
      Transfinite Curve {h[3 * j + i]} = (i == 1 ? 2 * n : 2) + 1;
    EndIf
  EndFor
EndFor
For j In {0:1}
  For i In {0:3}
    v[4 * j + i] = newc; Line(v[4 * j + i]) = {g[4 * j + i], g[4 * j + 4 + i]};
    Transfinite Curve {v[4 * j + i]} = (j == 1 ? n : 2) + 1;
  EndFor
EndFor
k = 0;
For j In {0:1}
  For i In {0:2}
    If (j == 0 || i != 1)
      groove[k] = news;
      Curve Loop(groove[k]) = {h[3 * j + i], v[4 * j + i + 1], -h[3 * j + 3 + i], -v[4 * j + i]};
      Plane Surface(groove[k]) = {groove[k]};
      k = k + 1;
    EndIf
  EndFor
EndFor
Transfinite Surface {groove[]};
Recombine Surface {groove[]};

// ----- lid
For i In {0:3}
  l[i] = newp; Point(l[i]) = {i == 0 || i == 3 ? -2.1 : 1.7, i < 2 ? 1 : 1.4, 0};
EndFor
For i In {0:3}
  lc[i] = newc; Line(lc[i]) = {l[i], l[(i + 1) % 4]};
  Transfinite Curve {lc[i]} = (i % 2 == 0 ? 2 * n : 2) + 1;
EndFor
lid = news; Curve Loop(lid) = {lc[]}; Plane Surface(lid) = {lid};
Transfinite Surface {lid};
Recombine Surface {lid};

// ----- slices
For s In {0 : 4}
  e[] = Extrude {0, 0, thickness} { Surface{ring[s]}; Layers{1}; Recombine; };
  slice[] += {ring[s], e[0]}; ring_volume[] += e[1];
  If (s > 0)
    ring_outside[] += e[3];
  EndIf
EndFor
For s In {0 : 4}
  e[] = Extrude {0, 0, thickness} { Surface{groove[s]}; Layers{1}; Recombine; };
  slice[] += {groove[s], e[0]}; groove_volume[] += e[1];
  If (s < 3)
    groove_below[] += e[2];
  EndIf
  If (s == 1)
    groove_inside[] += e[4];
  EndIf
  If (s == 3)
    groove_inside[] += e[3];
  EndIf
  If (s == 4)
    groove_inside[] += e[5];
  EndIf
EndFor
e[] = Extrude {0, 0, thickness} { Surface{lid}; Layers{1}; Recombine; };
slice[] += {lid, e[0]};

Physical Volume("ring", 1)   = {ring_volume[]};
Physical Volume("groove", 2) = {groove_volume[]};
Physical Volume("lid", 3)    = {e[1]};
Physical Surface("ring_outside", 11)  = {ring_outside[]};
Physical Surface("groove_inside", 21) = {groove_inside[]};
Physical Surface("groove_below", 22)  = {groove_below[]};
Physical Surface("lid_below", 31) = {e[2]};
Physical Surface("lid_above", 32) = {e[4]};
Physical Surface("slice", 5) = {slice[]};
