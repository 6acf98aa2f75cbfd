// Hertz contact: a quarter of the lower half of a sphere of radius 8 on a quarter of a block, pole at the origin.
// Both are graded to the contact point: a box of n x n x n cells around it and three blocks that grow outwards by a
// constant ratio. The contact radius at an approach of 0.005 is a = 0.2; the sphere's cells there are 0.023. The block is
// meant to be refined once by nodus (Global refinement = 1; it has no curved face to lose), its cells are 0.025 then.
//
// Volumes:  1 sphere, 2 block
// Surfaces: 11 sphere, x = 0     12 sphere, y = 0     13 sphere, flat top z = 8    14 sphere, curved (slave)
//           21 block, x = 0      22 block, y = 0      23 block, bottom             24 block, top z = 0 (master)
//           25 block, x = 16 and y = 16

R = 8;   // radius of the sphere
L = 16;  // edge of the block, 80 a

// Corners p[] of one body: 0-3 contact face of the box, 4-7 its far face, 8-10 rim, 11-14 far side. Curves that touch
// the contact surface are arcs about point `centre` unless that is zero. There are n cells across the box
// and m, each q times as long as the one before, from the box outwards. Makes surfaces s[] and volumes v[]:
// s[0-2] contact side (box, x block, y block), s[3-5] y = 0, s[6-8] x = 0, s[9-11] far side and ends.
Macro Octant
  For i In {0:3}
    j = (i + 1) % 4;
    bottom[i] = newc;
    If (centre)
      Circle(bottom[i]) = {p[i], centre, p[j]};
    Else
      Line(bottom[i]) = {p[i], p[j]};
    EndIf
    top[i]   = newc; Line(top[i])   = {p[4 + i], p[4 + j]};
    up[i]    = newc; Line(up[i])    = {p[i], p[4 + i]};
    far[i]   = newc; Line(far[i])   = {p[11 + i], p[11 + j]};
    out[i]   = newc; Line(out[i])   = {p[4 + i], p[11 + i]};
  EndFor
  For i In {0:2}
    along[i] = newc; // from the box to the rim
    If (centre)
      Circle(along[i]) = {p[i + 1], centre, p[8 + i]};
    Else
      Line(along[i]) = {p[i + 1], p[8 + i]};
    EndIf
    edge[i]  = newc; Line(edge[i])  = {p[8 + i], p[12 + i]};
  EndFor
  For i In {0:1}
    rim[i]   = newc;
    If (centre)
      Circle(rim[i]) = {p[8 + i], centre, p[9 + i]};
    Else
      Line(rim[i]) = {p[8 + i], p[9 + i]};
    EndIf
  EndFor
  Transfinite Curve {bottom[], top[], up[], far[], edge[], rim[]} = n + 1;
  Transfinite Curve {out[], along[]} = m + 1 Using Progression q;

  loop = newll; Curve Loop(loop) = {bottom[0], bottom[1], bottom[2], bottom[3]};         l[0] = loop;
  loop = newll; Curve Loop(loop) = {along[0], rim[0], -along[1], -bottom[1]};            l[1] = loop;
  loop = newll; Curve Loop(loop) = {along[1], rim[1], -along[2], -bottom[2]};            l[2] = loop;
  loop = newll; Curve Loop(loop) = {bottom[0], up[1], -top[0], -up[0]};                  l[3] = loop;
  loop = newll; Curve Loop(loop) = {along[0], edge[0], -out[1], -up[1]};                 l[4] = loop;
  loop = newll; Curve Loop(loop) = {top[0], out[1], -far[0], -out[0]};                   l[5] = loop;
  loop = newll; Curve Loop(loop) = {bottom[3], up[0], -top[3], -up[3]};                  l[6] = loop;
  loop = newll; Curve Loop(loop) = {along[2], edge[2], -out[3], -up[3]};                 l[7] = loop;
  loop = newll; Curve Loop(loop) = {top[3], out[0], -far[3], -out[3]};                   l[8] = loop;
  loop = newll; Curve Loop(loop) = {far[0], far[1], far[2], far[3]};                     l[9] = loop;
  loop = newll; Curve Loop(loop) = {rim[0], edge[1], -far[1], -edge[0]};                 l[10] = loop;
  loop = newll; Curve Loop(loop) = {rim[1], edge[2], -far[2], -edge[1]};                 l[11] = loop;
  loop = newll; Curve Loop(loop) = {top[0], top[1], top[2], top[3]};                     l[12] = loop;
  loop = newll; Curve Loop(loop) = {bottom[1], up[2], -top[1], -up[1]};                  l[13] = loop;
  loop = newll; Curve Loop(loop) = {bottom[2], up[3], -top[2], -up[2]};                  l[14] = loop;
  loop = newll; Curve Loop(loop) = {along[1], edge[1], -out[2], -up[2]};                 l[15] = loop;
  loop = newll; Curve Loop(loop) = {top[1], out[2], -far[1], -out[1]};                   l[16] = loop;
  loop = newll; Curve Loop(loop) = {top[2], out[3], -far[2], -out[2]};                   l[17] = loop;
  For i In {0:17}
    s[i] = news;
    If (centre && i < 3)
      Surface(s[i]) = {l[i]} In Sphere {centre};
    Else
      Surface(s[i]) = {l[i]};
    EndIf
  EndFor
  Transfinite Surface {s[]};
  Recombine Surface {s[]};

  shell = newsl; Surface Loop(shell) = {s[0], s[12], s[3], s[6], s[13], s[14]};   v[0] = newv; Volume(v[0]) = {shell};
  shell = newsl; Surface Loop(shell) = {s[13], s[10], s[1], s[4], s[15], s[16]};  v[1] = newv; Volume(v[1]) = {shell};
  shell = newsl; Surface Loop(shell) = {s[14], s[11], s[2], s[7], s[15], s[17]};  v[2] = newv; Volume(v[2]) = {shell};
  shell = newsl; Surface Loop(shell) = {s[12], s[9], s[5], s[8], s[16], s[17]};   v[3] = newv; Volume(v[3]) = {shell};
  Transfinite Volume {v[]};
Return

// The sphere. Its rim is at the equator, its far side is the flat top.
b      = 0.23;
d      = 0.85 * b;
e      = 0.75 * b;
n      = 10;
m      = 22;
q      = 1.232;
centre = newp; Point(centre) = {0, 0, R};
p[0]   = newp; Point(p[0])   = {0, 0, 0};
p[1]   = newp; Point(p[1])   = {b, 0, R - Sqrt(R * R - b * b)};
p[2]   = newp; Point(p[2])   = {d, d, R - Sqrt(R * R - 2 * d * d)};
p[3]   = newp; Point(p[3])   = {0, b, R - Sqrt(R * R - b * b)};
p[4]   = newp; Point(p[4])   = {0, 0, b};
p[5]   = newp; Point(p[5])   = {d, 0, d};
p[6]   = newp; Point(p[6])   = {e, e, e};
p[7]   = newp; Point(p[7])   = {0, d, d};
p[8]   = newp; Point(p[8])   = {R, 0, R};
p[9]   = newp; Point(p[9])   = {R / Sqrt(2), R / Sqrt(2), R};
p[10]  = newp; Point(p[10])  = {0, R, R};
p[11]  = centre;
p[12]  = newp; Point(p[12])  = {0.55 * R, 0, R};
p[13]  = newp; Point(p[13])  = {0.42 * R, 0.42 * R, R};
p[14]  = newp; Point(p[14])  = {0, 0.55 * R, R};
Call Octant;
Physical Volume(1)   = {v[]};
Physical Surface(11) = {s[{6:8}]};
Physical Surface(12) = {s[{3:5}]};
Physical Surface(13) = {s[{9:11}]};
Physical Surface(14) = {s[{0:2}]};

// The block.
b      = 0.25;
d      = 0.85 * b;
e      = 0.75 * b;
n      = 5;
m      = 11;
q      = 1.573;
centre = 0;
p[0]   = newp; Point(p[0])   = {0, 0, 0};
p[1]   = newp; Point(p[1])   = {b, 0, 0};
p[2]   = newp; Point(p[2])   = {d, d, 0};
p[3]   = newp; Point(p[3])   = {0, b, 0};
p[4]   = newp; Point(p[4])   = {0, 0, -b};
p[5]   = newp; Point(p[5])   = {d, 0, -d};
p[6]   = newp; Point(p[6])   = {e, e, -e};
p[7]   = newp; Point(p[7])   = {0, d, -d};
p[8]   = newp; Point(p[8])   = {L, 0, 0};
p[9]   = newp; Point(p[9])   = {L, L, 0};
p[10]  = newp; Point(p[10])  = {0, L, 0};
p[11]  = newp; Point(p[11])  = {0, 0, -L};
p[12]  = newp; Point(p[12])  = {L, 0, -L};
p[13]  = newp; Point(p[13])  = {L, L, -L};
p[14]  = newp; Point(p[14])  = {0, L, -L};
Call Octant;
Physical Volume(2)   = {v[]};
Physical Surface(21) = {s[{6:8}]};
Physical Surface(22) = {s[{3:5}]};
Physical Surface(23) = {s[9]};
Physical Surface(24) = {s[{0:2}]};
Physical Surface(25) = {s[{10:11}]};

Mesh.MshFileVersion = 4.1;
