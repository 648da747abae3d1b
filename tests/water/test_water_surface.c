/* The surface of water: densities, the grid, and surfels against double precision. */
#include "water_fixture.h"

static water_fixture f;

/* Two blocks of water, a ball, and drops around them. */
static void put_water(void)
{
    const double low[3] = {-0.11, 0.02, 0.3}, high[3] = {0.19, 0.13, 0.37}, center[3] = {0.05, 0.35, 0.4};
    const uint32_t counts[3] = {12, 7, 9}, thin[3] = {9, 1, 8};
    uint32_t hash = 3;
    f.count = 0;
    f.settings.spacing_m = 0.02f;
    water_fixture_box(&f, low, counts, 0.02, 0.3);
    water_fixture_box(&f, high, thin, 0.02, 0.1);
    water_fixture_ball(&f, center, 0.07, 0.019);
    for (int i = 0; i < 40; i++)
        water_fixture_add(&f, water_random(&hash, -0.3, 0.5), water_random(&hash, -0.1, 0.6),
                          water_random(&hash, 0.1, 0.8))
            ->share = i % 3 ? 1 : 0.4f;
    for (uint32_t i = 0; i < f.count; i++)
        for (int axis = 0; axis < 3; axis++)
            f.particles[i].velocity[axis] = (float)(axis + 1);
}

/* For the whole range of the kernel's n, and both meanings of shares. */
static void densities_are_those_of_double_precision(void **state)
{
    (void)state;
    virga_water_def def = water_fixture_def();
    def.max_cells = 131072; /* cells are as wide as kernels */
    water_fixture_open_with(&f, &def, false);
    put_water();
    for (int n = 1; n <= 8; n++) {
        f.settings.kernel_spacings = (float)(1 + (n - 1) % 4);
        f.settings.fading = n <= 4 ? VIRGA_WATER_FADING_COVERAGE : VIRGA_WATER_FADING_VOLUME;
        water_fixture_step(&f);
        for (uint32_t i = 0; i < f.count; i++) {
            const double at[3] = {(double)f.particles[i].position[0], (double)f.particles[i].position[1],
                                  (double)f.particles[i].position[2]};
            const double expected = water_reference(&f, at, NULL);
            /* Shares of particles that are not whole are off by 1/32,768 of themselves. */
            if (fabs((double)f.densities[i] - expected) > 2e-5 + expected / 32768)
                fail_msg("n = %g, fading %d, particle %u: %.7f, expected %.7f", (double)f.settings.kernel_spacings,
                         f.settings.fading, i, (double)f.densities[i], expected);
        }
    }
    water_fixture_close(&f);
}

static void surfels_lie_on_the_surface_with_its_normal(void **state)
{
    (void)state;
    water_fixture_open(&f);
    put_water();
    water_fixture_step(&f);
    double worst = 0, worst_normal = 1;
    REQUIRE(f.stats.surfels > 1000 && !f.stats.surfels_dropped);
    for (uint32_t i = 0; i < f.stats.surfels; i++) {
        const virga_surfel_gpu *surfel = &f.surfels[i];
        const double at[3] = {(double)surfel->position[0], (double)surfel->position[1], (double)surfel->position[2]};
        double gradient[3], normal[3], length = 0, along = 0;
        const double missing = water_reference(&f, at, gradient) - (double)f.settings.level;
        water_unpack_normal(surfel->normal, normal);
        for (int axis = 0; axis < 3; axis++) {
            length += gradient[axis] * gradient[axis];
            along -= normal[axis] * gradient[axis];
        }
        worst = fmax(worst, fabs(missing) / sqrt(length));
        worst_normal = fmin(worst_normal, along / sqrt(length));
        REQUIRE(fabs((double)surfel->velocity[0] - 1) < 1e-4 && fabs((double)surfel->velocity[2] - 3) < 1e-4);
    }
    printf("off the surface by up to %g m; cosine of normals from %g\n", worst, worst_normal);
    REQUIRE(worst < 0.05 * 0.02);
    REQUIRE(worst_normal > 0.98);
    water_fixture_close(&f);
}

/* The mean cover of the particles around a point, with the weights of their densities. */
static double mean_cover(const double at[3])
{
    double sum = 0, covers = 0;
    for (uint32_t i = 0; i < f.count; i++) {
        double r2 = 0;
        for (int axis = 0; axis < 3; axis++)
            r2 += pow(at[axis] - (double)f.particles[i].position[axis], 2);
        const double weight = f.shares[i] * pow(fmax(1 - r2 / pow(water_h(&f), 2), 0), 3);
        sum += weight;
        covers += weight * f.covers[i];
    }
    return covers / sum;
}

/* Of a ball that fades, particles that fade among others, and what is whole. The share is in the lowest eight bits of
 * the radius. The cover is that before the last step of Newton's method, which moves the surfel by a little. */
static void surfels_have_the_share_of_the_water_around_them(void **state)
{
    (void)state;
    const double center[3] = {-0.2, 0.35, 0.4};
    double worst = 0, least = 1;
    uint32_t hash = 4;
    water_fixture_open(&f);
    put_water();
    for (uint32_t i = 0; i < f.count; i += 7)
        f.particles[i].share = (float)water_random(&hash, 0.1, 1);
    water_fixture_ball(&f, center, 0.07, 0.019);
    for (uint32_t i = f.count - 100; i < f.count; i++)
        f.particles[i].share = 0.3f;
    water_fixture_step(&f);
    for (uint32_t i = 0; i < f.stats.surfels; i++) {
        const float *p = f.surfels[i].position;
        const double at[3] = {(double)p[0], (double)p[1], (double)p[2]}, expected = mean_cover(at);
        uint32_t bits;
        memcpy(&bits, &f.surfels[i].radius, sizeof bits);
        worst = fmax(worst, fabs(1 - (bits & 0xff) / 255.0 - expected));
        least = fmin(least, expected);
    }
    printf("shares from %.3f to 1 are off by up to %.4f\n", least, worst);
    REQUIRE(least < 0.31 && worst < 0.02);
    water_fixture_close(&f);
}

/* The density on the whole grid, also far from the water. It is 0 where no particle is within h. */
static void fill_grid(water_grid *grid)
{
    enum { X = 120, Y = 110, Z = 110 };
    static double field[X * Y * Z];
    const double h = water_h(&f);
    *grid = (water_grid){.low = {-45, -25, 0}, .sizes = {X, Y, Z}, .step = h / VIRGA_WATER_SIDE, .field = field};
    memset(field, 0, sizeof field);
    water_fixture_shares(&f);
    for (uint32_t p = 0; p < f.count; p++) {
        int first[3], last[3];
        for (int axis = 0; axis < 3; axis++) {
            const double at = (double)f.particles[p].position[axis];
            first[axis] = (int)fmax(floor((at - h) / grid->step) - grid->low[axis], 0);
            last[axis] = (int)fmin(ceil((at + h) / grid->step) - grid->low[axis], grid->sizes[axis] - 1);
        }
        for (int z = first[2]; z <= last[2]; z++)
            for (int y = first[1]; y <= last[1]; y++)
                for (int x = first[0]; x <= last[0]; x++) {
                    const size_t i = (size_t)((z * Y + y) * X + x);
                    double at[3];
                    water_grid_at(grid, i, at);
                    if (field[i] <= 0)
                        field[i] = water_reference(&f, at, NULL);
                }
    }
}

/* The surfel of an edge between two points of the grid, with their densities, in double precision: where the density is
 * the level if it were linear, the normal there, and a step of Newton's method along it of half a grid step at most. */
static void expect_surfel(const double from[3], const double to[3], const double field[2], double step, double at[3],
                          double normal[3])
{
    const double level = (double)f.settings.level, part = (level - field[0]) / (field[1] - field[0]);
    double gradient[3], length2 = 0;
    for (int axis = 0; axis < 3; axis++)
        at[axis] = from[axis] + part * (to[axis] - from[axis]);
    const double missing = level - water_reference(&f, at, gradient);
    for (int axis = 0; axis < 3; axis++)
        length2 += gradient[axis] * gradient[axis];
    const double length = sqrt(length2), moved = fmax(fmin(missing / length, 0.5 * step), -0.5 * step);
    for (int axis = 0; axis < 3; axis++) {
        normal[axis] = -gradient[axis] / length;
        at[axis] += moved * gradient[axis] / length;
    }
}

/* The angle from the normal of the surfel that is nearest to a position (rad), and its distance (m). */
static double nearest_surfel(const double at[3], const double normal[3], double *distance)
{
    double nearest = INFINITY, own[3], sine2 = 0;
    uint32_t best = 0;
    for (uint32_t i = 0; i < f.stats.surfels; i++) {
        const float *p = f.surfels[i].position;
        const double r2 = pow((double)p[0] - at[0], 2) + pow((double)p[1] - at[1], 2) + pow((double)p[2] - at[2], 2);
        best = r2 < nearest ? i : best;
        nearest = fmin(nearest, r2);
    }
    water_unpack_normal(f.surfels[best].normal, own);
    for (int axis = 0; axis < 3; axis++)
        sine2 += pow(own[(axis + 1) % 3] * normal[(axis + 2) % 3] - own[(axis + 2) % 3] * normal[(axis + 1) % 3], 2);
    *distance = sqrt(nearest);
    return asin(fmin(sqrt(sine2), 1));
}

static void positions_and_normals_are_those_of_double_precision(void **state)
{
    (void)state;
    water_fixture_open(&f);
    put_water();
    water_fixture_step(&f);
    water_grid grid;
    fill_grid(&grid);
    const size_t next[3] = {1, (size_t)grid.sizes[0], (size_t)grid.sizes[0] * (size_t)grid.sizes[1]};
    const size_t points = next[2] * (size_t)grid.sizes[2];
    double worst_m = 0, worst = 0, sum = 0;
    uint32_t count = 0;
    for (size_t i = 0; i + next[2] < points; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double field[2] = {grid.field[i], grid.field[i + next[axis]]}, level = (double)f.settings.level;
            double from[3], to[3], at[3], normal[3], distance;
            if ((field[0] < level) == (field[1] < level))
                continue;
            water_grid_at(&grid, i, from);
            water_grid_at(&grid, i + next[axis], to);
            expect_surfel(from, to, field, grid.step, at, normal);
            const double angle = nearest_surfel(at, normal, &distance);
            worst_m = fmax(worst_m, distance);
            worst = fmax(worst, angle);
            sum += angle;
            count++;
        }
    printf("%u surfels are off by up to %g m; their normals by %g rad on average, up to %g\n", count, worst_m,
           sum / count, worst);
    assert_int_equal(count, f.stats.surfels);
    REQUIRE(worst_m < 5e-6 && sum / count < 1e-4 && worst < 1e-4);
    water_fixture_close(&f);
}

static void every_edge_that_the_surface_crosses_has_a_surfel(void **state)
{
    (void)state;
    water_fixture_open(&f);
    put_water();
    water_grid grid;
    fill_grid(&grid);
    const float levels[3] = {0.5f, 0.2f, 0.8f};
    for (int i = 0; i < 3; i++) {
        f.settings.level = levels[i];
        water_fixture_step(&f);
        const uint32_t expected = water_count_crossings(&grid, (double)f.settings.level);
        if (f.stats.surfels != expected)
            fail_msg("level %g: %u surfels (%u, %u dropped), expected %u", (double)levels[i], f.stats.surfels,
                     f.stats.surfels_dropped, f.stats.blocks_dropped, expected);
    }
    water_fixture_close(&f);
}

/* Particles a tenth nearer to each other: also the outermost ones have the density of water. */
static void water_that_is_compressed_has_its_surface(void **state)
{
    (void)state;
    const double low[3] = {-0.1, 0.1, 0.2};
    const uint32_t counts[3] = {20, 10, 20};
    water_fixture_open(&f);
    f.settings.spacing_m = 0.02f;
    water_fixture_box(&f, low, counts, 0.0182, 0);
    water_fixture_step(&f);
    water_grid grid;
    fill_grid(&grid);
    assert_int_equal(f.stats.surfels, water_count_crossings(&grid, (double)f.settings.level));
    water_fixture_close(&f);
}

static void a_ball_has_the_volume_of_its_particles(void **state)
{
    (void)state;
    const double center[3] = {0, 0, 0};
    water_fixture_open(&f);
    f.settings.spacing_m = 0.02f;
    water_fixture_ball(&f, center, 0.2, 0.02);
    water_fixture_step(&f);
    /* The mean of the radius, cubed, is the volume but for the roughness of the surface. */
    double sum = 0;
    for (uint32_t i = 0; i < f.stats.surfels; i++) {
        const float *at = f.surfels[i].position;
        sum += sqrt((double)(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]));
    }
    const double radius = sum / f.stats.surfels, volume = 4 * M_PI / 3 * pow(radius, 3), water = f.count * pow(0.02, 3);
    if (fabs(volume / water - 1) > 0.02)
        fail_msg("%g m^3 of water in a surface around %g m^3", water, volume);
    water_fixture_close(&f);
}

static void the_order_of_particles_changes_nothing(void **state)
{
    (void)state;
    static float before[4096];
    water_fixture_open(&f);
    put_water();
    water_fixture_step(&f);
    const uint32_t surfels = f.stats.surfels;
    memcpy(before, f.densities, f.count * sizeof before[0]);
    for (uint32_t i = 0; i < f.count / 2; i++) {
        const virga_particle_gpu swapped = f.particles[i];
        f.particles[i] = f.particles[f.count - 1 - i];
        f.particles[f.count - 1 - i] = swapped;
    }
    water_fixture_step(&f);
    assert_int_equal(f.stats.surfels, surfels);
    for (uint32_t i = 0; i < f.count; i++)
        assert_float_equal(before[i], f.densities[f.count - 1 - i], 1e-5);
    water_fixture_close(&f);
}

static void the_same_particles_give_the_same_bits(void **state)
{
    (void)state;
    water_fixture_open(&f);
    put_water();
    water_fixture_step(&f);
    const size_t size = f.stats.surfels * sizeof *f.surfels;
    virga_surfel_gpu *before = malloc(size);
    REQUIRE(before);
    memcpy(before, f.surfels, size);
    for (int i = 0; i < 4; i++) {
        water_fixture_step(&f);
        assert_memory_equal(before, f.surfels, size);
    }
    free(before);
    water_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(densities_are_those_of_double_precision),
        cmocka_unit_test(surfels_lie_on_the_surface_with_its_normal),
        cmocka_unit_test(surfels_have_the_share_of_the_water_around_them),
        cmocka_unit_test(positions_and_normals_are_those_of_double_precision),
        cmocka_unit_test(every_edge_that_the_surface_crosses_has_a_surfel),
        cmocka_unit_test(water_that_is_compressed_has_its_surface),
        cmocka_unit_test(a_ball_has_the_volume_of_its_particles),
        cmocka_unit_test(the_order_of_particles_changes_nothing),
        cmocka_unit_test(the_same_particles_give_the_same_bits),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
