/* test_glass_same.c - the same bits: every time, with heights and without, and however a device adds up. */
#include "glass_ball_fixture.h"

#define OWN_LANES UINT32_MAX /* as many as the device has */

/* Drops close together: more of them reach a tile than a workgroup handles at once. */
static void crowd(shot *s)
{
    for (int i = 0; i < 150; i++)
        shot_drop(s, 0.02 + 1e-5 * i, 0.03, shot_water(s, 2e-3));
}

/* A frame's map and pixels, with film and beads; to be freed. The second of two. */
static float *whole_frame(const char *threads, const virga_glass_def *def, uint32_t lanes, size_t *size)
{
    shot s;
    ball balls[BALLS];
    effect_device_set_threads(threads);
    shot_open(&s, def, WIDTH, HEIGHT, false);
    shot_face(&s, 1, 30);
    if (lanes == 0 || (lanes != OWN_LANES && s.context->software))
        REQUIRE(glass_picture_use_lanes(s.glass, lanes) == VIRGA_OK);
    s.settings.pinning = 0.7f;
    put_even_balls(&s);
    put_balls(&s, balls, BALLS);
    crowd(&s);
    for (uint32_t i = 0; i < s.glass->columns * s.glass->rows; i++) {
        s.film[i] = i % 5 * 20;
        s.passed[i] = i % 2 * s.glass->last_tick;
    }
    shot_draw(&s, false);
    const float *pixels = shot_draw(&s, false);
    const size_t map = 16ull * s.columns * s.rows;
    *size = map + 16ull * WIDTH * HEIGHT;
    char *all = malloc(*size);
    memcpy(all, s.map, map);
    memcpy(all + map, pixels, *size - map);
    shot_close(&s);
    return (float *)all;
}

/* Drops in the paper's style, by one way of adding up, compressing and handing balls around. */
static float *paper_frame(bool height_map, virga_glass_blend blend, uint32_t compress_steps, uint32_t lanes)
{
    shot s;
    ball balls[BALLS];
    virga_glass_def def = shot_def();
    def.height_map = height_map;
    shot_open(&s, &def, WIDTH, HEIGHT, false);
    if (lanes == 0 || (lanes != OWN_LANES && s.context->software))
        REQUIRE(glass_picture_use_lanes(s.glass, lanes) == VIRGA_OK);
    shot_face(&s, -1, 30);
    put_even_balls(&s);
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

/* Where nobody asks for heights the paper's style has gathers that leave them out. Each blend and each loop of
 * compression is there once: one sums, the other works on the result. */
static void the_paper_shows_the_same_with_heights_and_without(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 2; i++) {
        const virga_glass_blend blend = i ? VIRGA_GLASS_BLEND_WEIGHTED : VIRGA_GLASS_BLEND_SUM;
        const uint32_t steps = i ? 9 : 5;
        float *with = paper_frame(true, blend, steps, OWN_LANES),
              *without = paper_frame(false, blend, steps, OWN_LANES);
        REQUIRE(sum_of_alpha(with, 0, WIDTH) > 1000);
        if (memcmp(with, without, 16ull * WIDTH * HEIGHT))
            fail_msg("other bits with blend %d and %u steps", (int)blend, steps);
        free(with);
        free(without);
    }
}

/* Without heights, and as GPUs do it. */
static void the_paper_shows_the_same_however_balls_are_handed_around(void **state)
{
    (void)state;
    float *own = paper_frame(false, VIRGA_GLASS_BLEND_SUM, 5, OWN_LANES);
    for (uint32_t lanes = 0; lanes <= 64; lanes += 64) {
        float *other = paper_frame(false, VIRGA_GLASS_BLEND_SUM, 5, lanes);
        if (memcmp(own, other, 16ull * WIDTH * HEIGHT))
            fail_msg("other bits with %u lanes", lanes);
        free(other);
    }
    free(own);
}

/* A way to draw the same frame. */
typedef struct way {
    const char *threads;
    uint32_t lanes;
} way;

static void compare_ways(const virga_glass_def *def, const way *ways, int count)
{
    size_t size = 0;
    float *first = whole_frame(ways[0].threads, def, ways[0].lanes, &size);
    for (int i = 1; i < count; i++) {
        float *other = whole_frame(ways[i].threads, def, ways[i].lanes, &size);
        if (memcmp(first, other, size))
            fail_msg("other bits in run %d, with %s threads and %u lanes", i, ways[i].threads, ways[i].lanes);
        free(other);
    }
    free(first);
}

static void the_same_bits_come_out_every_time(void **state)
{
    (void)state;
    compare_ways(NULL, (const way[]){{"1", OWN_LANES}, {"1", OWN_LANES}, {"2", OWN_LANES}}, 3);
}

/* By shared memory, by shuffles among a workgroup's subgroups, and as the device does it by itself. */
static void the_same_bits_come_out_however_balls_are_handed_around(void **state)
{
    (void)state;
    compare_ways(NULL, (const way[]){{"2", OWN_LANES}, {"2", 0}, {"2", 64}}, 3);
}

/* Film is interpolated between cells only where they are no smaller than texels; else a texel has the nearest one. */
static void the_same_bits_come_out_where_texels_are_larger_than_cells(void **state)
{
    (void)state;
    virga_glass_def def = shot_def();
    def.max_texels = 64;
    def.cell_m = 0.001f;
    compare_ways(&def, (const way[]){{"2", OWN_LANES}, {"2", 0}}, 2);
}

/* What a GPU says of its subgroups is not what a shader runs with: it may lack lanes. */
static void only_processors_shuffle(void **state)
{
    (void)state;
    shot s;
    open_small(&s);
    const virga_glass_def def = s.glass->def;
    REQUIRE(s.context->software == (s.context->properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU));
    REQUIRE(s.context->for_software || s.glass->picture.lanes == 0);
    s.context->for_software = false;
    virga_glass *other = NULL;
    REQUIRE(virga_glass_create(s.context, &def, &other) == VIRGA_OK);
    REQUIRE(other->picture.lanes == 0);
    virga_glass_destroy(&other);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_paper_shows_the_same_with_heights_and_without),
        cmocka_unit_test(the_paper_shows_the_same_however_balls_are_handed_around),
        cmocka_unit_test(the_same_bits_come_out_every_time),
        cmocka_unit_test(the_same_bits_come_out_however_balls_are_handed_around),
        cmocka_unit_test(the_same_bits_come_out_where_texels_are_larger_than_cells),
        cmocka_unit_test(only_processors_shuffle),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
