// A block 4 x 0.5 x 1 on a base 6 x 0.75 x 1, half of a structure that is symmetric about y = 0; interface z = 0.
//
// Volumes:  1 block, 2 base
// Surfaces: 11 block, bottom (slave)    12 block, y = 0           13 block, loaded part of the top, 0.2 <= x <= 1.4
//           14 block, rest of the top   15 block, back x = -2     16 block, front x = 2     17 block, y = 0.5
//           21 base, top (master)       22 base, y = 0            23 base, bottom           24 base, ends and y = 0.75

// The block: three pieces along x, so that the loaded part of the top is a surface of its own.
// Extrude glues the pieces (and would glue anything else whose curves coincide, which the base avoids).
x[]  = {-2, 0.2, 1.4, 2};
n[]  = {18, 10, 5};
nz   = 6;
For i In {0:3}
  low[i]  = newp; Point(low[i])  = {x[i], 0, 0};
  high[i] = newp; Point(high[i]) = {x[i], 0, 1};
  post[i] = newc; Line(post[i])  = {low[i], high[i]};
EndFor
Transfinite Curve {post[]} = nz + 1;
For i In {0:2}
  below = newc; Line(below) = {low[i], low[i + 1]};
  above = newc; Line(above) = {high[i], high[i + 1]};
  Transfinite Curve {below, above} = n[i] + 1;
  loop = newll; Curve Loop(loop) = {below, post[i + 1], -above, -post[i]};
  face[i] = news; Surface(face[i]) = {loop};
  Transfinite Surface {face[i]};
  Recombine Surface {face[i]};
  piece[]   = Extrude {0, 0.5, 0} { Surface{face[i]}; Layers{4}; Recombine; };
  side[i]   = piece[0];
  volume[i] = piece[1];
  bottom[i] = piece[2];
  front[i]  = piece[3];
  top[i]    = piece[4];
  back[i]   = piece[5];
EndFor
Physical Volume(1)   = {volume[]};
Physical Surface(11) = {bottom[]};
Physical Surface(12) = {face[]};
Physical Surface(13) = {top[1]};
Physical Surface(14) = {top[0], top[2]};
Physical Surface(15) = {back[0]};
Physical Surface(16) = {front[2]};
Physical Surface(17) = {side[]};

// The base, not matching.
a = newp; Point(a) = {-3, 0, -1};
b = newp; Point(b) = {3, 0, -1};
c = newp; Point(c) = {3, 0, 0};
d = newp; Point(d) = {-3, 0, 0};
ab = newc; Line(ab) = {a, b};
bc = newc; Line(bc) = {b, c};
cd = newc; Line(cd) = {c, d};
da = newc; Line(da) = {d, a};
Transfinite Curve {ab, cd} = 39;
Transfinite Curve {bc, -da} = 6 Using Progression 0.75;
loop = newll; Curve Loop(loop) = {ab, bc, cd, da};
base = news; Surface(base) = {loop};
Transfinite Surface {base};
Recombine Surface {base};
piece[] = Extrude {0, 0.75, 0} { Surface{base}; Layers{5}; Recombine; };
Physical Volume(2)   = {piece[1]};
Physical Surface(21) = {piece[4]};
Physical Surface(22) = {base};
Physical Surface(23) = {piece[2]};
Physical Surface(24) = {piece[0], piece[3], piece[5]};

Mesh.MshFileVersion = 4.1;
