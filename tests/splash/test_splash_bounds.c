/* The box around a small crown outside of which its pixels are not worked out: crown_may_cover of puff_ring.glsl. And
 * the rectangles of a puff's crowns that are drawn one by one: crown_rect of puff_crowns.glsl. */
#include "../host/effect_fixture.h"

#include "puff_bounds.spv.h"
#include "puff_rects.spv.h"

#include <descriptors.h>
#include <pipeline.h>

#include <string.h>

#define CROWNS      16384
#define POINTS      256 /* around each, as puff_bounds.comp has it */
#define PUFFS       16384
#define PUFF_POINTS 64 /* of each, as puff_rects.comp has it */

static struct {
    fixture gpu;
    host_buffer found;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline pipeline, rects;
} f;

static void make_pipeline(void)
{
    static const VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    const host_set_shape shape = {&type, 1, VK_SHADER_STAGE_COMPUTE_BIT};
    host_device *device = &f.gpu.device;
    char *error = f.gpu.error;
    const size_t size = sizeof f.gpu.error;
    REQUIRE(host_set_layout_create(device, &shape, &f.set_layout, error, size));
    REQUIRE(host_set_pool_create(device, &shape, 1, &f.pool, error, size));
    REQUIRE(host_sets_allocate(device, f.pool, f.set_layout, 1, &f.set, error, size));
    REQUIRE(
        host_pipeline_layout_create(device, &f.set_layout, 1, VK_SHADER_STAGE_COMPUTE_BIT, 0, &f.layout, error, size));
    REQUIRE(host_compute_create(device, HOST_CODE(puff_bounds), f.layout, &f.pipeline, error, size));
    REQUIRE(host_compute_create(device, HOST_CODE(puff_rects), f.layout, &f.rects, error, size));
}

static int begin(void **state)
{
    (void)state;
    memset(&f, 0, sizeof f);
    if (!fixture_begin(&f.gpu)) {
        printf("skipped: %s\n", f.gpu.error);
        exit(77);
    }
    make_pipeline();
    REQUIRE(host_buffer_create(&f.gpu.device, 16ull * CROWNS, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_READBACK,
                               "found", &f.found, f.gpu.error, sizeof f.gpu.error));
    host_set_write_buffer(&f.gpu.device, f.set, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, f.found.buffer);
    return 0;
}

static int end(void **state)
{
    (void)state;
    const VkDevice device = f.gpu.device.device;
    vkDestroyPipeline(device, f.pipeline, NULL);
    vkDestroyPipeline(device, f.rects, NULL);
    vkDestroyPipelineLayout(device, f.layout, NULL);
    vkDestroyDescriptorPool(device, f.pool, NULL);
    vkDestroyDescriptorSetLayout(device, f.set_layout, NULL);
    host_buffer_destroy(&f.gpu.device, &f.found);
    return fixture_end(&f.gpu) ? -1 : 0;
}

/* Runs one of the shaders, and adds up what it writes. */
static void count(VkPipeline pipeline, uint32_t invocations, uint64_t sums[4])
{
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&f.gpu.device, &cmd, f.gpu.error, sizeof f.gpu.error));
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, f.layout, 0, 1, &f.set, 0, NULL);
    vkCmdDispatch(cmd, invocations / 64, 1, 1);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    effect_fixture_submit(&f.gpu);
    host_buffer_invalidate(&f.gpu.device, &f.found);
    const uint32_t(*found)[4] = f.found.mapped;
    memset(sums, 0, 4 * sizeof sums[0]);
    for (uint32_t i = 0; i < invocations; i++)
        for (int k = 0; k < 4; k++)
            sums[k] += found[i][k];
}

/* Nothing that a crown covers is left out, and what is left out is worth it. */
static void a_crown_covers_nothing_outside_of_its_box(void **state)
{
    uint64_t sums[4];
    (void)state;
    count(f.pipeline, CROWNS, sums);
    const uint64_t covers = sums[0], may = sums[1], missed = sums[2];
    const double all = (double)CROWNS * POINTS;
    printf("of all points %.3f are covered, %.3f may be, %llu are missed\n", (double)covers / all, (double)may / all,
           (unsigned long long)missed);
    assert_int_equal(missed, 0);
    assert_true(covers > 0 && may < 3 * covers);
}

/* Each point that a puff covers is in the rectangle of one crown, and none in those of two. A cell's border is computed
 * in two ways, so that a few points beside one, where rounding decides, may be in the wrong cell. */
static void crowns_of_a_puff_cover_nothing_outside_of_their_rectangles(void **state)
{
    uint64_t sums[4];
    (void)state;
    count(f.rects, PUFFS, sums);
    const double all = (double)PUFFS * PUFF_POINTS;
    printf("of all points %.3f are covered, %.3f in a rectangle, %llu are missed, %llu in two\n", (double)sums[0] / all,
           (double)sums[1] / all, (unsigned long long)sums[2], (unsigned long long)sums[3]);
    assert_true(sums[0] > 0 && sums[1] < PUFFS * (uint64_t)PUFF_POINTS);
    assert_true((double)sums[2] <= 2e-6 * all && (double)sums[3] <= 2e-6 * all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_crown_covers_nothing_outside_of_its_box, begin, end),
        cmocka_unit_test_setup_teardown(crowns_of_a_puff_cover_nothing_outside_of_their_rectangles, begin, end),
    };
    return fixture_result(cmocka_run_group_tests(tests, NULL, NULL));
}
