# error: 31-36 unknown transform operation `rotatx`
# hint: did you mean `rotatex`?
object { shader a transform { rotatx 90 scaleu 2 } type sphere }
# error: 39-44 `rotatex` expects a number, found `ninety`
# hint: for example `rotatex 90`
object { shader a transform { rotatex ninety scaleu 2 } type sphere }
# error: 38-42 `rotate` expects an axis other than `0 0 0`
# hint: for example `rotate 0 0 1 90`
object { shader a transform { rotate 0 0 0 90 } type sphere }
# error: 33-66 the last row of a transform must be 0 0 0 1
# hint: `row` lists the matrix row by row, `col` column by column
object { shader a transform row 1 0 0 0  0 1 0 0  0 0 1 0  0 0 5 1 type sphere }
# error: 64-67 `transform` expects a number, found `type`
# hint: for example `transform { translate 0 0 1 }`
object { shader a transform col 1 0 0 0  0 1 0 0  0 0 1 0  0 0 type sphere }
# error: 35-35 `transform` expects at least one step, found `0`
# hint: for example `transform { translate 0 0 1 }`
object { shader a transform steps 0 times 0 1 type sphere }
# error: 51-54 `transform` expects `{`, `row`, `col` or `steps`, found `type`
# hint: for example `transform { translate 0 0 1 }`
object { shader a transform steps 2 times 0 1 { } type sphere }
# error: 37-37 `transform` expects `times` after the number of steps, found `{`
# hint: for example `transform { translate 0 0 1 }`
object { shader a transform steps 2 { } { } type sphere }
# error: 29-37 `transform` expects `{`, `row`, `col` or `steps`, found `translate`
# hint: for example `transform { translate 0 0 1 }`
object { shader a transform translate 0 0 1 type sphere }
# error: 45-45 `translate` expects a number, found `}`
# hint: for example `translate 0 0 1`
object { shader a transform { translate 0 0 } type sphere }
