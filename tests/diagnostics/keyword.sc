# error: 1-5 unknown keyword `shadr`
# hint: did you mean `shader`?
shadr { name a type diffuse diff 1 1 1 }
# error: 30-32 unknown keyword `dif` in `diffuse`
# hint: did you mean `diff`?
shader { name b type diffuse dif 1 0 0 }
# error: 53-58 unknown keyword `sampls` in `phong`
# hint: did you mean `samples`?
shader { name c type phong diff 1 0 0 spec 1 1 1 50 sampls 4 }
# error: 62-72 unknown keyword `aspectratio` in `camera`
# hint: expected `type`, `shutter`, `transform`, `eye`, `target`, `up`, `steps`, `fov`, `aspect`, `shift`, `fdist`, `lensr`, `sides` or `rotation`
camera { type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspectratio 1.5 aspect 1 }
# warning: 1-6 skipped: unknown keyword `wibble`
wibble { name x type y }
# error: 9-18 unknown keyword `Resolution` in `image`
# hint: did you mean `resolution`?
image { Resolution 640 480 colour { "sRGB linear" 1 1 1 } aa 0 1 }
# error: 43-45 expected a keyword of `sphere`, found the number `0.5`
# hint: `r` takes no further number here
object { shader b type sphere c 0 0 0 r 1 0.5 }
# error: 24-28 unknown object type `spere`
# hint: did you mean `sphere`?
object { shader b type spere c 0 0 0 r 1 }
# warning: 16-17 `aa` is written twice; the last one counts
# label: [9] 9-10 first written here
image { aa 0 1 aa 0 2 }
