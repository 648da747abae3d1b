/* test_glass_map.c - the height map against the same sums in double precision, and what film adds to it. */
#include "glass_ball_fixture.h"

enum { DENSITIES = 5 };

/* ---- the reference */

/* Over the radius of influence, as the papers print them; Goto's and Blinn's end at two radii, faded from 4/3 on. */
static double fade(double x)
{
    const double t = fmin(fmax((x * x / 4 - 4.0 / 9) * 9 / 5, 0), 1);
    return 1 - t * t * (3 - 2 * t);
}

static const double influence[DENSITIES] = {2, 2, 2.3660254037844386, 1.8477590650225735, 2};

static double density_of(int kind, double x)
{
    const double y = x / influence[kind];
    if (y >= 1)
        return 0;
    switch (kind) {
    case VIRGA_GLASS_DENSITY_GOTO: return fade(x) / (1 + pow(x, 4));
    case VIRGA_GLASS_DENSITY_BLINN: return fade(x) * exp(-log(2) * x * x);
    case VIRGA_GLASS_DENSITY_MURAKAMI: return y <= 1.0 / 3 ? 1 - 3 * y * y : 1.5 * (1 - y) * (1 - y);
    case VIRGA_GLASS_DENSITY_WYVILL: return pow(1 - y * y, 2);
    default: return 1 - 22.0 / 9 * y * y + 17.0 / 9 * pow(y, 4) - 4.0 / 9 * pow(y, 6);
    }
}

/* The x that has the density v, by bisection. */
static double inverse_of(int kind, double v)
{
    double low = 0, high = influence[kind];
    for (int i = 0; i < 60; i++) {
        const double middle = 0.5 * (low + high);
        if (density_of(kind, middle) > v)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static double window_of(int kind, double x)
{
    return fade(x * 2 / influence[kind]);
}

static double compress(const virga_glass_settings *s, double v)
{
    double from = (double)s->compress_from;
    for (uint32_t i = 0; s->compress && i < s->compress_steps; i++, from += (double)s->compress_step)
        v = v > from ? (double)s->compress_k * (v - from) + from : v;
    return v;
}

static double smooth(double low, double high, double x)
{
    const double t = fmin(fmax((x - low) / (high - low), 0), 1);
    return t * t * (3 - 2 * t);
}

/* p of the sum of densities, or of the root of that of their squares; see shaders/glass/draw/height.glsl. */
static double neck_profile(int kind, double density)
{
    const double x = density < 1 ? inverse_of(kind, density) : 0, rim = 1 - x * x, over = fmax(rim - 0.5, 0);
    const double t = fmin(fmax(2 * (density - 1), 0), 1), off = kind == VIRGA_GLASS_DENSITY_GOTO ? 1 : 0.5;
    return fmax(rim - off * (over * over - t * (2 - t) / 4), -1);
}

/* Density and height at a point, by sums of single balls. */
static void summed(const shot *s, const ball *balls, int count, double u, double v, double *density, double *height)
{
    const int kind = s->settings.density;
    double sum = 0, inverse = 0, squares = 0, outline = 0;
    for (int i = 0; i < count; i++) {
        const ball *b = &balls[i];
        const double x = (u - b->middle[0]) / b->radius, y = (v - b->middle[1]) / b->radius, r = hypot(x, y);
        const double z = b->height * fmax(1 + b->sag[0] * x + b->sag[1] * y, 0.2);
        sum += density_of(kind, r);
        outline += pow(density_of(kind, r), 2);
        inverse += density_of(kind, r) / z;
        squares += pow(z * fmax(1 - r * r, 0), 2);
    }
    *density = *height = 0;
    if (!(sum > 0))
        return;
    const double joined = sum + smooth(0.01, 0.02, sum) * (sqrt(outline) - sum);
    const double within = joined + smooth(0.5, 1, joined) * (sum - joined);
    const double neck = sum / inverse * neck_profile(kind, within), high = sqrt(squares), above = fmax(neck - high, 0);
    const double inner = high + (above > 0 ? pow(above, 3) / (above * above + 0.1 * squares) : 0);
    const double t = smooth(0.5, 0.7, joined);
    *density = compress(&s->settings, joined);
    *height = neck * (1 - t) + inner * t;
}

/* The same by Chen and Zhang's weights. */
static void weighted(const shot *s, const ball *balls, int count, double u, double v, double *density, double *height)
{
    const int kind = s->settings.density;
    double weights = 0, kv = 0, kvz = 0, around = 0;
    for (int i = 0; i < count; i++) {
        const ball *b = &balls[i];
        const double x = (u - b->middle[0]) / b->radius, y = (v - b->middle[1]) / b->radius, r = hypot(x, y);
        if (r >= influence[kind])
            continue;
        const double z = b->height * fmax(1 + b->sag[0] * x + b->sag[1] * y, 0.2);
        const double k = b->radius * (influence[kind] - r), d = density_of(kind, r);
        weights += k;
        kv += k * d;
        kvz += k * d * z;
        around += k * window_of(kind, r) / pow(1 + r * r, 2);
    }
    *density = *height = 0;
    if (!(kv > 0))
        return;
    const double sum = kv / weights, inner = 2 - 1 / sqrt(fmax(around / weights, 1e-4));
    const double x = sum < 1 ? inverse_of(kind, sum) : 0;
    const double t = smooth(0.55, 0.9, sum);
    *density = compress(&s->settings, sum);
    *height = kvz / kv * fmin(fmax((1 - x * x) * (1 - t) + inner * t, -1), 2);
}

static void reference(const shot *s, const ball *balls, int count, double u, double v, double *density, double *height)
{
    (s->settings.blend == VIRGA_GLASS_BLEND_WEIGHTED ? weighted : summed)(s, balls, count, u, v, density, height);
}

static const float *texel(const shot *s, uint32_t column, uint32_t row)
{
    return s->map + 4 * ((size_t)row * s->columns + column);
}

static double texel_u(const shot *s, uint32_t column)
{
    return (column + 0.5) * (double)s->glass->def.width_m / s->columns;
}

static double texel_v(const shot *s, uint32_t row)
{
    return (row + 0.5) * (double)s->glass->def.height_m / s->rows;
}

/* ---- the map */

static void compare_map(const shot *s, const ball *balls, int count)
{
    for (uint32_t row = 0; row < s->rows; row++)
        for (uint32_t column = 0; column < s->columns; column++) {
            double density, height;
            reference(s, balls, count, texel_u(s, column), texel_v(s, row), &density, &height);
            const float *found = texel(s, column, row);
            if (fabs((double)found[0] - density) > 1e-4 || (density > 0.45 && fabs((double)found[1] - height) > 4e-6))
                fail_msg("density %d blend %d at %u, %u: %g and %g m, expected %g and %g m", s->settings.density,
                         s->settings.blend, column, row, (double)found[0], (double)found[1], density, height);
        }
}

/* Every texel, to 1e-4 of density and 4 um of height: sums are in steps of 2^-23 of the largest. */
static void the_map_is_that_of_the_reference(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    open_small(&s);
    for (int i = 0; i < 2 * DENSITIES; i++) {
        s.settings.density = (virga_glass_density)(i / 2);
        s.settings.blend = (virga_glass_blend)(i % 2);
        s.settings.compress = i % 3 != 0;
        put_balls(&s, balls, BALLS);
        shot_draw(&s, false);
        REQUIRE(s.columns == 192 && s.rows == 128);
        compare_map(&s, balls, BALLS);
    }
    shot_close(&s);
}

/* Its height is that of the parabola, to 2 um, and its density that of the formula, 0.5 at its rim. */
static void a_drop_alone_is_a_cap(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    s.settings.compress = false;
    for (int i = 0; i < 2 * DENSITIES; i++) {
        s.settings.density = (virga_glass_density)(i / 2);
        s.settings.blend = (virga_glass_blend)(i % 2);
        shot_forget(&s);
        const ball b = ball_of(&s, shot_drop(&s, 0.048, 0.032, shot_water(&s, 8e-3)));
        shot_draw(&s, false);
        for (uint32_t column = 0; column < s.columns; column++) {
            const double x = (texel_u(&s, column) - b.middle[0]) / b.radius;
            const double y = (texel_v(&s, 60) - b.middle[1]) / b.radius, r2 = x * x + y * y;
            const float *found = texel(&s, column, 60);
            assert_float_equal(found[0], density_of(i / 2, sqrt(r2)), 2e-5);
            if (r2 < 1)
                assert_float_equal(found[1], b.height * (1 - r2) * (1 + b.sag[1] * y), 2e-6);
        }
        assert_float_equal(density_of(i / 2, 1), 0.5, 1e-9);
    }
    shot_close(&s);
}

/* Two at one position weigh one half each, so together they equal one (to 1e-5). */
static void weights_sum_to_one(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    s.settings.blend = VIRGA_GLASS_BLEND_WEIGHTED;
    shot_drop(&s, 0.05, 0.03, 20000);
    shot_draw(&s, false);
    const size_t size = 16ull * s.columns * s.rows;
    float *alone = malloc(size);
    memcpy(alone, s.map, size);
    shot_drop(&s, 0.05, 0.03, 20000);
    shot_draw(&s, false);
    for (size_t i = 0; i < size / 16; i++) {
        assert_float_equal(s.map[4 * i], alone[4 * i], 1e-5);
        assert_float_equal(s.map[4 * i + 1], alone[4 * i + 1], 1e-6);
    }
    free(alone);
    shot_close(&s);
}

/* The largest second difference of the height along the line through two drops that overlap, against that of the
 * higher of the two, which has a crease: less than an eighth for sums, and 0.55 for weights. */
static void merged_drops_have_no_crease(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    for (int i = 0; i < 2 * DENSITIES; i++) {
        s.settings.density = (virga_glass_density)(i / 2);
        s.settings.blend = (virga_glass_blend)(i % 2);
        shot_forget(&s);
        const ball a = ball_of(&s, shot_drop(&s, 0.041, 70.5 * 0.064 / 140, shot_water(&s, 10e-3)));
        const ball b = ball_of(&s, shot_drop(&s, 0.055, 70.5 * 0.064 / 140, shot_water(&s, 10e-3)));
        shot_draw(&s, false);
        double max_bend = 0, crease = 0, last[3] = {0}, plain[3] = {0};
        for (uint32_t column = 67; column < 130; column++) {
            const double u = texel_u(&s, column), xa = (u - a.middle[0]) / a.radius, xb = (u - b.middle[0]) / b.radius;
            memmove(last, last + 1, sizeof last - sizeof last[0]);
            memmove(plain, plain + 1, sizeof plain - sizeof plain[0]);
            last[2] = (double)texel(&s, column, 70)[1];
            plain[2] = a.height * fmax(1 - xa * xa, 1 - xb * xb);
            if (column < 69)
                continue;
            max_bend = fmax(max_bend, fabs(last[0] - 2 * last[1] + last[2]));
            crease = fmax(crease, fabs(plain[0] - 2 * plain[1] + plain[2]));
        }
        /* Weights end with a kink; a profile cut off at the rims' is above 1. */
        const double limit = i % 2 ? 0.55 : 0.12;
        if (max_bend > limit * crease)
            fail_msg("density %d blend %d: bends by %g m, a crease by %g m", i / 2, i % 2, max_bend, crease);
    }
    shot_close(&s);
}

/* Equal ones are one outline up to 2.33 radii apart, with Goto et al.'s density: by the sum it would be 2.63. */
static void drops_join_where_they_nearly_touch(void **state)
{
    (void)state;
    static const double apart[2] = {2.2, 2.5};
    shot s;
    open_small(&s);
    s.settings.density = VIRGA_GLASS_DENSITY_GOTO;
    for (int i = 0; i < 2; i++) {
        shot_forget(&s);
        const uint32_t nl = shot_water(&s, 10e-3);
        const double row_m = 70.5 * 0.064 / 140;
        const ball a = ball_of(&s, shot_drop(&s, 0.036, row_m, nl));
        shot_drop(&s, 0.036 + apart[i] * a.radius, row_m, nl);
        shot_draw(&s, false);
        double least = 1;
        for (uint32_t column = 0; column < s.columns; column++) {
            const double u = texel_u(&s, column) - a.middle[0];
            if (u > 0 && u < apart[i] * a.radius)
                least = fmin(least, (double)texel(&s, column, 70)[0]);
        }
        assert_int_equal(least >= 0.5, i == 0);
    }
    shot_close(&s);
}

/* The steepest slope of the water that is as near to a point, by differences of texels of which all are wet. */
static double steepest(const shot *s, double u, double v, double near_m)
{
    const double across_m[2] = {2 * 0.096 / s->columns, 2 * 0.064 / s->rows};
    double most = 0;
    for (uint32_t row = 1; row + 1 < s->rows; row++)
        for (uint32_t column = 1; column + 1 < s->columns; column++) {
            const float *left = texel(s, column - 1, row), *right = texel(s, column + 1, row);
            const float *below = texel(s, column, row - 1), *above = texel(s, column, row + 1);
            if (hypot(texel_u(s, column) - u, texel_v(s, row) - v) < near_m &&
                fminf(fminf(left[0], right[0]), fminf(below[0], above[0])) >= 0.5f)
                most = fmax(most, hypot((double)(right[1] - left[1]) / across_m[0],
                                        (double)(above[1] - below[1]) / across_m[1]));
        }
    return most;
}

/* A bead beside a drop of eight times its size, from where its middle is on the rim to where both end: the drop does
 * not raise it. The water at it is at most 1.4 times as steep as at the rim of a round cap. */
static void a_bead_beside_a_large_drop_has_no_walls(void **state)
{
    (void)state;
    const double distance[] = {12e-3, 13e-3, 14e-3, 15e-3, 17e-3, 20e-3, 23e-3};
    shot s;
    open_small(&s);
    s.settings.compress = false;
    for (int kind = 0; kind < DENSITIES; kind++) {
        s.settings.density = (virga_glass_density)kind;
        for (size_t i = 0; i < sizeof distance / sizeof distance[0]; i++) {
            const double u = 0.03 + distance[i];
            shot_forget(&s);
            const ball b = ball_of(&s, shot_drop(&s, u, 0.032, shot_water(&s, 1.5e-3)));
            shot_draw(&s, false);
            const double rim = 2 * b.height / b.radius, alone = steepest(&s, u, 0.032, 3e-3);
            shot_drop(&s, 0.03, 0.032, shot_water(&s, 12e-3));
            shot_draw(&s, false);
            const double both = steepest(&s, u, 0.032, 3e-3);
            if (both > 1.4 * rim || alone > rim)
                fail_msg("density %d, %g mm: slopes of %g, alone %g, at the rim %g", kind, 1e3 * distance[i], both,
                         alone, rim);
        }
    }
    shot_close(&s);
}

/* Slopes that the draws read are central differences of the heights, texel by texel, over the borders of tiles too. */
static void slopes_are_differences_of_heights(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    open_small(&s);
    put_balls(&s, balls, BALLS);
    shot_draw(&s, false);
    const double texel_m[2] = {0.096 / s.columns, 0.064 / s.rows};
    for (uint32_t row = 1; row + 1 < s.rows; row++)
        for (uint32_t column = 1; column + 1 < s.columns; column++) {
            const float *found = s.relief + 4 * ((size_t)row * s.columns + column);
            const double u = (double)texel(&s, column + 1, row)[1] - (double)texel(&s, column - 1, row)[1];
            const double v = (double)texel(&s, column, row + 1)[1] - (double)texel(&s, column, row - 1)[1];
            if (texel(&s, column, row)[0] < 0.5f)
                continue;
            assert_float_equal(found[1], 0.5 * u / texel_m[0], 2e-3);
            assert_float_equal(found[2], 0.5 * v / texel_m[1], 2e-3);
        }
    shot_close(&s);
}

/* A pane far away uses a part of its map. What a draw filters at the border lies beside texels that no view has
 * written: they count with a weight of 0, which makes nothing of a number alone. */
static void what_no_view_has_written_is_zero(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    VkCommandBuffer cmd;
    setenv("LVP_POISON_MEMORY", "true", 1); /* software Vulkan's memory is not zero then */
    open_small(&s);
    shot_aim(&s, (const double[3]){0.048, 0.032, 1}, (const double[3]){0.048, 0.032, 0}, 30);
    put_balls(&s, balls, BALLS);
    shot_draw(&s, false);
    const struct glass_picture *picture = &s.glass->picture;
    const VkBufferImageCopy all = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                   .imageExtent = {picture->max_columns, picture->max_rows, 1}};
    assert_true(s.columns < picture->max_columns && s.rows < picture->max_rows);
    shot_begin(&s, &cmd);
    vkCmdCopyImageToBuffer(cmd, picture->relief->image, VK_IMAGE_LAYOUT_GENERAL, s.download.buffer, 1, &all);
    shot_memory(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                VK_ACCESS_HOST_READ_BIT);
    shot_submit(&s);
    host_buffer_invalidate(&s.gpu.device, &s.download);
    const uint32_t *words = s.download.mapped;
    for (uint32_t row = 0; row < picture->max_rows; row++)
        for (uint32_t column = 0; column < picture->max_columns; column++)
            for (uint32_t i = 0; i < 4 && (row >= s.rows || column >= s.columns); i++)
                assert_int_equal(words[4 * (row * picture->max_columns + column) + i], 0);
    shot_close(&s);
}

/* ---- film */

/* Beads too small for a shape: two in a cell cover pi (w / c)^(2/3) (f^(2/3) + (1 - f)^(2/3)) of it, with the water w,
 * that of a cap with a base of 1 m radius c, and a lot f from 0.55 to 1: 1 to 2^(1/3) of what one would. To a level of
 * the map's bytes, and between cells to what lies between them. */
static void fine_film_covers_what_its_beads_do(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    for (uint32_t i = 0; i < s.glass->columns * s.glass->rows; i++)
        s.film[i] = 20;
    shot_draw(&s, false);
    const double cap = glass_cap_volume(glass_seen_deg(&s.settings)), cell = (double)s.glass->def.cell_m;
    const double one = M_PI * pow(20e-12 / cap, 2.0 / 3) / (cell * cell);
    double mean = 0, expected = 0;
    for (int i = 0; i < 1000; i++) {
        const double f = 0.55 + 0.45 * (i + 0.5) / 1000;
        expected += one * (pow(f, 2.0 / 3) + pow(1 - f, 2.0 / 3)) / 1000;
    }
    for (uint32_t i = 0; i < s.columns * s.rows; i++) {
        mean += (double)s.map[4 * i + 2] / (s.columns * s.rows);
        if ((double)s.map[4 * i + 2] < one - 1.0 / 255 || (double)s.map[4 * i + 2] > cbrt(2) * one + 1.0 / 255)
            fail_msg("texel %u: %g of it covered, expected %g to %g", i, (double)s.map[4 * i + 2], one, cbrt(2) * one);
    }
    assert_float_equal(mean, expected, 0.015 * expected); /* some 1,500 lots, in bytes */
    shot_close(&s);
}

/* One cell in five has such film, and is seen as such. A cell has 4 x 4 texels; of the inner ones each is 1/8 of a cell
 * off the middle along both sides, so 49/64 of what it shows is its own cell's. */
static void fine_film_is_seen_on_its_own_cells(void **state)
{
    (void)state;
    shot s;
    uint32_t seen[2] = {0};
    open_small(&s);
    for (uint32_t i = 0; i < s.glass->columns * s.glass->rows; i++)
        s.film[i] = virga_hash1(i) % 5 ? 0 : 20;
    shot_draw(&s, false);
    const double cap = glass_cap_volume(glass_seen_deg(&s.settings)), cell = (double)s.glass->def.cell_m;
    const double one = M_PI * pow(20e-12 / cap, 2.0 / 3) / (cell * cell), most = cbrt(2) * one + 1.0 / 255;
    assert_int_equal(s.columns, 4 * s.glass->columns);
    for (uint32_t i = 0; i < s.columns * s.rows; i++) {
        const uint32_t column = i % s.columns, row = i / s.columns, at = column / 4 + row / 4 * s.glass->columns;
        const double share = (double)s.map[4 * i + 2], low = 49.0 / 64 * (one - 1.0 / 255), high = 15.0 / 64 * most;
        if ((column + 1) / 2 % 2 == 0 || (row + 1) / 2 % 2 == 0)
            continue;
        seen[s.film[at] > 0]++;
        if (s.film[at] ? share < low || share > most : share > high)
            fail_msg("%g of texel %u is covered, film: %u", share, i, s.film[at]);
        REQUIRE(high < low);
    }
    REQUIRE(seen[0] > 3 * seen[1] && seen[1] > 100);
    shot_close(&s);
}

/* Beside a drop the height map goes on below the glass, for the drop's rim. Where a sheet of film ends there it ends on
 * the glass, and does not fall down to that. */
static void a_film_ends_on_the_glass_beside_drops(void **state)
{
    (void)state;
    shot s;
    ball balls[BALLS];
    uint32_t ends = 0;
    open_small(&s);
    put_balls(&s, balls, BALLS);
    for (uint32_t i = 0; i < s.glass->columns * s.glass->rows; i++) {
        s.film[i] = i % s.glass->columns % 6 < 3 ? 20 : 0; /* in stripes, so that many end near drops */
        s.passed[i] = s.glass->last_tick;
    }
    shot_draw(&s, false);
    for (uint32_t row = 1; row + 1 < s.rows; row++)
        for (uint32_t column = 1; column + 1 < s.columns; column++) {
            const double left = (double)texel(&s, column - 1, row)[1], right = (double)texel(&s, column + 1, row)[1];
            if (texel(&s, column, row)[3] < 2e-6f || texel(&s, column, row)[0] > 0.49f)
                continue;
            const float slope = s.relief[4 * ((size_t)row * s.columns + column) + 1];
            ends += left < -1e-5 || right < -1e-5;
            assert_float_equal(slope, 0.5 * (fmax(right, 0) - fmax(left, 0)) / (0.096 / s.columns), 2e-3);
        }
    assert_true(ends > 20);
    shot_close(&s);
}

#define THREAD_CELLS 16

/* A cell of a drop's way: ten rows straight down, then aslant. */
static uint32_t thread_cell(const shot *s, int i)
{
    const uint32_t column = 20 + (uint32_t)(i > 10 ? i - 10 : 0), row = 26 - (uint32_t)i;
    return column + row * s->glass->columns;
}

/* Where in a cell the water lies that a drop left, in cells; see shaders/glass/draw/beads.glsl. */
static void way_through(const shot *s, uint32_t number, double out[2])
{
    const double x = number % s->glass->columns, y = number / s->glass->columns;
    out[0] = x + 0.5 + 0.27 * sin(0.71 * x + 0.61 * y) + 0.11 * sin(1.63 * y - 1.13 * x);
    out[1] = y + 0.5 + 0.27 * sin(0.67 * x - 0.57 * y) + 0.11 * sin(1.27 * x + 1.51 * y);
}

/* The film of a drop on its way, so many ticks old. Draws it. Returns its water as the map has it, nl, and the least
 * density along the way. */
static double draw_thread(shot *s, uint32_t nl, uint32_t age, double *least)
{
    for (int i = 0; i < THREAD_CELLS; i++) {
        const uint32_t aslant = i >= 10, link = 5 + aslant - 3; /* down, or down and to the right */
        s->film[thread_cell(s, i)] = nl;
        s->passed[thread_cell(s, i)] = (s->glass->last_tick - age) | link << VIRGA_GLASS_LINK_BIT;
    }
    shot_draw(s, false);
    const double texel_m = 0.096 / s->columns;
    double water = 0;
    for (uint32_t i = 0; i < s->columns * s->rows; i++)
        water += s->map[4 * i] >= 0.5f ? fmax((double)s->map[4 * i + 1], 0) * texel_m * texel_m * 1e12 : 0;
    *least = 1e9;
    for (int i = 1; i + 1 < THREAD_CELLS; i++) /* it begins after the middle of the first cell */
        for (int k = 0; k < 8; k++) {
            const double share = k / 8.0;
            double from[2], to[2];
            way_through(s, thread_cell(s, i), from);
            way_through(s, thread_cell(s, i + 1), to);
            const double x = from[0] + share * (to[0] - from[0]), y = from[1] + share * (to[1] - from[1]);
            const float *at = texel(s, (uint32_t)(x * 0.002 / texel_m), (uint32_t)(y * 0.002 / texel_m));
            *least = fmin(*least, (double)at[0]);
        }
    return water;
}

/* What a running drop leaves is in one piece, with the water of its cells; it breaks where it is, and keeps it. */
static void a_drops_film_is_a_thread_until_it_breaks(void **state)
{
    (void)state;
    shot s;
    double whole, broken;
    open_small(&s);
    shot_draw(&s, false);
    s.glass->last_tick += 400; /* so that the film can be old */
    const double water = draw_thread(&s, 600, 0, &whole), later = draw_thread(&s, 600, 300, &broken);
    print_message("of %d nl the thread shows %.0f, its beads %.0f; least density %.2f, then %.2f\n", 600 * THREAD_CELLS,
                  water, later, whole, broken);
    assert_true(whole > 0.5 && broken < 0.5);
    assert_float_equal(water, 600 * THREAD_CELLS, 0.1 * 600 * THREAD_CELLS);
    assert_float_equal(later, 600 * THREAD_CELLS, 0.1 * 600 * THREAD_CELLS);
    shot_close(&s);
}

/* Pieces of water on the map, by filling them. */
static uint32_t count_pieces(const shot *s)
{
    const uint32_t size = s->columns * s->rows;
    uint8_t *seen = calloc(size, 1);
    uint32_t *stack = malloc(size * sizeof *stack), pieces = 0;
    for (uint32_t from = 0; from < size; from++) {
        uint32_t height = 0;
        if (seen[from] || s->map[4 * from] < 0.5f)
            continue;
        pieces++;
        seen[from] = 1;
        stack[height++] = from;
        while (height) {
            const uint32_t at = stack[--height];
            const uint32_t beside[4] = {at - 1, at + 1, at - s->columns, at + s->columns};
            for (int i = 0; i < 4; i++)
                if (beside[i] < size && !seen[beside[i]] && s->map[4 * beside[i]] >= 0.5f) {
                    seen[beside[i]] = 1;
                    stack[height++] = beside[i];
                }
        }
    }
    free(seen);
    free(stack);
    return pieces;
}

/* Half the width of a thread, by its cross-section: 4/3 h a^2 with the height h over its half width a. */
static double half_width(const shot *s, double nl)
{
    return sqrt(0.75 * nl * 1e-12 / (tan(glass_seen_deg(&s->settings) * M_PI / 360) * 0.002));
}

/* Thin threads break sooner than wide ones, and into more beads: 7.4 half widths apart, one or two of them in a cell of
 * 2 mm. Of two in a cell some touch the next one's. The water stays, to 10 %. Beads hardly wider than a texel, as
 * those of the thin one are, are in part mist, which the map has as cover and not as water. */
static void a_thin_thread_breaks_sooner_and_into_more_beads(void **state)
{
    (void)state;
    shot s;
    virga_glass_def def = shot_def();
    double least;
    def.max_texels = 1024;
    shot_open(&s, &def, WIDTH, HEIGHT, false);
    shot_aim(&s, (const double[3]){0.048, 0.032, 0.03}, (const double[3]){0.048, 0.032, 0}, 60);
    shot_draw(&s, false);
    s.glass->last_tick += 400;
    for (int i = 0; i < 2; i++) {
        const uint32_t nl = i ? 150 : 24, other = i ? 24 : 150;
        const double a = half_width(&s, nl), per_m = (double)s.settings.film_break_s / 3e-4 / s.glass->def.tick_s;
        const double water = draw_thread(&s, nl, 1 + (uint32_t)(1.31 * a * per_m), &least);
        const uint32_t pieces = count_pieces(&s);
        print_message("%u nl: half width %.2f mm, waves of %.2f mm: %u beads with %.0f nl, least density %.2f\n", nl,
                      1e3 * a, 7.4e3 * a, pieces, water, least);
        if (i)
            assert_float_equal(water, nl * THREAD_CELLS, 0.1 * nl * THREAD_CELLS);
        REQUIRE(least < 0.5 && (i ? pieces == THREAD_CELLS : pieces > 1.6 * THREAD_CELLS));
        REQUIRE(i ? 7.4 * a > 0.002 / 1.2 : 7.4 * a < 0.002 / 1.8);
        draw_thread(&s, other, 1 + (uint32_t)(1.31 * a * per_m), &least);
        REQUIRE(i ? least < 0.5 : least > 0.5);
    }
    shot_close(&s);
}

/* ---- passes */

/* Gather passes of a pane, all or those that are built. */
static int count_gathers(const shot *s, bool built)
{
    int count = 0;
    for (int i = 0; i < GLASS_GATHERS; i++) {
        const virga_pipeline *pass = s->glass->picture.gather_passes[i];
        count += pass && (!built || pass->pipeline);
    }
    return count;
}

static void a_view_builds_the_gathers_that_it_needs(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    REQUIRE(count_gathers(&s, false) == 3 && count_gathers(&s, true) == 0);
    put_film(&s, 20);
    shot_draw(&s, false);
    REQUIRE(count_gathers(&s, true) == 2);
    shot_close(&s);
}

/* The finest map of a pane of 192 texels has texels of 0.5 mm, one of 64 of 1.5 mm. Beads with a radius of a third of
 * its cells of 2 mm are then below half a texel. */
static void a_map_too_coarse_for_beads_has_no_gather_for_them(void **state)
{
    (void)state;
    shot s;
    virga_glass_def def = shot_def();
    def.max_texels = 64;
    shot_open(&s, &def, WIDTH, HEIGHT, false);
    shot_face(&s, 1, 30);
    put_film(&s, 20);
    shot_draw(&s, false);
    REQUIRE(!s.glass->picture.beads);
    REQUIRE(count_gathers(&s, false) == 2 && count_gathers(&s, true) == 2);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_map_is_that_of_the_reference),
        cmocka_unit_test(a_drop_alone_is_a_cap),
        cmocka_unit_test(weights_sum_to_one),
        cmocka_unit_test(merged_drops_have_no_crease),
        cmocka_unit_test(drops_join_where_they_nearly_touch),
        cmocka_unit_test(a_bead_beside_a_large_drop_has_no_walls),
        cmocka_unit_test(fine_film_covers_what_its_beads_do),
        cmocka_unit_test(fine_film_is_seen_on_its_own_cells),
        cmocka_unit_test(a_film_ends_on_the_glass_beside_drops),
        cmocka_unit_test(a_drops_film_is_a_thread_until_it_breaks),
        cmocka_unit_test(a_thin_thread_breaks_sooner_and_into_more_beads),
        cmocka_unit_test(slopes_are_differences_of_heights),
        cmocka_unit_test(what_no_view_has_written_is_zero),
        cmocka_unit_test(a_view_builds_the_gathers_that_it_needs),
        cmocka_unit_test(a_map_too_coarse_for_beads_has_no_gather_for_them),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
