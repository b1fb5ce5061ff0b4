%% the syntax of 2010
# warning: 118-119 the number after the absorption colour is ignored
# hint: remove it
shader { name glass type glass eta 1.5 color 1 1 1 absorbtion.distance 3 absorbtion.color { "sRGB nonlinear" 1 1 1 } 50 }
# warning: 10-13 `name` stands before `type`, where Sunflow does not look for it
# hint: write `name` after `type` to be read by Sunflow too
object { name early shader glass type sphere c 0 0 0 r 1 }
# warning: 22-27 `shader`, `modifier` and `transform` belong before `type`
# hint: write them before `type` to be read by Sunflow too
object { type sphere shader glass c 0 0 0 r 1 }
# warning: 1-6 a sphere without `c`, `r` and `transform` is the unit sphere at the origin
# hint: add `c 0 0 0 r 1`
object { shader glass type sphere }
# warning: 35-40 `scalex`, `scaley` and `scalez` are unknown to Sunflow
# hint: write `scale x y z`
object { shader glass transform { scalex 2 } type box }
# warning: 1-6 the mesh does not say which `normals` it has (here and in another place)
# hint: add `normals none`
# warning: 1-6 the mesh does not say which `uvs` it has
# hint: add `uvs none`
object { shader glass type generic-mesh points 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2 }
object { shader glass type generic-mesh points 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2 uvs none }
# warning: 1-1 this `}` closes nothing
# hint: remove it
}
