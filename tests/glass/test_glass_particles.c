/* test_glass_particles.c - how blades and particles meet drops. */
#include "glass_even_fixture.h"

/* Water of a particle, nl: a hemisphere. */
static uint32_t particle_water(void)
{
    return (uint32_t)(2 * M_PI / 3 * pow((double)f.settings.particle_radius_mm * 1e-3, 3) * NL_OF_M3);
}

/* One blade across a pane that is 0.16 m wide, which the host moves. */
static void open_blade(float from_deg)
{
    open_even(NULL);
    f.settings.wiper_count = 1;
    virga_glass_wiper *wiper = &f.settings.wipers[0];
    wiper->pivot_m[0] = 0.08f;
    wiper->pivot_m[1] = -0.02f;
    wiper->reach_m = 0.13f;
    wiper->blade_m = 0.11f;
    wiper->drive = VIRGA_GLASS_HOST;
    wiper->host_deg = from_deg;
    glass_fixture_step(&f, 1, false);
}

/* So that nothing but the blade moves them. */
static void lay_flat(void)
{
    f.info.world_from_pane[0] = 1;
    f.info.world_from_pane[5] = -1;
    f.info.world_from_pane[7] = 1;
}

static void turn_to(float deg, uint32_t ticks)
{
    f.settings.wipers[0].host_deg = deg;
    glass_fixture_step(&f, ticks, true);
}

static uint32_t count_of(uint32_t kind)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        count += glass_fixture_kind(&f.drops[i]) == kind;
    return count;
}

/* Deepest overlap of two particles, in radii. */
static double deepest_overlap(void)
{
    double deepest = 0;
    const double radius = (double)f.settings.particle_radius_mm * 1e-3;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        for (uint32_t k = 0; k < i; k++) {
            const virga_glass_drop_gpu *a = &f.drops[i], *b = &f.drops[k];
            if (glass_fixture_kind(a) != VIRGA_GLASS_PARTICLE || glass_fixture_kind(b) != VIRGA_GLASS_PARTICLE)
                continue;
            const double apart =
                hypot((double)a->position[0] - (double)b->position[0], (double)a->position[1] - (double)b->position[1]);
            deepest = fmax(deepest, 2 - apart / radius);
        }
    return deepest;
}

/* Section 4.4: a drop of the water of three particles becomes three. */
static void a_drop_becomes_as_many_particles_as_its_water_gives(void **unused)
{
    (void)unused;
    open_blade(60);
    const uint32_t particle = particle_water();
    glass_fixture_land(&f, 0.08, 0.06, 3 * particle);
    turn_to(60, 1);
    assert_int_equal(count_of(VIRGA_GLASS_DROP), 1);
    turn_to(120, 20);
    assert_int_equal(count_of(VIRGA_GLASS_PARTICLE), 3);
    assert_int_equal(count_of(VIRGA_GLASS_DROP), 0);
    uint32_t min = UINT32_MAX, max = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_PARTICLE) {
            min = f.drops[i].water_nl < min ? f.drops[i].water_nl : min;
            max = f.drops[i].water_nl > max ? f.drops[i].water_nl : max;
        }
    assert_true(max - min <= 1);
    glass_fixture_close(&f);
}

static void particles_settle_apart_in_front_of_the_blade(void **unused)
{
    (void)unused;
    open_blade(45);
    lay_flat();
    for (uint32_t i = 0; i < 40; i++)
        glass_fixture_land(&f, 0.06 + 0.04 * (double)virga_unit(virga_hash1(i)),
                           0.03 + 0.06 * (double)virga_unit(virga_hash1(i + 100)), particle_water());
    turn_to(45, 1);
    turn_to(110, 24);
    assert_in_range(count_of(VIRGA_GLASS_PARTICLE), 20, 40);
    turn_to(110, 60);
    print_message("%u particles, deepest overlap %.3f radii\n", count_of(VIRGA_GLASS_PARTICLE), deepest_overlap());
    assert_true(deepest_overlap() < 0.05);
    glass_fixture_close(&f);
}

/* The most particles that overlap one which has another within a radius. */
static uint32_t most_crowded(void)
{
    const double radius = (double)f.settings.particle_radius_mm * 1e-3;
    uint32_t most = 0;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++) {
        uint32_t around = 0, close = 0;
        for (uint32_t k = 0; k < f.glass->def.max_drops; k++) {
            const virga_glass_drop_gpu *a = &f.drops[i], *b = &f.drops[k];
            if (i == k || glass_fixture_kind(a) != VIRGA_GLASS_PARTICLE ||
                glass_fixture_kind(b) != VIRGA_GLASS_PARTICLE)
                continue;
            const double apart =
                hypot((double)a->position[0] - (double)b->position[0], (double)a->position[1] - (double)b->position[1]);
            around += apart < 2 * radius;
            close += apart < radius;
        }
        most = close && around > most ? around : most;
    }
    return most;
}

/* Lands drops right before the blade, along it. */
static void land_before_blade(float deg, uint32_t tick)
{
    const double angle = (double)deg * M_PI / 180 + 0.12;
    for (uint32_t i = 0; i < 12; i++) {
        const double from_pivot = 0.05 + 0.006 * (i + (double)virga_unit(virga_hash2(tick, i)));
        glass_fixture_land(&f, 0.08 + from_pivot * cos(angle), -0.02 + from_pivot * sin(angle), 3 * particle_water());
    }
}

/* The blade gathers the water of 1000 particles, of which the strip before it has room for 150 side by side. */
static void particles_in_a_crowd_merge_and_keep_their_water(void **unused)
{
    (void)unused;
    open_blade(45);
    lay_flat();
    turn_to(45, 1);
    uint32_t most = 0;
    for (uint32_t i = 0; i < 28; i++) {
        land_before_blade(45 + 2.5f * (float)i, i);
        turn_to(45 + 2.5f * (float)i, 1);
        most = count_of(VIRGA_GLASS_PARTICLE) > most ? count_of(VIRGA_GLASS_PARTICLE) : most;
    }
    const uint32_t in_motion = most_crowded(), crowd = f.glass->blades.crowd;
    turn_to(45 + 2.5f * 27, 30);
    print_message("at most %u particles; in motion %u overlap one, at rest %u, of at most %u; %u particles' water\n",
                  most, in_motion, most_crowded(), crowd, (uint32_t)(glass_fixture_water(&f) / particle_water()));
    assert_in_range(crowd, 12, 15);
    assert_true(in_motion < 2 * crowd && most_crowded() <= crowd);
    assert_int_equal(glass_fixture_count(&f, VIRGA_GLASS_LANDED), glass_fixture_water(&f) +
                                                                      glass_fixture_count(&f, VIRGA_GLASS_WIPED) +
                                                                      glass_fixture_count(&f, VIRGA_GLASS_RUN_OFF));
    glass_fixture_close(&f);
}

#define LEFT UINT32_MAX

/* The grid's cell of the particle at a place among the sorted ones; LEFT: it became a drop since. Counts how often each
 * particle has a place. */
static uint32_t cell_of_place(uint32_t place, uint8_t *places)
{
    const uint32_t *listed = f.list + sizeof(virga_list_gpu) / 4, *active = f.active + sizeof(virga_list_gpu) / 4;
    const uint32_t number = f.moved[3 * place + 2];
    REQUIRE(number < f.state->active_particles);
    places[number]++;
    const virga_glass_drop_gpu *drop = &f.drops[listed[active[number]]];
    return glass_fixture_kind(drop) == VIRGA_GLASS_DROP ? LEFT : drop->cell;
}

/* What the passes that sort left of the newest tick: every particle has one place, and those of a cell are together. */
static void sorted_particles_have_one_place_each_by_cells(void **unused)
{
    (void)unused;
    static uint8_t places[1024], seen[4096];
    open_blade(45);
    lay_flat();
    f.settings.particle_band = 16; /* all of them stay particles */
    turn_to(45, 1);
    for (uint32_t i = 0; i < 16; i++) {
        land_before_blade(45 + 2.5f * (float)i, i + 50);
        turn_to(45 + 2.5f * (float)i, 1);
    }
    const uint32_t count = f.state->active_particles;
    uint32_t runs = 0, before = LEFT;
    for (uint32_t place = 0; place < count; place++) {
        const uint32_t cell = cell_of_place(place, places);
        if (cell == before || cell == LEFT)
            continue;
        REQUIRE(cell < sizeof seen && !seen[cell]); /* its particles are not apart from each other */
        seen[cell] = 1;
        before = cell;
        runs++;
    }
    for (uint32_t i = 0; i < count; i++)
        REQUIRE(places[i] == 1);
    print_message("%u particles in %u cells\n", count, runs);
    REQUIRE(count > 100 && runs > 20 && runs < count);
    glass_fixture_close(&f);
}

/* Sections 4.5 and 4.6: particles that the blade left behind become drops, but not beside a large one; once that has
 * run away, within a second. */
static void held_particles_become_drops_when_the_way_is_free(void **unused)
{
    (void)unused;
    open_blade(45);
    glass_fixture_land(&f, 0.08, 0.08, particle_water());
    turn_to(45, 1);
    turn_to(90, 12);
    assert_int_equal(count_of(VIRGA_GLASS_PARTICLE), 1);
    const virga_glass_drop_gpu *particle = NULL;
    for (uint32_t i = 0; i < f.glass->def.max_drops; i++)
        if (glass_fixture_kind(&f.drops[i]) == VIRGA_GLASS_PARTICLE)
            particle = &f.drops[i];
    REQUIRE(particle);
    f.settings.drag = 100; /* the large one creeps */
    glass_fixture_land(&f, (double)particle->position[0] - 0.005, (double)particle->position[1], water_of(3e-3));
    turn_to(45, 12);
    turn_to(45, 30);
    assert_int_equal(count_of(VIRGA_GLASS_PARTICLE), 1);
    f.settings.drag = 1;
    turn_to(45, 20); /* it runs away */
    turn_to(45, 60);
    assert_int_equal(count_of(VIRGA_GLASS_PARTICLE), 0);
    assert_true(glass_fixture_count(&f, VIRGA_GLASS_TO_DROPS) == 1);
    glass_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_drop_becomes_as_many_particles_as_its_water_gives),
        cmocka_unit_test(particles_settle_apart_in_front_of_the_blade),
        cmocka_unit_test(particles_in_a_crowd_merge_and_keep_their_water),
        cmocka_unit_test(sorted_particles_have_one_place_each_by_cells),
        cmocka_unit_test(held_particles_become_drops_when_the_way_is_free),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
