# error: 38 `diff` expects a number, found the end of the file
# hint: for example `diff { "sRGB nonlinear" 1 0.5 0 }`
shader { name a type diffuse diff 1 1