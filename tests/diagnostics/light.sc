# error: 1-5 `light` lacks `type`
# hint: types are `point`, `directional`, `spherical`, `meshlight`, `mesh`, `sunsky`, `ibl` and `cornellbox`
light { color 1 1 1 power 10 p 0 0 0 }
# error: 14-17 unknown light type `pint`
# hint: did you mean `point`?
light { type pint color 1 1 1 power 10 p 0 0 0 }
# error: 1-5 `point` lacks `power`
# hint: add `color 1 1 1 power 100`
light { type point color 1 1 1 p 0 0 0 }
# error: 1-5 `point` lacks `color`
# hint: add `color 1 1 1`
light { type point power 10 p 0 0 0 }
# error: 1-5 `point` lacks `power` and `p`
# hint: add `color 1 1 1 power 100 p 0 5 0`
light { type point }
# error: 59-60 `radius` must be greater than 0, and is -1
light { type directional source 0 0 4 target 0 0 0 radius -1 emit 1 1 1 }
light { type sunsky up 0 0 1 east 0 1 0 sundir 1 1 1 turbidity 4 }
