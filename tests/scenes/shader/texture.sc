% A picture on a sphere and a mesh: its first row is its upper edge.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name picture type diffuse texture "../../stage/arrows.png" }
object { shader picture type sphere c -1.1 0 0 r 0.9 }
object {
  shader picture
  type generic-mesh
  points 4  0 -0.9 0.4  1.8 -0.9 0  1.8 0.9 0  0 0.9 0.4
  triangles 2  0 1 2  0 2 3
  normals none
  uvs vertex  0 0  1 0  1 1  0 1
}
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
