% A camera set by a matrix (columns: right, up, backwards), looking down upon an instance.
image { resolution 72 72 aa 0 1 filter box }
light { type directional source 3 6 4 target 0 0 0 radius 20 emit 2.5 2.5 2.5 }
camera { type pinhole transform row 1 0 0 0  0 0 1 6  0 -1 0 0  0 0 0 1 fov 40 aspect 1 }
shader { name a type diffuse diff 0.7 0.5 0.2 }
shader { name b type diffuse diff 0.2 0.5 0.7 }
object { shader a name ball type sphere c 0.8 0 -0.8 r 0.7 }
instance { name other geometry ball transform { scale 1 0.5 1 translate -1.6 0 1.6 } shader b }
