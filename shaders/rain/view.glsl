// view.glsl - a view's parameters, and what a streak covers in it. After tick.glsl.
#include "shared/view_gpu.h"

layout(scalar, set = 0, binding = 1) uniform View
{
    virga_view_gpu view;
    virga_rain_look_gpu look;
};

// Flat inputs of the haze: see haze.vert.
#define HAZE_VECTORS (VIRGA_RAIN_MAX_LEVELS / 4 + 1)
#define SKY_VECTORS 7

#ifdef SH_FETCHED
vec3 sh_coefficient(uint i);
#endif
#include "gpu/view.glsl"
#include "gpu/light.glsl"

#define SCENE_DEPTH_BINDING 12 // of gpu/scene_depth.glsl

// A streak that covers less than this is haze, see rain_draw.c; it fades in up to twice as much.
#define LEAST_COVERAGE (1.0 / 400.0)

#define WIDE_PX 3.0 // from here on a streak shows the inside of its drop

// Coverage of the middle line of a streak by one drop: the share of the time that the drop covers it (body / way, and
// all of the time where it moves by less than its own length), and of the sampling's width where the drop is narrower.
float streak_coverage(float width_px, float body, float way)
{
    const float narrow = min(width_px / view.min_width_px, 1.0);
    return min(look.streak_gain * body / max(way, body), 1.0) * narrow;
}
