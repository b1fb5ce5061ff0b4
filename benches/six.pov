// The six spheres of scenes/figures/7-six.sc for POV-Ray 3.7, for BENCHMARKS.md: the same spheres, lights, camera, number
// of samples and octaves, with POV-Ray's nearest patterns. It measures work of the same kind, not the same picture.
#version 3.7;
global_settings { assumed_gamma 1 ambient_light 0.01 max_trace_level 5 noise_generator 3 }
camera { location <0, 0, -10> look_at 0 angle 45 right x*4/3 }
light_source { <2, 0, -5> rgb 1 fade_distance 5 fade_power 1 }
light_source { <-2, 0, -5> rgb 1 fade_distance 5 fade_power 1 }
#declare Plain = finish { diffuse 1 };
sphere { 0, 1.5 pigment { wrinkles turbulence 0.6 octaves 4 color_map { [0 rgb <0, 0.5, 0.5>] [1 rgb <0, 0, 0.5>] } scale 0.3 } finish { diffuse 1 reflection 0.2 } translate <-3, 1.5, 0> }
sphere { 0, 1.5 pigment { wrinkles turbulence 0.6 octaves 10 color_map { [0 rgb <1, 1, 1>] [1 rgb <0.3, 0.3, 0>] } scale 1 } finish { Plain } translate <0, 1.5, 0> }
sphere { 0, 1.5 pigment { wrinkles turbulence 0.6 octaves 5 color_map { [0 rgb <1, 0.15, 0>] [1 rgb <1, 1, 0>] } scale 0.3 } finish { Plain } translate <3, 1.5, 0> }
sphere { 0, 1.5 pigment { marble turbulence 0.6 octaves 5 color_map { [0 rgb <0.91, 0.71, 0.63>] [1 rgb <0.47, 0.34, 0.07>] } scale 0.5 } finish { Plain } translate <-3, -1.5, 0> }
sphere { 0, 1.5 pigment { granite turbulence 0.6 octaves 4 color_map { [0 rgb <1, 1, 1>] [1 rgb <0.2, 0.2, 0.2>] } scale 0.1 } finish { Plain } translate <0, -1.5, 0> }
sphere { 0, 1.5 pigment { wood turbulence 0.6 octaves 5 color_map { [0 rgb <0.78, 0.39, 0>] [1 rgb <0.39, 0.2, 0>] } scale 0.2 } finish { diffuse 1 reflection 0.1 } translate <3, -1.5, 0> }
