% The triangles of another file, flat and smooth.
include ../../stage/light.sc
include ../../stage/camera.sc
shader { name glossy type phong diff 0.4 0.3 0.2 spec 0.5 0.5 0.5 40 samples 0 }
shader { name floor type diffuse diff 0.5 0.5 0.5 }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader glossy transform { rotatey 30 scaleu 0.6 translate -0.8 -0.2 0 } type file-mesh filename octahedron.obj }
object { shader glossy transform { rotatey 30 scaleu 0.6 translate 0.8 -0.2 0 } type file-mesh filename octahedron.obj smooth_normals true }
