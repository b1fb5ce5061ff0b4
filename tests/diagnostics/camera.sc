# error: 1-6 `camera` lacks `fov`, `aspect`, `eye` or `transform`, `target` and `up`
# hint: add `fov 60 aspect 1.333 eye 0 0 5 target 0 0 0 up 0 1 0`
camera { type pinhole }
# error: 1-6 `camera` lacks `fdist` and `up`
# hint: add `fdist 10 up 0 1 0`
camera { type thinlens eye 0 0 5 target 0 0 0 fov 40 aspect 1 lensr 0.1 }
# error: 1-6 `camera` lacks `type`
# hint: types are `pinhole`, `thinlens`, `spherical` and `fisheye`
camera { eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 }
# error: 15-20 unknown camera type `pinhol`
# hint: did you mean `pinhole`?
camera { type pinhol eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 }
# warning: 55-57 `fov` means nothing to a `fisheye` camera
camera { type fisheye eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 }
# error: 27-29 `fov` must be between 0 and 180, and is 200
# error: 38-38 `aspect` must be greater than 0, and is 0
camera { type pinhole fov 200 aspect 0 eye 0 0 5 target 0 0 0 up 0 1 0 }
camera {
  type spherical
  steps 2 times 0 1
# error: 37-37 `steps` expects a number, found `}`
# hint: for example `steps 2 times 0 1 { eye 0 0 5 target 0 0 0 up 0 1 0 } …`
    { eye 0 0 5 target 0 0 0 up 0 1 }
    { eye 0 0 6 target 0 0 0 up 0 1 0 }
}
