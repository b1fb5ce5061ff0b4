% Polished: the six as textures of Sunflow's shaders, under its sky. Varnished wood, a teapot of polished marble, brushed
% granite, a waxed ring, and dents that follow the exact slope of the noise.

image { resolution 960 540 aa 1 2 filter mitchell }
trace-depths { diff 1 refl 4 refr 4 }
gi { type path samples 32 }

camera { type pinhole eye 0 -9.5 3.4 target 0 0 0.85 up 0 0 1 fov 47 aspect 1.7778 }

light { type sunsky up 0 0 1 east 0 1 0 sundir -0.6 -0.75 0.9 turbidity 3 samples 96 }

texture { name walnut type wood depth 5 scale 1.2
   diffuse_initial { "sRGB nonlinear" 0.30 0.16 0.07 } diffuse_final { "sRGB nonlinear" 0.62 0.37 0.17 } }
texture { name veins type marble depth 7 scale 110
   diffuse_initial { "sRGB nonlinear" 0.16 0.20 0.19 } diffuse_final { "sRGB nonlinear" 0.92 0.93 0.88 } }
texture { name granite type stone depth 5 scale 0.5
   diffuse_initial { "sRGB nonlinear" 0.25 0.24 0.24 } diffuse_final { "sRGB nonlinear" 0.75 0.72 0.70 } }
texture { name mould type organic depth 6 scale 1.1 }
texture { name dents type organic depth 3 scale 0.35 }

shader { name varnished type shiny texture walnut refl 0.25 }
shader { name polished type shiny texture veins refl 0.15 }
shader { name brushed type ward texture granite spec 0.25 0.25 0.25 rough 0.12 0.3 samples 8 }
shader { name waxed type phong texture mould spec 0.2 0.2 0.2 60 samples 4 }
shader { name dented type shiny diff { "sRGB nonlinear" 0.75 0.42 0.16 } refl 0.5 }
shader { name glass type glass eta 1.5 color 0.98 1.0 0.99 }
shader { name floor type diffuse diff { "sRGB nonlinear" 0.55 0.52 0.47 } }

modifier { name hammered type bump texture dents scale 0.06 }

object { shader floor type plane p 0 0 0 n 0 0 1 }
object { shader varnished transform { rotatez 20 translate -3.3 0.6 1.1 } type sphere c 0 0 0 r 1.1 }
object { shader polished transform { scaleu 0.0125 rotatez -25 translate 0 0.2 0 } type teapot subdivs 16 smooth true }
object { shader brushed transform { rotatez 30 translate 3.2 0.8 1.1 } type sphere c 0 0 0 r 1.1 }
object { shader dented modifier hammered type sphere c -1.9 -1.9 0.6 r 0.6 }
object { shader glass type sphere c 0.15 -2.6 0.5 r 0.5 }
object { shader waxed transform { rotatex 78 rotatez 20 translate 2.0 -1.6 0.62 } type torus r 0.22 0.5 }
