// volume.comp - adds each particle's water to the pyramid of thickness.
//
// A particle's volume is spread over 3 x 3 texels by a quadratic B-spline, whose values add up to 1. The thickness that
// it adds is its volume over the area of the texel at its distance, at right angles to the ray.
//
// One invocation per sorted particle. Reads: grid, sorted. Writes: pyramid, prepared.levels.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/texels.glsl"
#include "water/packed_share.glsl"
#include "pyramid.glsl"
#include "prepared.glsl"
#include "shared/particle_grid.h"
layout(scalar, set = 0, binding = 9) readonly buffer Grid { virga_particle_grid_gpu grid; };
TEXELS(sorted_texel, 12, 11)

layout(local_size_x = VIRGA_WATER_LANES) in;

#define MIN_TEXEL 0.8 // of a particle's spacing: with smaller texels single particles would show

vec3 weights(float x) { return vec3(0.5 * (0.5 - x) * (0.5 - x), 0.75 - x * x, 0.5 * (0.5 + x) * (0.5 + x)); }

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= grid.sorted)
        return;
    const vec4 particle = uintBitsToFloat(sorted_texel(index));
    const vec3 p = particle.xyz + to_vec(view.origin_offset);
    const vec4 clip = project(to_mat(view.clip_from_rel), p);
    if (!(clip.w > max(NEAR_W, 0.5 * look.spacing_m)))
        return;
    const float pixel_m = look.pixel_angle * clip.w, wanted = MIN_TEXEL * look.spacing_m / pixel_m;
    const uint level = uint(clamp(ceil(log2(wanted / float(VIRGA_WATER_VOLUME_PX))), 0.0,
                                  float(VIRGA_WATER_VOLUME_LEVELS - 1)));
    const float texel_px = float(VIRGA_WATER_VOLUME_PX << level), texel_m = texel_px * pixel_m;
    const vec2 at = (0.5 * clip.xy / clip.w + 0.5) * vec2(look.width, look.height) / texel_px;
    const uvec2 size = level_size(level);
    if (any(lessThan(at, vec2(-1.5))) || any(greaterThan(at, vec2(size) + 1.5)))
        return;
    const ivec2 middle = ivec2(floor(at));
    const vec3 x = weights(at.x - float(middle.x) - 0.5), y = weights(at.y - float(middle.y) - 0.5);
    const float added = VIRGA_WATER_VOLUME_UNITS * counted_share(particle.w) * look.volume_m3 * length(p) /
                        (clip.w * texel_m * texel_m);
    for (int i = 0; i < 9; i++) {
        const ivec2 texel = middle + ivec2(i % 3 - 1, i / 3 - 1);
        const uint units = uint(min(added * x[i % 3] * y[i / 3] + 0.5, 1e9));
        if (units != 0u && all(greaterThanEqual(texel, ivec2(0))) && all(lessThan(texel, ivec2(size))))
            atomicAdd(pyramid[look.volume_first[level] + uint(texel.y) * size.x + uint(texel.x)], units);
    }
    if ((prepared.levels & 1u << level) == 0u)
        atomicOr(prepared.levels, 1u << level);
}
