% Stone on a turned box.
include ../../../stage/light.sc
include ../../../stage/camera.sc
shader { name m type stone }
object { shader m transform { scaleu 1.5 rotatey 25 } type box }
