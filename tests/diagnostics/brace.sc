# error: 1-7 unknown keyword `shader{`
# hint: put a blank before the brace: `shader {`
shader{ name a type diffuse diff 1 1 1 }
# error: 39-40 `diff` expects a number, found `1}`
# hint: put a blank on both sides of every brace
shader { name b type diffuse diff 1 1 1}
# error: 48-49 `color` expects a number, found `1}`
# hint: put a blank on both sides of every brace
light { type point color {"sRGB nonlinear" 1 1 1} power 10 p 0 0 0 }
# error: 1-6 this `object` is never closed
# label: [5] 1-6 the next block starts here
# hint: add the missing `}`
object { shader b type sphere c 0 0 0 r 1
object { shader b type sphere c 0 0 0 r 1 }
# error: 1-1 this `{` follows no keyword
{ stray }
# error: 7-17 `image` expects `{`, found `{resolution`
# hint: put a blank on both sides of every brace
image {resolution 10 10 }
shader { name c type phong diff { "sRGB nonlinear" 1 1 1
# error: 3-6 `diff` expects `}` after the colour, found `spec`
# hint: for example `diff { "sRGB nonlinear" 1 0.5 0 }`
  spec 1 1 1 50
# error: 11-13 `samples` expects a whole number, found `4.5`
# hint: write `5`, without fraction or exponent
  samples 4.5
}
light { type point color 1 1 1 power 10 p 0 0 0 }
camera
# error: 1-5 `camera` expects `{`, found `light`
# error: 38-40 `power` expects a number, found `ten`
# hint: for example `power 100`
light { type point color 1 1 1 power ten p 0 0 0 }
