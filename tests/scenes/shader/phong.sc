% Two lights, two highlights.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.1 0.3 0.1 spec 0.6 0.6 0.6 40 samples 0 }
object { shader glossy type sphere }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
