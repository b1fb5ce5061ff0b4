image {
# warning: 14-14 width is 0, and 1 is used: it must be from 1 to 16384
# warning: 16-20 height is 20000, and 16384 is used: it must be from 1 to 16384
  resolution 0 20000
# warning: 8-8 the second number of `aa` is 1, and 3 is used: it must be from 3 to 5
  aa 3 1
# warning: 11-11 `samples` is 0, and 1 is used: it must be from 1 to 256
  samples 0
# warning: 12-12 `contrast` is 2, and 1 is used: it must be from 0 to 1
  contrast 2
# warning: 10-16 unknown filter `mitchel`; `box` is used
# hint: did you mean `mitchell`?
  filter mitchel
# warning: 10-12 `yes` is neither `true` nor `false`, and counts as `false`
# hint: write `true` or `false`
  jitter yes
}
# error: 24-24 `resolution` expects a whole number, found `}`
# hint: for example `resolution 640 480`
image { resolution 640 }
# error: 20-20 `resolution` expects a whole number, found `}`
# hint: for example `resolution 640 480`
image { resolution }
# error: 1-10 `background` lacks `color`
# hint: add `color 0.1 0.2 0.3`
background { }
background { color 0 0 1 }
# warning: 1-10 skipped: the scene has a background already
# label: [12] 1-26 this one counts
background { color 0 1 0 }
# error: 29-32 `refl` expects a whole number, found `many`
# hint: for example `refl 4`
trace-depths { diff -1 refl many }
# warning: 8-14 unknown filter `gausian`; `box` is used
# hint: did you mean `gaussian`?
filter gausian 3 3
