image {
# error: 14-18 `resolution` expects a whole number, found `640.0`
# hint: write `640`, without fraction or exponent
  resolution 640.0 480
# error: 8-8 `aa` expects a whole number, found `x`
# hint: for example `aa 0 2`
  aa 0 x
# error: 11-13 `samples` expects a whole number, found `1e2`
# hint: write `100`, without fraction or exponent
  samples 1e2
# error: 12-14 `contrast` expects a finite number, found `NaN`
# hint: for example `contrast 0.1`
  contrast NaN
}
camera {
  type pinhole
  eye 0 0
# error: 3-8 `eye` expects a number, found `target`
# hint: for example `eye 0 0 5`
# error: 14-21 `target` expects a finite number, found `Infinity`
# hint: for example `target 0 0 0`
  target 0 0 Infinity
# error: 10-12 `up` expects a number, found `inf`
# hint: for example `up 0 1 0`
  up 0 1 inf
# error: 7-9 `fov` must be between 0 and 180, and is -40
  fov -40
# error: 10-14 `aspect` expects a number, found `1,333`
# hint: for example `aspect 1.333`
  aspect 1,333
}
# error: 38-41 `power` expects a finite number, found `1e40`
# hint: for example `power 100`
light { type point color 1 1 1 power 1e40 p 0 0 0 }
# error: 41-41 `r` must be greater than 0, and is 0
object { shader a type sphere c 0 0 0 r 0 }
# error: 41-42 `r` must be greater than 0, and is -1
object { shader a type sphere c 0 0 0 r -1 }
