// Block 20 x 10 x 50 cut by a plane through its centre whose normal makes 30 degrees with the z axis. The meshes of the
// two halves match on the cut, but each half has its own nodes there.
//
// Volumes:  1 lower half, 2 upper half
// Surfaces: 11 lower half, z = 0     12 lower half, cut (master)     13 lower half, sides
//           21 upper half, z = 50    22 upper half, cut (slave)      23 upper half, sides

B     = 20;
D     = 10;
H     = 50;
slope = Tan(Pi / 6);
nx    = 6;
ny    = 3;
nz    = 7; // per half

// Half between the heights za (at x = 0), zb (at x = B) below and zc, zd above. No Extrude: it would glue the halves.
// Makes volume `body` and face[] = {below, x = B, above, x = 0, y = 0, y = D}.
Macro Half
  For k In {0:1}
    y = D * k;
    p[4 * k]     = newp; Point(p[4 * k])     = {0, y, za};
    p[4 * k + 1] = newp; Point(p[4 * k + 1]) = {B, y, zb};
    p[4 * k + 2] = newp; Point(p[4 * k + 2]) = {B, y, zd};
    p[4 * k + 3] = newp; Point(p[4 * k + 3]) = {0, y, zc};
    For i In {0:3}
      c[4 * k + i] = newc; Line(c[4 * k + i]) = {p[4 * k + i], p[4 * k + (i + 1) % 4]};
    EndFor
    Transfinite Curve {c[4 * k], c[4 * k + 2]} = nx + 1;
    Transfinite Curve {c[4 * k + 1], c[4 * k + 3]} = nz + 1;
    loop = newll; Curve Loop(loop) = {c[4 * k], c[4 * k + 1], c[4 * k + 2], c[4 * k + 3]};
    face[4 + k] = news; Plane Surface(face[4 + k]) = {loop};
  EndFor
  For i In {0:3}
    post[i] = newc; Line(post[i]) = {p[i], p[4 + i]};
  EndFor
  Transfinite Curve {post[]} = ny + 1;
  For i In {0:3}
    loop = newll; Curve Loop(loop) = {c[i], post[(i + 1) % 4], -c[4 + i], -post[i]};
    face[i] = news; Plane Surface(face[i]) = {loop};
  EndFor
  Transfinite Surface {face[]};
  Recombine Surface {face[]};
  shell = newsl; Surface Loop(shell) = {face[]};
  body = newv; Volume(body) = {shell};
  Transfinite Volume {body};
Return

za = 0; zb = 0; zc = H / 2 - slope * B / 2; zd = H / 2 + slope * B / 2;
Call Half;
Physical Volume(1)   = {body};
Physical Surface(11) = {face[0]};
Physical Surface(12) = {face[2]};
Physical Surface(13) = {face[1], face[{3:5}]};

za = zc; zb = zd; zc = H; zd = H;
Call Half;
Physical Volume(2)   = {body};
Physical Surface(21) = {face[2]};
Physical Surface(22) = {face[0]};
Physical Surface(23) = {face[1], face[{3:5}]};

Mesh.MshFileVersion = 2.2;
