% Clear glass before a red sphere: refraction, reflection, a black shadow.
include ../../stage/light.sc
include ../../stage/camera.sc
background { color 0.3 0.4 0.6 }
shader { name clear type glass eta 1.5 color 0.9 1 0.95 }
shader { name red type diffuse diff 0.7 0.1 0.1 }
object { shader clear type sphere }
object { shader red type sphere c -0.6 -0.4 -2.2 r 0.6 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
