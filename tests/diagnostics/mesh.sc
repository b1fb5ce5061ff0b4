object {
  shader a
  type generic-mesh
# error: 3-8 `points` needs 9 numbers, found 8
# label: [5] 3-11 the list ends here
  points 3  0 0 0  1 0 0  0 1
  triangles 1  0 1 2
  normals none
  uvs none
}
object {
  shader a
  type generic-mesh
# error: 3-8 `points` needs 6000000000 numbers, found 9
# label: [13] 3-11 the list ends here
  points 2000000000  0 0 0  1 0 0  0 1 0
  triangles 1  0 1 2
  normals none
  uvs none
}
object {
  shader a
  type generic-mesh
# error: 3-8 `points` needs 9 numbers, found 10
# label: [20] 34-34 one too many
  points 3  0 0 0  1 0 0  0 1 0  7
  triangles 1  0 1 2
  normals none
  uvs none
}
object {
  shader a
  type generic-mesh
# error: 24-26 `points` expects finite numbers, found `NaN` (and 1 more)
  points 3  0 0 0  1 0 NaN  0 1 -Infinity
  triangles 1  0 1 2
  normals none
  uvs none
}
object {
  shader a
  type generic-mesh
# error: 24-28 `points` expects finite numbers, found `1.0.0`
# hint: for example `points 3 0 0 0 1 0 0 0 1 0`
  points 3  0 0 0  1 0 1.0.0  0 1 0
# error: 20-21 `triangles` expects indices from 0, found `-2`
# hint: for example `triangles 1 0 1 2`
  triangles 1  0 1 -2
  normals none
  uvs none
}
object {
  shader a
  type generic-mesh
  points 3  0 0 0  1 0 0  0 1 0
# error: 20-20 there is no point 3 in a mesh of 3 (nor for 1 more indices)
# hint: points count from 0: the last one is 2
  triangles 2  0 1 3  4 0 1
# error: 3-9 `normals vertex` needs 9 numbers in this mesh, found 3
# hint: `vertex` means 3 numbers for each of the 3 points
  normals vertex 0 0 1
# error: 3-5 `uvs facevarying` needs 12 numbers in this mesh, found 2
# hint: `facevarying` means 2 numbers for each corner of the 2 triangles
  uvs facevarying 0 0
}
object {
  shader a
  type generic-mesh
  points 3  0 0 0  1 0 0  0 1 0
  triangles 1  0 1 2
# error: 11-16 unknown kind of vertex data `smooth`
# hint: expected `none`, `vertex` or `facevarying`
  normals smooth
  uvs none
# error: 16-16 there is no shader 1 in a list of 1
# hint: `face_shaders` counts from 0
  face_shaders 1
}
# error: 1-6 `generic-mesh` lacks `points`
# hint: add `points 3 0 0 0 1 0 0 0 1 0`
object { shader a type generic-mesh triangles 1 0 1 2 normals none uvs none }
object {
  shader a
  type mesh
# error: 3-3 the mesh announces 3 lines of `v`, found 2
# label: [66] 1-1 the lines end here
  3 1
  v 0 0 0  0 0 1  0 0
  v 1 0 0  0 0 1  1 0
  t 0 1 2
}
object {
  shader a
  type mesh
  2 1
  v 0 0 0  0 0 1  0 0
  v 1 0 0  0 0 1  1
# error: 3-3 `v` expects a number, found `t`
# hint: for example `v 0 0 0 0 0 1 0 0`
  t 0 1 1
}
object {
  shader a
  type flat-mesh
  2 1
  v 0 0 0  0 0 1  0 0
  v 1 0 0  0 0 1  1 0
# error: 9-9 there is no point 2 in a mesh of 2
# hint: points count from 0: the last one is 1
  t 0 1 2
}
# error: 1-6 the mesh lacks its numbers
# hint: write `V T`, V lines `v x y z nx ny nz u v` and T lines `t a b c`
object { shader a type mesh name m }
# error: 29-30 `mesh` expects the length of the list, found `-3`
object { shader a type mesh -3 1 }
