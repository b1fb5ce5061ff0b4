% Organic on a sphere, a knot and a cube.

shader { name shown type organic }
include "include/studio.sc"
