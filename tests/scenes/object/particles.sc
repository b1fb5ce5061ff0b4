% Spheres of one size at given points, once stretched.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.4 0.3 0.2 spec 0.5 0.5 0.5 40 samples 0 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { noinstance type particles name cloud points 5 0 0 0 0.5 0.3 0 -0.5 0.4 0.2 0.1 -0.6 0.3 -0.3 -0.3 0.5 radius 0.3 }
instance { geometry cloud transform { translate -0.6 0 0 } shader glossy }
instance { geometry cloud transform { scale 0.6 1.2 0.6 translate 0.9 0 0 } shader glossy }
