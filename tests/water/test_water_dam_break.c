/* The frames of a dam break by another program, where they are: densities against those of that program, and the volume
 * inside the surface against that of the particles. */
#include "water_fixture.h"

#include "../host/test_particles.h"
#include "mesh_volume.h"
#include "particles.h"

#define SPACING_M  0.025
#define VOLUME_M3  (0.8 * SPACING_M * SPACING_M * SPACING_M)
#define SUPPORT_M  (2 * SPACING_M) /* of the simulator's kernel, and of ours */
#define REST_KG_M3 1000

/* Below it a particle is thin spray. A particle alone has 0.255 in the simulator's kernel and 0.157 in ours. */
#define SIMULATOR_SPRAY 0.5
#define OWN_SPRAY       0.44

static const double tank_m[3] = {1.23, 1.5, 0.72};

static water_fixture f;
static particles frame;

/* Reads a frame into the fixture. */
static void put_frame(const char *name)
{
    char error[512];
    if (!particles_read(test_particles_path(name), &frame, error, sizeof error))
        fail_msg("%s", error);
    f.settings.spacing_m = (float)SPACING_M;
    f.settings.volume_m3 = (float)VOLUME_M3;
    f.count = 0;
    for (uint32_t i = 0; i < frame.count; i++)
        water_fixture_add(&f, (double)frame.position[i][0], (double)frame.position[i][1], (double)frame.position[i][2]);
}

/* The cubic spline of Monaghan with the support h, whose density the simulator writes. */
static double spline(double q)
{
    const double factor = 8 / (M_PI * pow(SUPPORT_M, 3));
    return factor * (q < 0.5 ? 6 * q * q * (q - 1) + 1 : q < 1 ? 2 * pow(1 - q, 3) : 0);
}

static double spline_density(uint32_t of)
{
    double sum = 0;
    for (uint32_t i = 0; i < frame.count; i++) {
        double r2 = 0;
        for (int axis = 0; axis < 3; axis++)
            r2 += pow((double)frame.position[i][axis] - (double)frame.position[of][axis], 2);
        if (r2 < SUPPORT_M * SUPPORT_M)
            sum += VOLUME_M3 * spline(sqrt(r2) / SUPPORT_M);
    }
    return sum;
}

/* Walls add to the simulator's density, and not to ours. */
static bool is_near_wall(const float at[3])
{
    for (int axis = 0; axis < 3; axis++)
        if ((double)at[axis] < SUPPORT_M || (double)at[axis] > tank_m[axis] - SUPPORT_M)
            return true;
    return false;
}

typedef struct comparison {
    uint32_t compared, spray, same_spray;
    double worst_spline, mean, rms, worst, covariance, variances[2];
} comparison;

static comparison compare(void)
{
    comparison c = {0};
    double sums[2] = {0};
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < frame.count; i++) {
            const double values[2] = {(double)f.densities[i], (double)frame.density[i] / REST_KG_M3};
            if (is_near_wall(frame.position[i]))
                continue;
            if (pass == 0) {
                c.compared++;
                sums[0] += values[0];
                sums[1] += values[1];
                c.worst_spline = fmax(c.worst_spline, fabs(spline_density(i) - values[1]));
                c.worst = fmax(c.worst, fabs(values[0] - values[1]));
                c.rms += pow(values[0] - values[1], 2);
                c.spray += values[1] < 0.5;
                c.same_spray += (values[1] < SIMULATOR_SPRAY) == (values[0] < OWN_SPRAY);
                continue;
            }
            const double off[2] = {values[0] - sums[0] / c.compared, values[1] - sums[1] / c.compared};
            c.covariance += off[0] * off[1];
            for (int k = 0; k < 2; k++)
                c.variances[k] += off[k] * off[k];
        }
    c.rms = sqrt(c.rms / c.compared);
    c.mean = (sums[0] - sums[1]) / c.compared;
    return c;
}

/* Away from walls the file's densities are those of a cubic spline over its positions, but for the last move of the
 * particles, which comes after them. Ours are of another kernel. */
static void its_densities_are_those_of_the_simulator(void **state)
{
    static const char *const names[] = {"dam_break_0060.bgeo", "dam_break_0100.bgeo"};
    (void)state;
    water_fixture_open(&f);
    for (int k = 0; k < 2; k++) {
        put_frame(names[k]);
        REQUIRE(frame.density);
        water_fixture_step(&f);
        const comparison c = compare();
        const double correlation = c.covariance / sqrt(c.variances[0] * c.variances[1]);
        printf("%s: %u particles away from walls; a cubic spline is off by %.4f at most; ours by %.3f at most, %.3f in "
               "the mean, %.3f RMS; correlation %.4f; %u of spray, %u on the same side of that\n",
               names[k], c.compared, c.worst_spline, c.worst, c.mean, c.rms, correlation, c.spray, c.same_spray);
        REQUIRE(c.compared > 3500 && c.spray > 100);
        REQUIRE(c.worst_spline < 0.06 && fabs(c.mean) < 0.05 && c.rms < 0.06 && correlation > 0.98);
        REQUIRE(c.same_spray > 0.99 * c.compared);
        particles_free(&frame);
    }
    water_fixture_close(&f);
}

/* Volume of the surface, with that of the droplets that splash particles become, over that of all particles. */
static double share_of_volume(double volume_m3)
{
    uint32_t splashes = 0;
    field made;
    water_mesh mesh;
    water_fixture_step(&f);
    for (uint32_t i = 0; i < f.count; i++)
        if (f.densities[i] < virga_default_water_settings().spray_density) {
            f.particles[i].share = 0;
            splashes++;
        }
    const field_def def = {f.particles, f.count, (double)f.settings.spacing_m, volume_m3,
                           (double)f.settings.kernel_spacings};
    REQUIRE(field_create(&made, &def) && water_mesh_create(&mesh, &made, (double)f.settings.level));
    const double share = (mesh_volume(&mesh) / volume_m3 + splashes) / f.count;
    water_mesh_destroy(&mesh);
    field_destroy(&made);
    return share;
}

static void its_volume_is_that_of_the_particles(void **state)
{
    static const char *const names[] = {"dam_break_0040.ply", "dam_break_0060.ply", "dam_break_0080.ply",
                                        "dam_break_0100.ply", "dam_break_0120.ply"};
    (void)state;
    water_fixture_open(&f);
    for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
        put_frame(names[k]);
        const double share = share_of_volume(VOLUME_M3);
        printf("%s: surface and spray have %.4f of the particles' volume\n", names[k], share);
        REQUIRE(fabs(share - 1) < 0.03);
        particles_free(&frame);
    }
    water_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(its_densities_are_those_of_the_simulator),
        cmocka_unit_test(its_volume_is_that_of_the_particles),
    };
    if (!test_particles_have("dam_break_0060.bgeo"))
        return 77;
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
