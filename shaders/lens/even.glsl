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

// What two texels beside each other gather.
struct even_sums {
    vec3 of_both, first, second;
    float weight; // the same of both
};

// Two rows, as far above the texels as below them, or the row of the texels themselves. `above`, `below`: the samples
// in the first texel's column; `down`: how far the rows are away, squared; `ends`: how far discs reach, and how far
// they are whole, squared. From the middle between both texels, columns x and 1 - x are alike: the first texel sees
// column x at x, and the second one column 1 - x.
void gather_rows(const bool two, int above, int below, float down, float edge, vec2 ends, inout even_sums to)
{
    const vec2 sides = sqrt(max(ends - down, 0.0));
    const float whole = floor(sides.y); // columns on each side that both cover wholly
    int left_above = above, right_above = above + 1, left_below = below, right_below = below + 1;
    const int core_end = right_above + int(whole);
    const int end = right_above + int(sides.x) + 1;
    for (; right_above < core_end; right_above++) {
        to.of_both += kept_color(left_above) + kept_color(right_above);
        left_above--;
        if (two) {
            to.of_both += kept_color(left_below) + kept_color(right_below);
            left_below--;
            right_below++;
        }
    }
    float x = whole + 1.0, near = clamp(edge - sqrt(whole * whole + down), 0.0, 1.0), sum = 2.0 * whole;
    for (; right_above < end; right_above++) {
        const float far = clamp(edge - sqrt(x * x + down), 0.0, 1.0);
        vec3 on_left = kept_color(left_above), on_right = kept_color(right_above);
        left_above--;
        if (two) {
            on_left += kept_color(left_below);
            on_right += kept_color(right_below);
            left_below--;
            right_below++;
        }
        to.first += far * on_right + near * on_left;
        to.second += near * on_right + far * on_left;
        sum += far + near;
        near = far;
        x += 1.0;
    }
    to.weight += two ? 2.0 * sum : sum;
}

// As gather_two, of texels with the mean circle of confusion `radius`.
void gather_even(ivec2 texel, float radius, out vec4 sums[2])
{
    even_sums to = even_sums(vec3(0.0), vec3(0.0), vec3(0.0), 0.0);
    int above = row_of(texel) + texel.x, below = above;
    const float edge = radius + 0.5;
    const vec2 ends = vec2(edge * edge, (radius - 0.5) * (radius - 0.5));
    gather_rows(false, above, below, 0.0, edge, ends, to);
    const float last = floor(edge);
    for (float y = 1.0; y <= last; y += 1.0) {
        above -= kept_size.x;
        below += kept_size.x;
        gather_rows(true, above, below, y * y, edge, ends, to);
    }
    sums[0] = vec4(to.of_both + to.first, to.weight);
    sums[1] = vec4(to.of_both + to.second, to.weight);
}
