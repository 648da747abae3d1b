// even.glsl - the far field of two texels where all discs in reach are behind the focus and about equally wide.
//
// A sample covers a texel by min(its radius, the texel's), see gather_far. Where no two radii around a workgroup's
// tiles are farther apart than EVEN, each is taken for the texel's own, and that for the mean of two texels beside each
// other. Then the weight of a sample depends on its distance alone, so samples that are equally far away are added
// before they are weighted: those of the rows above and below. And samples that both texels cover wholly are added
// without a weight. The weights of a texel are 1 / area all, which its sum is divided by.
//
// What that changes: the edge of a disc is where the texel's radius says, EVEN texels away at most from where its own
// says. On a plane, where radii differ by g from texel to texel, it is r g away: a hundredth of a texel on a floor that
// goes from the focus to infinity in 200 rows of texels.
//
// The includer has kept, color_of and row_of, and says after it kept its samples whether they are even.
const float EVEN = 1.0 / 16.0; // texels

shared uint least_kept, most_kept; // radii of samples, as words; 0 in front of the focus

void begin_even()
{
    least_kept = 0x7F7FFFFFu; // the largest float
    most_kept = 0u;
}

// Of all samples that a lane kept.
void note_kept(vec2 least_and_most)
{
    const uvec2 words = floatBitsToUint(max(least_and_most, 0.0));
    atomicMin(least_kept, words.x);
    atomicMax(most_kept, words.y);
}

// A texel that is little out of focus looks for the far field beside it, and not for its own (BESIDE in gather.glsl).
bool is_even()
{
    const float least = uintBitsToFloat(least_kept), most = uintBitsToFloat(most_kept);
    return least > 2.0 && most - least <= EVEN;
}

vec3 kept_color(int at) { return color_of(kept[at]); }
#define COLORS vec3
#include "even_rows.glsl"

// As gather_two, of texels with the mean circle of confusion `radius`.
void gather_even(ivec2 texel, float radius, out vec4 sums[2])
{
    const even_sums to = gather_disc(texel, radius);
    sums[0] = vec4(to.of_both + to.first, to.weight);
    sums[1] = vec4(to.of_both + to.second, to.weight);
}
