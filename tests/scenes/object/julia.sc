% A Julia set of quaternions.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.4 0.3 0.2 spec 0.5 0.5 0.5 40 samples 0 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader glossy transform { rotatey 45 scaleu 0.8 } type julia q -0.125 -0.256 0.847 0.0895 iterations 8 epsilon 0.001 }
