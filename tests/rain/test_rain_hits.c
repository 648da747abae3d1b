/* test_rain_hits.c - what meets a pane in the rain is what the drops in its way bring: as much water as theory says,
 * more where it drives into them, none under a roof, and the drop of a streak keeps its id. */
#include "rain_fixture.h"

#include <math.h>

#define PARTS 8 /* of a pane's side */

static rain_fixture f;
static host_buffer read_back;

typedef struct caught {
    double water_m3, variance_m6;
    uint32_t drops;
    uint32_t named;                /* with the id of a drop that is in the field, of the last frame's */
    uint32_t last;                 /* drops of the last frame */
    uint32_t there[PARTS * PARTS]; /* by part of the pane */
} caught;

static void open_rain(bool roof)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 24576;
    def.range_m = 8;
    def.occlusion_size = 256;
    def.max_panes = 2;
    rain_fixture_open(&f);
    if (roof) {
        static const float quad[1][4][3] = {{{-100, 4, -100}, {100, 4, -100}, {100, 4, 100}, {-100, 4, 100}}};
        rain_fixture_quads(&f, quad, 1);
    } else {
        rain_fixture_floor(&f);
    }
    rain_fixture_rain(&f, &def);
    f.settings.rate_mm_h = 50;
    REQUIRE(virga_rain_set(f.rain, &f.settings) == VIRGA_OK);
    memset(&read_back, 0, sizeof read_back);
    rain_fixture_readback(&f, sizeof(virga_impacts_gpu) + VIRGA_RAIN_MAX_HITS * sizeof(virga_impact_gpu), &read_back);
}

static void close_rain(void)
{
    host_buffer_destroy(&f.gpu.device, &read_back);
    virga_rain_destroy(&f.rain);
    virga_context_destroy(&f.context);
    host_buffer *buffers[] = {&f.vertices, &f.indices, &f.impacts, &f.drops};
    assert_int_equal(effect_fixture_end(&f.gpu, buffers, sizeof buffers / sizeof buffers[0]), 0);
}

static void check_hit(const virga_impact_gpu *hit, const virga_rain_pane *pane, uint32_t first, uint32_t ticks)
{
    REQUIRE(hit->position[0] >= 0 && hit->position[0] <= pane->width_m);
    REQUIRE(hit->position[1] >= 0 && hit->position[1] <= pane->height_m);
    REQUIRE(hit->tick >= first && hit->tick < first + ticks);
    /* The water of one drop, or of a few, rounded by chance. */
    REQUIRE((double)hit->water_nl >= virga_drop_volume((double)hit->diameter_m) * 1e12 - 1);
}

/* Ids of the field are a slot's number and which of its drops it is. */
static bool in_field(uint32_t id)
{
    const uint32_t slot = id & ((1u << VIRGA_RAIN_ID_SLOT_BITS) - 1);
    return slot < f.slots && rain_fixture_drops(&f)[slot].id == id;
}

static uint32_t part_of(const virga_impact_gpu *hit, const virga_rain_pane *pane)
{
    const uint32_t x = (uint32_t)(hit->position[0] / pane->width_m * PARTS);
    const uint32_t y = (uint32_t)(hit->position[1] / pane->height_m * PARTS);
    return (x < PARTS ? x : PARTS - 1) + (y < PARTS ? y : PARTS - 1) * PARTS;
}

/* Rain on a pane, in frames of 1/24 s; it moves, and the camera with it. */
static caught run(virga_rain_pane pane, double seconds)
{
    caught sum = {0};
    for (int frame = 0; frame < (int)(seconds * 24); frame++) {
        const VkCommandBuffer cmd = rain_fixture_begin_frame(&f);
        if (f.occluder_count)
            REQUIRE(virga_rain_draw_occlusion(f.rain, cmd, f.camera, f.occluders, f.occluder_count) == VIRGA_OK);
        rain_fixture_record_step(&f, cmd, 1.0 / 24);
        virga_rain_buffer hits;
        REQUIRE(virga_rain_find_hits(f.rain, cmd, &pane, &hits) == VIRGA_OK);
        virga_rain_buffer drops;
        virga_rain_drops(f.rain, &drops, NULL, NULL);
        rain_fixture_copy(cmd, &drops, &f.drops);
        rain_fixture_copy(cmd, &hits, &read_back);
        rain_fixture_end_frame(&f);
        host_buffer_invalidate(&f.gpu.device, &read_back);
        host_buffer_invalidate(&f.gpu.device, &f.drops);
        sum.named = sum.last = 0;
        const virga_impacts_gpu *head = read_back.mapped;
        const virga_impact_gpu *list = (const virga_impact_gpu *)(head + 1);
        REQUIRE(head->dropped == 0);
        for (uint32_t i = 0; i < head->count; i++) {
            if (!list[i].water_nl)
                continue;
            check_hit(&list[i], &pane, head->first_tick, head->ticks);
            sum.water_m3 += list[i].water_nl * 1e-12;
            sum.variance_m6 += list[i].water_nl * 1e-12 * list[i].water_nl * 1e-12;
            sum.drops++;
            sum.last++;
            sum.named += in_field(list[i].id);
            sum.there[part_of(&list[i], &pane)]++;
        }
        for (int axis = 0; axis < 3; axis++) {
            pane.corner_m[axis] += (double)pane.velocity_m_s[axis] / 24;
            f.camera[axis] += (double)pane.velocity_m_s[axis] / 24;
        }
    }
    return sum;
}

/* Water (m^3) a second and square metre on a pane that faces z and drives that way. */
static double theory(double speed_m_s)
{
    const double low = VIRGA_DROP_MIN_M, high = VIRGA_DROP_MAX_M;
    const int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; i++) {
        const double d = low + (high - low) * (i + 0.5) / steps;
        sum += virga_sizes_density(&f.settings.sizes, 50, 0, d) * virga_drop_volume(d) * (high - low) / steps;
    }
    return sum * speed_m_s;
}

static void lying_pane_gets_the_rate(void **unused)
{
    (void)unused;
    open_rain(false);
    f.camera[1] = 1.7;
    const virga_rain_pane pane = {
        .corner_m = {-0.6, 1.5, 0.4}, .along_u = {1, 0, 0}, .along_v = {0, 0, -1}, .width_m = 1.2f, .height_m = 0.8f};
    run(pane, 0.5);
    const caught got = run(pane, 6);
    const double expected = 50e-3 / 3600 * 1.2 * 0.8 * 6;
    print_message("%u drops, %.3f ml, expected %.3f +- %.3f\n", got.drops, got.water_m3 * 1e6, expected * 1e6,
                  sqrt(got.variance_m6) * 1e6);
    assert_true(fabs(got.water_m3 - expected) < 0.03 * expected + 3 * sqrt(got.variance_m6));
    print_message("%u of the last %u are drops with a streak\n", got.named, got.last);
    assert_true(got.named > got.last / 4);
    close_rain();
}

/* Chi-square over the pane's parts: 63 if drops fell independently, with a deviation of 11.2. They lie in cells, one to
 * each, so it is less; parts that are left out, as those along an edge would be, add hundreds. */
static void drops_lie_evenly_on_a_pane(void **unused)
{
    (void)unused;
    open_rain(false);
    f.camera[1] = 1.7;
    const virga_rain_pane pane = {.corner_m = {-0.6, 1.3, 0.7},
                                  .along_u = {0.8f, 0, 0.6f},
                                  .along_v = {0, 1, 0},
                                  .width_m = 1.2f,
                                  .height_m = 0.6f,
                                  .velocity_m_s = {-6, 0, 8}};
    run(pane, 0.5);
    const caught got = run(pane, 2);
    double chi_square = 0;
    for (int i = 0; i < PARTS * PARTS; i++) {
        const double expected = (double)got.drops / (PARTS * PARTS), off = got.there[i] - expected;
        chi_square += off * off / expected;
    }
    print_message("chi-square of %u drops over %d parts: %.1f\n", got.drops, PARTS * PARTS, chi_square);
    assert_true(got.drops > 10000 && chi_square < 63 + 5 * 11.2);
    close_rain();
}

static void a_driving_pane_meets_more(void **unused)
{
    (void)unused;
    open_rain(false);
    f.camera[1] = 1.7;
    const virga_rain_pane pane = {.corner_m = {-0.6, 1.3, 0.7},
                                  .along_u = {1, 0, 0},
                                  .along_v = {0, 1, 0},
                                  .width_m = 1.2f,
                                  .height_m = 0.6f,
                                  .velocity_m_s = {0, 0, 12}};
    run(pane, 0.5);
    const caught got = run(pane, 2);
    const double expected = theory(12) * 1.2 * 0.6 * 2;
    print_message("%u drops, %.3f ml, expected %.3f +- %.3f\n", got.drops, got.water_m3 * 1e6, expected * 1e6,
                  sqrt(got.variance_m6) * 1e6);
    assert_true(fabs(got.water_m3 - expected) < 0.04 * expected + 3 * sqrt(got.variance_m6));
    close_rain();
}

static void nothing_meets_a_pane_under_a_roof(void **unused)
{
    (void)unused;
    open_rain(true);
    f.camera[1] = 1.7;
    const virga_rain_pane pane = {
        .corner_m = {-0.6, 1.5, 0.4}, .along_u = {1, 0, 0}, .along_v = {0, 0, -1}, .width_m = 1.2f, .height_m = 0.8f};
    run(pane, 0.5);
    assert_int_equal(run(pane, 0.5).drops, 0);
    close_rain();
}

static void wrong_panes_are_refused(void **unused)
{
    (void)unused;
    open_rain(false);
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&f);
    virga_rain_buffer hits;
    virga_rain_pane pane = {.along_u = {1, 0, 0}, .along_v = {0, 1, 0}, .width_m = 1, .height_m = 1};
    assert_int_equal(virga_rain_find_hits(f.rain, cmd, &pane, &hits), VIRGA_NOT_READY);
    rain_fixture_record_step(&f, cmd, 1.0 / 24);
    assert_int_equal(virga_rain_find_hits(f.rain, cmd, NULL, &hits), VIRGA_ERROR_INVALID);
    pane.along_u[0] = 2;
    assert_int_equal(virga_rain_find_hits(f.rain, cmd, &pane, &hits), VIRGA_ERROR_INVALID);
    pane.along_u[0] = 1;
    pane.width_m = NAN;
    assert_int_equal(virga_rain_find_hits(f.rain, cmd, &pane, &hits), VIRGA_ERROR_INVALID);
    pane.width_m = 1;
    for (int i = 0; i < 2; i++)
        assert_int_equal(virga_rain_find_hits(f.rain, cmd, &pane, &hits), VIRGA_OK);
    assert_int_equal(virga_rain_find_hits(f.rain, cmd, &pane, &hits), VIRGA_ERROR_INVALID);
    rain_fixture_end_frame(&f);
    close_rain();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lying_pane_gets_the_rate),  cmocka_unit_test(drops_lie_evenly_on_a_pane),
        cmocka_unit_test(a_driving_pane_meets_more), cmocka_unit_test(nothing_meets_a_pane_under_a_roof),
        cmocka_unit_test(wrong_panes_are_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
