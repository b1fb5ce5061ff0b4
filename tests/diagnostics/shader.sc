# error: 1-6 `diffuse` lacks `name`
# hint: add `name NAME`
shader { type diffuse diff 1 1 1 }
# error: 1-6 `diffuse` lacks `diff` or `texture`
# hint: add `diff 0.5 0.5 0.5`
shader { name b type diffuse }
# error: 50-50 `spec` expects a number, found `}`
# hint: for example `spec { "sRGB nonlinear" 1 1 1 } 50`
shader { name c type phong diff 1 1 1 spec 1 1 1 }
# error: 1-6 `phong` lacks `spec`
# hint: add `spec 1 1 1 50`
# error: 41-41 expected a keyword of `phong`, found the number `1`
# hint: `texture` takes no further number here
shader { name d type phong texture spec 1 1 1 50 }
# error: 1-6 `glass` lacks `eta`
# hint: add `eta 1.5`
shader { name e type glass color 1 1 1 }
# error: 32-32 `eta` must be greater than 0, and is 0
# error: 46-62 unknown keyword `absorbtion.colour` in `glass`
# hint: did you mean `absorbtion.color`?
shader { name f type glass eta 0 color 1 1 1 absorbtion.colour 1 1 1 }
# error: 22-27 unknown shader type `difuse`
# hint: did you mean `diffuse`?
shader { name g type difuse diff 1 1 1 }
# error: 1-6 `shader` lacks `type`
# hint: types are `constant`, `diffuse`, `phong`, `mirror`, `glass`, `shiny`, `ward`, `amb-occ`, `amb-occ2`, `uber`, `wireframe`, `view-caustics`, `view-irradiance`, `view-global`, `id`, `fire`, `water`, `organic`, `wood`, `marble` and `stone`
shader { name h }
# warning: 15-15 there is already a shader `b`; names find the first one
# label: [2] 15-15 first declared here
shader { name b type mirror refl 1 1 1 }
shader { name i type ward diff 1 1 1 spec 1 1 1 rough 0.1 0.1 }
