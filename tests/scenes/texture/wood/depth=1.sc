% One octave: rings without knots.
include ../../../stage/light.sc
include ../../../stage/camera.sc
shader { name m type wood depth 1 }
object { shader m type sphere }
