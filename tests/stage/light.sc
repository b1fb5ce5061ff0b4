% Size, sampling and light of the golden scenes. Small, and with few samples: every picture is compared on each run.
image { resolution 96 72 aa 0 1 filter box }
light { type point color 1 0.95 0.9 power 2600 p 5 7 6 }
light { type point color 0.6 0.7 1 power 700 p -7 3 4 }
