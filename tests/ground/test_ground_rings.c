/* Rings on puddles: each drop starts one at its instant, and the map shows the waves of the table. */
#include "ripple_fixture.h"

#include "ground/ring_table.h"

#include <virga/shared/random.h>

#include <math.h>

/* A level floor under `mm` of water everywhere. */
static void begin(double mm)
{
    virga_ground_def def = virga_default_ground_def();
    def.cells = 128;
    def.cached_tiles = 0;
    def.max_impacts = MAX_DROPS;
    def.ripple_texels = 256;
    def.ripple_texel_m = 0.004f;
    ground_fixture_open(&f);
    ground_fixture_floor(&f, VIRGA_MATERIAL_CUSTOM);
    ground_fixture_ground(&f, &def);
    ground_fixture_step(&f, 0);
    ripple_fixture_flood(mm);
}

/* Slope away from a point, at a texel. */
static double radial(int x, int y, double from_x, double from_z)
{
    const double dx = (x + 0.5 - 128) * 0.004 - from_x, dz = (y + 0.5 - 128) * 0.004 - from_z;
    const double r = hypot(dx, dz);
    return (slope(x, y, 0) * dx + slope(x, y, 1) * dz) / r;
}

/* The crater that a drop leaves in deep enough water, as shaders/ground/rings.glsl derives it. */
typedef struct crater {
    double depth_m;
    int width;
} crater;

static crater crater_of(const virga_impact_gpu *drop)
{
    static const double pi = 3.14159265358979323846, widths[VIRGA_RING_WIDTHS] = {VIRGA_RING_WIDTH_LIST};
    const double speed = hypot(hypot((double)drop->velocity[0], (double)drop->velocity[1]), (double)drop->velocity[2]);
    const double energy = 0.5 * 998.2 * pi / 6 * pow((double)drop->diameter_m, 3) * speed * speed;
    const double own = pow(energy / 2 / (pi / 4 * 9789), 0.25);
    const int width = fabs(log(own / widths[0])) < fabs(log(own / widths[1])) ? 0 : 1;
    const double of_1_m = pi / 8 * 9789 * widths[width] * widths[width] + 3 * pi / 4 * 0.0728;
    return (crater){sqrt(0.01 * energy / of_1_m), width};
}

/* A drop that falls at a share of its tick, so many ticks later: all texels so many texels from it, on all sides. */
static void check_waves(double diameter_m, double share, uint32_t ticks, int least, int most)
{
    float *table = malloc(sizeof(float) * VIRGA_RING_LAYERS * VIRGA_RING_TIMES * VIRGA_RING_RADII);
    ring_table_fill(table, 0.5 * 0.004);
    begin(5);
    virga_impact_gpu *drop = ground_fixture_drop(&f, 0, 0, 0, 4000);
    drop->position[0] = drop->position[2] = 0;
    drop->time_s = (float)share / 60;
    drop->diameter_m = (float)diameter_m;
    const crater own = crater_of(drop);
    ground_fixture_step(&f, ticks);
    read_back();
    const double age = (ticks - share) / 60, open = fmin(age / VIRGA_RING_OPENS_S, 1);
    const double depth_m = own.depth_m * open * open * (3 - 2 * open);
    double max_error = 0, highest = 0;
    for (int i = 0; i < 4 * most * most; i++) {
        const int x = 128 - most + i % (2 * most), y = 128 - most + i / (2 * most);
        const double r = hypot((x + 0.5 - 128) * 0.004, (y + 0.5 - 128) * 0.004);
        if (r < least * 0.004 || r >= most * 0.004)
            continue;
        const double expected = depth_m * ring_table_slope(table, ring_layer(own.width, 0.005), r, age);
        max_error = fmax(max_error, fabs(radial(x, y, 0, 0) - expected));
        highest = fmax(highest, fabs(expected));
    }
    assert_true(highest > 0.002);
    if (!(max_error <= 0.02 * highest))
        fail_msg("off by %g where waves are %g", max_error, highest);
    free(table);
    end();
}

static void test_the_map_shows_the_waves_of_the_table(void **state)
{
    (void)state;
    check_waves(1.2e-3, 0.5, 12, 4, 22); /* up to 9 cm, inside the softened end */
    check_waves(2.5e-3, 0.5, 12, 4, 22);
}

static void test_the_map_shows_the_crater(void **state)
{
    (void)state;
    check_waves(2.5e-3, 0.7, 1, 0, 4);
}

/* Two milliseconds on, not all of it is there. */
static void test_the_crater_opens(void **state)
{
    (void)state;
    check_waves(2.5e-3, 0.88, 1, 0, 4);
}

static bool is_flat(void)
{
    const uint32_t texels = f.ground->def.ripple_texels;
    for (uint32_t i = 0; i < texels * texels; i++)
        if (((const uint32_t *)picture.mapped)[i])
            return false;
    return true;
}

/* A step that nobody sees leaves the map. The next one draws what it would have drawn. */
static void test_what_nobody_sees_is_drawn_later(void **state)
{
    static uint32_t seen[4096 * 4];
    (void)state;
    for (int unseen = 0; unseen < 2; unseen++) {
        begin(3);
        assert_true((size_t)f.ground->def.ripple_texels * f.ground->def.ripple_texels * 4 >= sizeof seen);
        ground_fixture_drop(&f, 3, -4, 0, 4000);
        f.is_unseen = unseen;
        ground_fixture_step(&f, 1);
        read_back();
        assert_int_equal(is_flat(), unseen);
        f.is_unseen = false;
        ground_fixture_step(&f, 2);
        read_back();
        assert_false(is_flat());
        const char *middle = (const char *)picture.mapped + picture.size / 2 - sizeof seen / 2;
        if (!unseen)
            memcpy(seen, middle, sizeof seen);
        assert_memory_equal(seen, middle, sizeof seen);
        end();
    }
}

static void test_a_ring_is_of_its_drop_and_its_instant(void **state)
{
    (void)state;
    begin(3);
    virga_impact_gpu *drop = ground_fixture_drop(&f, 3, -4, 0, 4000);
    drop->id = 0xabcdef01u;
    drop->time_s = 0.25f / 60;
    const uint32_t tick = f.tick;
    ground_fixture_step(&f, 1);
    read_back();
    const virga_rings_gpu *head = records.mapped;
    const virga_ring_gpu *ring = (const virga_ring_gpu *)(head + 1);
    assert_int_equal(head->total, 1);
    assert_int_equal(ring->id, 0xabcdef01u);
    assert_int_equal(ring->tick, tick);
    assert_float_equal(ring->share, 0.25, 1e-3);
    assert_int_equal(ring->cell[0], 3);
    assert_int_equal(ring->cell[1], -4);
    assert_float_equal(ring->depth_m, 3e-3, 1e-6);
    end();
}

static void test_there_are_no_rings_on_a_film_or_beside_the_water(void **state)
{
    (void)state;
    begin(0.5);
    for (int i = 0; i < 10; i++)
        ground_fixture_drop(&f, i, 0, 0, 4000);
    ground_fixture_step(&f, 1);
    read_back();
    assert_int_equal(((const virga_rings_gpu *)records.mapped)->total, 0);
    end();
}

/* Also one that a count in steps of a workgroup would run over the end of 32 bits with. */
static void test_a_list_that_tells_of_any_number_of_drops_is_read_as_far_as_it_can_be(void **state)
{
    (void)state;
    begin(5);
    for (int i = 0; i < 10; i++)
        ground_fixture_drop(&f, i, 0, 0, 4000);
    f.list_count = 0xffffff01u;
    ground_fixture_step(&f, 1);
    read_back();
    assert_int_equal(((const virga_rings_gpu *)records.mapped)->total, 10);
    end();
}

static void test_a_cloudburst_never_lives_longer_than_there_is_room(void **state)
{
    (void)state;
    begin(5);
    for (int step = 0; step < 60; step++) {
        for (uint32_t i = 0; i < 3000; i++) {
            const uint32_t h = virga_hash3(77, (uint32_t)step, i);
            ground_fixture_drop(&f, (int)(h & 15) - 8, (int)(h >> 4 & 15) - 8, 0, 100)->id = h;
        }
        ground_fixture_step(&f, 1);
    }
    read_back();
    const virga_rings_gpu *head = records.mapped;
    const virga_ring_gpu *rings = (const virga_ring_gpu *)(head + 1);
    const double in_a_life = head->total * VIRGA_RING_MAX_LIFE_S;
    const double room = VIRGA_MAX_RINGS / (1 + VIRGA_GROUND_PIECE_S * VIRGA_GROUND_MAX_PIECES / VIRGA_RING_MAX_LIFE_S);
    assert_true(in_a_life <= room && in_a_life > 0.8 * room); /* the rest is for pieces that begin later */
    /* In the order of time: the slot after the newest holds the oldest. */
    for (uint32_t i = 1; i < head->total && i < VIRGA_MAX_RINGS; i++)
        assert_true(rings[(head->total - i) % VIRGA_MAX_RINGS].tick >=
                        rings[(head->total - i - 1) % VIRGA_MAX_RINGS].tick ||
                    head->total < VIRGA_MAX_RINGS);
    end();
}

/* As rain has them: hundreds of small drops to one that makes waves. */
static void test_rings_that_are_drawn_bring_the_waves_of_all_drops(void **state)
{
    (void)state;
    begin(5);
    double brought = 0;
    uint32_t large = 0, shown = 0;
    for (uint32_t step = 0; step < 30; step++) {
        for (uint32_t i = 0; i < 2000; i++) {
            const uint32_t h = virga_hash3(78, step, i);
            virga_impact_gpu *drop =
                ground_fixture_drop(&f, (int)(h & 15) - 8, (int)(h >> 4 & 15) - 8, 0, i % 100 ? 100 : 4000);
            drop->id = h << 1 | (i % 100 == 0);
            drop->diameter_m = i % 100 ? 0.4e-3f : 2.2e-3f;
            brought += pow(crater_of(drop).depth_m, 2);
            large += drop->id & 1;
        }
        ground_fixture_step(&f, 1);
    }
    read_back();
    const virga_rings_gpu *head = records.mapped;
    const virga_ring_gpu *rings = (const virga_ring_gpu *)(head + 1);
    double drawn = 0;
    assert_true(head->total <= VIRGA_MAX_RINGS);
    for (uint32_t i = 0; i < head->total; i++) {
        drawn += rings[i].crater_m * rings[i].crater_m;
        shown += rings[i].id & 1;
    }
    assert_int_equal(shown, large); /* twenty a tick, where there are slots for 78 */
    /* 1800 small ones are drawn, each for the same share: 0.58 of all, off by 1 / sqrt(1800) of it. */
    if (fabs(drawn / brought - 1) > 0.03)
        fail_msg("%g of the variance that drops bring is drawn", drawn / brought);
    end();
}

/* A drop that stands for forty: 32 pieces around it, each with a ring of more than its own waves, within 0.1 s. */
static void test_a_drop_that_stands_for_many_makes_the_waves_of_all(void **state)
{
    (void)state;
    begin(5);
    virga_impact_gpu *drop = ground_fixture_drop(&f, 0, 0, 0, 40000);
    drop->weight = 40;
    drop->diameter_m = 2e-3f;
    ground_fixture_step(&f, 1);
    read_back();
    const virga_rings_gpu *head = records.mapped;
    const virga_ring_gpu *rings = (const virga_ring_gpu *)(head + 1);
    const double depth_m = crater_of(drop).depth_m;
    double drawn = 0;
    int latest = 0, cells = 0;
    assert_int_equal(head->total, 32);
    for (uint32_t i = 0; i < head->total; i++) {
        drawn += rings[i].crater_m * rings[i].crater_m;
        cells += i > 0 && rings[i].cell[0] != rings[i - 1].cell[0];
        assert_true(rings[i].share >= 0 && rings[i].share < 1 + VIRGA_GROUND_PIECE_S * 60 * 32);
        latest = rings[i].share > 24 ? latest + 1 : latest;
    }
    assert_float_equal(drawn / (40 * depth_m * depth_m), 1, 1e-4);
    assert_true(latest > 2 && cells > 16);
    end();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_map_shows_the_waves_of_the_table),
        cmocka_unit_test(test_the_map_shows_the_crater),
        cmocka_unit_test(test_the_crater_opens),
        cmocka_unit_test(test_what_nobody_sees_is_drawn_later),
        cmocka_unit_test(test_a_ring_is_of_its_drop_and_its_instant),
        cmocka_unit_test(test_there_are_no_rings_on_a_film_or_beside_the_water),
        cmocka_unit_test(test_a_list_that_tells_of_any_number_of_drops_is_read_as_far_as_it_can_be),
        cmocka_unit_test(test_a_cloudburst_never_lives_longer_than_there_is_room),
        cmocka_unit_test(test_rings_that_are_drawn_bring_the_waves_of_all_drops),
        cmocka_unit_test(test_a_drop_that_stands_for_many_makes_the_waves_of_all),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
