shader { name a type diffuse diff 1 1 1 }
# error: 1-6 this `object` is never closed
# hint: add the missing `}`
object { shader a type sphere c 0 0 0
