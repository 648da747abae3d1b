/* test_water_vdb.c - the density of water as OpenVDB: each voxel against sums in double precision. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "file.h"
#include "read_vdb.h"
#include "water/volume_blocks.h"

#include <virga/shared/random.h>

#define D 0.02
#define H (2 * D) /* the kernel's radius */

enum { PARTICLES = 400 };

static virga_particle_gpu particles[PARTICLES];
static const double origin_m[3] = {10, -2, 0.005};
static char folder[64], path[128];

static int make_folder(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/virga-vdb-XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/water_density.0001.vdb", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(path);
    return rmdir(folder);
}

static float random_at(uint32_t index, uint32_t what)
{
    return 2 * virga_unit(virga_hash3(3, index, what)) - 1;
}

/* A cloud on both sides of the particles' origin, which is none of the world, and one particle far from it. */
static void make_particles(void)
{
    for (uint32_t i = 0; i < PARTICLES; i++) {
        particles[i] = (virga_particle_gpu){.share = i % 5 ? 1 : 0.25f, .id = i};
        for (uint32_t axis = 0; axis < 3; axis++) {
            particles[i].position[axis] = 0.12f * random_at(i, axis) + (i == 7 ? 3 : 0);
            particles[i].velocity[axis] = 4 * random_at(i, 3 + axis);
        }
    }
    particles[3].position[1] = NAN;
}

/* Equations 1 and 2 of the paper, and the mean velocity with the same weights. */
static double density_at(const double position[3], double velocity[3])
{
    double sum = 0;
    memset(velocity, 0, 3 * sizeof *velocity);
    for (uint32_t i = 0; i < PARTICLES; i++) {
        double r2 = 0;
        for (int axis = 0; axis < 3; axis++)
            r2 += pow(position[axis] - origin_m[axis] - (double)particles[i].position[axis], 2);
        if (!(r2 < H * H))
            continue;
        const double weight =
            (double)particles[i].share * D * D * D * 315 / (64 * M_PI * pow(H, 9)) * pow(H * H - r2, 3);
        sum += weight;
        for (int axis = 0; axis < 3; axis++)
            velocity[axis] += weight * (double)particles[i].velocity[axis];
    }
    for (int axis = 0; axis < 3 && sum > 0; axis++)
        velocity[axis] /= sum;
    return sum;
}

static void write_particles(uint32_t count)
{
    const field_def def = {particles, count, D, D * D * D, H / D};
    char error[256] = "";
    field made;
    assert_true(field_create(&made, &def));
    volume v = field_volume(&made);
    v.surface = 0.5;
    memcpy(v.origin_m, origin_m, sizeof origin_m);
    if (!volume_write(path, &v, error, sizeof error))
        fail_msg("%s", error);
    field_destroy(&made);
}

static vdb_contents read_back(void)
{
    vdb_contents found;
    char reason[256];
    if (!read_vdb(path, &found, reason))
        fail_msg("%s", reason);
    assert_int_equal(found.grids, 2);
    assert_string_equal(found.density_class, "fog volume");
    assert_string_equal(found.density_unit, "1");
    assert_string_equal(found.velocity_unit, "m/s");
    assert_string_equal(found.length_unit, "m");
    assert_string_equal(found.creator, "virga");
    assert_true(found.background == 0 && found.surface == 0.5f);
    assert_int_equal(found.count, found.velocities);
    for (int axis = 0; axis < 3; axis++)
        assert_true(fabs(found.voxel_m[axis] - D / 2) < 1e-12);
    return found;
}

/* Grid points near a particle that have density. */
static size_t expected_count(void)
{
    size_t count = 0;
    for (int cloud = 0; cloud < 2; cloud++) {
        const int middle = cloud ? 300 : 0, reach = 20; /* points of D / 2 */
        for (int i = 0; i < 41 * 41 * 41; i++) {
            const int at[3] = {i % 41 - reach + middle, i / 41 % 41 - reach + middle, i / 41 / 41 - reach + middle};
            double position[3], velocity[3];
            for (int axis = 0; axis < 3; axis++)
                position[axis] = origin_m[axis] + D / 2 * at[axis];
            count += density_at(position, velocity) > 0;
        }
    }
    return count;
}

static void voxels_are_the_density_of_the_particles(void **state)
{
    (void)state;
    double worst = 0, worst_speed = 0;
    make_particles();
    write_particles(PARTICLES);
    vdb_contents found = read_back();
    assert_int_equal(found.count, expected_count());
    for (size_t i = 0; i < found.count; i++) {
        const vdb_voxel *voxel = &found.voxels[i];
        double velocity[3];
        worst = fmax(worst, fabs((double)voxel->density - density_at(voxel->position_m, velocity)));
        for (int axis = 0; axis < 3; axis++)
            worst_speed = fmax(worst_speed, fabs((double)voxel->velocity[axis] - velocity[axis]));
    }
    printf("%zu voxels, density wrong by %.2e at most, velocity by %.2e m/s\n", found.count, worst, worst_speed);
    assert_true(worst < 1e-6);
    assert_true(worst_speed < 4 * 1.0 / 1024); /* half floats */
    free(found.voxels);
}

static void the_same_particles_give_the_same_file(void **state)
{
    (void)state;
    void *data[2];
    size_t size[2];
    char error[256];
    make_particles();
    for (int run = 0; run < 2; run++) {
        write_particles(PARTICLES);
        assert_true(file_read(path, 100 << 20, &data[run], &size[run], error, sizeof error));
    }
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(data[0], data[1], size[0]);
    free(data[0]);
    free(data[1]);
}

static void no_particles_are_an_empty_volume(void **state)
{
    (void)state;
    write_particles(0);
    vdb_contents found = read_back();
    assert_int_equal(found.count, 0);
    free(found.voxels);
}

static void a_file_that_cannot_be_written_is_an_error(void **state)
{
    (void)state;
    const volume v = {.voxel_m = 1};
    char error[256] = "";
    assert_false(volume_write("/tmp/no/such/folder/a.vdb", &v, error, sizeof error));
    assert_non_null(strstr(error, "/tmp/no/such/folder/a.vdb"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(voxels_are_the_density_of_the_particles),
        cmocka_unit_test(the_same_particles_give_the_same_file),
        cmocka_unit_test(no_particles_are_an_empty_volume),
        cmocka_unit_test(a_file_that_cannot_be_written_is_an_error),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
