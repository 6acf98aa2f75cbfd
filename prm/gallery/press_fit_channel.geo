// Lower half of the channel of the press fit: 1900 long, bottom at y = -449, upper side at y = -199 for x < 800, rising to -149
// at x = 1000; a slice of thickness 1.
// gmsh -setnumber n 4: cells along the slope.
//
// Volume:   1 channel
// Surfaces: 11 upper side (master)   12 bottom   13 ends   14 z = 0 and z = 1

DefineConstant[ n = 4 ];
x[] = {0, 800, 1000, 1900};
y[] = {-199, -199, -149, -149};
For i In {0:3}
  low[i]  = newp; Point(low[i])  = {x[i], -449, 0};
  high[i] = newp; Point(high[i]) = {x[i], y[i], 0};
  post[i] = newc; Line(post[i])  = {high[i], low[i]};
EndFor
Transfinite Curve {post[]} = n + 1 Using Progression 1.2;
For i In {0:2}
  below = newc; Line(below) = {low[i], low[i + 1]};
  above = newc; Line(above) = {high[i], high[i + 1]};
  Transfinite Curve {below, above} = Round(n * (x[i + 1] - x[i]) / 200) + 1;
  loop = newll; Curve Loop(loop) = {below, -post[i + 1], -above, post[i]};
  face[i] = news; Plane Surface(face[i]) = {loop};
  Transfinite Surface {face[i]};
  Recombine Surface {face[i]};
  piece[] = Extrude {0, 0, 1} { Surface{face[i]}; Layers{1}; Recombine; };
  back[i]   = piece[0];
  volume[i] = piece[1];
  bottom[i] = piece[2];
  right[i]  = piece[3];
  top[i]    = piece[4];
  left[i]   = piece[5];
EndFor

Physical Volume("channel", 1) = {volume[]};
Physical Surface("wall", 11)   = {top[]};
Physical Surface("bottom", 12) = {bottom[]};
Physical Surface("ends", 13)   = {left[0], right[2]};
Physical Surface("faces", 14)  = {face[], back[]};

Mesh.MshFileVersion = 4.1;
