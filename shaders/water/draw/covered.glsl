// covered.glsl - how much of a pixel of the target the water's surface covers.
//
// The includer includes surface.glsl.
#include "gaps.glsl"

// x: the sum of weights where that has no gap; y: the nearest water's own sum; z: the weight of water behind it;
// w: above 0 where a part of the nearest is not there.
vec4 closed_in(ivec2 texel)
{
    const Gap gap = gap_at(texel);
    return vec4(gap.closed, gap.closed * gap.own, gap.fill, float(gap.fades));
}

vec4 closed_at(vec2 at)
{
    if (!SCALED)
        return closed_in(ivec2(at));
    const vec2 low = floor(at - 0.5), share = at - 0.5 - low;
    const ivec2 last = ivec2(look.width, look.height) - 1, one = clamp(ivec2(low), ivec2(0), last),
                two = clamp(ivec2(low) + 1, ivec2(0), last);
    return mix(mix(closed_in(one), closed_in(ivec2(two.x, one.y)), share.x),
               mix(closed_in(ivec2(one.x, two.y)), closed_in(two), share.x), share.y);
}

struct Covered {
    float surface; // the part of a pixel
    float specks;  // the sum of their weights
};

// `moved`: the sums of splat_sum.frag.
//
// Of water that fades, a part of the sum W of the nearest water's weights is missing: the share s = 1 - missing / W of
// it is there. What sums.w has beyond s W is that of water behind it, which counted by its fill.
Covered covered_at(vec2 at, vec4 sums, vec4 moved)
{
    const vec4 closed = closed_at(at);
    const bool fades = closed.w > 0.0;
    const float missing = fades ? missing_of(sums, moved) : 0.0, specks = moved.z + missing;
    const float all = sums.w + missing, slope = length(vec2(dFdx(all), dFdy(all)));
    const float weight = (fades ? closed.x : max(sums.w, closed.x)) + specks;
    float surface = coverage_of(weight, slope, sums.z / max(sums.w, 1e-12));
    if (fades) {
        const float behind = clamp((all - closed.y) / max(closed.z, 1e-3), 0.0, 1.0);
        surface *= clamp(1.0 - missing / max(closed.y, 1e-12), 0.0, 1.0);
        surface += (1.0 - surface) * behind;
    }
    return Covered(sums.w > 1e-4 ? surface : 0.0, specks);
}
