% Marble on a sphere, a knot and a cube.

shader { name shown type marble }
include "include/studio.sc"
