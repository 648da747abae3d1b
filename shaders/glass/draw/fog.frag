// fog.frag - condensation: droplets of fog scatter what is behind them. Premultiplied.
//
// Droplets cover the share c of the glass. Light that meets them is refracted: over a cap the inclination is evenly
// distributed over a disc, up to the contact angle t, so they show the mean of a disc with the angular radius (n - 1)
// t. The rest passes between them as through a mask of holes. By Babinet's principle its undisturbed part has the
// amplitude 1 - c, so the intensity (1 - c)^2, and c (1 - c) is diffracted as by single discs of a droplet's radius r:
// a corona, which is seen around lamps. The sum is 1. Airy's disc of the wavelength l is close to a normal distribution
// with the standard deviation 0.21 l / r in angle; red spreads more than blue.
//
// A surface that is not glass is seen through the share c without its gloss, as under water (without_gloss), and
// droplets reflect light of all directions to the eye instead: dew makes paint and leaves matt, and darker or lighter
// by what they mirrored. Nothing is diffracted: light that has passed between droplets is scattered by the surface
// anyway.
//
// Droplets smaller than pixels are seen as grain: the number N on an area varies. That of independent ones varies by
// sqrt(N); droplets that merge keep their distance, so GRAIN of that. Larger ones are seen as drops, with the same
// cover. One invocation per pixel of a block with fog. Reads: the fog map, the plate and its copies. Writes: radiance.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#define HAS_LAMPS (view.light_count != 0u)
#include "sky.glsl"
#include "gpu/light.glsl"
#include "surface.glsl"
#include "plate.glsl"
#include "path.glsl"
#include "water_light.glsl"
#include "gpu/encode.glsl"

layout(set = 0, binding = 32) uniform sampler2D fog_map;

layout(location = 14) flat in vec4 mist_grid;
layout(location = 0) out vec4 radiance;

#define PI 3.14159265
#define HAS_DROPLETS ((DRAW_MODE & VIRGA_GLASS_DRAW_DROPLETS) != 0u)
#define IS_OPAQUE (SIDE == VIRGA_GLASS_DRAW_OPAQUE)
#define THROUGH 0.95 // of the light passes a droplet's two faces; one face twice on a surface that is not glass
#define TAPS 6
#define TURN 2.39996323                  // rad, the golden angle
#define WAVES vec3(0.61, 0.55, 0.46)     // micrometres: red, green, blue
#define GRAIN 0.6
#define MAX_GRAIN 0.6                    // of the cover
#define SINGLE vec2(0.7, 1.4)            // radius in pixels: smaller droplets are grain, larger ones drops
#define RAGGED 0.35                      // cells: how far the border of wiped fog is off the cells' own
#define SMALLEST_M 1e-5                  // side of the finest grid of droplets and of grain

float hash_at(ivec2 cell, uint salt)
{
    return virga_unit(virga_hash1(uint(cell.x) * 0x9e3779b9u + uint(cell.y) * 0x85ebca6bu + salt));
}

// Noise with the mean 0 and the standard deviation 1, fixed on the pane.
float noise_at(vec2 at, uint salt)
{
    const vec2 low = floor(at), t = smoothstep(0.0, 1.0, at - low);
    const ivec2 cell = ivec2(low);
    const float bottom = mix(hash_at(cell, salt), hash_at(cell + ivec2(1, 0), salt), t.x);
    const float top = mix(hash_at(cell + ivec2(0, 1), salt), hash_at(cell + ivec2(1, 1), salt), t.x);
    return (mix(bottom, top, t.y) - 0.5) * 5.0; // 1 / sqrt(12), less what the mixing takes
}

// Cover and radius (m) of the fog at a point.
vec2 fog_at(vec2 at)
{
    const float side = look.pane.cell_m;
    const vec2 shift = vec2(noise_at(at / (0.45 * side), 0x667578u), noise_at(at / (0.45 * side), 0x667579u));
    const vec2 last = (mist_grid.xy - 0.5) / vec2(textureSize(fog_map, 0));
    const vec2 uv = clamp((at + RAGGED * 0.5 * side * shift) * mist_grid.zw, vec2(0.0), last);
    const vec2 found = textureLod(fog_map, uv, 0.0).rg;
    return vec2(found.r, found.g * 1e-6 / max(found.r, 1e-4));
}

// The cover as it is on a pixel: more or less by the droplets' number there.
float with_grain(float cover, float radius, float pixel_m)
{
    const float level = max(log2(pixel_m / SMALLEST_M), 0.0), low = floor(level);
    const float side = SMALLEST_M * exp2(low);
    const float fine = noise_at(pane_position / side, 0x677261u);
    const float coarse = noise_at(pane_position / (2.0 * side), 0x677262u);
    const float number = cover * pixel_m * pixel_m / (PI * radius * radius);
    const float varies = min(GRAIN * inversesqrt(max(number, 1e-3)), MAX_GRAIN);
    return clamp(cover * (1.0 + varies * mix(fine, coarse, level - low) * 0.8), 0.0, 0.95);
}

// What is behind, spread by a normal distribution with this standard deviation. Points of the pane turn the samples
// in different ways, so lamps show as sparkling grain and not as images of the pattern.
vec3 corona_here(float radius_px, float turn)
{
    if (tint_given.w == 0.0)
        return environment(normalize(position), vec2(1.0));
    const float copied = max(max(plate_size().x, plate_size().y) / float(VIRGA_GLASS_COPY), 1.0);
    const int level = clamp(int(log2(max(radius_px / copied, 1.0)) + 0.5), 0, VIRGA_GLASS_COPY_LEVELS - 1);
    // The weights turn the distribution of green into those of red and blue.
    const vec3 wide2 = WAVES * WAVES / (WAVES.g * WAVES.g);
    vec3 sum = vec3(0.0), weights = vec3(0.0);
    for (int i = 0; i < TAPS; i++) {
        const float angle = TURN * float(i) + turn, rho2 = -2.0 * log(1.0 - (float(i) + 0.5) / float(TAPS));
        const vec3 weight = exp(0.5 * rho2 * (1.0 - 1.0 / wide2)) / wide2;
        const vec2 from = gl_FragCoord.xy + radius_px * sqrt(rho2) * vec2(cos(angle), sin(angle));
        sum += weight * copy_at(nearest_in(from) / plate_size(), level);
        weights += weight;
    }
    // A narrow one is less wide than a texel of the largest copy.
    const vec3 sharp = host_color(textureLod(scene_color, gl_FragCoord.xy / plate_size(), 0.0).rgb, uint(tint_given.w));
    return mix(sharp, sum / weights, clamp(2.0 * radius_px / copied, 0.0, 1.0));
}

// Fog of droplets that are too small to be seen, over what is behind.
vec4 scattered(float cover, float radius, float turn)
{
    if (IS_OPAQUE) {
        const vec3 d = normalize(position);
        const vec3 under = without_gloss(scene_light(true, gl_FragCoord.xy, d, 1.0), d, cross(along_u, along_v));
        return vec4(cover * (mist_light + THROUGH * tint_given.rgb * under), cover);
    }
    const float spread = 0.21 * WAVES.g * 1e-6 / max(radius, 1e-6);
    const vec3 corona = corona_here(min(spread, 0.1) / max(gain_angle.y, 1e-6), turn);
    const vec3 light = cover * mist_light + cover * (1.0 - cover) * tint_given.rgb * corona;
    return vec4(light, cover * (2.0 - cover));
}

// A random angle for each square of the pane that is about as large as a pixel.
float turn_here(float pixel_m)
{
    const float side = SMALLEST_M * exp2(floor(max(log2(pixel_m / SMALLEST_M), 0.0)));
    return 2.0 * PI * hash_at(ivec2(floor(pane_position / side)), 0x747572u);
}

// ---- droplets that are seen

struct Seen {
    vec2 way;    // from its middle, in radii
    float cover; // of the pixel
    float radius;
};

// The droplet of a grid with this side that covers the point best. Each square of it has one, of a random size.
void find_droplet(float side, float cover, float pixel_m, uint salt, inout Seen seen)
{
    const vec2 at = pane_position / side;
    const ivec2 middle = ivec2(floor(at));
    for (int i = 0; i < 9; i++) {
        const ivec2 cell = middle + ivec2(i % 3 - 1, i / 3 - 1);
        const uint random = virga_hash4(look.pane.seed, salt, uint(cell.x), uint(cell.y));
        const vec2 shift = vec2(virga_unit(virga_hash2(random, 1u)), virga_unit(virga_hash2(random, 2u))) - 0.5;
        const float size = 0.7 + 0.6 * virga_unit(random); // its square has a mean of 1.03
        const float radius = side * sqrt(cover / (1.03 * PI)) * size;
        const vec2 offset = (at - vec2(cell) - 0.5 - 0.6 * shift) * side;
        const float covers = clamp((radius - length(offset)) / pixel_m + 0.5, 0.0, 1.0);
        if (covers > seen.cover)
            seen = Seen(offset / radius, covers, radius);
    }
}

// Droplets on two grids, of which the coarser takes over as they grow.
Seen droplet_here(float cover, float radius, float pixel_m)
{
    const float level = max(log2(radius * sqrt(PI / cover) / SMALLEST_M), 0.0), low = floor(level);
    const float side = SMALLEST_M * exp2(low), share = smoothstep(0.0, 1.0, level - low);
    Seen seen = Seen(vec2(0.0), 0.0, 1.0);
    find_droplet(side, cover * (1.0 - share), pixel_m, 0x666f31u + uint(low), seen);
    find_droplet(2.0 * side, cover * share, pixel_m, 0x666f31u + uint(low) + 1u, seen);
    return seen;
}

vec4 droplet_light(Seen seen, float pixel_m)
{
    const vec3 d = normalize(position), flat_normal = cross(along_u, along_v);
    const float steepest = sin(2.0 * atan(look.fog_cap_height)), x = min(length(seen.way), 0.999);
    const vec2 way = seen.way * (x / max(length(seen.way), 1e-4));
    const vec2 leans = way * steepest;
    const float up = sqrt(max(1.0 - dot(leans, leans), 1e-3));
    const vec3 normal = normalize(up * flat_normal + leans.x * along_u + leans.y * along_v);
    const float height = look.fog_cap_height * seen.radius * (1.0 - x * x); // of a flat cap
    const Water water = Water(1.0, 0.0, height, 1.0, -leans / up, LENS.y);
    if (IS_OPAQUE)
        return vec4(water_light(path_through(d, water, pixel_m, true), d, water), 1.0) * seen.cover;
    const float pixels = 1.0 + (WATER - 1.0) * steepest / seen.radius * pixel_m / max(gain_angle.y, 1e-6);
    return vec4(water_light(path_by_normal(d, normal, pixels), d, water), 1.0) * seen.cover;
}

void main()
{
    const float pixel_m = max(max(length(dFdx(pane_position)), length(dFdy(pane_position))), 1e-7);
    const vec2 fog = fog_at(pane_position);
    if (fog.x <= 1e-3 || is_behind_scene())
        discard;
    if (IS_OPAQUE && dot(position, cross(along_u, along_v)) > 0.0)
        discard; // the back of a surface that is not glass
    const float single = HAS_DROPLETS ? smoothstep(SINGLE.x, SINGLE.y, fog.y / pixel_m) : 0.0;
    vec4 shown = vec4(0.0);
    if (single < 1.0)
        shown = (1.0 - single) * scattered(with_grain(fog.x, fog.y, pixel_m), fog.y, turn_here(pixel_m));
    if (HAS_DROPLETS && single > 0.0) {
        const Seen seen = droplet_here(fog.x, fog.y, pixel_m);
        if (seen.cover > 0.0)
            shown += single * droplet_light(seen, pixel_m);
    }
    radiance = for_target(shown);
}
