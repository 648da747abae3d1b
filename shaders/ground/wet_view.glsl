// wet_view.glsl - the view of the draw of wet ground.
#define VIRGA_GLSL
#include "shared/ground_wet_gpu.h"
#include "shared/view_gpu.h"
#include "gpu/vectors.glsl"

layout(scalar, set = 0, binding = 0) uniform View
{
    virga_view_gpu view;
    virga_ground_wet_gpu wet;
};

#include "gpu/view.glsl"
