// paper_slopes.glsl - the water at a pixel in the paper's style: from densities alone, whose slopes are differences
// between neighbours. Include it after surface.glsl.
#include "paper_texel.glsl"

// With textureGather: on software Vulkan four of these cost half of twelve fetches.
layout(set = 0, binding = 27) uniform usampler2D paper_map;

vec4 densities_of(uvec4 words)
{
    return vec4(density_of(words.x), density_of(words.y), density_of(words.z), density_of(words.w));
}

float interpolate(vec4 four, vec2 t) { return mix(mix(four.x, four.y, t.x), mix(four.z, four.w, t.x), t.y); }

// Slope per texel between the second and third of four neighbours. At the map's border the first may be the second
// itself, and the last (its texel is not read then) the third.
float slope_between(vec4 densities, bool has_first, bool has_last, float t)
{
    const float last = has_last ? densities.w : densities.z;
    return mix((densities.z - densities.x) * (has_first ? 0.5 : 1.0), (last - densities.y) * (has_last ? 0.5 : 1.0), t);
}

// From 4 x 4 texels; the pixel is between the four in their middle. Nothing is shown where there is no glass.
Water water_by_density()
{
    const vec2 texels = texels_here(), low = min(floor(texels), last_texel() - 1.0), t = texels - low;
    const vec2 one = 1.0 / vec2(textureSize(paper_map, 0)), at = low * one;
    const uvec4 lower_left = textureGather(paper_map, at);
    const uvec4 lower_right = textureGather(paper_map, at + vec2(2.0 * one.x, 0.0));
    const uvec4 upper_left = textureGather(paper_map, at + vec2(0.0, 2.0 * one.y));
    const uvec4 upper_right = textureGather(paper_map, at + 2.0 * one);
    const uvec4 four = uvec4(lower_left.y, lower_right.x, upper_left.z, upper_right.w);
    const vec4 glass = vec4(lessThan(four, uvec4(0x80000000u)));
    const vec4 lower = densities_of(uvec4(lower_left.xy, lower_right.xy));
    const vec4 upper = densities_of(uvec4(upper_left.wz, upper_right.wz));
    const vec4 left = densities_of(uvec4(lower_left.zy, upper_left.zy));
    const vec4 right = densities_of(uvec4(lower_right.wx, upper_right.wx));
    const bvec2 has_first = greaterThan(low, vec2(0.0)), has_last = lessThan(low + 1.0, last_texel());
    Water water;
    water.cover = cover_of(interpolate(vec4(lower.yz, upper.yz) * glass, t));
    water.mist = (1.0 - water.cover) * interpolate(vec4(four & 0xffu) * glass, t) / 255.0;
    water.slope = vec2(slope_between(mix(lower, upper, t.y), has_first.x, has_last.x, t.x),
                       slope_between(mix(left, right, t.x), has_first.y, has_last.y, t.y)) /
                  map_grid.xy;
    water.height = water.bend = 0.0;
    return water;
}
