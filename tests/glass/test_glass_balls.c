/* test_glass_balls.c - the balls that a drop is made of, and the lists of tiles that they are in. */
#include "glass_ball_fixture.h"

/* ---- lists of tiles */

/* Copies of what the newest frame left of tiles' lists; they stay until the fixture's next. */
static const virga_glass_tile_gpu *read_lists(shot *s, host_buffer *down, const uint32_t **entries)
{
    const struct glass_picture *picture = &s->glass->picture;
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
    ball balls[BALLS];
    host_buffer down = {0};
    const uint32_t *entries;
    open_small(&s);
    put_balls(&s, balls, BALLS);
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
    assert_true(all > 4 * BALLS);
    host_buffer_destroy(&s.gpu.device, &down);
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
    assert_int_equal(stats.ball_entries_dropped, s.cut_count);
    shot_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lists_hold_the_balls_that_were_counted),
        cmocka_unit_test(sub_balls_flow_into_their_drop_and_keep_its_water),
        cmocka_unit_test(tiles_without_room_are_counted_and_empty),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
