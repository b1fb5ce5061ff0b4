% Neither light nor shadow.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name c type constant color 0.2 0.5 0.9 }
object { shader c type sphere }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
