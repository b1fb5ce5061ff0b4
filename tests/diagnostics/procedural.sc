# error: 22-27 unknown shader type `marbel`
# hint: did you mean `marble`?
shader { name a type marbel depth 4 }
# error: 35-37 `depth` expects a whole number, found `4.5`
# hint: write `5`, without fraction or exponent
shader { name b type marble depth 4.5 }
# error: 35-37 `depth` must be from 0 to 32, and is 400
shader { name c type marble depth 400 }
# error: 33-38 unknown noise `perlin`
# hint: expected `improved`, `classic` or `lattice`
shader { name d type wood noise perlin }
# error: 31-37 unknown sum `absolut`
# hint: did you mean `absolute`?
shader { name e type wood sum absolut }
# error: 43-48 `diffuse_initial` expects a colour, found `orange`
# hint: for example `{ "sRGB nonlinear" 1 0.5 0 }`
shader { name f type fire diffuse_initial orange diffuse_final 1 0 0 }
# error: 28-41 unknown keyword `diffuse_inital` in `water`
# hint: did you mean `diffuse_initial`?
# error: 55-55 `scale` must be from 0.000001 to 1000000, and is 0
shader { name g type water diffuse_inital 1 0 0 scale 0 }
# error: 33-34 `seed` must be at least 0, and is -1
# error: 42-46 unknown space `outer`
# hint: expected `local`, `world` or `uv`
shader { name h type stone seed -1 space outer }
