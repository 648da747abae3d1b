/* test_rain_field.c - the field of drops: a function of seed, position and time, for any camera. */
#include "rain_fixture.h"

#include <math.h>

static void open_field(rain_fixture *f, float wind_x, uint32_t seed)
{
    virga_rain_def def = virga_default_rain_def();
    def.max_drops = 16384;
    def.range_m = 8;
    def.occlusion_size = 256;
    def.seed = seed;
    rain_fixture_open(f);
    rain_fixture_floor(f);
    rain_fixture_rain(f, &def);
    f->settings.rate_mm_h = 25;
    f->settings.wind_m_s[0] = wind_x;
    f->settings.gust_m_s = wind_x != 0 ? 1 : 0;
    f->camera[1] = 1.7;
    assert_int_equal(virga_rain_set(f->rain, &f->settings), VIRGA_OK);
}

static uint64_t hash_state(const rain_fixture *f)
{
    const virga_impact_gpu *list;
    const virga_impacts_gpu *head = rain_fixture_impacts(f, &list);
    uint64_t hash = rain_fixture_hash(rain_fixture_drops(f), f->slots * sizeof(virga_drop_gpu), HASH_START);
    hash = rain_fixture_hash(head, 16, hash);
    return rain_fixture_hash(list, head->count * sizeof *list, hash);
}

static uint64_t hash_of_run(uint32_t seed)
{
    rain_fixture f;
    open_field(&f, 3, seed);
    uint64_t hash = HASH_START;
    for (int i = 0; i < 5; i++) {
        rain_fixture_step(&f, 1.0 / 24);
        const uint64_t state = hash_state(&f);
        hash = rain_fixture_hash(&state, sizeof state, hash);
    }
    rain_fixture_close(&f);
    return hash;
}

static void two_runs_give_the_same_bits(void **state)
{
    (void)state;
    assert_true(hash_of_run(7) == hash_of_run(7));
}

static void passes_for_software_and_for_a_gpu_give_the_same_bits(void **state)
{
    (void)state;
    effect_fixture_variants = VIRGA_VARIANTS_SOFTWARE;
    const uint64_t software = hash_of_run(7);
    effect_fixture_variants = VIRGA_VARIANTS_GPU;
    assert_true(hash_of_run(7) == software);
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
}

static void another_seed_gives_another_field(void **state)
{
    (void)state;
    assert_true(hash_of_run(7) != hash_of_run(8));
}

static void a_cut_of_the_camera_and_back_shows_the_same_drops(void **state)
{
    (void)state;
    rain_fixture f;
    open_field(&f, 3, 1);
    rain_fixture_step(&f, 0.5);
    const uint64_t before = rain_fixture_hash(rain_fixture_drops(&f), f.slots * sizeof(virga_drop_gpu), HASH_START);
    f.camera[0] = 5000;
    rain_fixture_step(&f, 0);
    assert_true(before != rain_fixture_hash(rain_fixture_drops(&f), f.slots * sizeof(virga_drop_gpu), HASH_START));
    f.camera[0] = 0;
    rain_fixture_step(&f, 0);
    assert_true(before == rain_fixture_hash(rain_fixture_drops(&f), f.slots * sizeof(virga_drop_gpu), HASH_START));
    rain_fixture_close(&f);
}

static void the_way_of_the_camera_does_not_matter(void **state)
{
    (void)state;
    uint64_t hashes[2];
    for (int run = 0; run < 2; run++) {
        rain_fixture f;
        open_field(&f, 3, 1);
        for (int i = 0; i < 6; i++) {
            f.camera[2] = run ? 40.0 * i : 0;
            f.camera[0] = i == 5 ? 12 : run ? -7.0 * i : 3;
            f.camera[2] = i == 5 ? -4 : f.camera[2];
            rain_fixture_step(&f, 1.0 / 24);
        }
        hashes[run] = rain_fixture_hash(rain_fixture_drops(&f), f.slots * sizeof(virga_drop_gpu), HASH_START);
        rain_fixture_close(&f);
    }
    assert_true(hashes[0] == hashes[1]);
}

/* The drops of one look by slot, in the world. */
typedef struct look {
    double position[3];
    uint32_t id;
} look;

static look *copy_look(const rain_fixture *f)
{
    look *drops = malloc(f->slots * sizeof *drops);
    for (uint32_t i = 0; i < f->slots; i++) {
        drops[i].id = rain_fixture_drops(f)[i].id;
        for (int axis = 0; axis < 3; axis++)
            drops[i].position[axis] = (double)rain_fixture_drops(f)[i].position[axis] + f->origin[axis];
    }
    return drops;
}

static void a_moved_camera_sees_the_same_drops_at_the_same_positions(void **state)
{
    (void)state;
    rain_fixture f;
    open_field(&f, 3, 1);
    rain_fixture_step(&f, 0.5);
    look *before = copy_look(&f);
    f.camera[0] = 0.3;
    f.camera[1] = 1.9;
    rain_fixture_step(&f, 0);
    look *after = copy_look(&f);
    uint32_t same = 0, strange = 0;
    for (uint32_t i = 0; i < f.slots; i++) {
        if (before[i].id != after[i].id)
            continue;
        double moved = 0;
        for (int axis = 0; axis < 3; axis++)
            moved = fmax(moved, fabs(before[i].position[axis] - after[i].position[axis]));
        /* A slot whose drop left the box shows another one, whose id is the same once in 1024 times. */
        same += moved < 1e-5;
        strange += moved >= 1e-5;
    }
    assert_true(strange <= f.slots / 2000);
    printf("%u of %u drops are in both looks\n", same, f.slots);
    assert_true(same > f.slots * 3 / 4);
    free(before);
    free(after);
    rain_fixture_close(&f);
}

static void ids_are_unique(void **state)
{
    (void)state;
    rain_fixture f;
    open_field(&f, 3, 1);
    rain_fixture_step(&f, 0.5);
    /* The low bits are the slot, so two drops alive can not share an id. */
    for (uint32_t i = 0; i < f.slots; i++)
        assert_int_equal(rain_fixture_drops(&f)[i].id & ((1u << VIRGA_RAIN_ID_SLOT_BITS) - 1), i);
    rain_fixture_close(&f);
}

/* Still air: each drop that stays falls by its terminal speed; the set of speeds seen must be those of real sizes. */
static void drops_fall_by_the_table_in_still_air(void **state)
{
    (void)state;
    rain_fixture f;
    open_field(&f, 0, 1);
    rain_fixture_step(&f, 0.5);
    look *before = copy_look(&f);
    rain_fixture_step(&f, 1.0 / 60);
    look *after = copy_look(&f);
    uint32_t checked = 0;
    const double slowest = virga_drop_terminal_speed(VIRGA_DROP_MIN_M, 0),
                 fastest = virga_drop_terminal_speed(VIRGA_DROP_MAX_M, 0);
    for (uint32_t i = 0; i < f.slots; i++) {
        if (before[i].id != after[i].id)
            continue;
        const double speed = (before[i].position[1] - after[i].position[1]) * 60;
        assert_true(speed > slowest * 0.98 && speed < fastest * 1.02);
        assert_true(fabs(before[i].position[0] - after[i].position[0]) < 1e-5);
        checked++;
    }
    assert_true(checked > f.slots / 2);
    free(before);
    free(after);
    rain_fixture_close(&f);
}

static void a_new_rate_moves_no_drop(void **state)
{
    (void)state;
    uint64_t hashes[2];
    for (int run = 0; run < 2; run++) {
        rain_fixture f;
        open_field(&f, 3, 1);
        rain_fixture_step(&f, 0.1);
        f.settings.rate_mm_h = run ? 80 : 25;
        f.settings.sizes.kind = run ? VIRGA_SIZES_BEST : VIRGA_SIZES_MARSHALL_PALMER;
        assert_int_equal(virga_rain_set(f.rain, &f.settings), VIRGA_OK);
        rain_fixture_step(&f, 0.2);
        hashes[run] = rain_fixture_hash(rain_fixture_drops(&f), f.slots * sizeof(virga_drop_gpu), HASH_START);
        rain_fixture_close(&f);
    }
    assert_true(hashes[0] == hashes[1]);
}

static void far_from_the_origin_the_field_is_as_fine(void **state)
{
    (void)state;
    rain_fixture f;
    open_field(&f, 0, 1);
    f.camera[0] = 3e6;
    rain_fixture_step(&f, 0.5);
    look *before = copy_look(&f);
    rain_fixture_step(&f, 1.0 / 60);
    look *after = copy_look(&f);
    for (uint32_t i = 0; i < f.slots; i++)
        if (before[i].id == after[i].id)
            assert_true(fabs(before[i].position[0] - after[i].position[0]) < 1e-5);
    free(before);
    free(after);
    rain_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_runs_give_the_same_bits),
        cmocka_unit_test(passes_for_software_and_for_a_gpu_give_the_same_bits),
        cmocka_unit_test(another_seed_gives_another_field),
        cmocka_unit_test(a_cut_of_the_camera_and_back_shows_the_same_drops),
        cmocka_unit_test(the_way_of_the_camera_does_not_matter),
        cmocka_unit_test(a_moved_camera_sees_the_same_drops_at_the_same_positions),
        cmocka_unit_test(ids_are_unique),
        cmocka_unit_test(drops_fall_by_the_table_in_still_air),
        cmocka_unit_test(a_new_rate_moves_no_drop),
        cmocka_unit_test(far_from_the_origin_the_field_is_as_fine),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
