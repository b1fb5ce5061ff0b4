% Figure 2 of the 2010 report. Water: the same figure in blue and green; `fire` with other colours, so that nothing mirrors.
% In its own dialect: `power` is the distance at which a light ends, and colours are display values.

dialect report

image { resolution 640 480 aa 0 1 samples 1 }
camera { type pinhole eye 0 0 40 target 0 0 0 up 0 1 0 fov 60 aspect 1.333 }

light { type point color 1 1 1 power 20 p 0 15 15 }
light { type point color 1 1 1 power 20 p 0 -15 15 }
light { type point color 1 1 1 power 20 p 0 0 15 }
light { type point color 1 1 1 power 20 p -14 0 12.5 }
light { type point color 1 1 1 power 20 p 14 0 12.5 }

shader {
   name water
   type fire
   depth 4
   diffuse_initial { "sRGB nonlinear" 0 0 1 }
   diffuse_final { "sRGB nonlinear" 0 0.8 0.4 }
}

object { shader water type sphere c 0 0 0 r 10 }
