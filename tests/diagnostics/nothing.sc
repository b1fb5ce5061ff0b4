# error: `nothing.sc` holds no scene
# hint: a scene consists of blocks like `camera { … }` and `object { … }`
# warning: 1-3 skipped: unknown keyword `PNG`
PNG IHDR these are the bytes of a picture
