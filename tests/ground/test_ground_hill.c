/* What hosts read of wet ground on hills and beside walls: virga_ground_at and virga_ground_far_at of
 * shared/ground_map.glsl, on maps that a test writes. */
#include "../host/effect_fixture.h"

#include "hill.spv.h"

#include <descriptors.h>
#include <pipeline.h>

#include <math.h>
#include <string.h>

#define CELLS 64
#define SIDE  256 /* points along an edge of the square that is read */

/* As hill.comp has it. */
typedef struct surface {
    float rise[2], base, cell_m;
    int32_t cells, far;
} surface;

static struct {
    fixture gpu;
    host_image map, spots;
    host_buffer found;
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    float texels[CELLS][CELLS][4]; /* wet, depth, variance, height */
} f;

static void make_pipeline(void)
{
    static const VkDescriptorType types[3] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                              VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                              VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    const host_set_shape shape = {types, 3, VK_SHADER_STAGE_COMPUTE_BIT};
    host_device *device = &f.gpu.device;
    char *error = f.gpu.error;
    const size_t size = sizeof f.gpu.error;
    REQUIRE(host_sampler_create(device, HOST_SAMPLE_NEAREST, &f.sampler, error, size));
    REQUIRE(host_set_layout_create(device, &shape, &f.set_layout, error, size));
    REQUIRE(host_set_pool_create(device, &shape, 1, &f.pool, error, size));
    REQUIRE(host_sets_allocate(device, f.pool, f.set_layout, 1, &f.set, error, size));
    REQUIRE(host_pipeline_layout_create(device, &f.set_layout, 1, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(surface),
                                        &f.layout, error, size));
    REQUIRE(host_compute_create(device, HOST_CODE(hill), f.layout, &f.pipeline, error, size));
}

static int begin(void **state)
{
    static const uint32_t none[CELLS][2 * CELLS];
    const host_image_def def = {.format = VK_FORMAT_R32_UINT, .extent = {2 * CELLS, CELLS, 1}, .name = "spots"};
    (void)state;
    memset(&f, 0, sizeof f);
    if (!fixture_begin(&f.gpu)) {
        printf("skipped: %s\n", f.gpu.error);
        exit(77);
    }
    make_pipeline();
    REQUIRE(host_buffer_create(&f.gpu.device, 4ull * SIDE * SIDE, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               HOST_BUFFER_READBACK, "found", &f.found, f.gpu.error, sizeof f.gpu.error));
    REQUIRE(
        host_image_create_with(&f.gpu.device, &def, none, sizeof none, 4, &f.spots, f.gpu.error, sizeof f.gpu.error));
    return 0;
}

static void read_map(const surface *s)
{
    const host_image_def def = {
        .format = VK_FORMAT_R32G32B32A32_SFLOAT, .extent = {CELLS, CELLS, 1}, .name = "wetness"};
    const VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    VkCommandBuffer cmd;
    REQUIRE(host_image_create_with(&f.gpu.device, &def, f.texels, sizeof f.texels, 16, &f.map, f.gpu.error,
                                   sizeof f.gpu.error));
    host_set_write_image(&f.gpu.device, f.set, 0, f.sampler, f.map.view, layout);
    host_set_write_image(&f.gpu.device, f.set, 1, f.sampler, f.spots.view, layout);
    host_set_write_buffer(&f.gpu.device, f.set, 2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, f.found.buffer);
    REQUIRE(host_begin_frame(&f.gpu.device, &cmd, f.gpu.error, sizeof f.gpu.error));
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, f.pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, f.layout, 0, 1, &f.set, 0, NULL);
    vkCmdPushConstants(cmd, f.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof *s, s);
    vkCmdDispatch(cmd, SIDE / 8, SIDE / 8, 1);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    effect_fixture_submit(&f.gpu);
    host_buffer_invalidate(&f.gpu.device, &f.found);
    host_image_destroy(&f.gpu.device, &f.map);
}

static void bounds(double *low, double *high)
{
    const float *found = f.found.mapped;
    *low = INFINITY;
    *high = -INFINITY;
    for (int i = 0; i < SIDE * SIDE; i++) {
        *low = fmin(*low, (double)found[i]);
        *high = fmax(*high, (double)found[i]);
    }
}

static int end(void **state)
{
    (void)state;
    const VkDevice device = f.gpu.device.device;
    vkDestroyPipeline(device, f.pipeline, NULL);
    vkDestroyPipelineLayout(device, f.layout, NULL);
    vkDestroyDescriptorPool(device, f.pool, NULL);
    vkDestroyDescriptorSetLayout(device, f.set_layout, NULL);
    vkDestroySampler(device, f.sampler, NULL);
    host_image_destroy(&f.gpu.device, &f.spots);
    host_buffer_destroy(&f.gpu.device, &f.found);
    return fixture_end(&f.gpu) ? -1 : 0;
}

/* Wet ground everywhere: its height at the middle of each cell. */
static void lay(float rise_x, float rise_z, float step_m)
{
    for (int z = 0; z < CELLS; z++)
        for (int x = 0; x < CELLS; x++) {
            const float height =
                rise_x * ((float)x + 0.5f) + rise_z * ((float)z + 0.5f) + (x >= CELLS / 2 ? step_m : 0);
            const float texel[4] = {1, 1, 0, height};
            memcpy(f.texels[z][x], texel, sizeof texel);
        }
}

/* Slopes up to 45 degrees, cells of the window and of the map beyond it. They were striped: cells that lie higher or
 * lower by more than 0.2 m counted as another surface. */
static void a_hill_is_wet_everywhere(void **state)
{
    static const float slopes[][2] = {{0.3f, 0}, {0, -0.6f}, {0.5f, 0.5f}, {-1, 0}, {0.9f, -0.9f}};
    static const float cells_m[] = {0.05f, 0.1f, 0.8f, 1.6f};
    (void)state;
    for (size_t i = 0; i < 5; i++)
        for (size_t k = 0; k < 4; k++)
            for (int32_t far = 0; far < 2; far++) {
                const float cell_m = cells_m[k];
                const surface s = {{slopes[i][0] * cell_m, slopes[i][1] * cell_m}, 0, cell_m, CELLS, far};
                double low, high;
                lay(s.rise[0], s.rise[1], 0);
                read_map(&s);
                bounds(&low, &high);
                /* The map beyond the window fades to its edge. */
                if (far ? high < 0.999 : low < 0.999)
                    fail_msg("slope %g, %g, cells of %g m: wet is %g to %g", (double)slopes[i][0], (double)slopes[i][1],
                             (double)cell_m, low, high);
                const float *found = f.found.mapped;
                const int middle = SIDE / 2;
                for (int n = 0; n < 8; n++)
                    assert_float_equal(found[middle * SIDE + middle + n], found[middle * SIDE + middle], 1e-3);
            }
}

/* A terrace 3 m above the ground: a level plane half way up, as a wall has points there, belongs to neither. */
static void what_is_between_two_surfaces_is_dry(void **state)
{
    static const float cells_m[] = {0.05f, 0.1f, 0.8f, 1.6f};
    (void)state;
    for (size_t k = 0; k < 4; k++)
        for (int32_t far = 0; far < 2; far++) {
            const surface s = {{0, 0}, 1.5f, cells_m[k], CELLS, far};
            double low, high;
            lay(0, 0, 3);
            read_map(&s);
            bounds(&low, &high);
            assert_float_equal(high, 0, 1e-6);
        }
}

/* Ground in front of a wall is as wet as before it, though beyond its foot cells are the wall's top; on the wall itself
 * nothing is wet. It had a dry strip there, half a cell wide. */
static void ground_is_wet_up_to_a_wall(void **state)
{
    static const float cells_m[] = {0.05f, 0.1f};
    (void)state;
    for (size_t k = 0; k < 2; k++) {
        const surface s = {{0, 0}, 0, cells_m[k], CELLS, 0};
        const float *found = f.found.mapped;
        lay(0, 0, 3);
        read_map(&s);
        for (int x = 0; x < SIDE; x++) {
            const float at = 2 + ((float)x + 0.5f) / SIDE * (CELLS - 4);
            if (at < CELLS / 2)
                assert_float_equal(found[SIDE / 2 * SIDE + x], 1, 1e-3);
            else if (at > CELLS / 2 + 0.5f)
                assert_float_equal(found[SIDE / 2 * SIDE + x], 0, 1e-6);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_hill_is_wet_everywhere, begin, end),
        cmocka_unit_test_setup_teardown(what_is_between_two_surfaces_is_dry, begin, end),
        cmocka_unit_test_setup_teardown(ground_is_wet_up_to_a_wall, begin, end),
    };
    return fixture_result(cmocka_run_group_tests(tests, NULL, NULL));
}
