% The inner and the outer side of a cylinder without caps.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.4 0.3 0.2 spec 0.5 0.5 0.5 40 samples 0 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader glossy transform { rotatex -60 scaleu 0.7 } type cylinder }
