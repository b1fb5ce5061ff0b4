shader { name a type diffuse diff 1 1 1 }
# warning: 1-2 this block comment is never closed, and hides the rest of the file
# hint: end it with the word `*/`
/* an unfinished thought
shader { name b type diffuse diff 1 1 1 }
