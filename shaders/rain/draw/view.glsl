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

// Pixels over which the lens blurs what is that far away: by the angle under which its opening is seen from there, less
// that from where it is sharp.
float blur_px(float depth) { return view.lens_px * abs(view.inv_focus - 1.0 / max(depth, NEAR_W)); }

// 1 / the view depth from which a ray is hazed, which is linear on the picture: 0 and less for none.
float inverse_begin(vec3 ray)
{
    return look.begin[0] * ray.x + look.begin[1] * ray.y + look.begin[2] * ray.z + look.begin[3];
}

// How wide a streak is drawn.
float drawn_width(float width_px, float blur) { return max(width_px, max(view.min_width_px, blur)); }

// Coverage of the middle line of a streak by one drop: the share of the time that the drop covers it (body / way, and
// all of the time where it moves by less than its own length), and of the width and length that it is drawn over where
// the drop is narrower than the sampling or out of focus.
// Of a picture that is averaged from several views all of the shutter counts, so that the same streaks are drawn
// whatever their number.
float streak_coverage(float width_px, float body, float way, float blur)
{
    const float longer = max(way, body);
    const float share = width_px / drawn_width(width_px, blur) * longer / max(longer, blur);
    return min(look.streak_gain * body / longer, 1.0) * share;
}
