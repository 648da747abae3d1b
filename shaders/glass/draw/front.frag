// front.frag - a drop on the camera's front element, far out of focus. Premultiplied.
// One invocation per pixel of a drop's quad. Reads: quads, nodes, the plate and its copies. Writes: radiance, motion,
// reactive.
//
// The drop covers a share of the opening, the alpha (front_overlap.glsl). Its light is the mean of what the rays
// through that part show, each refracted at another point of the drop. SAMPLES points on the smaller of the two discs
// stand for it, each for an equal area; those at the rim of the other disc count by how far they are within. Each shows
// as much of the plate as the drop bends the light of its area over, so the plate's smaller copies do the rest of the
// mean. All weights are divided by their sum, so an even scene stays even.
//
// The veil is mist on the glass: droplets of the same contact angle all over the opening, so every pixel has the same
// share of it. A droplet bends light by its shape and not by its size, so its light is that of a drop which the whole
// opening sees: the mean over a cone with a half-angle of 2 tan(contact angle / 2) (n - 1).
//
// Streaks of film, as a cloth leaves them, are ridges with a round section. One that meets the glass at the angle t has
// the inclinations b from -t to t, b evenly in sin b; so |inclination| < b has the share min(sin b / sin t, 1). Streaks
// dry with their edges in place, so t falls evenly in time from T, the receding contact angle, to 0. The mean over all
// of them is the share
//
//     S(b) = (1 / T) integral from 0 to T of min(sin b / sin t, 1) dt = (b + sin b ln(tan(T / 2) / tan(b / 2))) / T,
//
// with S(T) = 1. All light that they take from a lamp is on two rays across the streaks, most of it near the lamp and
// none at the ends, which are (n - 1) T away. Streaks in several directions make a starburst. BURST samples at equal
// steps of b stand for a ray, each with its part of S. Lamps count as they are on the picture.
//
// Where drops overlap on the picture, one covers the others' light too. Drops that lie beside each other on the pane
// cover the sum of their shares instead: where all of them cover C, up to C^2 / 2 of the light is between the two.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/light.glsl"
#include "drop_inputs.glsl"
#define FAR_APART
#include "plate.glsl"
#include "path.glsl"
#include "drop_path.glsl"
#include "water_light.glsl"
#include "temporal.glsl"
#include "drop_quad.glsl"
#include "front_overlap.glsl"
#include "gpu/encode.glsl"

layout(location = 0) in vec2 local; // as in drop.vert: the pixel's ray, in radii from the drop's middle
layout(location = 2) flat in vec4 amount; // x: radius of the opening, in radii of the drop; y: see write_whole, or 0
layout(location = 3) flat in uint quad;
layout(location = 0) out vec4 radiance;

#define SAMPLES 32
#define BURST   32
#define TURN 2.39996323   // rad, the golden angle: Vogel's spiral, whose points are as dense everywhere
#define OUTERMOST 0.97    // radius at which a drop's rim counts as too steep
#define SPACING (sqrt(3.14159265 / float(SAMPLES))) // a side of a sample's area, of a disc of radius 1

vec2 spiral(int i)
{
    const float angle = TURN * float(i);
    return sqrt((float(i) + 0.5) / float(SAMPLES)) * vec2(cos(angle), sin(angle));
}

// Where a point of the drop, in radii along the picture's axes, is along the pane's.
vec2 on_pane(vec2 at)
{
    const vec3 across = at.x * normalize(to_vec(view.right)) + at.y * normalize(to_vec(view.up));
    const vec2 along = vec2(dot(across, along_u), dot(across, along_v));
    return along * min(1.0, OUTERMOST / max(length(along), 1e-6));
}

vec3 light_through(float opening)
{
    const bool wide = opening >= 1.0; // the drop is the smaller disc
    const vec2 middle = wide ? vec2(0.0) : local, other = wide ? local : vec2(0.0);
    const float smaller = min(opening, 1.0), larger = max(opening, 1.0), side = smaller * SPACING;
    const vec3 d = normalize(pixel_ray(gl_FragCoord.xy));
    vec4 sum = vec4(0.0);
    far_apart = true;
    for (int i = 0; i < SAMPLES; i++) {
        const vec2 at = middle + smaller * spiral(i);
        float weight = clamp((larger - length(at - other)) / side + 0.5, 1e-4, 1.0);
        if (look.opening_blades > 0u)
            weight *= clamp(opening * (1.0 - opening_reach((at - local) / opening)) / side + 0.5, 1e-4, 1.0);
        const Path path = path_through_drop(on_pane(at), d, side);
        sum += weight * vec4(water_light(path, d, Water(1.0, 0.0, 0.0, 1.0, vec2(0.0), LENS.y)), 1.0);
    }
    return sum.rgb / sum.a;
}

// S of the comment above.
float share_within(float inclined)
{
    const float full = look.starburst_rad;
    return (inclined + sin(inclined) * log(tan(0.5 * full) / tan(0.5 * inclined))) / full;
}

// Light of all rays through film that is inclined so much; and a sample shows so many pixels.
vec3 light_of_inclined(vec3 d, float inclined, float pixels)
{
    const vec3 flat_normal = cross(along_u, along_v);
    vec3 sum = vec3(0.0);
    for (uint ray = 0u; ray < 2u * look.starburst_rays; ray++) {
        const float turn = look.starburst_turn + 3.14159265 * float(ray) / float(look.starburst_rays);
        const vec3 aside = cos(turn) * along_u + sin(turn) * along_v;
        const Path path = path_by_normal(d, cos(inclined) * flat_normal + sin(inclined) * aside, pixels);
        sum += water_light(path, d, Water(1.0, 0.0, 0.0, 0.0, vec2(0.0), 0.0));
    }
    return sum / float(2u * look.starburst_rays);
}

vec3 light_of_streaks()
{
    const vec3 d = normalize(pixel_ray(gl_FragCoord.xy));
    const float each = look.starburst_rad / float(BURST), pixels = max((WATER - 1.0) * each / gain_angle.y, 1.0);
    vec3 sum = vec3(0.0);
    float inside = 0.0;
    for (int i = 0; i < BURST; i++) {
        const float within = share_within(each * (float(i) + 1.0));
        sum += (within - inside) * light_of_inclined(d, each * (float(i) + 0.5), pixels);
        inside = within;
    }
    return sum;
}

void main()
{
    const float share = amount.y != 0.0 ? abs(amount.y) : opening_share(local, amount.x);
    if (share <= 0.0)
        discard;
    stand_on(vec2(quad_float(quad, 12u), quad_float(quad, 13u)));
    radiance = for_target(vec4(amount.y < 0.0 ? light_of_streaks() : light_through(amount.x), 1.0) * share);
#ifdef TEMPORAL
    write_temporal(vec2(0.0), share);
#endif
}
