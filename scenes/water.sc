% Water on a sphere, a knot and a cube.

shader { name shown type water }
include "include/studio.sc"
