# error: 39-39 `subdivs` must be from 1 to 100000, and is 0
object { shader a type teapot subdivs 0 }
# error: 38-41 the shape has 6400000000 triangles: too many, or too many with those before it
# hint: use a smaller `subdivs`: a scene may make 20000000 triangles from patches
object { shader a type gumbo subdivs 5000 }
# error: 1-6 `bezier-mesh` lacks `n`
# hint: add `n 4 4`
object { shader a type bezier-mesh points 0 0 0 }
# error: 42-47 `points` needs 60 numbers, found 3
# label: [4] 55-55 the list ends here
object { shader a type bezier-mesh n 5 4 points 0 0 0 }
# warning: 38-40 5 points do not make patches
# hint: their number is 4, or 3 more for each further patch: 4, 7, 10 …
object { shader a type bezier-mesh n 5 4 points 0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 0 0 0 1 0 0 2 0 0 3 0 0 4 0 0 }
# error: 37-37 `r` expects a number, found `}`
# hint: for example `r 0.25 1`
object { shader a type torus r 0.25 }
# warning: 42-43 `level` is 50, and 20 is used: it must be from 0 to 20
# error: 50-54 `axis` expects a direction other than `0 0 0`
object { shader a type sphereflake level 50 axis 0 0 0 }
# error: 50-55 2 points do not make strands of 2 segments
# hint: each strand has 3 points; `points` counts numbers, three for each
object { shader a type hair segments 2 width 0.1 points 6 0 0 0 0 0 1 }
# error: 50-55 `points` needs 9 numbers, found 6
# label: [9] 71-71 the list ends here
object { shader a type hair segments 2 width 0.1 points 9 0 0 0 0 0 1 }
# error: 1-6 `particles` lacks `points` or `filename`
# hint: add `points N X Y Z …`
object { shader a type particles radius 1 }
# error: 34-39 the points are here and in a file
# label: [11] 49-56 the file
# hint: write one of `points` and `filename`
object { shader a type particles points 1 0 0 0 filename a.dat radius 1 }
# error: 1-6 `file-mesh` lacks `filename`
# hint: add `filename "mesh.obj"`
object { shader a type file-mesh }
# warning: 1-6 skipped: the object is written in Java (`janino`), which cannot be read: it is left out
# hint: write it with the other types of this format
object { shader a type janino-tesselatable name j <code>
   }
</code>
}
# warning: 1-6 skipped: the shader is written in Java (`janino`), which cannot be read: a grey stands in
# hint: write it with the other types of this format
shader { name k type janino <code>
   }
</code>
}
# error: 37-41 `center` expects a direction other than `0 0 0`
light { type ibl image a.hdr center 0 0 0 up 0 0 1 lock true }
# error: 66-66 there is no point 1 in a mesh of 1
# hint: points count from 0: the last one is 0
light { type meshlight emit 1 1 1 points 1 0 0 0 triangles 1 0 0 1 }
# error: 1-5 the mesh lacks its numbers
# hint: write `V T`, V lines `v x y z nx ny nz u v` and T lines `t a b c`
light { type mesh emit 1 1 1 }
