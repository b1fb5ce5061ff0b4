# error: 10-22 `include.sc` includes itself
# label: [3] 10-24 on the way here
# hint: remove one of the `include` lines
include "../include.sc"
