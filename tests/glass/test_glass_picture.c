/* test_glass_picture.c - the height map against the same sums in double precision, what a drop does to light in
 * closed form, and
 * what is drawn where. */
#include "glass_picture_fixture.h"

#define PLACES 60
#define WATER  1.333

enum { WIDTH = 240, HEIGHT = 160, DENSITIES = 5 };

/* ---- the reference */

typedef struct ball {
    double middle[2], radius, height, sag[2];
} ball;

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

/* Density and height at a place; see picture_gather.glsl. */
static void reference(const shot *s, const ball *balls, int count, double u, double v, double *density, double *height)
{
    const int kind = s->settings.density;
    const bool weighted = s->settings.blend == VIRGA_GLASS_BLEND_WEIGHTED;
    double own = 0, weights = 0, kv = 0, kvz = 0, around = 0;
    for (int i = 0; i < count; i++) {
        const ball *b = &balls[i];
        const double x = (u - b->middle[0]) / b->radius, y = (v - b->middle[1]) / b->radius, r = hypot(x, y);
        if (r >= influence[kind])
            continue;
        const double z = b->height * fmax(1 + b->sag[0] * x + b->sag[1] * y, 0.2);
        const double k = weighted ? b->radius * (influence[kind] - r) : z, d = density_of(kind, r);
        own += d;
        weights += k;
        kv += k * d;
        kvz += k * d * z;
        around += k * window_of(kind, r) / pow(1 + r * r, 2);
    }
    *density = *height = 0;
    if (!(kv > 0))
        return;
    const double sum = weighted ? kv / weights : own, mean = kvz / kv;
    const double inner = 2 - 1 / sqrt(fmax(weighted ? around / weights : around / mean, 1e-4));
    const double x = sum < 1 ? inverse_of(kind, sum) : 0;
    const double t = smooth(0.55, 0.9, sum);
    *density = compress(&s->settings, sum);
    *height = mean * fmin(fmax((1 - x * x) * (1 - t) + inner * t, -1), 2);
}

/* A drop at rest, as the pane has it: upright, so that it sags downwards. */
static ball ball_of(const shot *s, const virga_glass_drop_gpu *drop)
{
    const double angle = glass_rest_deg(&s->settings), flat = tan(angle * M_PI / 360);
    ball b = {.middle = {(double)drop->position[0], (double)drop->position[1]}};
    b.radius = cbrt(drop->water_nl * 1e-12 / glass_cap_volume(angle));
    b.height = b.radius * flat;
    b.sag[1] = -fmin(998.2 * 9.80665 * b.radius * b.radius / (8 * 0.0728 * flat), 0.6);
    return b;
}

static double random_in(uint32_t *state, double low, double high)
{
    *state = virga_hash1(*state);
    return low + (high - low) * (double)virga_unit(*state);
}

static void put_balls(shot *s, ball balls[PLACES], int count)
{
    uint32_t random = 5;
    shot_forget(s);
    for (int i = 0; i < count; i++)
        balls[i] = ball_of(s, shot_drop(s, random_in(&random, 0, 0.096), random_in(&random, 0, 0.064),
                                        shot_water(s, random_in(&random, 1e-3, 4e-3))));
}

static void open_small(shot *s)
{
    shot_open(s, NULL, WIDTH, HEIGHT, false);
    shot_face(s, 1, 30);
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

/* ---- lists of tiles */

/* Copies of what the newest frame left of tiles' lists; they stay until the fixture's next. */
static const virga_glass_tile_gpu *read_lists(shot *s, host_buffer *down, const uint32_t **entries)
{
    const struct glass_picture *picture = s->glass->picture;
    VkCommandBuffer cmd;
    VkDeviceSize offset = 0;
    REQUIRE(host_buffer_create(&s->gpu.device, picture->tiles->size + picture->entries->size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "lists down", down, s->gpu.error,
                               sizeof s->gpu.error));
    shot_begin(s, &cmd);
    effect_fixture_transfers(cmd);
    const virga_glass_tile_gpu *tiles =
        effect_fixture_copy(cmd, picture->tiles->buffer, picture->tiles->size, down, &offset);
    *entries = effect_fixture_copy(cmd, picture->entries->buffer, picture->entries->size, down, &offset);
    shot_submit(s);
    host_buffer_invalidate(&s->gpu.device, down);
    return tiles;
}

static bool reaches(const virga_glass_ball_gpu *ball, const uint32_t tile[2])
{
    for (int axis = 0; axis < 2; axis++)
        if (tile[axis] - (ball->tiles[axis] & 0xffff) >= ball->tiles[axis] >> 16)
            return false;
    return true;
}

/* Each ball, one to a drop at rest, once in the list of each tile that it says to reach: one entry more would be
 * another tile's, one less an older frame's. Some lie over the edge. */
static void lists_hold_the_balls_that_were_counted(void **state)
{
    (void)state;
    shot s;
    ball balls[PLACES];
    host_buffer down = {0};
    const uint32_t *entries;
    open_small(&s);
    put_balls(&s, balls, PLACES);
    shot_drop(&s, 0, 0.064, shot_water(&s, 3e-3));
    shot_drop(&s, 0.096, 0, shot_water(&s, 2e-4));
    shot_draw(&s, false);
    const virga_glass_tile_gpu *tiles = read_lists(&s, &down, &entries);
    const uint32_t columns = s.columns / VIRGA_GLASS_TILE, rows = s.rows / VIRGA_GLASS_TILE;
    uint32_t all = 0;
    for (uint32_t i = 0; i < columns * rows; i++) {
        const uint32_t at[2] = {i % columns, i / columns};
        uint32_t reached = 0;
        assert_int_equal(tiles[i].filled, tiles[i].count);
        for (uint32_t k = 0; k < s.drop_count; k++) {
            uint32_t times = 0;
            for (uint32_t j = 0; j < tiles[i].count; j++)
                times += entries[tiles[i].first + j] == k;
            assert_int_equal(times, reaches(&s.balls[k], at));
            reached += times;
        }
        assert_int_equal(reached, tiles[i].count);
        all += reached;
    }
    assert_true(all > 4 * PLACES);
    host_buffer_destroy(&s.gpu.device, &down);
    shot_close(&s);
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
    ball balls[PLACES];
    open_small(&s);
    for (int i = 0; i < 2 * DENSITIES; i++) {
        s.settings.density = (virga_glass_density)(i / 2);
        s.settings.blend = (virga_glass_blend)(i % 2);
        s.settings.compress = i % 3 != 0;
        put_balls(&s, balls, PLACES);
        shot_draw(&s, false);
        REQUIRE(s.columns == 192 && s.rows == 128);
        compare_map(&s, balls, PLACES);
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

/* Two in one place weigh one half each, so together they are as one (to 1e-5). */
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
 * higher of the
 * two, which has a crease: less than an eighth for sums, and 0.55 for weights. */
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
        double worst = 0, crease = 0, last[3] = {0}, plain[3] = {0};
        for (uint32_t column = 67; column < 130; column++) {
            const double u = texel_u(&s, column), xa = (u - a.middle[0]) / a.radius, xb = (u - b.middle[0]) / b.radius;
            memmove(last, last + 1, sizeof last - sizeof last[0]);
            memmove(plain, plain + 1, sizeof plain - sizeof plain[0]);
            last[2] = (double)texel(&s, column, 70)[1];
            plain[2] = a.height * fmax(1 - xa * xa, 1 - xb * xb);
            if (column < 69)
                continue;
            worst = fmax(worst, fabs(last[0] - 2 * last[1] + last[2]));
            crease = fmax(crease, fabs(plain[0] - 2 * plain[1] + plain[2]));
        }

        const double limit =
            i % 2 ? 0.55 : 0.12; /* weights end with a kink; a profile cut off at the rims' is above 1 */
        if (worst > limit * crease)
            fail_msg("density %d blend %d: bends by %g m, a crease by %g m", i / 2, i % 2, worst, crease);
    }
    shot_close(&s);
}

/* ---- balls */

/* Each ball's share of the water of a drop with this radius, and how far it is from (0.05, 0.03); the heaviest. */
static uint32_t water_of_balls(const shot *s, double radius, double share[4], double apart[4])
{
    uint32_t heaviest = 0;
    for (uint32_t k = 0; k < s->ball_count; k++) {
        share[k] = pow((double)s->balls[k].radius_m / radius, 3);
        apart[k] = hypot((double)s->balls[k].middle[0] - 0.05, (double)s->balls[k].middle[1] - 0.03);
        heaviest = share[k] > share[heaviest] ? k : heaviest;
    }
    return heaviest;
}

/* What has just landed is a main ball and three around it, which come nearer as (1 - t)^2 and are gone at t = 1, after
 * impact_s; all are caps, so water goes with the cube of the radius: its sum is the drop's, and theirs 0.27 (1 - t)^2
 * of it (to 1e-5) all the time. No two of them have as much, or are as far. */
static void sub_balls_flow_into_their_drop_and_keep_its_water(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    s.settings.impact_s = 0.4f;
    for (int i = 0; i <= 10; i++) {
        const double t = 0.1 * i, left = (1 - t) * (1 - t);
        shot_forget(&s);
        virga_glass_drop_gpu *drop = shot_drop(&s, 0.05, 0.03, shot_water(&s, 6e-3));
        drop->age_s = s.settings.impact_s * (float)t;
        const ball whole = ball_of(&s, drop);
        shot_draw(&s, false);
        REQUIRE(s.ball_count == (i < 10 ? 4 : 1));
        double share[4], apart[4];
        const uint32_t heaviest = water_of_balls(&s, whole.radius, share, apart);
        assert_float_equal(share[heaviest], 1 - 0.27 * left, 1e-5);
        assert_float_equal(apart[heaviest], 0, 1e-7);
        double others = 0;
        for (uint32_t k = 0; k < s.ball_count; k++) {
            if (k == heaviest)
                continue;
            others += share[k];
            REQUIRE(apart[k] > 0.84 * left * whole.radius && apart[k] < 1.46 * left * whole.radius);
            for (uint32_t other = 0; other < k; other++)
                REQUIRE(fabs(share[k] - share[other]) > 1e-3 * left && fabs(apart[k] - apart[other]) > 1e-3 * apart[k]);
        }
        assert_float_equal(others, i < 10 ? 0.27 * left : 0, 1e-5);
    }
    shot_close(&s);
}

/* Where all lists do not fit, those with more than an equal share are left out whole, and counted; the others show all:
 * here one wide drop over every tile, and as many small ones as are too much over the middle. */
static void tiles_without_room_are_counted_and_empty(void **state)
{
    (void)state;
    enum { MANY = 240 };
    static float alone[WIDTH * HEIGHT * 4];
    shot s;
    virga_glass_def def = shot_def();
    def.max_drops = 256;
    shot_open(&s, &def, WIDTH, HEIGHT, false);
    shot_face(&s, 1, 30);
    shot_drop(&s, 0.048, 0.032, shot_water(&s, 0.06));
    shot_draw(&s, false);
    assert_int_equal(s.cut_count, 0);
    REQUIRE(s.columns * s.rows <= WIDTH * HEIGHT);
    for (uint32_t i = 0; i < s.columns * s.rows; i++)
        alone[i] = s.map[4 * i];
    for (int i = 0; i < MANY; i++)
        shot_drop(&s, 0.048, 0.032, shot_water(&s, 0.008));
    shot_draw(&s, false);
    assert_int_equal(s.ball_count, MANY + 1);
    assert_true(s.cut_count >= MANY + 1 && s.cut_count % (MANY + 1) == 0);
    uint32_t shown = 0, empty = 0;
    for (uint32_t i = 0; i < s.columns * s.rows; i++) {
        const bool cut = s.map[4 * i] == 0;
        empty += cut;
        shown += !cut;
        if (!cut && s.map[4 * i] != alone[i])
            fail_msg("texel %u: density %g, expected 0 or %g", i, (double)s.map[4 * i], (double)alone[i]);
    }
    assert_int_equal(empty * (MANY + 1), s.cut_count * VIRGA_GLASS_TILE * VIRGA_GLASS_TILE);
    assert_true(shown > 0);
    shot_step(&s, 1); /* which takes the counts of completed frames in */
    virga_glass_stats stats;
    virga_glass_stats_get(s.glass, &stats);
    assert_int_equal(stats.balls, MANY + 1);
    assert_int_equal(stats.balls_cut, s.cut_count);
    shot_close(&s);
}

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
    const double cap = glass_cap_volume(glass_rest_deg(&s.settings)), cell = (double)s.glass->def.cell_m;
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

/* Beside a drop the height map goes on below the glass, for the drop's rim. Where a sheet of film ends there it ends on
 * the glass, and does not fall down to that. */
static void a_film_ends_on_the_glass_beside_drops(void **state)
{
    (void)state;
    shot s;
    ball balls[PLACES];
    uint32_t ends = 0;
    open_small(&s);
    put_balls(&s, balls, PLACES);
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

/* Slopes that the draws read are central differences of the heights, texel by texel, over the borders of tiles too. */
static void slopes_are_differences_of_heights(void **state)
{
    (void)state;
    shot s;
    ball balls[PLACES];
    open_small(&s);
    put_balls(&s, balls, PLACES);
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

/* ---- light */

static bool refract_ray(const double d[3], const double n[3], double ratio, double out[3])
{
    const double c = -(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]), k = 1 - ratio * ratio * (1 - c * c);
    for (int i = 0; i < 3; i++)
        out[i] = ratio * d[i] + (ratio * c - sqrt(fmax(k, 0))) * n[i];
    return k >= 0;
}

/* Where a ray from the camera through a pixel leaves the pane to, through one cap, as tangents; false: thrown back. */
static bool leaves(const double tangent[2], double side, const double slope[2], double out[2])
{
    const double length = sqrt(1 + tangent[0] * tangent[0] + tangent[1] * tangent[1]);
    const double d[3] = {tangent[0] / length, tangent[1] / length, -side / length};
    const double n = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
    const double normal[3] = {-slope[0] / n, -slope[1] / n, 1 / n}, flat[3] = {0, 0, side};
    const double facing[3] = {side * normal[0], side * normal[1], side * normal[2]};
    double in_water[3], e[3];
    refract_ray(d, side > 0 ? facing : flat, 1 / WATER, in_water);
    const bool passes = refract_ray(in_water, side > 0 ? flat : facing, WATER, e);
    for (int i = 0; i < 2; i++)
        out[i] = e[i] / fabs(e[2]);
    return passes;
}

/* From both sides, straight on: to 4 % of the way and a pixel within 0.85 radii, where the map's texels show the
 * slope. Where the
 * closed form is thrown back (a coated pane, seen from behind), so is the ray. */
static void compare_refraction(shot *s, double side, const ball *b, int *passed, int *thrown_back)
{
    shot_face(s, side, 30);
    const float *pixels = shot_draw(s, true);
    const double f = 0.5 * HEIGHT / tan(15 * M_PI / 180), away = fabs(s->camera.position_m[2]);
    for (int y = 0; y < HEIGHT; y += 2)
        for (int x = 0; x < WIDTH; x += 2) {
            const double right = (x + 0.5 - 0.5 * WIDTH) / f, up = -(y + 0.5 - 0.5 * HEIGHT) / f;
            const double tangent[2] = {right * side, up}; /* along u and v */
            const double p = (0.048 + tangent[0] * away - b->middle[0]) / b->radius;
            const double q = (0.032 + tangent[1] * away - b->middle[1]) / b->radius, r2 = p * p + q * q;
            const float *found = pixels + 4 * (y * WIDTH + x);
            if (r2 > 1.5)
                assert_float_equal(found[3], 0, 0);
            if (r2 > 0.72)
                continue;
            const double sag = 1 + b->sag[1] * q, steep = b->height / b->radius;
            const double slope[2] = {-2 * p * sag * steep, (-2 * q * sag + (1 - r2) * b->sag[1]) * steep};
            double out[2];
            if (!leaves(tangent, side, slope, out)) {
                if (hypot(slope[0], slope[1]) > 1.3)
                    assert_float_equal(hypot((double)found[0], (double)found[1]), 0, 0);
                *thrown_back += 1;
                continue;
            }
            const double way[2] = {(out[0] - tangent[0]) * side * f, -(out[1] - tangent[1]) * f};
            if (hypot(way[0], way[1]) > 500)
                continue; /* grazing: a texel's slope decides */
            *passed += 1;
            assert_float_equal(found[2], 1, 0);
            const double allowed = 1.5 + 0.04 * hypot(way[0], way[1]);
            if (hypot((double)found[0] - way[0], (double)found[1] - way[1]) > allowed)
                fail_msg("side %g at %d, %d: %g, %g px, expected %g, %g", side, x, y, (double)found[0],
                         (double)found[1], way[0], way[1]);
        }
}

static void a_drop_bends_light_by_snell(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    s.settings.thickness_mm = 0;
    for (int coated = 0; coated < 2; coated++) {
        int passed = 0, thrown_back = 0;
        s.settings.advancing_deg = coated ? 112 : 60;
        s.settings.receding_deg = coated ? 98 : 38;
        shot_forget(&s);
        const ball b = ball_of(&s, shot_drop(&s, 0.048, 0.032, shot_water(&s, 20e-3)));
        compare_refraction(&s, 1, &b, &passed, &thrown_back);
        REQUIRE(passed > 500 && !thrown_back);
        compare_refraction(&s, -1, &b, &passed, &thrown_back);
        REQUIRE(!coated == !thrown_back);
    }
    shot_close(&s);
}

/* A film of the same thickness everywhere is drawn, and shows what lies behind it. */
static void a_flat_film_does_not_bend(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    s.settings.thickness_mm = 0;
    shot_face(&s, -1, 30);
    for (uint32_t i = 0; i < s.glass->columns * s.glass->rows; i++) {
        s.film[i] = 80; /* 20 um */
        s.passed[i] = s.glass->last_tick;
    }
    const float *pixels = shot_draw(&s, true);
    for (int y = 16; y < HEIGHT - 16; y++)
        for (int x = 16; x < WIDTH - 16; x++) {
            const float *found = pixels + 4 * (y * WIDTH + x);
            assert_float_equal(found[3], 1, 1e-6);
            assert_float_equal(hypot((double)found[0], (double)found[1]), 0, 0.02);
        }
    shot_close(&s);
}

/* Nothing is to be seen but what the pane shows of lights that a test adds. */
static void open_before_black(shot *s)
{
    open_small(s);
    float *black = calloc(4ull * WIDTH * HEIGHT, sizeof *black);
    shot_plate(s, black);
    free(black);
    memset(&s->settings.lighting.environment_sh, 0, sizeof s->settings.lighting.environment_sh);
}

/* An even film of so many nanolitres a cell, not yet drawn together into beads. */
static void put_film(shot *s, uint32_t nl)
{
    for (uint32_t i = 0; i < s->glass->columns * s->glass->rows; i++) {
        s->film[i] = nl;
        s->passed[i] = s->glass->last_tick;
    }
}

/* Before a black plate under an even sky a flat film shows what it reflects: ((n - 1) / (n + 1))^2 straight on. */
static void water_reflects_by_fresnel(void **state)
{
    (void)state;
    shot s;
    open_before_black(&s);
    for (int i = 0; i < 3; i++)
        s.settings.lighting.environment_sh[0][i] = 1 / 0.282095f;
    put_film(&s, 80);
    const float *middle = shot_draw(&s, false) + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    const double straight = (WATER - 1) / (WATER + 1);
    for (int i = 0; i < 3; i++)
        assert_float_equal(middle[i], straight * straight, 2e-4);
    shot_close(&s);
}

/* A lamp beside the eye, mirrored straight back by a thin film on what is not glass: spread over a disc of 0.15 rad, as
 * bumps would, Fresnel's 0.02 of I / (distance^2 2 pi 0.15^2). Over one of 0.02 rad it would be 56 times as bright. */
static void a_film_on_metal_mirrors_a_lamp_widely(void **state)
{
    (void)state;
    shot s;
    open_before_black(&s);
    s.settings.opaque = true;
    shot_face(&s, 1, 30);
    const double u = 0.5 * (double)s.glass->def.width_m, v = 0.5 * (double)s.glass->def.height_m;
    const double away = fmax(v, u * HEIGHT / WIDTH) / tan(15 * M_PI / 180);
    s.settings.lighting.light_count = 1;
    s.settings.lighting.lights[0] = (virga_light){.position_m = {u, v, away}, .intensity = {1, 1, 1}};
    put_film(&s, 40); /* 10 um */
    const float *middle = shot_draw(&s, false) + 4 * (HEIGHT / 2 * WIDTH + WIDTH / 2);
    const double straight = (WATER - 1) / (WATER + 1);
    const double spread = 1 / (away * away * 2 * M_PI * 0.15 * 0.15);
    assert_float_equal(middle[0] / (straight * straight * spread), 1, 0.02);
    shot_close(&s);
}

/* Where the plate's colours are places, they tell what was looked up: right and down as shares of the picture. */
static void put_places(shot *s)
{
    float *pixels = malloc(16ull * WIDTH * HEIGHT);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        pixels[4 * i] = (float)((i % WIDTH + 0.5) / WIDTH);
        pixels[4 * i + 1] = (float)((i / WIDTH + 0.5) / HEIGHT);
        pixels[4 * i + 2] = pixels[4 * i + 3] = 1;
    }
    shot_plate(s, pixels);
    free(pixels);
}

static double mirrored(double x)
{
    return 1 - fabs(1 - (x - 2 * floor(x / 2)));
}

/* In the style of the paper always, mirrored at the borders; by Snell where the picture has it. To 3 % of the
 * picture, as copies
 * are coarse. */
static void compare_lookup(shot *s, int *compared, int *beyond)
{
    float *vectors = malloc(16ull * WIDTH * HEIGHT);
    memcpy(vectors, shot_draw(s, true), 16ull * WIDTH * HEIGHT);
    const float *colors = shot_draw(s, false);
    const bool paper = s->settings.style == VIRGA_GLASS_STYLE_PAPER;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float *v = vectors + 4 * i, *c = colors + 4 * i;
        const double x = (i % WIDTH + 0.5 + (double)v[0]) / WIDTH, y = (i / WIDTH + 0.5 + (double)v[1]) / HEIGHT;
        const bool inside = x > 0.16 && x < 0.84 && y > 0.16 && y < 0.84;
        if (v[2] < 1 || (v[0] == 0 && v[1] == 0) || (!paper && !inside))
            continue;
        *compared += 1;
        *beyond += x < -0.1 || x > 1.1 || y < -0.1 || y > 1.1;
        assert_float_equal((double)c[0] / (double)c[2], mirrored(x), 0.03);
        assert_float_equal((double)c[1] / (double)c[2], mirrored(y), 0.03);
    }
    free(vectors);
}

static void the_picture_is_looked_up_where_the_vectors_say(void **state)
{
    (void)state;
    shot s;
    ball balls[PLACES];
    int compared = 0, beyond = 0;
    open_small(&s);
    put_places(&s);
    put_balls(&s, balls, 20);
    shot_face(&s, -1, 30);
    s.settings.gain = 0;
    memset(&s.settings.lighting.environment_sh, 0, sizeof s.settings.lighting.environment_sh);
    compare_lookup(&s, &compared, &beyond);
    print_message("%d compared\n", compared);
    REQUIRE(compared > 300);
    s.settings.style = VIRGA_GLASS_STYLE_PAPER;
    s.settings.paper_shift = 4;
    compared = 0;
    compare_lookup(&s, &compared, &beyond);
    REQUIRE(compared > 1000 && beyond > 200);
    shot_close(&s);
}

/* ---- where, and how often the same */

static double sum_of_alpha(const float *pixels, int from_column, int to_column)
{
    double sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (i % WIDTH >= from_column && i % WIDTH < to_column)
            sum += (double)pixels[4 * i + 3];
    return sum;
}

static void the_scene_hides_what_is_behind_it(void **state)
{
    (void)state;
    shot s;
    ball balls[PLACES];
    open_small(&s);
    put_balls(&s, balls, PLACES);
    s.give_depth = true;
    const double distance = fabs(s.camera.position_m[2]);
    const float *p = s.camera.clip_from_view;
    for (int nearer = 0; nearer < 2; nearer++) {
        s.scene_depth = (float)(-(double)p[10] + (double)p[14] / (distance * (nearer ? 0.95 : 1.05)));
        const double alpha = sum_of_alpha(shot_draw(&s, false), 0, WIDTH);
        REQUIRE(nearer ? alpha == 0 : alpha > 1000);
    }
    shot_close(&s);
}

static void nothing_is_drawn_where_there_is_no_glass(void **state)
{
    (void)state;
    static const uint8_t half[2] = {0, 1};
    shot s;
    ball balls[PLACES];
    open_small(&s);
    virga_glass_shape shape = virga_default_glass_shape();
    shape.mask = half;
    shape.mask_columns = 2;
    shape.mask_rows = 1;
    REQUIRE(virga_glass_shape_set(s.glass, &shape) == VIRGA_OK);
    shot_step(&s, 1);
    put_balls(&s, balls, PLACES);
    const float *pixels = shot_draw(&s, false);
    REQUIRE(sum_of_alpha(pixels, 0, WIDTH / 2 - 1) == 0);
    REQUIRE(sum_of_alpha(pixels, WIDTH / 2 + 1, WIDTH) > 1000);
    shot_close(&s);
}

#define OWN_LANES UINT32_MAX /* those that the device was found to have */

/* Drops in one place, of which more reach a tile than a workgroup takes at once. */
static void crowd(shot *s)
{
    for (int i = 0; i < 150; i++)
        shot_drop(s, 0.02 + 1e-5 * i, 0.03, shot_water(s, 2e-3));
}

/* A frame's map and pixels, with film and beads; to be freed. */
static float *whole_frame(const char *threads, uint32_t lanes, size_t *count)
{
    shot s;
    ball balls[PLACES];
    setenv("LP_NUM_THREADS", threads, 1);
    open_small(&s);
    if (lanes == 0 || (lanes != OWN_LANES && s.context->software))
        REQUIRE(glass_picture_take_lanes(s.glass, lanes) == VIRGA_OK);
    put_places(&s);
    put_balls(&s, balls, PLACES);
    crowd(&s);
    for (uint32_t i = 0; i < s.glass->columns * s.glass->rows; i++) {
        s.film[i] = i % 5 * 20;
        s.passed[i] = i % 2 * s.glass->last_tick;
    }
    for (int again = 0; again < 2; again++) {
        const float *pixels = shot_draw(&s, false);
        *count = 4ull * (s.columns * s.rows + WIDTH * HEIGHT);
        if (!again)
            continue;
        float *all = malloc(*count * 4);
        memcpy(all, s.map, 16ull * s.columns * s.rows);
        memcpy(all + 4ull * s.columns * s.rows, pixels, 16ull * WIDTH * HEIGHT);
        shot_close(&s);
        return all;
    }
    return NULL;
}

/* Drops in the paper's style, by one way of adding up and compressing. */
static float *paper_frame(bool height_map, virga_glass_blend blend, uint32_t compress_steps)
{
    shot s;
    ball balls[PLACES];
    virga_glass_def def = shot_def();
    def.height_map = height_map;
    shot_open(&s, &def, WIDTH, HEIGHT, false);
    shot_face(&s, -1, 30);
    put_places(&s);
    put_balls(&s, balls, 20);
    s.settings.style = VIRGA_GLASS_STYLE_PAPER;
    s.settings.blend = blend;
    s.settings.compress_steps = compress_steps;
    float *copy = malloc(16ull * WIDTH * HEIGHT);
    REQUIRE(copy);
    memcpy(copy, shot_draw(&s, false), 16ull * WIDTH * HEIGHT);
    shot_close(&s);
    return copy;
}

/* Where nobody asks for heights the paper's style has gathers that leave them out. */
static void the_paper_shows_the_same_with_heights_and_without(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 4; i++) {
        const virga_glass_blend blend = i & 1 ? VIRGA_GLASS_BLEND_WEIGHTED : VIRGA_GLASS_BLEND_SUM;
        float *with = paper_frame(true, blend, i & 2 ? 9 : 5), *without = paper_frame(false, blend, i & 2 ? 9 : 5);
        REQUIRE(sum_of_alpha(with, 0, WIDTH) > 1000);
        if (memcmp(with, without, 16ull * WIDTH * HEIGHT))
            fail_msg("other bits with blend %d and %d steps", (int)blend, i & 2 ? 9 : 5);
        free(with);
        free(without);
    }
}

static void the_same_bits_come_out_every_time(void **state)
{
    (void)state;
    size_t count = 0;
    float *first = whole_frame("1", OWN_LANES, &count);
    for (int i = 0; i < 2; i++) {
        float *other = whole_frame(i == 1 ? "1" : "2", OWN_LANES, &count);
        if (memcmp(first, other, count * 4))
            fail_msg("other bits in run %d", i);
        free(other);
    }
    free(first);
}

/* By shared memory, by shuffles among a workgroup's subgroups, and as the device does it by itself. */
static void the_same_bits_come_out_however_balls_are_handed_around(void **state)
{
    (void)state;
    size_t count = 0;
    float *own = whole_frame("2", OWN_LANES, &count);
    for (uint32_t lanes = 0; lanes <= 64; lanes += 64) {
        float *other = whole_frame("2", lanes, &count);
        if (memcmp(own, other, count * 4))
            fail_msg("other bits as for %u lanes", lanes);
        free(other);
    }
    free(own);
}

/* What a GPU says of its subgroups is not what a shader runs with: it may lack lanes. */
static void only_processors_shuffle(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    const virga_glass_def def = s.glass->def;
    REQUIRE(s.context->software == (s.context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU));
    REQUIRE(s.context->software || s.glass->picture->lanes == 0);
    s.context->software = false;
    virga_glass *other = NULL;
    REQUIRE(virga_glass_create(s.context, &def, &other) == VIRGA_OK);
    REQUIRE(other->picture->lanes == 0);
    virga_glass_destroy(&other);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_hold_the_balls_that_were_counted),
        cmocka_unit_test(the_map_is_that_of_the_reference),
        cmocka_unit_test(a_drop_alone_is_a_cap),
        cmocka_unit_test(weights_sum_to_one),
        cmocka_unit_test(merged_drops_have_no_crease),
        cmocka_unit_test(sub_balls_flow_into_their_drop_and_keep_its_water),
        cmocka_unit_test(tiles_without_room_are_counted_and_empty),
        cmocka_unit_test(fine_film_covers_what_its_beads_do),
        cmocka_unit_test(a_film_ends_on_the_glass_beside_drops),
        cmocka_unit_test(slopes_are_differences_of_heights),
        cmocka_unit_test(a_drop_bends_light_by_snell),
        cmocka_unit_test(a_flat_film_does_not_bend),
        cmocka_unit_test(water_reflects_by_fresnel),
        cmocka_unit_test(a_film_on_metal_mirrors_a_lamp_widely),
        cmocka_unit_test(the_picture_is_looked_up_where_the_vectors_say),
        cmocka_unit_test(the_scene_hides_what_is_behind_it),
        cmocka_unit_test(nothing_is_drawn_where_there_is_no_glass),
        cmocka_unit_test(the_paper_shows_the_same_with_heights_and_without),
        cmocka_unit_test(the_same_bits_come_out_every_time),
        cmocka_unit_test(the_same_bits_come_out_however_balls_are_handed_around),
        cmocka_unit_test(only_processors_shuffle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
