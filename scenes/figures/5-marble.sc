% Figure 5 of the 2010 report. Marble: brown, pink and white bands.
% In its own dialect: `power` is the distance at which a light ends, and colours are display values.

dialect report

image { resolution 640 480 aa 0 1 samples 1 }
camera { type pinhole eye 0 15 40 target 0 0 0 up 0 1 0 fov 60 aspect 1.333 }

light { type point color 1 1 1 power 60 p 0 15 15 }
light { type point color 1 1 1 power 60 p 0 -15 15 }
light { type point color 1 1 1 power 60 p 0 0 15 }
light { type point color 1 1 1 power 60 p -14 0 12.5 }
light { type point color 1 1 1 power 60 p 14 0 12.5 }

shader {
   name marble
   type marble
   depth 4
}

object { shader marble type sphere c 0 0 0 r 12 }
