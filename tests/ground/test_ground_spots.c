/* What hosts read of dark spots: virga_ground_spots of shared/ground_map.glsl, on maps that a test writes. */
#include "../host/effect_fixture.h"

#include "spots.spv.h"

#include <descriptors.h>
#include <pipeline.h>

#include <math.h>
#include <string.h>

#define CELLS 16
#define BITS  (8 * CELLS)
#define SIDE  1024 /* points along an edge of the square that is read */

/* As spots.comp has it. */
typedef struct square {
    int32_t low_cell[2];
    float first[2], apart, pixel_cells;
    int32_t cells;
    float wet, joint_m, most_m;
} square;

static struct {
    fixture gpu;
    host_image map;
    host_buffer found;
    VkSampler sampler;
    VkDescriptorSetLayout set_layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    uint32_t words[CELLS][2 * CELLS];
} f;

static void set_bit(int x, int z)
{
    f.words[z / 8][x / 8 * 2 + z % 8 / 4] |= 1u << (z % 4 * 8 + x % 8);
}

static void make_pipeline(void)
{
    static const VkDescriptorType types[2] = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                              VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    const host_set_shape shape = {types, 2, VK_SHADER_STAGE_COMPUTE_BIT};
    host_device *device = &f.gpu.device;
    char *error = f.gpu.error;
    const size_t size = sizeof f.gpu.error;
    REQUIRE(host_sampler_create(device, HOST_SAMPLE_NEAREST, &f.sampler, error, size));
    REQUIRE(host_set_layout_create(device, &shape, &f.set_layout, error, size));
    REQUIRE(host_set_pool_create(device, &shape, 1, &f.pool, error, size));
    REQUIRE(host_sets_allocate(device, f.pool, f.set_layout, 1, &f.set, error, size));
    REQUIRE(host_pipeline_layout_create(device, &f.set_layout, 1, VK_SHADER_STAGE_COMPUTE_BIT, sizeof(square),
                                        &f.layout, error, size));
    REQUIRE(host_compute_create(device, HOST_CODE(spots), f.layout, &f.pipeline, error, size));
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
    REQUIRE(host_buffer_create(&f.gpu.device, 4ull * SIDE * SIDE, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                               HOST_BUFFER_READBACK, "found", &f.found, f.gpu.error, sizeof f.gpu.error));
    return 0;
}

/* The bits set until now are the map. */
static void put_map(void)
{
    const host_image_def def = {.format = VK_FORMAT_R32_UINT, .extent = {2 * CELLS, CELLS, 1}, .name = "spots"};
    REQUIRE(host_image_create_with(&f.gpu.device, &def, f.words, sizeof f.words, 4, &f.map, f.gpu.error,
                                   sizeof f.gpu.error));
    host_set_write_image(&f.gpu.device, f.set, 0, f.sampler, f.map.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    host_set_write_buffer(&f.gpu.device, f.set, 1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, f.found.buffer);
}

static const float *read_square(const square *s)
{
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&f.gpu.device, &cmd, f.gpu.error, sizeof f.gpu.error));
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, f.pipeline);
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, f.layout, 0, 1, &f.set, 0, NULL);
    vkCmdPushConstants(cmd, f.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof *s, s);
    vkCmdDispatch(cmd, SIDE / 8, SIDE / 8, 1);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    effect_fixture_submit(&f.gpu);
    host_buffer_invalidate(&f.gpu.device, &f.found);
    return f.found.mapped;
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
    host_image_destroy(&f.gpu.device, &f.map);
    host_buffer_destroy(&f.gpu.device, &f.found);
    return fixture_end(&f.gpu) ? -1 : 0;
}

/* Eight points per bit, over the whole map. */
static const square whole = {.apart = 1.0f / 64, .first = {1.0f / 128, 1.0f / 128}, .cells = CELLS, .wet = 0.7f};

static double mean_of(const float *found)
{
    double sum = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += (double)found[i];
    return sum / SIDE / SIDE;
}

/* Every fourth bit along both axes. */
static void put_single_bits(void)
{
    for (int i = 0; i < 1024; i++)
        set_bit(i % 32 * 4 + 1, i / 32 * 4 + 1);
    put_map();
}

/* With what shared/ground_map.glsl has: the mean over 1024 places, whose radii are in [0.35; 0.9]. */
static void spots_by_themselves_are_as_dark_as_wide_pixels_have_them(void **state)
{
    (void)state;
    put_single_bits();
    const double mean = 16 * mean_of(read_square(&whole));
    print_message("%.3f of a bit\n", mean);
    assert_float_equal(mean, 0.69, 0.02);
}

/* Points of the map that are at least this dark. */
static int count_dark(float wet, float least)
{
    square s = whole;
    s.wet = wet;
    const float *found = read_square(&s);
    int count = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        count += found[i] > least;
    return count;
}

/* Where half of the pores are full all spots are whole, and a sixteenth of the ground is theirs: they have 80 times the
 * water that the smallest needs. With the least water for which the largest are whole, small ones are smaller; with a
 * sixteenth of that, all have half of their radii, and are still as dark in the middle. */
static void spots_dry_from_the_rim(void **state)
{
    (void)state;
    put_single_bits();
    const float least = 0.1f / 16 / (0.9f * 2.4f);
    const int fresh = count_dark(0.5f, 0), damp = count_dark(least, 0), half = count_dark(least / 16, 0);
    print_message("%d points, %d, and %d of them half dry\n", fresh, damp, half);
    assert_true(damp < 0.95 * fresh);
    assert_float_equal((double)half / damp, 0.25, 0.01);
    assert_true(count_dark(least / 16, 0.5f) > 1024);
    assert_int_equal(count_dark(0, 0), 0);
}

/* Small ones have less water for their area, and are gone from where large ones still are. */
static void fewer_spots_are_left_the_drier_it_gets(void **state)
{
    (void)state;
    put_single_bits();
    int before = 1 << 30;
    for (float wet = 0.5f; wet > 1e-13f; wet *= 0.25f) {
        const int now = count_dark(wet, 0);
        assert_true(now <= before);
        before = now;
    }
    assert_true(before < 1024);
}

/* Otherwise it would have a straight edge where only other bits are around a point. */
static void no_spot_reaches_beyond_the_bits_beside(void **state)
{
    (void)state;
    put_single_bits();
    static const float edges[2] = {0.001f, 2.999f}; /* of the bits beside, in a period of 4 */
    for (int edge = 0; edge < 2; edge++) {
        square s = whole;
        s.first[0] = s.first[1] = edges[edge] / 8;
        const float *found = read_square(&s);
        for (int line = 0; line < SIDE - 32; line += 32)
            for (int i = 0; i < SIDE; i++) {
                assert_float_equal((double)found[line * SIDE + i], 0, 0);
                assert_float_equal((double)found[i * SIDE + line], 0, 0);
            }
    }
}

static void bits_side_by_side_have_no_gap(void **state)
{
    (void)state;
    memset(f.words, 0xff, sizeof f.words);
    put_map();
    const float *found = read_square(&whole);
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_float_equal((double)found[i], 1, 0);
}

/* A window that has moved by whole cells: the spots at a position stay as they were. */
static void spots_stay_where_they_are_when_the_window_moves(void **state)
{
    (void)state;
    for (int i = 0; i < 600; i++)
        set_bit(i * 37 % BITS, i * 101 % BITS);
    put_map();
    float *before = malloc(4ull * SIDE * SIDE);
    memcpy(before, read_square(&whole), 4ull * SIDE * SIDE);
    square moved = whole;
    moved.low_cell[0] = 11;
    moved.low_cell[1] = 5;
    moved.first[0] -= 11;
    moved.first[1] -= 5;
    const float *found = read_square(&moved);
    double largest = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        largest = fmax(largest, fabs((double)found[i] - (double)before[i]));
    free(before);
    assert_true(largest < 1e-3);
}

static void wide_pixels_have_the_mean_of_the_cell(void **state)
{
    (void)state;
    for (int i = 0; i < 10; i++)
        set_bit(5 * 8 + i % 8, 7 * 8 + i / 8 * 3);
    put_map();
    const double share = 10.0 / 64;
    const square one = {.first = {5.5f, 7.5f}, .apart = 0, .pixel_cells = 0.25f, .cells = CELLS, .wet = 1};
    assert_float_equal((double)read_square(&one)[0], share * (0.69 + 0.31 * share), 1e-6);
}

/* Of a joint 10 mm wide, in steps of 30 um: in the joint the darkness of its grains; beside it a strip that holds what
 * the joint has caught and its own rain, with a tenth of the pores full; nothing from 12 mm on. */
static void strips_beside_a_joint_hold_its_water(void **state)
{
    (void)state;
    static const float wets[6] = {0, 0.004f, 0.02f, 0.05f, 0.09f, 0.5f}, pixels_m[4] = {1e-4f, 1e-3f, 3e-3f, 0.02f};
    const double width = 0.010, most = 0.012, apart = 3e-5;
    put_map();
    for (int i = 0; i < 24; i++) {
        const double wet = (double)wets[i / 4], pixel = (double)pixels_m[i % 4];
        const square line = {.first = {-0.015f, 0},
                             .apart = (float)apart,
                             .wet = wets[i / 4],
                             .cells = CELLS,
                             .pixel_cells = pixels_m[i % 4],
                             .joint_m = (float)width,
                             .most_m = (float)most};
        const float *found = read_square(&line);
        const double grains = fmin(10 * wet, 1), strip = fmin(wet < 0.1 ? 0.5 * width * wet / (0.1 - wet) : 1, 0.008);
        double sum = 0;
        for (int k = 0; k < SIDE; k++) {
            const double away = -0.015 + apart * k;
            assert_true(found[k] >= 0 && found[k] <= 1);
            if (away < -0.5 * pixel)
                assert_float_equal((double)found[k], grains, 1e-5);
            if (away > most)
                assert_float_equal((double)found[k], 0, 1e-5);
            sum += apart * (double)found[k];
        }
        if (pixel < most) /* wider ones are cut off at most_m */
            assert_float_equal(sum, 0.015 * grains + strip, 6e-5);
        if (strip < 0.008)
            assert_float_equal(0.1 * 2 * strip, wet * (width + 2 * strip), 1e-8);
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, begin, end)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(spots_by_themselves_are_as_dark_as_wide_pixels_have_them),
        TEST(spots_dry_from_the_rim),
        TEST(fewer_spots_are_left_the_drier_it_gets),
        TEST(no_spot_reaches_beyond_the_bits_beside),
        TEST(bits_side_by_side_have_no_gap),
        TEST(spots_stay_where_they_are_when_the_window_moves),
        TEST(wide_pixels_have_the_mean_of_the_cell),
        TEST(strips_beside_a_joint_hold_its_water),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
