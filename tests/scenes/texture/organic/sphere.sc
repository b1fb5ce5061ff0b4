% Organic on the unit sphere.
include ../../../stage/light.sc
include ../../../stage/camera.sc
shader { name m type organic }
object { shader m type sphere }
