# error: 9-14 unknown dialect `sunfow`
# hint: did you mean `sunflow`?
dialect sunfow
dialect sunflow
# error: 9-14 the scene names two dialects
# label: [2] 9-15 first named here
# hint: keep one of them
dialect report
# error: 8-10 `bucket` expects a whole number, found `big`
# hint: for example `bucket 32 hilbert`
bucket big hilbert
override a
# error: 1-11 `override` expects `true` or `false` after the name, found `texturepath`
# hint: for example `override NAME false`
# error: 13-13 `texturepath` expects a folder, found `}`
# hint: for example `texturepath "folder"`
texturepath }
accel bih
filter mitchell
gi { type path samples 16 }
gi { type none }
photons { caustics 1000 kd 64 0.5 }
modifier { name m type bump texture t.png scale 1 }
lightserver { shadows true }
