// tick.glsl - data of the tick, for all shaders of ground.
#define VIRGA_GLSL
#include "shared/ground_gpu.h"

layout(scalar, set = 0, binding = 0) uniform Tick { virga_ground_tick_gpu tick; };
