% A tinted mirror between a red sphere and a grey floor, a sky behind.
include ../../stage/light.sc
include ../../stage/camera.sc
background { color 0.3 0.4 0.6 }
shader { name silver type mirror refl 0.9 0.85 0.7 }
shader { name red type diffuse diff 0.7 0.1 0.1 }
object { shader silver type sphere }
object { shader red type sphere c 1.6 -0.5 0.8 r 0.5 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
