% The camera of most golden scenes: a little from above, the origin in the middle.
camera { type pinhole eye 1.5 2 6 target 0 0 0 up 0 1 0 fov 26 aspect 1.333333 }
