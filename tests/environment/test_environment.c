/* test_environment.c - harmonics and panoramas of a host's images, against sums and formulas in double precision. */
#include "../gpu/gpu_fixture.h"
#include "../scene/host_parts.h"

#include <math.h>

enum { WIDTH = 64, HEIGHT = 32, FACE = 24, PANORAMA = 128 };

#define PI     3.14159265358979323846
#define FORMAT VK_FORMAT_R32G32B32A32_SFLOAT

typedef struct lit {
    gpu_fixture *f;
    virga_context *context;
    virga_environment *environment;
    host_image flat;
    VkImage cube;
    VkImageView cube_view;
    VkDeviceMemory cube_memory;
    host_buffer down;
} lit;

/* The surroundings: a sky, a ground, and a small bright lamp low in the east. */
static void light_of(const double d[3], double light[3])
{
    const double lamp = 50 * exp(40 * (0.96 * d[0] + 0.28 * d[1] - 1));
    for (int c = 0; c < 3; c++)
        light[c] = 0.4 + 0.3 * d[1] + 0.1 * (c + 1) * d[0] * d[2] + lamp / (c + 1);
}

static void add_harmonics(const double d[3], const double light[3], double solid, double sh[9][3])
{
    const double x = d[0], y = d[1], z = d[2];
    const double band[9] = {sqrt(1 / PI) / 2,
                            sqrt(3 / PI) / 2 * y,
                            sqrt(3 / PI) / 2 * z,
                            sqrt(3 / PI) / 2 * x,
                            sqrt(15 / PI) / 2 * x * y,
                            sqrt(15 / PI) / 2 * y * z,
                            sqrt(5 / PI) / 4 * (3 * z * z - 1),
                            sqrt(15 / PI) / 2 * x * z,
                            sqrt(15 / PI) / 4 * (x * x - y * y)};
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            sh[i][c] += band[i] * light[c] * solid;
}

static void on_panorama(double column, double row, double d[3])
{
    const double azimuth = (column / WIDTH - 0.5) * 2 * PI, polar = row / HEIGHT * PI;
    d[0] = sin(polar) * sin(azimuth);
    d[1] = cos(polar);
    d[2] = -sin(polar) * cos(azimuth);
}

static void on_cube(int face, double s, double t, double d[3])
{
    const double faces[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
    const double length = sqrt(1 + s * s + t * t);
    for (int i = 0; i < 3; i++)
        d[i] = faces[face][i] / length;
}

/* ---- open and close */

static void open_lit(lit *l, void **state)
{
    virga_environment_def def = virga_default_environment_def();
    *l = (lit){.f = *state};
    def.panorama_width = PANORAMA;
    l->context = gpu_context(l->f);
    REQUIRE(virga_environment_create(l->context, &def, &l->environment) == VIRGA_OK);
    REQUIRE(host_buffer_create(&l->f->gpu.device, PANORAMA * PANORAMA / 2 * 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "panorama", &l->down, l->f->gpu.error, sizeof l->f->gpu.error));
}

static void close_lit(lit *l)
{
    host_device *device = &l->f->gpu.device;
    virga_environment_destroy(&l->environment);
    virga_context_destroy(&l->context);
    host_image_destroy(device, &l->flat);
    host_buffer_destroy(device, &l->down);
    if (l->cube) {
        vkDestroyImageView(device->device, l->cube_view, NULL);
        vkDestroyImage(device->device, l->cube, NULL);
        vkFreeMemory(device->device, l->cube_memory, NULL);
    }
}

static virga_environment_info flat(lit *l, VkFormat format, const void *data, uint32_t bytes)
{
    fixture *gpu = &l->f->gpu;
    const host_image_def def = {
        .format = format, .extent = {WIDTH, HEIGHT, 1}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT, .name = "surroundings"};
    host_image_destroy(&gpu->device, &l->flat);
    REQUIRE(host_image_create_with(&gpu->device, &def, data, (VkDeviceSize)WIDTH * HEIGHT * bytes, bytes, &l->flat,
                                   gpu->error, sizeof gpu->error));
    return (virga_environment_info){.image = {.image = l->flat.image,
                                              .view = l->flat.view,
                                              .format = format,
                                              .before = {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}},
                                    .width = WIDTH,
                                    .height = HEIGHT};
}

static uint32_t device_type(const lit *l, uint32_t bits)
{
    VkPhysicalDeviceMemoryProperties types;
    vkGetPhysicalDeviceMemoryProperties(l->f->gpu.device.physical, &types);
    for (uint32_t i = 0; i < types.memoryTypeCount; i++)
        if (bits >> i & 1 && types.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT)
            return i;
    return 0;
}

static void make_cube(lit *l)
{
    const VkDevice device = l->f->gpu.device.device;
    const VkImageCreateInfo info = {.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                    .flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT,
                                    .imageType = VK_IMAGE_TYPE_2D,
                                    .format = FORMAT,
                                    .extent = {FACE, FACE, 1},
                                    .mipLevels = 1,
                                    .arrayLayers = 6,
                                    .samples = VK_SAMPLE_COUNT_1_BIT,
                                    .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    VkMemoryRequirements need;
    REQUIRE(vkCreateImage(device, &info, NULL, &l->cube) == VK_SUCCESS);
    vkGetImageMemoryRequirements(device, l->cube, &need);
    const VkMemoryAllocateInfo memory = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                         .allocationSize = need.size,
                                         .memoryTypeIndex = device_type(l, need.memoryTypeBits)};
    REQUIRE(vkAllocateMemory(device, &memory, NULL, &l->cube_memory) == VK_SUCCESS);
    REQUIRE(vkBindImageMemory(device, l->cube, l->cube_memory, 0) == VK_SUCCESS);
    const VkImageViewCreateInfo view = {.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                        .image = l->cube,
                                        .viewType = VK_IMAGE_VIEW_TYPE_CUBE,
                                        .format = FORMAT,
                                        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 6}};
    REQUIRE(vkCreateImageView(device, &view, NULL, &l->cube_view) == VK_SUCCESS);
}

static void barrier(VkCommandBuffer cmd, VkImage image, uint32_t layers, VkImageLayout from, VkImageLayout to)
{
    const VkImageMemoryBarrier barrier = {.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                          .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
                                          .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
                                          .oldLayout = from,
                                          .newLayout = to,
                                          .image = image,
                                          .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers}};
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    vkCmdPipelineBarrier(cmd, all, all, 0, 0, NULL, 0, NULL, 1, &barrier);
}

static void fill_cube(lit *l, const float *texels, VkDeviceSize size)
{
    fixture *gpu = &l->f->gpu;
    host_buffer up;
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 6},
                                    .imageExtent = {FACE, FACE, 1}};
    REQUIRE(host_buffer_create_with(&gpu->device, texels, size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, "faces", &up,
                                    gpu->error, sizeof gpu->error));
    VkCommandBuffer cmd = gpu_begin_frame(l->f, l->context);
    barrier(cmd, l->cube, 6, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(cmd, up.buffer, l->cube, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    barrier(cmd, l->cube, 6, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    gpu_submit(l->f);
    gpu_wait(l->f);
    host_buffer_destroy(&gpu->device, &up);
}

/* ---- record, and compare */

static void record(lit *l, const virga_environment_info *info, float sh[9][3])
{
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {PANORAMA, PANORAMA / 2, 1}};
    virga_image panorama;
    VkCommandBuffer cmd = gpu_begin_frame(l->f, l->context);
    assert_int_equal(virga_environment_record(l->environment, cmd, info), VIRGA_OK);
    virga_environment_panorama(l->environment, &panorama);
    vkCmdCopyImageToBuffer(cmd, panorama.image, panorama.before.layout, l->down.buffer, 1, &copy);
    gpu_submit(l->f);
    gpu_wait(l->f);
    assert_int_equal(virga_frame_completed(l->context, l->f->gpu.device.completed), VIRGA_OK);
    assert_int_equal(virga_environment_harmonics(l->environment, sh), l->f->gpu.device.frame);
    host_buffer_invalidate(&l->f->gpu.device, &l->down);
}

static double largest_error(const float sh[9][3], const double expected[9][3])
{
    double most = 0;
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            most = fmax(most, fabs((double)sh[i][c] - expected[i][c]));
    return most / expected[0][0];
}

static double half_value(uint16_t bits)
{
    const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
    return exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
}

/* The panorama shows the same surroundings, as far as texels show the lamp: compared away from it. */
static void assert_panorama_shows_them(const lit *l)
{
    const uint16_t *halves = l->down.mapped;
    for (int y = 2; y < PANORAMA / 2 - 2; y++)
        for (int x = 0; x < PANORAMA; x++) {
            double d[3], light[3];
            on_panorama((x + 0.5) * WIDTH / PANORAMA, (y + 0.5) * HEIGHT * 2 / PANORAMA, d);
            light_of(d, light);
            if (0.96 * d[0] + 0.28 * d[1] > 0.6)
                continue;
            for (int c = 0; c < 3; c++)
                if (fabs(half_value(halves[4 * (y * PANORAMA + x) + c]) - light[c]) > 0.02)
                    fail_msg("texel (%d, %d): %g, expected %g", x, y, half_value(halves[4 * (y * PANORAMA + x) + c]),
                             light[c]);
        }
}

static void harmonics_of_a_panorama(void **state)
{
    static float texels[HEIGHT][WIDTH][4];
    double expected[9][3] = {{0}};
    float sh[9][3];
    lit l;
    open_lit(&l, state);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double d[3], light[3];
            on_panorama(x + 0.5, y + 0.5, d);
            light_of(d, light);
            for (int c = 0; c < 3; c++)
                texels[y][x][c] = (float)light[c];
            add_harmonics(d, light, 2 * PI / WIDTH * (cos(y * PI / HEIGHT) - cos((y + 1) * PI / HEIGHT)), expected);
        }
    const virga_environment_info info = flat(&l, FORMAT, texels, 16);
    record(&l, &info, sh);
    const double error = largest_error(sh, expected);
    printf("panorama: off by %.2e of the mean light\n", error);
    assert_true(error < 1e-5);
    assert_panorama_shows_them(&l);
    close_lit(&l);
}

static void harmonics_of_a_cube_map(void **state)
{
    static float texels[6][FACE][FACE][4];
    double expected[9][3] = {{0}}, whole = 0;
    float sh[9][3];
    lit l;
    open_lit(&l, state);
    for (int face = 0; face < 6; face++)
        for (int y = 0; y < FACE; y++)
            for (int x = 0; x < FACE; x++) {
                const double s = (2 * x + 1.0) / FACE - 1, t = (2 * y + 1.0) / FACE - 1;
                const double solid = 4.0 / FACE / FACE / pow(1 + s * s + t * t, 1.5);
                double d[3], light[3];
                on_cube(face, s, t, d);
                light_of(d, light);
                for (int c = 0; c < 3; c++)
                    texels[face][y][x][c] = (float)light[c];
                add_harmonics(d, light, solid, expected);
                whole += solid;
            }
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            expected[i][c] *= 4 * PI / whole;
    make_cube(&l);
    fill_cube(&l, &texels[0][0][0][0], sizeof texels);
    const virga_environment_info info = {.kind = VIRGA_ENVIRONMENT_CUBE,
                                         .image = {.image = l.cube,
                                                   .view = l.cube_view,
                                                   .format = FORMAT,
                                                   .before = {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}},
                                         .width = FACE,
                                         .height = FACE};
    record(&l, &info, sh);
    const double error = largest_error(sh, expected);
    printf("cube map: off by %.2e of the mean light\n", error);
    assert_true(error < 1e-5);
    assert_panorama_shows_them(&l);
    close_lit(&l);
}

/* The z axis of the image is up: the same sky, turned. And its bytes are encoded. */
static void an_image_may_be_turned_and_encoded(void **state)
{
    static uint8_t texels[HEIGHT][WIDTH][4];
    double expected[9][3] = {{0}};
    float sh[9][3];
    lit l;
    open_lit(&l, state);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            double d[3], light[3];
            on_panorama(x + 0.5, y + 0.5, d);
            for (int c = 0; c < 3; c++) {
                texels[y][x][c] = (uint8_t)(128 + 100 * d[c]);
                light[c] = pow((texels[y][x][c] / 255.0 + 0.055) / 1.055, 2.4);
                if (texels[y][x][c] <= 10)
                    light[c] = texels[y][x][c] / 255.0 / 12.92;
            }
            /* What is along the image's +Z is up: the world's (x, y, z) is the image's (x, z, -y). */
            const double world[3] = {d[0], d[2], -d[1]};
            add_harmonics(world, light, 2 * PI / WIDTH * (cos(y * PI / HEIGHT) - cos((y + 1) * PI / HEIGHT)), expected);
        }
    virga_environment_info info = flat(&l, VK_FORMAT_R8G8B8A8_UNORM, texels, 4);
    const float turned[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
    memcpy(info.image_from_world, turned, sizeof turned);
    info.encoding = VIRGA_ENCODING_SRGB;
    record(&l, &info, sh);
    assert_true(largest_error(sh, expected) < 1e-5);
    close_lit(&l);
}

/* A picture of 90 degrees to the sides, before grey surroundings: it replaces the part that it shows. */
static void a_picture_stands_for_what_it_shows(void **state)
{
    static float texels[HEIGHT][WIDTH][4];
    const gpu_picture size = {.images = {.width = WIDTH, .height = HEIGHT}};
    const double grey = 0.3;
    double expected[9][3] = {{0}};
    float sh[9][3];
    lit l;
    open_lit(&l, state);
    const virga_view view = gpu_view(&size);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const double ray[3] = {2 * (x + 0.5) / WIDTH - 1, 1 - 2 * (y + 0.5) / HEIGHT, -1};
            const double length = sqrt(ray[0] * ray[0] + ray[1] * ray[1] + 1);
            const double d[3] = {ray[0] / length, ray[1] / length, ray[2] / length};
            double light[3], more[3];
            light_of(d, light);
            for (int c = 0; c < 3; c++) {
                texels[y][x][c] = (float)light[c];
                more[c] = light[c] - grey;
            }
            add_harmonics(d, more, 4.0 / WIDTH / HEIGHT / (length * length * length), expected);
        }
    virga_environment_info info = flat(&l, FORMAT, texels, 16);
    info.kind = VIRGA_ENVIRONMENT_PICTURE;
    info.view = &view;
    for (int c = 0; c < 3; c++) {
        info.rest_sh[0][c] = (float)(grey * 2 * sqrt(PI));
        expected[0][c] += grey * 2 * sqrt(PI);
    }
    record(&l, &info, sh);
    const double error = largest_error(sh, expected);
    printf("picture: off by %.2e of the mean light\n", error);
    assert_true(error < 1e-5);
    close_lit(&l);
}

/* ---- pictures of frames that go on */

/* What the host draws into its picture: one color. */
static void paint(const lit *l, VkCommandBuffer cmd, float light)
{
    const VkClearColorValue color = {.float32 = {light, 2 * light, 4 * light, 1}};
    const VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    host_image_barrier(cmd, &l->flat, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       VK_ACCESS_TRANSFER_WRITE_BIT);
    vkCmdClearColorImage(cmd, l->flat.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &color, 1, &all);
    host_image_barrier(cmd, &l->flat, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT,
                       VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_READ_BIT);
}

/* A frame whose picture has one color, with the same around it. */
static void record_painted(lit *l, const virga_environment_info *info, float light, bool lost, bool tell)
{
    virga_environment_info with = *info;
    VkCommandBuffer cmd = gpu_begin_frame(l->f, l->context);
    for (int c = 0; c < 3; c++)
        with.rest_sh[0][c] = (float)(1 << c) * light * (float)(2 * sqrt(PI));
    paint(l, cmd, light);
    assert_int_equal(virga_environment_record(l->environment, cmd, &with), VIRGA_OK);
    if (lost)
        host_parts_throw_away(&l->f->gpu.device, l->context, cmd, tell);
    gpu_submit(l->f);
}

/* The light and the frame that are found once all is done. */
static uint64_t find_light(lit *l, double *light)
{
    float sh[9][3] = {{0}};
    gpu_wait(l->f);
    assert_int_equal(virga_frame_completed(l->context, l->f->gpu.device.completed), VIRGA_OK);
    const uint64_t frame = virga_environment_harmonics(l->environment, sh);
    *light = (double)sh[0][0] / (2 * sqrt(PI));
    for (int c = 0; c < 3 && frame; c++)
        assert_float_equal((double)sh[0][c], (1 << c) * *light * 2 * sqrt(PI), 1e-4);
    return frame;
}

/* The host's last picture, recorded in the frame that draws it, frame after frame without waiting. Frames that are
 * thrown away, reported or not, leave the light of the newest frame that the device has executed. */
static void the_last_picture_of_each_frame_is_found(void **state)
{
    static const float black[HEIGHT][WIDTH][4];
    const gpu_picture size = {.images = {.width = WIDTH, .height = HEIGHT}};
    double light;
    lit l;
    open_lit(&l, state);
    const virga_view view = gpu_view(&size);
    virga_environment_info info = flat(&l, FORMAT, black, 16);
    info.kind = VIRGA_ENVIRONMENT_PICTURE;
    info.view = &view;
    record_painted(&l, &info, 7, true, true); /* the first one is lost */
    assert_int_equal(find_light(&l, &light), 0);
    for (int frame = 1; frame <= 6; frame++)
        record_painted(&l, &info, (float)frame, false, false);
    const uint64_t sixth = find_light(&l, &light);
    assert_int_equal(sixth, l.f->gpu.device.frame);
    assert_float_equal(light, 6, 1e-4);
    for (int tell = 0; tell < 2; tell++) {
        record_painted(&l, &info, 9, true, tell);
        assert_int_equal(find_light(&l, &light), sixth);
        assert_float_equal(light, 6, 1e-4);
    }
    record_painted(&l, &info, 3, false, false);
    assert_int_equal(find_light(&l, &light), l.f->gpu.device.frame);
    assert_float_equal(light, 3, 1e-4);
    close_lit(&l);
}

/* ---- mistakes */

static void refuse_as(lit *l, VkCommandBuffer cmd, const virga_environment_info *info, virga_log_id id,
                      const char *line)
{
    gpu_forget_log(l->f);
    assert_int_equal(virga_environment_record(l->environment, cmd, info), VIRGA_ERROR_INVALID);
    assert_one_error(l->f, id);
    if (!strstr(l->f->last, line))
        fail_msg("expected '%s' in: %s", line, l->f->last);
}

static void refuse(lit *l, VkCommandBuffer cmd, const virga_environment_info *info, const char *line)
{
    refuse_as(l, cmd, info, VIRGA_LOG_ARGUMENT, line);
}

static void what_is_missing_or_wrong_is_told(void **state)
{
    static const float texels[HEIGHT][WIDTH][4];
    lit l;
    float sh[9][3];
    open_lit(&l, state);
    const virga_environment_info good = flat(&l, FORMAT, texels, 16);
    virga_environment_info wrong = good;
    assert_int_equal(virga_environment_harmonics(l.environment, sh), 0);
    VkCommandBuffer cmd = gpu_begin_frame(l.f, l.context);
    wrong.image.view = VK_NULL_HANDLE;
    refuse(&l, cmd, &wrong, "environment_info.image");
    wrong = good;
    wrong.width = 0;
    refuse(&l, cmd, &wrong, "environment_info.width");
    wrong = good;
    wrong.kind = VIRGA_ENVIRONMENT_CUBE;
    refuse(&l, cmd, &wrong, "environment_info.height: expected the width");
    wrong.kind = VIRGA_ENVIRONMENT_PICTURE;
    refuse(&l, cmd, &wrong, "environment_info.view");
    wrong = good;
    wrong.image_from_world[0] = 2;
    refuse(&l, cmd, &wrong, "environment_info.image_from_world");
    assert_int_equal(virga_environment_record(l.environment, cmd, &good), VIRGA_OK);
    refuse_as(&l, cmd, &good, VIRGA_LOG_FRAME_ORDER, "called again in frame");
    gpu_submit(l.f);
    gpu_wait(l.f);
    close_lit(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(harmonics_of_a_panorama),
        gpu_kept_test(harmonics_of_a_cube_map),
        gpu_kept_test(an_image_may_be_turned_and_encoded),
        gpu_kept_test(a_picture_stands_for_what_it_shows),
        gpu_kept_test(the_last_picture_of_each_frame_is_found),
        gpu_kept_test(what_is_missing_or_wrong_is_told),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("environment", tests, NULL, NULL));
}
