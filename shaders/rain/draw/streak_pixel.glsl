// streak_pixel.glsl - what thin and wide streaks do alike at a pixel.
#include "shared/rain_limits.h"
#include "streak_form.glsl"
#include "gpu/scene_depth.glsl"
#include "gpu/temporal.glsl"
#ifdef MOTION
layout(location = 4) noperspective in vec2 motion;
#endif

// Light varies as the drop oscillates: a cosine of turns, as near as a cubic comes (1.1 % of its height).
float streak_wave(float turns, float size)
{
    const float saw = 4.0 * abs(fract(turns) - 0.5) - 1.0;
    return 1.0 + size * saw * (1.5 - 0.5 * saw * saw);
}
