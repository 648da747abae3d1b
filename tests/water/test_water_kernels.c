/* Isotropic and anisotropic kernels: against double precision, on flat water, in thin sheets; the volume of water. */
#include "water_kernels.h"

static water_fixture f;
static water_kernel kernels[WATER_MAX_KERNELS];

static void set_up(virga_water_kernel kernel, float spacings)
{
    water_fixture_open(&f);
    f.settings.spacing_m = 0.02f;
    f.settings.kernel = kernel;
    f.settings.kernel_spacings = spacings;
}

/* A block, a sheet that it touches, and drops. */
static void put_water(void)
{
    const double low[3] = {-0.11, 0.02, 0.3}, high[3] = {0.09, 0.08, 0.32};
    const uint32_t counts[3] = {10, 6, 7}, thin[3] = {9, 1, 8};
    uint32_t hash = 3;
    water_fixture_box(&f, low, counts, 0.02, 0.2);
    water_fixture_box(&f, high, thin, 0.02, 0.1);
    for (int i = 0; i < 30; i++)
        water_fixture_add(&f, water_random(&hash, -0.2, 0.3), water_random(&hash, -0.1, 0.2),
                          water_random(&hash, 0.2, 0.5))
            ->share = i % 3 ? 1 : 0.4f;
}

static bool is_near_surface(const float position[3])
{
    const double h = water_h(&f);
    for (uint32_t i = 0; i < f.stats.surfels; i++) {
        double r2 = 0;
        for (int k = 0; k < 3; k++)
            r2 += pow((double)(f.surfels[i].position[k] - position[k]), 2);
        if (r2 < h * h)
            return true;
    }
    return false;
}

/* Largest difference of the device's kernel from the reference: of its center in h, else in parts. */
static double kernel_error(uint32_t i, const water_kernel *expected)
{
    static const int rows[6] = {0, 1, 2, 0, 0, 1}, columns[6] = {0, 1, 2, 1, 2, 2};
    const double h = water_h(&f);
    const float *center = &f.centers[4 * i], *shape = &f.shapes[8 * i];
    double worst = fabs((double)center[3] / expected->factor - 1), trace = 0;
    for (int k = 0; k < 3; k++) {
        worst = fmax(worst, fabs((double)center[k] - expected->center[k]) / h);
        trace += expected->shape[k][k];
    }
    for (int k = 0; k < 6; k++)
        worst = fmax(worst, fabs((double)shape[k] / (h * h) - expected->shape[rows[k]][columns[k]]) / trace);
    return worst;
}

static void kernels_are_those_of_double_precision(void **state)
{
    (void)state;
    set_up(VIRGA_WATER_KERNEL_ANISOTROPIC, 2);
    put_water();
    water_fixture_step(&f);
    water_kernels_reference(&f, kernels);
    uint32_t compared = 0;
    double worst = 0, flattest = 1;
    for (uint32_t i = 0; i < f.stats.in_grid; i++) {
        const uint32_t particle = f.sorted_indices[i];
        const water_kernel *expected = &kernels[particle];
        if (!is_near_surface(f.particles[particle].position))
            continue;
        const double error = kernel_error(i, expected);
        if (error > 2e-4)
            fail_msg("particle %u: kernel off by %g", particle, error);
        compared++;
        worst = fmax(worst, error);
        for (int k = 0; k < 3; k++)
            flattest =
                fmin(flattest, expected->axes[k] / fmax(expected->axes[(k + 1) % 3], expected->axes[(k + 2) % 3]));
    }
    printf("%u kernels: off by up to %g; axes in the ratio of up to 1 : %g\n", compared, worst, 1 / flattest);
    REQUIRE(compared > 300 && flattest < 0.55);
    water_fixture_close(&f);
}

static void surfels_lie_on_the_surface_of_anisotropic_kernels(void **state)
{
    (void)state;
    set_up(VIRGA_WATER_KERNEL_ANISOTROPIC, 2);
    put_water();
    water_fixture_step(&f);
    water_kernels_reference(&f, kernels);
    double worst = 0, normals = 0;
    REQUIRE(f.stats.surfels > 1000);
    for (uint32_t i = 0; i < f.stats.surfels; i++) {
        double at[3], gradient[3], normal[3], length = 0, along = 0;
        for (int k = 0; k < 3; k++)
            at[k] = (double)f.surfels[i].position[k];
        const double missing = water_kernel_density(&f, kernels, at, gradient) - (double)f.settings.level;
        water_unpack_normal(f.surfels[i].normal, normal);
        for (int k = 0; k < 3; k++) {
            length += gradient[k] * gradient[k];
            along -= normal[k] * gradient[k];
        }
        worst = fmax(worst, fabs(missing) / sqrt(length));
        normals += along / sqrt(length);
    }
    printf("off the surface by up to %g m; mean cosine of normals %g\n", worst, normals / f.stats.surfels);
    REQUIRE(worst < 0.1 * 0.02);
    REQUIRE(normals / f.stats.surfels > 0.99);
    water_fixture_close(&f);
}

/* Number of edges of the whole grid that the surface crosses. */
static uint32_t count_crossings(void)
{
    enum { X = 66, Y = 46, Z = 46 };
    static double field[X * Y * Z];
    const water_grid grid = {
        .low = {-28, -16, 14}, .sizes = {X, Y, Z}, .step = water_h(&f) / VIRGA_WATER_SIDE, .field = field};
    for (size_t i = 0; i < X * Y * Z; i++) {
        double at[3];
        water_grid_at(&grid, i, at);
        field[i] = water_kernel_density(&f, kernels, at, NULL);
    }
    return water_count_crossings(&grid, (double)f.settings.level);
}

static void every_edge_that_the_surface_crosses_has_a_surfel(void **state)
{
    (void)state;
    set_up(VIRGA_WATER_KERNEL_ANISOTROPIC, 2);
    put_water();
    water_fixture_step(&f);
    water_kernels_reference(&f, kernels);
    const uint32_t expected = count_crossings();
    /* A point that is inside by less than single precision shows may be outside there. */
    if (abs((int)f.stats.surfels - (int)expected) > 2)
        fail_msg("%u surfels, expected %u", f.stats.surfels, expected);
    water_fixture_close(&f);
}

/* RMS of the height of flat water, and its mean above the uppermost particles, in spacings. */
static void measure_flat_water(virga_water_kernel kernel, float spacings, double *mean, double *rms)
{
    const double low[3] = {0, 0, 0}, d = 0.02;
    const uint32_t counts[3] = {26, 26, 9};
    set_up(kernel, spacings);
    water_fixture_box(&f, low, counts, d, 0.2);
    water_fixture_step(&f);
    double sum = 0, squares = 0;
    uint32_t found = 0;
    for (uint32_t i = 0; i < f.stats.surfels; i++) {
        const float *at = f.surfels[i].position;
        if (fmin((double)at[0], (double)at[1]) < 6 * d || fmax((double)at[0], (double)at[1]) > 19 * d ||
            (double)at[2] < 4 * d)
            continue;
        const double height = (double)at[2] / d - 8;
        sum += height;
        squares += height * height;
        found++;
    }
    REQUIRE(found > 200);
    *mean = sum / found;
    *rms = sqrt(squares / found - *mean * *mean);
    printf("%s, radius %g spacings: surface %.3f above the uppermost layer, RMS %.4f spacings\n",
           kernel ? "anisotropic" : "isotropic", (double)spacings, *mean, *rms);
    water_fixture_close(&f);
}

/* Particles on a lattice, each moved by up to a fifth of the spacing: an RMS of 0.115 on each axis. */
static void flat_water_is_flat_and_at_its_height(void **state)
{
    (void)state;
    double mean[2][2], rms[2][2];
    for (int kernel = 0; kernel < 2; kernel++)
        for (int wide = 0; wide < 2; wide++) {
            measure_flat_water((virga_water_kernel)kernel, wide ? 3 : 2, &mean[kernel][wide], &rms[kernel][wide]);
            REQUIRE(rms[kernel][wide] < 0.08);
            REQUIRE(fabs(mean[kernel][wide] - 0.5) < 0.06);
        }
    /* Wider kernels see more particles: that is what makes water flat. The shape of kernels matters less. */
    REQUIRE(rms[0][1] < 0.75 * rms[0][0] && rms[1][1] < 0.75 * rms[1][0]);
}

static uint32_t surfels_of_a_sheet(virga_water_kernel kernel)
{
    const double low[3] = {0, 0, 0};
    const uint32_t counts[3] = {16, 16, 1};
    set_up(kernel, 3);
    water_fixture_box(&f, low, counts, 0.02, 0.1);
    water_fixture_step(&f);
    const uint32_t surfels = f.stats.surfels;
    water_fixture_close(&f);
    return surfels;
}

static void wide_anisotropic_kernels_keep_a_sheet_of_one_layer(void **state)
{
    (void)state;
    assert_int_equal(surfels_of_a_sheet(VIRGA_WATER_KERNEL_ISOTROPIC), 0);
    REQUIRE(surfels_of_a_sheet(VIRGA_WATER_KERNEL_ANISOTROPIC) > 500);
}

static void the_volume_inside_the_surface_is_that_of_the_particles(void **state)
{
    (void)state;
    for (int kernel = 0; kernel < 2; kernel++) {
        const double low[3] = {0, 0, 0}, d = 0.02;
        const uint32_t counts[3] = {16, 14, 12};
        set_up((virga_water_kernel)kernel, 2);
        water_fixture_box(&f, low, counts, d, 0.15);
        water_fixture_step(&f);
        water_kernels_reference(&f, kernels);
        /* Points at random in the box around the water, without their error: one in each cell of half a spacing. */
        uint32_t inside = 0, hash = 11;
        for (int z = -3; z < 27; z++)
            for (int y = -3; y < 31; y++)
                for (int x = -3; x < 35; x++) {
                    const double at[3] = {d / 2 * (x + water_random(&hash, 0, 1)),
                                          d / 2 * (y + water_random(&hash, 0, 1)),
                                          d / 2 * (z + water_random(&hash, 0, 1))};
                    inside += water_kernel_density(&f, kernels, at, NULL) >= (double)f.settings.level;
                }
        const double ratio = inside / 8.0 / f.count;
        printf("%s: volume inside the surface %.4f of the particles'\n", kernel ? "anisotropic" : "isotropic", ratio);
        if (fabs(ratio - 1) > 0.03)
            fail_msg("volume %g", ratio);
        water_fixture_close(&f);
    }
}

static void the_order_of_particles_changes_no_bit(void **state)
{
    (void)state;
    for (int kernel = 0; kernel < 2; kernel++) {
        set_up((virga_water_kernel)kernel, 2);
        put_water();
        water_fixture_step(&f);
        const uint32_t surfels = f.stats.surfels;
        const size_t size = surfels * sizeof *f.surfels;
        virga_surfel_gpu *before = malloc(size);
        REQUIRE(before);
        memcpy(before, f.surfels, size);
        for (uint32_t i = 0; i < f.count; i++) {
            const uint32_t other = virga_hash1(i) % f.count;
            const virga_particle_gpu swapped = f.particles[i];
            f.particles[i] = f.particles[other];
            f.particles[other] = swapped;
        }
        water_fixture_step(&f);
        assert_int_equal(f.stats.surfels, surfels);
        assert_memory_equal(before, f.surfels, size);
        free(before);
        water_fixture_close(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kernels_are_those_of_double_precision),
        cmocka_unit_test(surfels_lie_on_the_surface_of_anisotropic_kernels),
        cmocka_unit_test(every_edge_that_the_surface_crosses_has_a_surfel),
        cmocka_unit_test(flat_water_is_flat_and_at_its_height),
        cmocka_unit_test(wide_anisotropic_kernels_keep_a_sheet_of_one_layer),
        cmocka_unit_test(the_volume_inside_the_surface_is_that_of_the_particles),
        cmocka_unit_test(the_order_of_particles_changes_no_bit),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
