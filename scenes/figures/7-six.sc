% Figure 7 of the 2010 report. All six, with ghosts of the neighbours in the water.
% In its own dialect: `power` is the distance at which a light ends, and colours are display values.

dialect report

image { resolution 640 480 aa 0 1 samples 1 }
camera { type pinhole eye 0 0 10 target 0 0 0 up 0 1 0 fov 60 aspect 1.333 }

light { type point color 1 1 1 power 11 p 2 0 5 }
light { type point color 1 1 1 power 11 p -2 0 5 }

shader { name organic type organic depth 20 }
shader { name wood type wood depth 5 }
shader { name marble type marble depth 5 }
shader { name water type water depth 4 }
shader { name fire type fire depth 5 }
shader { name stone type stone depth 4 }

object { shader water type sphere name water c -3 1.5 0 r 1.5 }
object { shader organic type sphere name organic c 0 1.5 0 r 1.5 }
object { shader fire type sphere name fire c 3 1.5 0 r 1.5 }
object { shader marble type sphere name marble c -3 -1.5 0 r 1.5 }
object { shader stone type sphere name stone c 0 -1.5 0 r 1.5 }
object { shader wood type sphere name wood c 3 -1.5 0 r 1.5 }
