// tickets.glsl - what a particle remembers between the passes of the sort: its cell, and how many came there before it.
layout(std430, set = 0, binding = 7) buffer Tickets { uvec2 tickets[]; };
