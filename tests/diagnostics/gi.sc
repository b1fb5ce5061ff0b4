# error: 1-2 `gi` lacks `type`
# hint: types are `path`, `irr-cache`, `igi`, `ambocc`, `fake` and `none`
gi { samples 16 }
# error: 11-14 unknown gi type `paht`
# hint: did you mean `path`?
gi { type paht samples 16 }
# error: 1-2 `path` lacks `samples`
# hint: add `samples 64`
gi { type path }
# error: 61-61 `spacing` expects a number, found `}`
# hint: for example `spacing 0.05 5`
gi { type irr-cache samples 256 tolerance 0.05 spacing 0.05 }
# error: 70-73 `global` expects the number of photons, found `grid`
# hint: for example `global 100000 grid 50 0.5`
gi { type irr-cache samples 256 tolerance 0.05 spacing 0.05 5 global grid 50 0.5 }
# warning: 75-80 there is no photon map `octree`: there will be none
# hint: expected `grid` or `kd`
gi { type irr-cache samples 256 tolerance 0.05 spacing 0.05 5 global 1000 octree 50 0.5 }
# error: 1-2 `igi` lacks `b` or `c`
# hint: add `b 0.00003`
# warning: 23-24 the number of samples is -4, and 0 is used: it must be from 0 to 1000000
gi { type igi samples -4 sets 1 bias-samples 0 }
# error: 19-23 `up` expects a direction other than `0 0 0`
gi { type fake up 0 0 0 sky 1 1 1 ground 0 0 0 }
# warning: 25-28 there is no caustic map `tree`: there will be none
# hint: the only one is `kd`
photons { caustics 1000 tree 64 0.5 }
# warning: 20-30 the number of photons is 99999999999, and 20000000 is used: it must be from 0 to 20000000
photons { caustics 99999999999 kd 64 0.5 }
# error: 11-18 `caustics` lacks the number of photons
# hint: for example `caustics 100000 kd 64 0.5`
photons { caustics kd 64 0.5 }
# error: 1-7 `photons` lacks `caustics`
# hint: add `caustics 100000 kd 64 0.5`
photons { }
# error: 30-33 `direct-samples` expects a whole number, found `many`
# hint: for example `direct-samples 4`
lightserver { direct-samples many }
# warning: 8-11 the size of a bucket is 1000, and 512 is used: it must be from 16 to 512
# warning: 14-27 unknown bucket order `reverse hilbrt`
# hint: expected `column`, `diagonal`, `hilbert`, `random`, `row` or `spiral`
bucket 1000 "reverse hilbrt"
