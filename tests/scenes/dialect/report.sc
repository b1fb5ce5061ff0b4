% The 2010 program's camera, lights and half-and-half mirror.
dialect report
image { resolution 96 72 aa 0 0 samples 1 }
camera { type pinhole eye 0 0 40 target 0 0 0 up 0 1 0 fov 60 aspect 1.333 }
light { type point color { "sRGB nonlinear" 1 1 1 } power 200 p 0 10 60 }
shader { name s type stone diffuse_initial { "sRGB nonlinear" 0.2 0.2 0.2 } diffuse_final { "sRGB nonlinear" 1 1 1 } }
shader { name w type wood }
shader { name k type mirror refl { "sRGB nonlinear" 1 1 1 } }
object { shader s type sphere c -7 2 0 r 6 }
object { shader k type sphere c 7 2 0 r 6 }
object { shader w type plane p 0 -6 0 n 0 1 0 }
