% Fire on an octahedron with smooth normals.
include ../../../stage/light.sc
include ../../../stage/camera.sc
shader { name m type fire }
object {
  shader m
  transform { rotatey 20 }
  type generic-mesh
  points 6  1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1
  triangles 8  2 4 0  2 1 4  2 5 1  2 0 5  3 0 4  3 4 1  3 1 5  3 5 0
  normals vertex  1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1
  uvs none
}
