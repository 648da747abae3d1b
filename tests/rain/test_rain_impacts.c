/* test_rain_impacts.c - what lands is the rain that was asked for: in litres, in sizes and in speeds. */
#include "rain_fixture.h"

#include "rain/rain_internal.h"

#include <math.h>

/* Impacts on a square of floor, gathered over some time. */
typedef struct landed {
    float half_m;                 /* half of its side, seen from above */
    double water_m3, variance_m6; /* and the variance of the sum, each impact counted as a Poisson event */
    double number;
    uint32_t impacts;
    double *diameters, *weights;
} landed;

enum { MAX_IMPACTS = 4000000, MAP_SIZE = 256 };

static void gather(const rain_fixture *f, landed *sum)
{
    const virga_impact_gpu *list;
    const virga_impacts_gpu *head = rain_fixture_impacts(f, &list);
    assert_int_equal(head->dropped, 0);
    for (uint32_t i = 0; i < head->count; i++) {
        const float x = list[i].position[0] + head->origin[0], z = list[i].position[2] + head->origin[2];
        if (fabsf(x) > sum->half_m || fabsf(z) > sum->half_m || sum->impacts == MAX_IMPACTS)
            continue;
        const double volume = virga_drop_volume((double)list[i].diameter_m), weight = (double)list[i].weight;
        sum->water_m3 += weight * volume;
        sum->variance_m6 += weight * weight * volume * volume;
        sum->number += weight;
        sum->diameters[sum->impacts] = (double)list[i].diameter_m;
        sum->weights[sum->impacts++] = weight;
    }
}

/* A floor that rises by `slope` along x. */
static void sloping_floor(rain_fixture *f, float slope)
{
    const float low = -100 * slope, high = 100 * slope;
    const float quad[1][4][3] = {{{-100, low, -100}, {100, high, -100}, {100, high, 100}, {-100, low, 100}}};
    rain_fixture_quads(f, quad, 1);
}

static void run(rain_fixture *f, double rate, double seconds, float slope, uint32_t map_size, landed *sum)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 24576;
    def.range_m = 6;
    def.occlusion_size = map_size;
    def.tick_s = 1.0 / 30;
    def.seed = (uint32_t)rate;
    rain_fixture_open(f);
    sloping_floor(f, slope);
    rain_fixture_rain(f, &def);
    f->camera[1] = 1.7;
    f->settings.rate_mm_h = (float)rate;
    assert_int_equal(virga_rain_set(f->rain, &f->settings), VIRGA_OK);
    memset(sum, 0, sizeof *sum);
    sum->half_m = slope > 0 ? 1.25f : 2.5f;
    sum->diameters = malloc(MAX_IMPACTS * sizeof(double));
    sum->weights = malloc(MAX_IMPACTS * sizeof(double));
    for (int step = 0; step < (int)(seconds * 3); step++) {
        rain_fixture_step(f, 1.0 / 3);
        gather(f, sum);
    }
}

static void finish(rain_fixture *f, landed *sum)
{
    free(sum->diameters);
    free(sum->weights);
    rain_fixture_close(f);
}

static void check_rate(double rate, float slope, uint32_t map_size)
{
    rain_fixture f;
    landed sum;
    const double seconds = 60;
    run(&f, rate, seconds, slope, map_size, &sum);
    const double area_m2 = 4 * (double)sum.half_m * (double)sum.half_m;
    const double expected = rate * 1e-3 / 3600 * seconds * area_m2, noise = sqrt(sum.variance_m6);
    printf("%g mm/h: %u impacts, %.4f of the water asked for, counting noise %.2f %%\n", rate, sum.impacts,
           sum.water_m3 / expected, 100 * noise / expected);
    assert_true(fabs(sum.water_m3 - expected) <= 0.01 * expected + 2.5 * noise);
    finish(&f, &sum);
}

static void drizzle_lands_at_its_rate(void **state)
{
    (void)state;
    check_rate(1, 0, MAP_SIZE);
}

static void heavy_rain_lands_at_its_rate(void **state)
{
    (void)state;
    check_rate(25, 0, MAP_SIZE);
}

static void a_cloudburst_lands_at_its_rate(void **state)
{
    (void)state;
    check_rate(100, 0, MAP_SIZE);
}

/* Seen from above a hillside gets as much as a floor, also where a texel of the map is a step of half a metre. */
static void a_steep_slope_gets_its_rain(void **state)
{
    (void)state;
    check_rate(25, 2, 64);
}

typedef struct weighted {
    double diameter, weight;
} weighted;

static int by_diameter(const void *a, const void *b)
{
    const double x = ((const weighted *)a)->diameter, y = ((const weighted *)b)->diameter;
    return x < y ? -1 : x > y;
}

/* Kolmogorov and Smirnov with weights: the effective number of samples is (sum w)^2 / sum w^2. */
static void sizes_follow_the_distribution(void **state)
{
    (void)state;
    rain_fixture f;
    landed sum;
    run(&f, 25, 6, 0, MAP_SIZE, &sum);
    weighted *sorted = malloc(sum.impacts * sizeof *sorted);
    double squares = 0;
    for (uint32_t i = 0; i < sum.impacts; i++) {
        sorted[i] = (weighted){sum.diameters[i], sum.weights[i]};
        squares += sum.weights[i] * sum.weights[i];
    }
    qsort(sorted, sum.impacts, sizeof *sorted, by_diameter);
    const virga_sizes sizes = {VIRGA_SIZES_MARSHALL_PALMER, NULL, NULL, 0};
    double below = 0, max_distance = 0, share = 0, last = -1;
    for (uint32_t i = 0; i < sum.impacts; i++) {
        /* Halfway between classes, where a class's share ends. */
        if (sorted[i].diameter != last)
            share = virga_sizes_landing_share(&sizes, 25, 0, sorted[i].diameter * 1.00345);
        last = sorted[i].diameter;
        below += sorted[i].weight;
        if (i + 1 == sum.impacts || sorted[i + 1].diameter != last)
            max_distance = fmax(max_distance, fabs(below / sum.number - share));
    }
    const double effective = sum.number * sum.number / squares;
    printf("largest distance %.5f with %.0f effective samples, limit %.5f\n", max_distance, effective,
           1.63 / sqrt(effective));
    assert_true(max_distance < 1.63 / sqrt(effective));
    free(sorted);
    finish(&f, &sum);
}

static void impacts_have_the_speed_of_their_size(void **state)
{
    (void)state;
    rain_fixture f;
    landed sum;
    run(&f, 25, 1, 0, MAP_SIZE, &sum);
    const virga_impact_gpu *list;
    const virga_impacts_gpu *head = rain_fixture_impacts(&f, &list);
    assert_true(head->count > 100);
    for (uint32_t i = 0; i < head->count; i++) {
        const double speed = virga_drop_terminal_speed((double)list[i].diameter_m, 0);
        assert_true(fabs((double)-list[i].velocity[1] - speed) < 1e-3 * speed);
        assert_true(list[i].normal[1] > 0.999f);
        assert_true(fabsf(list[i].position[1] + head->origin[1]) < 1e-3f);
        assert_int_equal(list[i].material, 1);
        assert_true(list[i].time_s >= 0 && list[i].time_s <= (float)head->ticks * head->tick_s);
    }
    finish(&f, &sum);
}

static void water_in_nanolitres_adds_up_to_the_head(void **state)
{
    (void)state;
    rain_fixture f;
    landed sum;
    run(&f, 25, 1, 0, MAP_SIZE, &sum);
    const virga_impact_gpu *list;
    const virga_impacts_gpu *head = rain_fixture_impacts(&f, &list);
    uint64_t water = 0;
    double exact = 0;
    for (uint32_t i = 0; i < head->count; i++) {
        water += list[i].water_nl;
        exact += virga_drop_volume((double)list[i].diameter_m) * (double)list[i].weight * 1e12;
    }
    assert_true(water == ((uint64_t)head->water_nl_high << 32 | head->water_nl_low));
    assert_true(fabs((double)water - exact) < 4 * sqrt((double)head->count));
    finish(&f, &sum);
}

/* The head's group_count, read by an indirect dispatch right after the step: here of a pass of the rain's own, which is
 * harmless. Synchronization validation complains where nothing makes the dispatch wait. */
static void impacts_are_ready_as_indirect_arguments(void **state)
{
    (void)state;
    rain_fixture f;
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 24576;
    def.range_m = 6;
    rain_fixture_open(&f);
    rain_fixture_rain(&f, &def);
    const VkCommandBuffer cmd = rain_fixture_begin_frame(&f);
    rain_fixture_record_step(&f, cmd, def.tick_s);
    const virga_rain *rain = f.rain;
    const uint32_t tables = rain->tick_offset + (uint32_t)offsetof(rain_tick_block, tables);
    const uint32_t offsets[5] = {tables, 0, rain->tick_offset,
                                 rain->tick_offset + (uint32_t)offsetof(rain_tick_block, weights), 0};
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, rain->impact_mark->pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, rain->bindings->layout, 0, 1, &rain->step_set, 5,
                            offsets);
    virga_rain_buffer impacts;
    virga_rain_impacts(rain, &impacts);
    vkCmdDispatchIndirect(cmd, impacts.buffer, impacts.offset + offsetof(virga_impacts_gpu, group_count));
    rain_fixture_end_frame(&f);
    rain_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(impacts_have_the_speed_of_their_size),
        cmocka_unit_test(water_in_nanolitres_adds_up_to_the_head),
        cmocka_unit_test(sizes_follow_the_distribution),
        cmocka_unit_test(drizzle_lands_at_its_rate),
        cmocka_unit_test(heavy_rain_lands_at_its_rate),
        cmocka_unit_test(a_cloudburst_lands_at_its_rate),
        cmocka_unit_test(a_steep_slope_gets_its_rain),
        cmocka_unit_test(impacts_are_ready_as_indirect_arguments),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
