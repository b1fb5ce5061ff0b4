% A small photo studio: floor, wall, three lights and a camera, with a sphere, a knot and a cube on show.
% The file that includes it declares the shader `shown`.

image {
   resolution 720 400
   aa 1 2
   filter mitchell
}

trace-depths { diff 1 refl 3 refr 3 }

camera {
   type pinhole
   eye 0 3.4 12
   target 0 1.2 0
   up 0 1 0
   fov 38
   aspect 1.8
}

% A key light in three points, so that its shadows are soft; a cool fill, and one from the camera.
light { type point color 1 0.92 0.80 power 1000 p -5 8 7 }
light { type point color 1 0.92 0.80 power 1000 p -4.3 8.6 7.6 }
light { type point color 1 0.92 0.80 power 1000 p -5.6 8.4 6.3 }
light { type point color 0.62 0.76 1 power 950 p 8 5 7 }
light { type point color 1 0.97 0.93 power 750 p 1 4 14 }

shader { name floor type diffuse diff { "sRGB nonlinear" 0.36 0.37 0.40 } }
shader { name wall type diffuse diff { "sRGB nonlinear" 0.47 0.50 0.57 } }

object { shader floor type plane p 0 0 0 n 0 1 0 }
object { shader wall type plane p 0 0 -5 n 0 0 1 }

object { shader shown type sphere name ball c -2.7 1.1 0 r 1.1 }

include "knot.sc"
instance { name shown-knot geometry knot transform { rotatey 24 translate 0 1.42 0 } shader shown }

object { shader shown transform { scaleu 1.75 rotatey 33 translate 2.75 0.875 0 } type box name cube }
