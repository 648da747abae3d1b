// fall_buffers.glsl - which droplets have fallen, and which are alive: a bit each, 32 to a word.
layout(scalar, set = 0, binding = 7) buffer Marks { uvec4 marks[]; }; // fallen; alive; place of the first fallen among the returns; -
