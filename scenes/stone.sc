% Stone on a sphere, a knot and a cube.

shader { name shown type stone }
include "include/studio.sc"
