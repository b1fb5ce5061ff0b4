# error: 39-39 `diff` expects a number, found `}`
# hint: for example `diff { "sRGB nonlinear" 1 0.5 0 }`
shader { name a type diffuse diff 1 1 }
shader { name b type diffuse diff 1 1 1 }
