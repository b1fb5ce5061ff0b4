# error: 1-6 this `shader` is never closed
# hint: add the missing `}`
# warning: 15-15 this quotation ends with its line
# hint: add the closing `"`
shader { name "a type diffuse diff 1 1 1 }
object { shader a type sphere c 0 0 0 r 1 }
