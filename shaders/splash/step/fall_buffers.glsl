// fall_buffers.glsl - marks: a bit per droplet for fallen and for alive, 32 in a word; and for each word the number of
// fallen and of living droplets before it (prefix sum).
#ifndef MARKS_ACCESS
#define MARKS_ACCESS // coherent where invocations read what others wrote
#endif
layout(scalar, set = 0, binding = 7) MARKS_ACCESS buffer Marks { uvec4 marks[]; };
