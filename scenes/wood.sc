% Wood on a sphere, a knot and a cube.

shader { name shown type wood }
include "include/studio.sc"
