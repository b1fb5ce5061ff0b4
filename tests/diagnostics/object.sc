# error: 1-6 `object` lacks `shader` or `shaders`
# hint: add `shader NAME`
object { type sphere c 0 0 0 r 1 }
# error: 1-6 `sphere` lacks `r`
# hint: add `r 1`
object { shader a type sphere c 0 0 0 }
# error: 1-6 `sphere` lacks `c`
# hint: add `c 0 0 0`
object { shader a type sphere r 1 }
# error: 1-6 `object` lacks `type`
# hint: types are `sphere`, `plane`, `box`, `generic-mesh`, `mesh`, `flat-mesh`, `file-mesh`, `bezier-mesh`, `teapot`, `gumbo`, `torus`, `cylinder`, `banchoff`, `sphereflake`, `julia`, `hair`, `particles` and `dlasurface`
object { shader a c 0 0 0 r 1 }
# error: 27-32 unknown keyword `sphere` in `sphere`
# hint: expected `type`, `name`, `noinstance`, `shader`, `shaders`, `modifier`, `modifiers`, `transform`, `accel`, `c` or `r`
object { shaders 2 a type sphere c 0 0 0 r 1 }
# error: 18-19 `shaders` expects the number of names, found `-1`
# hint: for example `shaders 2 red blue`
object { shaders -1 a type sphere c 0 0 0 r 1 }
# error: 1-6 `plane` takes one `p` and `n`, or three `p`; found 1 `p` and no `n`
# hint: for example `p 0 0 0 n 0 1 0`
object { shader a type plane p 0 0 0 }
# error: 38-38 the normal of a plane must not be `0 0 0`
object { shader a type plane p 0 0 0 n 0 0 0 }
# error: 1-6 `plane` takes one `p` and `n`, or three `p`; found 2 `p` and `n`
# hint: for example `p 0 0 0 n 0 1 0`
object { shader a type plane p 0 0 0 p 1 0 0 n 0 1 0 }
# error: 35-35 `points` expects `2` and two corners, found `3`
# hint: for example `points 2 -1 -1 -1 1 1 1`
object { shader a type box points 3 0 0 0 1 1 1 }
object { shader a type teapot subdivs 4 }
# error: 24-27 unknown object type `quad`
# hint: expected `sphere`, `plane`, `box`, `generic-mesh`, `mesh`, `flat-mesh`, `file-mesh`, `bezier-mesh`, `teapot`, `gumbo`, `torus`, `cylinder`, `banchoff`, `sphereflake`, `julia`, `hair`, `particles` or `dlasurface`
object { shader a type quad points 4 0 0 0 1 0 0 1 1 0 0 1 0 }
object { shader a type sphere name ball c 0 0 0 r 1 }
# warning: 36-39 there is already an object or instance `ball`; names find the first one
# label: [13] 36-39 first declared here
object { shader a type sphere name ball c 0 0 1 r 1 }
# warning: 17-20 there is already an object or instance `ball`; names find the first one
# label: [13] 36-39 first declared here
instance { name ball geometry ball transform { } shader a }
# error: 1-8 `instance` lacks `transform` and `shader` or `shaders`
# hint: add `transform { } shader NAME`
instance { geometry ball }
# error: 1-8 `instance` lacks `geometry`
# hint: add `geometry NAME`
# error: 45-45 `translate` expects a number, found `}`
# hint: for example `translate 0 0 1`
instance { name x transform { translate 0 0 } shader a }
