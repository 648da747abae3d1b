// even_rows.glsl - two texels beside each other gather samples whose discs are all equally wide. The weight of a sample
// depends on its distance alone, so samples that are equally far away are added before they are weighted: those of the
// rows above and below. And samples that both texels cover wholly are added without a weight.
//
// The includer has kept_color(at), of type COLORS, row_of and kept_size.
// What two texels beside each other gather.
struct even_sums {
    COLORS of_both, first, second;
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
        COLORS on_left = kept_color(left_above), on_right = kept_color(right_above);
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

// `radius`: at least half a texel.
even_sums gather_disc(ivec2 texel, float radius)
{
    even_sums to = even_sums(COLORS(0.0), COLORS(0.0), COLORS(0.0), 0.0);
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
    return to;
}
