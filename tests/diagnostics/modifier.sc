# error: 1-8 `bump` lacks `name`
# hint: add `name NAME`
modifier { type bump texture a.png scale 1 }
# error: 24-27 unknown modifier type `bmup`
# hint: did you mean `bump`?
modifier { name a type bmup texture a.png scale 1 }
# error: 1-8 `bump` lacks `scale`
# hint: add `scale 0.02`
modifier { name b type bump texture a.png }
# error: 48-52 unknown keyword `scale` in `normalmap`
# hint: expected `name`, `type` or `texture`
modifier { name c type normalmap texture a.png scale 1 }
# warning: 17-17 there is already a modifier `c`; names find the first one
# label: [4] 17-17 first declared here
modifier { name c type perlin function 0 size 1 scale 50 }
# error: 23-28 unknown texture type `marbel`
# hint: did you mean `marble`?
texture { name d type marbel }
# error: 1-7 `texture` lacks `name`
# hint: add `name NAME`
# error: 29-30 `depth` must be from 0 to 32, and is 99
texture { type marble depth 99 }
texture { name d type marble }
# warning: 16-16 there is already a texture `d`; names find the first one
# label: [8] 16-16 first declared here
texture { name d type wood }
