% Fire on a sphere, a knot and a cube.

shader { name shown type fire }
include "include/studio.sc"
