// view.glsl - a view's parameters, and what a streak covers in it. Include it after tick.glsl.
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

#define SCENE_DEPTH_BINDING 12 // for gpu/scene_depth.glsl

// A streak that covers less than this is haze, see rain_draw.c. It fades in up to twice this coverage. What is wide is
// seen at less contrast, so there the limit is lower.
#define MIN_COVERAGE (1.0 / 800.0)
#define MAX_COVERAGE 0.25 // of a streak that stands for many drops

#define WIDE_PX 3.0 // from this width on a streak shows the inside of its drop

// The blur (px) of the lens at a depth: the angle of its aperture seen from there, minus that from the depth in focus.
float blur_px(float depth) { return view.lens_px * abs(view.inv_focus - 1.0 / max(depth, NEAR_W)); }

// 1 / view depth at which haze begins on a ray. It is linear on the picture; 0 or less: no haze.
float inverse_begin(vec3 ray)
{
    return look.begin[0] * ray.x + look.begin[1] * ray.y + look.begin[2] * ray.z + look.begin[3];
}

// The width with which a streak is drawn.
float drawn_width(float width_px, float blur) { return max(width_px, max(view.min_width_px, blur)); }

// Coverage of a streak's center line by one drop. It is the fraction of the time for which the drop covers it (body /
// path, or all of it if the drop moves by less than its length), times what it covers of the width and length that are
// drawn, where the drop is narrower than the sampling or out of focus. When a picture is averaged from several views,
// all of the shutter counts, so that the same streaks are drawn for any number of views.
float streak_coverage(float width_px, float body, float path, float blur)
{
    const float longer = max(path, body);
    const float share = width_px / drawn_width(width_px, blur) * longer / max(longer, blur);
    return min(look.streak_gain * body / longer, 1.0) * share;
}

// Coverage from a drop's width and length, its path (all in pixels), its diameter and velocity (m, m/s), and from the
// number of drops that its slot stands for. A streak of many drops covers no more than a large drop would there: far
// rain is fine grain, not bars. The rest of its coverage is haze, see rain_draw.c.
float limited_coverage(vec2 size_px, float path, float blur, float diameter, vec3 velocity, float drops)
{
    const float one = streak_coverage(size_px.x, size_px.y, path, blur);
    const float large_px = size_px.x * look.group_m / diameter;
    const float faster = length(vec3(velocity.x, look.group_m_s, velocity.z)) / max(length(velocity), 1e-3);
    const float large = streak_coverage(large_px, large_px, path * faster, blur);
    const float coverage = min(one * drops, max(one, min(large, MAX_COVERAGE)));
    const float least = MIN_COVERAGE * min(WIDE_PX / drawn_width(size_px.x, blur), 1.0);
    return coverage * clamp(coverage / least - 1.0, 0.0, 1.0);
}
