% The six materials of the 2010 report, lit with Sunflow's lights.
%
%    jaspe render scenes/six-materials.sc
%
% A name and a type are enough for a material; everything else has a default.

image {
   resolution 960 600
   aa 1 2
   filter mitchell
}

trace-depths { diff 1 refl 3 refr 3 }

camera {
   type pinhole
   eye 0 7.2 22
   target 0 2.65 0
   up 0 1 0
   fov 33
   aspect 1.6
}

% A warm key light from the left, in five points so that its shadows are soft.
light { type point color 1 0.91 0.78 power 1850 p -9 13 11 }
light { type point color 1 0.91 0.78 power 1850 p -8.1 13.8 11.8 }
light { type point color 1 0.91 0.78 power 1850 p -10 12.4 11.5 }
light { type point color 1 0.91 0.78 power 1850 p -8.3 12 10 }
light { type point color 1 0.91 0.78 power 1850 p -9.7 14 10.2 }
% A cool fill from the right, a faint one from the camera, and a rim light on the wall.
light { type point color 0.60 0.75 1 power 2200 p 13 7 11 }
light { type point color 1 0.96 0.92 power 1700 p 2 6 24 }
light { type point color 1 0.86 0.72 power 700 p 0 7.4 -8.2 }

shader { name fire type fire }
shader { name water type water }
shader { name organic type organic }
shader { name wood type wood }
shader { name marble type marble }
shader { name stone type stone }

shader {
   name floor
   type stone
   diffuse_initial { "sRGB nonlinear" 0.22 0.22 0.24 }
   diffuse_final { "sRGB nonlinear" 0.43 0.43 0.46 }
   scale 4
}

shader {
   name step
   type stone
   diffuse_initial { "sRGB nonlinear" 0.34 0.31 0.29 }
   diffuse_final { "sRGB nonlinear" 0.74 0.70 0.65 }
   space world
   scale 6
}

shader { name wall type diffuse diff { "sRGB nonlinear" 0.44 0.47 0.55 } }

object { shader floor type plane p 0 0 0 n 0 1 0 }
object { shader wall type plane p 0 0 -10 n 0 0 1 }
object { shader step transform { scale 14 2.4 4.4 translate 0 1.2 -3 } type box name step }

object { shader water   type sphere name water   c -4.1 3.9 -2.6 r 1.5 }
object { shader organic type sphere name organic c  0   3.9 -2.6 r 1.5 }
object { shader fire    type sphere name fire    c  4.1 3.9 -2.6 r 1.5 }
object { shader marble  type sphere name marble  c -4.1 1.5  2.6 r 1.5 }
object { shader stone   type sphere name stone   c  0   1.5  2.6 r 1.5 }
object { shader wood    type sphere name wood    c  4.1 1.5  2.6 r 1.5 }
