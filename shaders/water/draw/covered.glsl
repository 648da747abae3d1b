// covered.glsl - how much of a pixel of the target the water's surface covers.
//
// The includer includes surface.glsl.
#include "gaps.glsl"

float closed_at(vec2 at)
{
    if (!SCALED)
        return gap_at(ivec2(at)).closed;
    const vec2 low = floor(at - 0.5), share = at - 0.5 - low;
    const ivec2 last = ivec2(look.width, look.height) - 1, one = clamp(ivec2(low), ivec2(0), last),
                two = clamp(ivec2(low) + 1, ivec2(0), last);
    return mix(mix(gap_at(one).closed, gap_at(ivec2(two.x, one.y)).closed, share.x),
               mix(gap_at(ivec2(one.x, two.y)).closed, gap_at(two).closed, share.x), share.y);
}

// `specks`: the sum of their weights.
float covered_at(vec2 at, vec4 sums, float specks)
{
    const float slope = length(vec2(dFdx(sums.w), dFdy(sums.w)));
    return sums.w > 1e-4 ? coverage_of(max(sums.w, closed_at(at)) + specks, slope, sums.z / sums.w) : 0.0;
}
