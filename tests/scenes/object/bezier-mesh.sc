% One patch, like a saddle.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.4 0.3 0.2 spec 0.5 0.5 0.5 40 samples 0 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader glossy transform { translate -1.5 -1.5 0 scaleu 0.6 rotatex -70 } type bezier-mesh n 4 4 points
   0 0 0  1 0 1.5  2 0 1.5  3 0 0
   0 1 -1.5  1 1 0  2 1 0  3 1 -1.5
   0 2 -1.5  1 2 0  2 2 0  3 2 -1.5
   0 3 0  1 3 1.5  2 3 1.5  3 3 0
}
