% Catmull's elephant, in flat facets.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.4 0.3 0.2 spec 0.5 0.5 0.5 40 samples 0 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader glossy transform { translate -12 -7 0 scaleu 0.09 rotatex -90 rotatey 150 translate 0 -0.9 0 } type gumbo subdivs 3 smooth false }
