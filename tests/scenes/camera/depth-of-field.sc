% The middle sphere is in focus.
image { resolution 96 72 aa 2 2 samples 1 filter box }
light { type point color 1 0.95 0.9 power 2600 p 5 7 6 }
camera { type thinlens eye 0 0.5 6 target 0 0 0 up 0 1 0 fov 36 aspect 1.333333 fdist 6 lensr 0.35 }
shader { name white type diffuse diff 0.8 0.8 0.8 }
object { shader white type sphere c -1.6 0 2 r 0.6 }
object { shader white type sphere c 0 0 0 r 0.6 }
object { shader white type sphere c 2.4 0 -3 r 0.6 }
