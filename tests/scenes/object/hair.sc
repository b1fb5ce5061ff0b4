% Strands that turn their flat side to the camera.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.4 0.3 0.2 spec 0.5 0.5 0.5 40 samples 0 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader glossy type hair segments 2 width 0.12 points 36
   -1 -1 0  -0.8 0 0  -1.2 0.8 0   -0.3 -1 0  -0.3 0 0.2  0 0.8 0.4   0.4 -1 0  0.4 0 0  0.4 0.9 0   1 -1 0  1.2 -0.2 0.5  0.8 0.6 0.8 }
