% Another noise, another piece.
include ../../../stage/light.sc
include ../../../stage/camera.sc
shader { name m type marble noise classic seed 7 }
object { shader m type sphere }
