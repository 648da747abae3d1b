/* The passes of a substep against double precision, and the same bits in every run. */
#include "fluid_fixture.h"

static fluid_fixture f;

#define D    0.05
#define SIDE 0.4 /* of the box */

/* V W in double precision, as a function of the distance in spacings, and its derivative. */
static double kernel(double q)
{
    return (pow(fmax(2 - q, 0), 3) - 4 * pow(fmax(1 - q, 0), 3)) / (4 * M_PI);
}

static double kernel_slope(double q)
{
    return (-3 * pow(fmax(2 - q, 0), 2) + 12 * pow(fmax(1 - q, 0), 2)) / (4 * M_PI);
}

#define REACH 1.9 /* spacings: pairs that are farther apart are not listed, see neighbours.glsl */

/* The kernel's integral over a plane at the distance s, by summing up rings. */
static double plane_by_rings(double s)
{
    const int rings = 4000;
    double sum = 0;
    for (int i = 0; i < rings; i++) {
        const double r = 2.0 * (i + 0.5) / rings;
        sum += kernel(sqrt(s * s + r * r)) * 2 * M_PI * r * 2.0 / rings;
    }
    return sum;
}

static double layers(double z)
{
    return plane_by_rings(z + 0.5) + plane_by_rings(z + 1.5);
}

/* The walls' density, and its gradient with the factor of the mirror image. */
static double walls(const double p[3], double gradient[3])
{
    double left[3], slope[3];
    for (int axis = 0; axis < 3; axis++) {
        const double low = p[axis], high = SIDE / D - p[axis], h = 1e-3;
        left[axis] = 1 - layers(low) - layers(high);
        slope[axis] = (layers(low + h) + layers(high - h) - layers(low - h) - layers(high + h)) / h;
    }
    for (int axis = 0; axis < 3; axis++)
        gradient[axis] = slope[axis] * left[(axis + 1) % 3] * left[(axis + 2) % 3];
    return 1 - left[0] * left[1] * left[2];
}

/* Density and alpha of particle i, from positions in spacings. */
static void reference(const double (*p)[3], uint32_t count, uint32_t i, double *density, double *alpha)
{
    double sum[3], squares = 0;
    *density = kernel(0) + walls(p[i], sum);
    for (uint32_t j = 0; j < count; j++) {
        double apart[3], r = 0;
        for (int axis = 0; axis < 3; axis++) {
            apart[axis] = p[i][axis] - p[j][axis];
            r += apart[axis] * apart[axis];
        }
        r = sqrt(r);
        if (j == i || r >= REACH)
            continue;
        *density += kernel(r);
        squares += pow(kernel_slope(r), 2);
        for (int axis = 0; axis < 3; axis++)
            sum[axis] += kernel_slope(r) * apart[axis] / r;
    }
    *alpha = 1 / (sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2] + squares);
}

/* Particles out of order, also in the corners. */
static uint32_t put_particles(double (*p)[3])
{
    uint32_t hash = 11, count = 0;
    virga_particle_gpu *put = f.upload.mapped;
    for (; count < 400; count++)
        for (int axis = 0; axis < 3; axis++) {
            hash = virga_hash1(hash);
            const float at = (float)SIDE * virga_unit(hash) * (axis == 1 ? 0.7f : 1);
            put[count].position[axis] = at;
            p[count][axis] = (double)at / D;
        }
    return count;
}

static void density_and_alpha_are_those_of_double_precision(void **state)
{
    (void)state;
    static double p[400][3];
    host_buffer down = {0};
    VkDeviceSize offset = 0;
    fluid_fixture_open(&f);
    fluid_fixture_box(&f, D, SIDE, SIDE, SIDE);
    const uint32_t count = put_particles(p);
    const virga_buffer *buffers[3] = {f.fluid->grid.sorted_velocities, f.fluid->walls, f.fluid->grid.sorted_indices};
    REQUIRE(host_buffer_create(&f.gpu.device, buffers[0]->size + buffers[1]->size + buffers[2]->size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "sorted down", &down,
                               f.gpu.error, sizeof f.gpu.error));
    REQUIRE(fluid_fixture_try(&f, 1e-4, count, false) == VIRGA_OK);
    assert_int_equal(f.stats.substeps, 1);
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    effect_fixture_transfers(cmd);
    const float(*velocities)[4] = effect_fixture_copy(cmd, buffers[0]->buffer, buffers[0]->size, &down, &offset);
    const float(*found_walls)[4] = effect_fixture_copy(cmd, buffers[1]->buffer, buffers[1]->size, &down, &offset);
    const uint32_t *indices = effect_fixture_copy(cmd, buffers[2]->buffer, buffers[2]->size, &down, &offset);
    effect_fixture_complete(&f.gpu, f.context);
    host_buffer_invalidate(&f.gpu.device, &down);
    for (uint32_t i = 0; i < count; i++) {
        double density, alpha;
        reference((const double(*)[3])p, count, indices[i], &density, &alpha);
        if (fabs((double)velocities[i][3] - density) > 2e-5 || fabs((double)found_walls[i][3] / alpha - 1) > 1e-4)
            fail_msg("particle %u: density %.6f and alpha %.5f, expected %.6f and %.5f", indices[i],
                     (double)velocities[i][3], (double)found_walls[i][3], density, alpha);
    }
    host_buffer_destroy(&f.gpu.device, &down);
    fluid_fixture_close(&f);
}

/* Gradient of a pair as shaders/fluid/pairs.glsl packs it: 22 bits of an index, and three components of 14 bits. */
static void unpack_pair(uint32_t first, uint32_t second, uint32_t *j, double gradient[3])
{
    const int32_t z = (int32_t)first >> 22;
    *j = first & 0x3fffff;
    gradient[0] = ((int32_t)(second << 18) >> 18) / 2047.0;
    gradient[1] = ((int32_t)(second << 4) >> 18) / 2047.0;
    gradient[2] = (z * 16 + (int32_t)(second >> 28)) / 2047.0;
}

/* The pairs of a particle: all that are nearer than REACH, each once, with the gradient 4 pi V grad W. */
static void check_pairs(const double (*p)[3], const uint32_t *indices, const uint32_t (*lists)[4],
                        const uint32_t (*gradients)[4], uint32_t count, uint32_t i, uint32_t texels)
{
    const uint32_t stride = f.fluid->def.max_particles;
    uint32_t found = 0, expected = 0;
    for (uint32_t k = 0; k < count; k++) {
        double r2 = 0;
        for (int axis = 0; axis < 3; axis++)
            r2 += pow(p[indices[i]][axis] - p[k][axis], 2);
        expected += k != indices[i] && r2 < REACH * REACH;
    }
    for (uint32_t n = 0; n < 4 * texels; n++) {
        uint32_t j;
        double gradient[3], r = 0;
        unpack_pair(lists[n / 4 * stride + i][n % 4], gradients[n / 4 * stride + i][n % 4], &j, gradient);
        REQUIRE(j < count);
        for (int axis = 0; axis < 3; axis++)
            r += pow(p[indices[i]][axis] - p[indices[j]][axis], 2);
        r = sqrt(r);
        found += j != i;
        for (int axis = 0; axis < 3; axis++) {
            const double apart = p[indices[i]][axis] - p[indices[j]][axis];
            assert_float_equal(gradient[axis], j == i ? 0 : 4 * M_PI * kernel_slope(r) * apart / r, 0.5 / 2047 + 2e-5);
        }
    }
    assert_int_equal(found, expected);
}

static void pairs_are_those_of_double_precision(void **state)
{
    (void)state;
    static double p[400][3];
    host_buffer down = {0};
    VkDeviceSize offset = 0;
    fluid_fixture_open(&f);
    fluid_fixture_box(&f, D, SIDE, SIDE, SIDE);
    const uint32_t count = put_particles(p);
    const virga_buffer *buffers[4] = {f.fluid->lists, f.fluid->gradients, f.fluid->solved,
                                      f.fluid->grid.sorted_indices};
    const void *read[4];
    REQUIRE(host_buffer_create(&f.gpu.device, buffers[0]->size + buffers[1]->size + buffers[2]->size + buffers[3]->size,
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "pairs down", &down, f.gpu.error,
                               sizeof f.gpu.error));
    REQUIRE(fluid_fixture_try(&f, 1e-4, count, false) == VIRGA_OK);
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    effect_fixture_transfers(cmd);
    for (int b = 0; b < 4; b++)
        read[b] = effect_fixture_copy(cmd, buffers[b]->buffer, buffers[b]->size, &down, &offset);
    effect_fixture_complete(&f.gpu, f.context);
    host_buffer_invalidate(&f.gpu.device, &down);
    const uint32_t(*solved)[2] = read[2];
    for (uint32_t i = 0; i < count; i++)
        check_pairs((const double(*)[3])p, read[3], read[0], read[1], count, i, solved[i][1] >> 16);
    host_buffer_destroy(&f.gpu.device, &down);
    fluid_fixture_close(&f);
}

/* Of a step, for water of this speed. */
static uint32_t substeps_at(double speed, double dt)
{
    fluid_fixture_open(&f);
    fluid_fixture_box(&f, 0.04, 0.8, 0.8, 0.4);
    const virga_fluid_block block = {.high_m = {0.4f, 0.4f, 0.4f}, .velocity_m_s = {(float)speed, 0, 0}};
    REQUIRE(virga_fluid_add(f.fluid, &block) == VIRGA_OK);
    fluid_fixture_step(&f, dt);
    const uint32_t substeps = f.stats.substeps;
    fluid_fixture_close(&f);
    return substeps;
}

/* With cfl = 0.4, 16 mm of this spacing. Water at rest counts as falling a spacing: 0.886 m/s. */
static void the_speed_decides_on_the_substeps(void **state)
{
    (void)state;
    assert_int_equal(substeps_at(0, 0.017), 1);
    assert_int_equal(substeps_at(0, 0.019), 2);
    assert_int_equal(substeps_at(1.5, 0.01), 1);
    assert_int_equal(substeps_at(1.7, 0.01), 2);
    assert_int_equal(substeps_at(4.7, 0.01), 3);
}

static uint64_t hash_of(const void *data, size_t size)
{
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const unsigned char *)data)[i]) * 1099511628211u;
    return hash;
}

static void the_same_calls_give_the_same_bits(void **state)
{
    (void)state;
    uint64_t first = 0;
    for (int run = 0; run < 3; run++) {
        fluid_fixture_open(&f);
        fluid_fixture_box(&f, 0.04, 0.8, 0.8, 0.4);
        fluid_fixture_block(&f, 0, 0, 0, 0.4, 0.4, 0.4);
        fluid_fixture_run(&f, 15);
        fluid_fixture_block(&f, 0.4, 0.6, 0.1, 0.6, 0.8, 0.3);
        fluid_fixture_run(&f, 15);
        const uint64_t hash = hash_of(f.particles, f.count * sizeof *f.particles);
        first = run ? first : hash;
        REQUIRE(hash == first);
        assert_int_equal(f.count, 1000 + 125);
        fluid_fixture_close(&f);
    }
}

/* Two blocks of which one arrives later have the ids of their order. */
static void blocks_follow_each_other(void **state)
{
    (void)state;
    fluid_fixture_open(&f);
    fluid_fixture_box(&f, 0.04, 0.4, 0.4, 0.4);
    fluid_fixture_block(&f, 0, 0, 0, 0.4, 0.04, 0.08);
    fluid_fixture_step(&f, 0);
    fluid_fixture_block(&f, 0, 0.2, 0, 0.04, 0.32, 0.04);
    fluid_fixture_step(&f, 0);
    assert_int_equal(f.count, 23);
    for (uint32_t i = 0; i < f.count; i++)
        assert_int_equal(f.particles[i].id, i);
    assert_float_equal(f.particles[10].position[2], 0.06, 1e-6);
    assert_float_equal(f.particles[22].position[1], 0.3, 1e-6);
    fluid_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(density_and_alpha_are_those_of_double_precision),
        cmocka_unit_test(pairs_are_those_of_double_precision),
        cmocka_unit_test(the_speed_decides_on_the_substeps),
        cmocka_unit_test(the_same_calls_give_the_same_bits),
        cmocka_unit_test(blocks_follow_each_other),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
