// lens.glsl - what the passes of the lens share: the view, its pictures, and the circle of confusion.
//
// A thin lens with an aperture of diameter A (m), focused at distance s, images a point at distance z as a disc. With
// the image distance v of the focus, the disc's diameter on the sensor is c = A v |1/s - 1/z|, by similar triangles. A
// direction with tangent 1 is v away from the sensor's centre, which is p pixels on the picture. So the radius in
// pixels is
//
//     r = A p / 2 |1/s - 1/z|
//
// whatever the sensor's size. It has a sign here: r = A p / 2 (1/s - 1/z) is negative in front of the focus. It is
// linear in 1/z, and so in the values of a depth buffer. Greater r is farther.
//
// Software Vulkan executes both sides of every branch, also the body of a loop that has no turn. So what a picture does
// not need is left out by specialisation.
#define VIRGA_GLSL
#include "shared/lens_gpu.h"

layout(constant_id = 0) const uint FORM = 0u;
const uint OWN_FORM = FORM & 255u;
// A pass that works at a quarter of the resolution, and then at half of it: see narrow.glsl.
#ifdef WIDE_PASS
bool COARSE; // it is at a quarter now
#define FINER           (!COARSE)
#define BY_SCALE(a, b)  (COARSE ? a : b)
#elif defined(OF_ONE_SCALE) // a pass with a form for each
const bool COARSE = (OWN_FORM & VIRGA_LENS_QUARTER) != 0u;
#define BY_SCALE(a, b)  (COARSE ? a : b)
#else
#define COARSE          false
#define FINER           false
#define BY_SCALE(a, b)  b
#endif
#ifdef NOT_SPECIALISED // a fragment shader
#define STEP   view.step
#define HALVED (STEP == 2u)
#else
const bool HALVED = (FORM & VIRGA_LENS_HALVED) != 0u;
const bool IN_PLACE = (FORM & VIRGA_LENS_IN_PLACE) != 0u;
#define STEP BY_SCALE(4u, (HALVED ? 2u : 1u)) // as view.step, but for what is coarse
#endif
// Texels per pixel, along a side.
#define TEXELS BY_SCALE(0.25, (HALVED ? 0.5 : 1.0))

layout(scalar, set = 0, binding = 0) uniform View { virga_lens_gpu view; };
#ifndef STATE_WRITTEN
layout(scalar, set = 0, binding = 29) uniform State { virga_lens_state_gpu state; };
#endif

// The largest radius of a circle of confusion, in texels.
#define MAX_RADIUS BY_SCALE((0.5 * view.max_radius), view.max_radius)

// The work image: texels and tiles that are used.
#define WORK_SIZE    BY_SCALE((ivec2(view.columns + 1u, view.rows + 1u) >> 1), ivec2(view.columns, view.rows))
#define TILE_COLUMNS BY_SCALE(((view.tile_columns + 1u) >> 1), view.tile_columns)

// 1 / view depth (1/m) of a value of the depth buffer. 0 at infinity.
float inverse_depth(float stored) { return max((view.depth_a + stored) / view.depth_b, 0.0); }

#ifndef STATE_WRITTEN
// 1/m. Only a focus that follows what is in the picture has to be computed first, see focus.comp.
float focus_inv_m() { return view.follow != 0u ? state.focus_inv_m : view.focus_inv_m; }

// The signed radius of the circle of confusion, in texels of the work image.
float circle(float inv_m)
{
    const float r = view.circle_px_m * (focus_inv_m() - inv_m) * TEXELS;
    return clamp(r, -MAX_RADIUS, MAX_RADIUS);
}
#endif

#ifndef STATE_WRITTEN
// The same for values of the depth buffer, in which it is linear, too. One function with one rounding: passes have to
// agree to the last bit.
struct depth_line {
    float slope, at_infinity, most; // texels
};

depth_line line_of_depths()
{
    const float at_infinity = view.depth_given != 0u ? view.circle_px_m * focus_inv_m() * TEXELS : 0.0;
    return depth_line(-view.circle_per_depth * TEXELS, at_infinity, min(at_infinity, MAX_RADIUS));
}

vec4 depth_circles(depth_line line, vec4 stored)
{
    const vec4 r = fma(stored + view.depth_a, vec4(line.slope), vec4(line.at_infinity));
    return clamp(r, vec4(-MAX_RADIUS), vec4(line.most));
}
#endif

// How much of a pixel comes from the blurred images. `radius` in px.
float blurriness(float radius) { return HALVED ? smoothstep(0.5, 2.0, abs(radius)) : 1.0; }

#define POINT 0.5 // texels: a smaller circle of confusion is sharp

// How much something is behind what is in front of the focus, by both circles of confusion (texels, with their sign):
// all of it where it is in focus or behind it. In front of the focus, by how far its circle is beyond a point: all of
// it up to a quarter of that of what is before it, nothing from three quarters on. `front` is below -POINT.
float behind_share(float radius, float front)
{
    return smoothstep(0.25, 0.75, 1.0 - (radius + POINT) / (front + POINT));
}

// How much of what has this circle of confusion comes from the coarse fields. `radius` in px.
float coarseness(float radius) { return smoothstep(VIRGA_LENS_COARSE_FROM, VIRGA_LENS_COARSE_TO, abs(radius)); }

// What a picture may not hold: NaN becomes 0, infinity and huge numbers the largest half float.
vec4 finite(vec4 color)
{
    return clamp(mix(color, vec4(0.0), isnan(color)), vec4(-65504.0), vec4(65504.0));
}

vec3 finite(vec3 color)
{
    return clamp(mix(color, vec3(0.0), isnan(color)), vec3(-65504.0), vec3(65504.0));
}
