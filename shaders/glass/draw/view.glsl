// view.glsl - what all passes of the height map and of the draws share: the view, the settings, and small helpers.
#define VIRGA_GLSL
#include "shared/compact.h"
#include "shared/glass_picture_gpu.h"
#include "shared/random.h"
#include "shared/view_gpu.h"
#include "gpu/vectors.glsl"

layout(scalar, set = 0, binding = 0) uniform Picture
{
    virga_view_gpu view;
    virga_glass_picture_gpu look;
};

#define WATER 1.333 // its refractive index

#define DENSITY_GOTO 0u
#define DENSITY_BLINN 1u
#define DENSITY_MURAKAMI 2u
#define DENSITY_WYVILL 3u
#define DENSITY_NISHIMURA 4u

vec2 texel_m() { return vec2(look.texel_m[0], look.texel_m[1]); }

// How much of a drop is drawn as a shape: none below a radius of half a texel, where a drop only covers a part of a
// texel (mist), and all from one texel on.
float shape_share(float radius_m) { return smoothstep(0.5, 1.0, radius_m / max(look.texel_m[0], look.texel_m[1])); }

// Radius of the base of a spherical cap with this volume: drop_nl_of_m3 a^3.
float cap_radius(float water_nl) { return pow(max(water_nl, 0.0) / look.drop_nl_of_m3, 1.0 / 3.0); }
