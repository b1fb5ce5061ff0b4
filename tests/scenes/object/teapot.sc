% Newell's pot, smooth; its lid and spout.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.4 0.3 0.2 spec 0.5 0.5 0.5 40 samples 0 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader glossy transform { scaleu 0.011 rotatex -90 translate 0 -1 0 } type teapot }
