# error: 10-19 cannot read `missing.sc`: no such file
# hint: looked in the current folder
include "missing.sc"
include "include/broken.sc"
include "include/loop.sc"
# error: 10-18 cannot include `model.obj`: not a `.sc` file
include "model.obj"
# error: 10-16 cannot read `old.sca`: no such file
# hint: looked in the current folder, `include`
include "old.sca"
include
# error: 1 `include` expects a file name, found the end of the file
# hint: for example `include "file.sc"`
