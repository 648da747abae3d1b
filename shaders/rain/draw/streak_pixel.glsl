// streak_pixel.glsl - what thin and wide streaks have in common at a pixel.
#include "shared/rain_limits.h"
#include "streak_form.glsl"
#include "gpu/scene_depth.glsl"
#include "gpu/temporal.glsl"
#ifdef MOTION
layout(location = 4) noperspective in vec2 motion;
#endif

// The light varies as the drop oscillates: a cosine of `oscillations`, as a cubic approximation (error 1.1 % of its
// height).
float streak_wave(float oscillations, float size)
{
    const float triangle = 4.0 * abs(fract(oscillations) - 0.5) - 1.0;
    return 1.0 + size * triangle * (1.5 - 0.5 * triangle * triangle);
}
