// Two concentric rings, a quarter of a slice of thickness 0.05, not matching along the interface r = 0.6.
// gmsh -setnumber level 1 (or 2): number of times the coarse mesh is halved.
//
// Volumes:  1 inner ring 0.2 <= r <= 0.6, 2 outer ring 0.6 <= r <= 1
// Surfaces: 11 inner ring, r = 0.2     12 inner ring, r = 0.6 (slave)     21 outer ring, r = 0.6 (master)     22 r = 1
//           13 inner ring, x = 0       14 inner ring, y = 0               23 outer ring, x = 0                24 y = 0
//           15 inner ring, z = 0, 0.05                                    25 outer ring, z = 0, 0.05

DefineConstant[ level = 1 ];
refine = 2 ^ level;

// Ring between radii r and R with `around` cells along the quarter and `across` between the radii. No Extrude: it
// would glue the rings where curves coincide. Makes volume `body` and face[] = {y = 0, R, x = 0, r, z = 0, z = 0.05}.
Macro Ring
  For k In {0:1}
    z = 0.05 * k;
    o = newp; Point(o) = {0, 0, z};
    p[4 * k]     = newp; Point(p[4 * k])     = {r, 0, z};
    p[4 * k + 1] = newp; Point(p[4 * k + 1]) = {R, 0, z};
    p[4 * k + 2] = newp; Point(p[4 * k + 2]) = {0, R, z};
    p[4 * k + 3] = newp; Point(p[4 * k + 3]) = {0, r, z};
    c[4 * k]     = newc; Line(c[4 * k])       = {p[4 * k], p[4 * k + 1]};
    c[4 * k + 1] = newc; Circle(c[4 * k + 1]) = {p[4 * k + 1], o, p[4 * k + 2]};
    c[4 * k + 2] = newc; Line(c[4 * k + 2])   = {p[4 * k + 2], p[4 * k + 3]};
    c[4 * k + 3] = newc; Circle(c[4 * k + 3]) = {p[4 * k + 3], o, p[4 * k]};
    Transfinite Curve {c[4 * k], c[4 * k + 2]} = across + 1;
    Transfinite Curve {c[4 * k + 1], c[4 * k + 3]} = around + 1;
    loop = newll; Curve Loop(loop) = {c[4 * k], c[4 * k + 1], c[4 * k + 2], c[4 * k + 3]};
    face[4 + k] = news; Plane Surface(face[4 + k]) = {loop};
  EndFor
  For i In {0:3}
    post[i] = newc; Line(post[i]) = {p[i], p[4 + i]};
  EndFor
  Transfinite Curve {post[]} = 2;
  For i In {0:3}
    loop = newll; Curve Loop(loop) = {c[i], post[(i + 1) % 4], -c[4 + i], -post[i]};
    face[i] = news; Surface(face[i]) = {loop};
  EndFor
  Transfinite Surface {face[]};
  Recombine Surface {face[]};
  shell = newsl; Surface Loop(shell) = {face[]};
  body = newv; Volume(body) = {shell};
  Transfinite Volume {body};
Return

r = 0.2; R = 0.6; around = 8 * refine; across = 4 * refine;
Call Ring;
Physical Volume(1)   = {body};
Physical Surface(11) = {face[3]};
Physical Surface(12) = {face[1]};
Physical Surface(13) = {face[2]};
Physical Surface(14) = {face[0]};
Physical Surface(15) = {face[{4:5}]};

r = 0.6; R = 1; around = 5 * refine; across = 3 * refine;
Call Ring;
Physical Volume(2)   = {body};
Physical Surface(21) = {face[3]};
Physical Surface(22) = {face[1]};
Physical Surface(23) = {face[2]};
Physical Surface(24) = {face[0]};
Physical Surface(25) = {face[{4:5}]};

Mesh.MshFileVersion = 4.1;
