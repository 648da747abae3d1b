// state.glsl - counts and indirect arguments that the passes of a step write.
#ifndef STATE_ACCESS
#define STATE_ACCESS
#endif
layout(scalar, set = 0, binding = 1) STATE_ACCESS buffer State { virga_water_state_gpu state; };
