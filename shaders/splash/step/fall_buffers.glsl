// fall_buffers.glsl - which droplets have fallen, and which are alive: a bit each, 32 to a word; then, of the droplets
// before the word, how many have fallen and how many are alive.
#ifndef MARKS_ACCESS
#define MARKS_ACCESS // coherent where lanes look at what others have written
#endif
layout(scalar, set = 0, binding = 7) MARKS_ACCESS buffer Marks { uvec4 marks[]; };
