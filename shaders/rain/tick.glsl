// tick.glsl - data of the newest tick, for all passes and draws of rain.
#define VIRGA_GLSL
#include "shared/rain_gpu.h"
#include "shared/random.h"
#include "shared/drop.h"
#include "shared/impact.h"
#include "shared/surface.glsl"
#include "gpu/vectors.glsl"

// Small tables are in a uniform buffer: software Vulkan reads it without a loop over lanes.
layout(scalar, set = 0, binding = 0) uniform Tick
{
    virga_tick_gpu tick;
    virga_map_gpu maps[VIRGA_RAIN_MAX_MAPS];
    virga_class_gpu classes[VIRGA_RAIN_CLASSES];
};
