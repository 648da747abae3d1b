/* Spray: which particles are splash particles, and the droplets that they become (section 4.1 of the paper). */
#include "water_fixture.h"

#include "water/spray_kernel.h"

static water_fixture f;

static void set_up(void)
{
    water_fixture_open(&f);
    f.settings.spacing_m = 0.02f;
    f.settings.spray_density = 0.45f;
    f.settings.style = VIRGA_WATER_STYLE_PAPER;
}

static double distance(const float a[3], const float b[3])
{
    double r2 = 0;
    for (int k = 0; k < 3; k++)
        r2 += pow((double)a[k] - (double)b[k], 2);
    return sqrt(r2);
}

/* A particle on its own with a speed along x. */
static void add_drop(double x, double y, double speed)
{
    water_fixture_add(&f, x, y, 0.5)->velocity[0] = (float)speed;
}

/* Water with drops above it, at speeds from 0 to 5 m/s. */
static void put_water(void)
{
    const double low[3] = {0, 0, 0};
    const uint32_t counts[3] = {10, 8, 6};
    water_fixture_box(&f, low, counts, 0.02, 0.1);
    for (int i = 0; i < 24; i++)
        add_drop(0.1 * (i % 6), 0.1 * (i / 6), 0.2 * i);
}

static double volume_m3(void)
{
    return pow((double)f.settings.spacing_m, 3);
}

static uint32_t pieces_at(double speed)
{
    return 1 + (uint32_t)((f.settings.spray_pieces - 1) * fmin(speed / (double)f.settings.spray_speed_m_s, 1) + 1e-6);
}

/* Equation 4 as it stands, and the condition below it. */
static void a_droplet_has_the_density_of_the_surface_at_its_radius(void **state)
{
    (void)state;
    const double levels[] = {0.05, 0.1, 0.25, 0.37, 0.374};
    for (size_t i = 0; i < sizeof levels / sizeof *levels; i++)
        for (int pieces = 1; pieces <= 32; pieces += 8) {
            const double d = 0.013, volume = d * d * d / pieces, radius = cbrt(3 / (4 * M_PI * pieces)) * d;
            double ratio, factor, level;
            water_spray_kernel(levels[i], &ratio, &factor, &level);
            const double h = ratio * radius;
            const double density = 315 / (64 * M_PI * pow(h, 9)) * pow(h * h - radius * radius, 3) * volume;
            assert_float_equal(density, levels[i], 1e-9);
            assert_float_equal(factor, 315 * volume / (64 * M_PI * h * h * h), 1e-9);
            REQUIRE(ratio > 1 && ratio < 1.74);
        }
}

/* No radius h' gives more than 0.3742: there the level of droplets ends. */
static void above_the_largest_level_droplets_keep_their_radius(void **state)
{
    (void)state;
    double largest = 0, ratio, factor, level;
    for (double x = 0; x < 1; x += 1e-4)
        largest = fmax(largest, 105.0 / 16 * pow(x * (1 - x * x), 3));
    water_spray_kernel(0.5, &ratio, &factor, &level);
    REQUIRE(level < largest && level > 0.999 * largest);
    assert_float_equal(factor * pow(1 - 1 / (ratio * ratio), 3), level, 1e-9);
}

static void particles_of_low_density_become_spray_and_no_others(void **state)
{
    (void)state;
    set_up();
    put_water();
    f.settings.spray_pieces = 1;
    water_fixture_step(&f);
    uint32_t expected = 0;
    for (uint32_t i = 0; i < f.count; i++) {
        const double at[3] = {(double)f.particles[i].position[0], (double)f.particles[i].position[1],
                              (double)f.particles[i].position[2]};
        expected += water_reference(&f, at, NULL) < (double)f.settings.spray_density;
    }
    REQUIRE(expected >= 24 && expected < 60);
    assert_int_equal(f.stats.splashes, expected);
    assert_int_equal(f.stats.droplets, expected);
    water_fixture_close(&f);
}

static void spray_leaves_the_surface(void **state)
{
    (void)state;
    set_up();
    put_water();
    f.settings.level = 0.1f; /* so that drops on their own have a surface */
    f.settings.spray_density = 0;
    f.count = 480;
    water_fixture_step(&f);
    const uint32_t water_alone = f.stats.surfels;
    f.count = 504;
    water_fixture_step(&f);
    REQUIRE(f.stats.surfels > water_alone + 100);
    f.settings.spray_density = 0.22f;
    water_fixture_step(&f);
    assert_int_equal(f.stats.splashes, 24);
    assert_int_equal(f.stats.surfels, water_alone + VIRGA_WATER_DROPLET_SURFELS * f.stats.droplets);
    water_fixture_close(&f);
}

/* A point of the pattern in the unit ball: see shaders/water/spray/pattern.glsl. The radius is the cube root of the van
 * der Corput sequence. */
static void pattern_point(uint32_t id, uint32_t i, uint32_t count, double point[3])
{
    const double angle = 2.39996323 * i + 2 * M_PI * (double)virga_unit(virga_hash1(id));
    const double z = 1 - (2 * i + 1.0) / count, side = sqrt(1 - z * z);
    double share = 0;
    for (uint32_t rest = i + 1, digit = 1; rest; rest /= 2, digit++)
        share += (rest & 1) * pow(0.5, digit);
    point[0] = cbrt(share) * side * cos(angle);
    point[1] = cbrt(share) * side * sin(angle);
    point[2] = cbrt(share) * z;
}

/* Where the droplets of a particle are, for each number of them from 1 to 25. */
static void droplets_have_the_pattern_of_their_number(void **state)
{
    (void)state;
    set_up();
    f.settings.spray_pieces = 25;
    for (int i = 0; i < 25; i++) {
        add_drop(0.1 * (i % 5), 0.1 * (i / 5), (i + 0.5) / 24 * (double)f.settings.spray_speed_m_s);
        f.particles[i].id = 1000 + 77 * (uint32_t)i;
    }
    water_fixture_step(&f);
    uint32_t at = 0;
    for (uint32_t i = 0; i < 25; i++) {
        const uint32_t count = i < 24 ? i + 1 : 25;
        for (uint32_t k = 0; k < count; k++, at++) {
            double point[3] = {0};
            if (count > 1)
                pattern_point(f.particles[i].id, k, count, point);
            for (int axis = 0; axis < 3; axis++)
                assert_float_equal((double)f.droplets[at].position[axis],
                                   (double)f.particles[i].position[axis] +
                                       0.02 * (double)f.settings.spray_pattern * point[axis],
                                   1e-6);
        }
    }
    assert_int_equal(f.stats.droplets, at);
    water_fixture_close(&f);
}

/* Equation 3, and the number of droplets by the speed. */
static void droplets_share_the_volume_of_their_particle(void **state)
{
    (void)state;
    set_up();
    for (int i = 0; i < 24; i++)
        add_drop(0.1 * (i % 6), 0.1 * (i / 6), 0.2 * i);
    f.particles[3].share = 0.5f;
    water_fixture_step(&f);
    uint32_t at = 0, wanted = 0;
    double volume = 0;
    for (uint32_t i = 0; i < f.count; i++)
        wanted += pieces_at(0.2 * i);
    assert_int_equal(f.stats.droplets, wanted);
    for (; at < f.stats.droplets; at++) {
        const virga_spray_gpu *droplet = &f.droplets[at];
        const uint32_t particle = (uint32_t)(droplet->velocity[0] / 0.2f + 0.5f), pieces = pieces_at(0.2 * particle);
        const double share = particle == 3 ? 0.5 : 1, r = cbrt(3 * share / (4 * M_PI * pieces)) * 0.02;
        /* Shares below 1 are known to 1/255. */
        assert_float_equal((double)droplet->radius, r, 2e-7 * 0.02 + (share < 1 ? 2e-3 : 1e-6) * r);
        REQUIRE(distance(droplet->position, f.particles[particle].position) <=
                (pieces > 1 ? 1.0001 * 0.02 * (double)f.settings.spray_pattern : 1e-7));
        volume += 4 * M_PI / 3 * pow((double)droplet->radius, 3);
    }
    assert_float_equal(volume / volume_m3(), 23.5, 3e-3);
    water_fixture_close(&f);
}

static uint32_t droplets_at_speed(double speed, double step_s)
{
    f.time_s += step_s;
    f.particles[0].velocity[0] = (float)speed;
    water_fixture_step(&f);
    return f.stats.droplets;
}

static void the_largest_speed_counts_until_the_particle_is_water_again(void **state)
{
    (void)state;
    const double low[3] = {0, 0, 0};
    const uint32_t counts[3] = {8, 8, 8};
    set_up();
    add_drop(1, 1, 0);
    assert_int_equal(droplets_at_speed(1.001, 0.01), 7);
    assert_int_equal(droplets_at_speed(2.001, 0.01), 13);
    assert_int_equal(droplets_at_speed(0.5, 0.01), 13);
    assert_int_equal(droplets_at_speed(9, 0.01), 25);
    assert_int_equal(droplets_at_speed(0.5, 0.3), 4); /* too long after the last step */
    assert_int_equal(droplets_at_speed(2.001, 0.01), 13);
    assert_int_equal(droplets_at_speed(0.5, -0.01), 4); /* back in time */
    assert_int_equal(droplets_at_speed(2.001, 0.01), 13);
    f.particles[0].id = 77; /* another one */
    assert_int_equal(droplets_at_speed(0.5, 0.01), 4);
    assert_int_equal(droplets_at_speed(2.001, 0.01), 13);
    water_fixture_box(&f, low, counts, 0.02, 0);
    f.particles[0].position[0] = f.particles[0].position[1] = f.particles[0].position[2] = 0.07f;
    const uint32_t corners = droplets_at_speed(0.5, 0.01);
    f.particles[0].position[0] = 1;
    assert_int_equal(droplets_at_speed(0.5, 0.01), corners + 4);
    water_fixture_close(&f);
}

static void sub_frames_leave_no_state(void **state)
{
    (void)state;
    set_up();
    add_drop(1, 1, 0);
    assert_int_equal(droplets_at_speed(2.001, 0.01), 13);
    f.sub_frame = true;
    assert_int_equal(droplets_at_speed(9, -0.005), 25);
    assert_int_equal(droplets_at_speed(0.5, 0.002), 13); /* as in the frame */
    f.sub_frame = false;
    assert_int_equal(droplets_at_speed(0.5, 0.01), 13);
    assert_int_equal(droplets_at_speed(1.001, 0.01), 13);
    water_fixture_close(&f);
}

static void states_follow_ids_through_any_order_and_number(void **state)
{
    (void)state;
    set_up();
    f.settings.spray_pieces = 2;
    for (int i = 0; i < 3000; i++)
        water_fixture_add(&f, 0.06 * (i % 20), 0.06 * (i / 20 % 15), 0.06 * (i / 300))->velocity[1] = i % 3 ? 0 : 9;
    for (uint32_t i = 0; i < f.count; i++)
        f.particles[i].id = virga_hash1(f.particles[i].id) & 0xfffffff0u; /* many share the end of their ids */
    water_fixture_step(&f);
    assert_int_equal(f.stats.droplets, 4000);
    for (uint32_t i = 0; i < f.count; i++) {
        const uint32_t other = virga_hash1(i) % f.count;
        const virga_particle_gpu swapped = f.particles[i];
        f.particles[i] = f.particles[other];
        f.particles[other] = swapped;
    }
    for (uint32_t i = 0; i < f.count; i++)
        f.particles[i].velocity[1] = 0;
    for (int i = 0; i < 3; i++) {
        f.time_s += 0.01;
        water_fixture_step(&f);
        assert_int_equal(f.stats.droplets, 4000);
    }
    water_fixture_close(&f);
}

static void the_order_of_particles_changes_no_bit_of_the_spray(void **state)
{
    (void)state;
    static virga_spray_gpu before[1024];
    set_up();
    put_water();
    water_fixture_step(&f);
    const uint32_t droplets = f.stats.droplets;
    REQUIRE(droplets < 1024);
    memcpy(before, f.droplets, droplets * sizeof *before);
    for (uint32_t i = 0; i < f.count / 2; i++) {
        const virga_particle_gpu swapped = f.particles[i];
        f.particles[i] = f.particles[f.count - 1 - i];
        f.particles[f.count - 1 - i] = swapped;
    }
    water_fixture_step(&f);
    assert_int_equal(f.stats.droplets, droplets);
    assert_memory_equal(before, f.droplets, droplets * sizeof *before);
    water_fixture_close(&f);
}

/* Density of droplets that overlap: equation 4, summed. */
static double spray_density(uint32_t first, uint32_t end, const float at[3])
{
    double sum = 0, ratio, factor, level;
    water_spray_kernel((double)f.settings.level, &ratio, &factor, &level);
    for (uint32_t i = first; i < end; i++) {
        const double q = distance(at, f.droplets[i].position) / (ratio * (double)f.droplets[i].radius);
        sum += q < 1 ? factor * pow(1 - q * q, 3) : 0;
    }
    return sum / level;
}

static void surfels_of_spray_lie_on_the_surface_of_touching_droplets(void **state)
{
    (void)state;
    set_up();
    f.settings.level = 0.2f;
    f.settings.spray_density = 0.4f;
    f.settings.spray_pattern = 0.5f;
    f.settings.spray_pieces = 9;
    add_drop(0, 0, 9);
    water_fixture_step(&f);
    assert_int_equal(f.stats.droplets, 9);
    assert_int_equal(f.stats.surfels, 9 * VIRGA_WATER_DROPLET_SURFELS);
    uint32_t shown = 0, outside = 0;
    for (uint32_t i = 0; i < f.stats.surfels; i++) {
        const virga_surfel_gpu *surfel = &f.surfels[i];
        const virga_spray_gpu *droplet = &f.droplets[i / VIRGA_WATER_DROPLET_SURFELS];
        if (surfel->radius == 0)
            continue;
        shown++;
        outside += distance(surfel->position, droplet->position) > 1.02 * (double)droplet->radius;
        assert_float_equal(spray_density(0, 9, surfel->position), 1, 0.02);
    }
    printf("%u surfels of 144 on the surface, %u of them where droplets touch\n", shown, outside);
    REQUIRE(shown > 40 && shown < 144 && outside > 10);
    water_fixture_close(&f);
}

/* The half of the states that the frame should have written is not read: it is that of the frame before the last. */
static void a_frame_that_is_thrown_away_leaves_no_states(void **state)
{
    (void)state;
    set_up();
    add_drop(1, 1, 0);
    assert_int_equal(droplets_at_speed(2.001, 0.01), 13);
    f.particles[0].id = 77;
    assert_int_equal(droplets_at_speed(0.5, 0.01), 4);
    f.particles[0].id = 0;
    water_fixture_throw_away(&f);
    assert_int_equal(droplets_at_speed(0.5, 0.01), 4);
    assert_int_equal(droplets_at_speed(2.001, 0.01), 13);
    assert_int_equal(droplets_at_speed(0.5, 0.01), 13);
    water_fixture_close(&f);
}

static void too_much_spray_is_counted(void **state)
{
    (void)state;
    virga_water_def def = water_fixture_def();
    def.max_spray = 64;
    def.max_droplets = 256;
    water_fixture_open_with(&f, &def, false);
    f.settings.spacing_m = 0.02f;
    f.settings.spray_density = 0.45f;
    f.settings.style = VIRGA_WATER_STYLE_PAPER;
    for (int i = 0; i < 100; i++)
        add_drop(0.1 * (i % 10), 0.1 * (i / 10), 2);
    water_fixture_step(&f);
    assert_int_equal(f.stats.splashes, 64);
    assert_int_equal(f.stats.splashes_dropped, 36);
    assert_int_equal(f.stats.droplets, 256);
    assert_int_equal(f.stats.droplets_dropped, 64 * 13 - 256);
    water_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_droplet_has_the_density_of_the_surface_at_its_radius),
        cmocka_unit_test(above_the_largest_level_droplets_keep_their_radius),
        cmocka_unit_test(particles_of_low_density_become_spray_and_no_others),
        cmocka_unit_test(spray_leaves_the_surface),
        cmocka_unit_test(droplets_have_the_pattern_of_their_number),
        cmocka_unit_test(droplets_share_the_volume_of_their_particle),
        cmocka_unit_test(the_largest_speed_counts_until_the_particle_is_water_again),
        cmocka_unit_test(sub_frames_leave_no_state),
        cmocka_unit_test(states_follow_ids_through_any_order_and_number),
        cmocka_unit_test(the_order_of_particles_changes_no_bit_of_the_spray),
        cmocka_unit_test(surfels_of_spray_lie_on_the_surface_of_touching_droplets),
        cmocka_unit_test(a_frame_that_is_thrown_away_leaves_no_states),
        cmocka_unit_test(too_much_spray_is_counted),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
