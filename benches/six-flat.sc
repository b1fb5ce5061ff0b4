% Figure 7 (scenes/figures/7-six.sc) in six flat colours, to tell what its textures cost. Wood and water mirror what they mirror
% there: without octaves, and with one colour for both, their textures are flat.

dialect report

image { resolution 640 480 aa 0 1 samples 1 }
camera { type pinhole eye 0 0 10 target 0 0 0 up 0 1 0 fov 60 aspect 1.333 }

light { type point color 1 1 1 power 11 p 2 0 5 }
light { type point color 1 1 1 power 11 p -2 0 5 }

shader { name organic type diffuse diff { "sRGB nonlinear" 0.65 0.65 0.5 } }
shader { name wood type wood depth 0 diffuse_initial { "sRGB nonlinear" 0.6 0.3 0 } diffuse_final { "sRGB nonlinear" 0.6 0.3 0 } }
shader { name marble type diffuse diff { "sRGB nonlinear" 0.8 0.6 0.5 } }
shader { name water type water depth 0 diffuse_initial { "sRGB nonlinear" 0 0.25 0.5 } diffuse_final { "sRGB nonlinear" 0 0.25 0.5 } }
shader { name fire type diffuse diff { "sRGB nonlinear" 1 0.6 0 } }
shader { name stone type diffuse diff { "sRGB nonlinear" 0.7 0.7 0.7 } }

object { shader water type sphere name water c -3 1.5 0 r 1.5 }
object { shader organic type sphere name organic c 0 1.5 0 r 1.5 }
object { shader fire type sphere name fire c 3 1.5 0 r 1.5 }
object { shader marble type sphere name marble c -3 -1.5 0 r 1.5 }
object { shader stone type sphere name stone c 0 -1.5 0 r 1.5 }
object { shader wood type sphere name wood c 3 -1.5 0 r 1.5 }
