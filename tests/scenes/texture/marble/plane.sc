% Marble on a plane that reaches the horizon.
include ../../../stage/light.sc
include ../../../stage/camera.sc
shader { name m type marble }
object { shader m type plane p 0 -1 0 n 0 1 0 }
