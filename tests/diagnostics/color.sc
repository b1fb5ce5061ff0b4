# error: 37-39 `color` expects a colour, found `red`
# hint: for example `color { "sRGB nonlinear" 1 0.5 0 }`
shader { name a type constant color red }
# error: 43-43 `color` expects a number, found `}`
# hint: for example `color { "sRGB nonlinear" 1 0.5 0 }`
shader { name b type constant color 1 0.5 }
# error: 39-39 unknown colour space `1`
# hint: name the colour space: `{ "sRGB nonlinear" 1 0.5 0 }`
shader { name c type constant color { 1 0.5 0 } }
# error: 39-42 unknown colour space `sRGB`
# hint: put the name in quotes: `"sRGB nonlinear"`
shader { name d type constant color { sRGB nonlinear 1 0.5 0 } }
# error: 40-53 unknown colour space `srgb nonlinear`
# hint: did you mean `sRGB nonlinear`?
shader { name e type constant color { "srgb nonlinear" 1 0.5 0 } }
# error: 62-62 `color` expects a number, found `}`
# hint: for example `color { "sRGB nonlinear" 1 0.5 0 }`
shader { name f type constant color { "sRGB nonlinear" 1 0.5 } }
# error: 64-66 `color` expects `}` after the colour, found `0.5`
# hint: for example `color { "sRGB nonlinear" 1 0.5 0 }`
shader { name g type constant color { "sRGB nonlinear" 1 0.5 0 0.5 } }
# error: 37-56 this colour is too bright to be a number
shader { name h type constant color { "blackbody" 1e30 } }
# error: 40-47 `spectrum` expects its first and last wavelength within the quotes
# hint: for example `{ "spectrum 400 700" 3 0.1 0.5 1 }`
shader { name i type constant color { "spectrum" 3 1 1 1 } }
# error: 40-55 `spectrum` expects its first and last wavelength within the quotes
# hint: for example `{ "spectrum 400 700" 3 0.1 0.5 1 }`
shader { name j type constant color { "spectrum 700 400" 3 1 1 1 } }
# error: 58-58 `color` expects at least two samples, found `1`
# hint: for example `color { "sRGB nonlinear" 1 0.5 0 }`
shader { name k type constant color { "spectrum 400 700" 1 1 } }
# error: 64-64 `color` expects a number, found `}`
# hint: for example `color { "sRGB nonlinear" 1 0.5 0 }`
shader { name l type constant color { "spectrum 400 700" 3 1 1 } }
# error: 56-58 `color` expects a finite number, found `NaN`
# hint: for example `color { "sRGB nonlinear" 1 0.5 0 }`
shader { name m type constant color { "sRGB nonlinear" NaN 0 0 } }
# error: 1-6 `constant` lacks `color`
# hint: add `color 1 1 1`
shader { name n type constant }
# error: 40-42 unknown colour space `hsv`
# hint: expected `sRGB nonlinear`, `sRGB linear`, `XYZ`, `blackbody` or `spectrum 400 700`
shader { name o type constant color { "hsv" 1 1 1 } }
