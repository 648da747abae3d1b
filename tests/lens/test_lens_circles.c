/* test_lens_circles.c - circles of confusion for a host that blurs by itself, against double precision. */
#include "lens_drawn.h"

#define WIDTH  37
#define HEIGHT 29

/* Fills the depths of a picture from 0.15 m to the sky. */
static void paint_depths(lens_picture *picture, uint32_t *hash)
{
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        picture->depth[i] = i % 7 ? (float)(6.6 * lens_random(hash)) : 0;
}

/* The radius of virga/lens.h's thin lens in pixels, cut to the largest. */
static double expected(const lens_fixture *f, float inv_depth)
{
    const double aperture_m = (double)f->settings.focal_m / (double)f->settings.aperture_f;
    const double focus_inv_m = f->settings.focus_m > 0 ? 1 / (double)f->settings.focus_m : 0;
    const double most = (double)f->settings.max_radius_px;
    const double radius = 0.5 * aperture_m * 0.5 * HEIGHT * (double)LENS_COTANGENT * (focus_inv_m - (double)inv_depth);
    return fmin(fmax(radius, -most), most);
}

/* Copies one part's circles of the newest prepare. */
static void read_circles(lens_fixture *f, VkCommandBuffer cmd, uint32_t part, VkDeviceSize offset)
{
    virga_lens_image circles;
    virga_lens_circles(f->lens, part, &circles);
    assert_true(circles.width == WIDTH && circles.height == HEIGHT && circles.view);
    const VkBufferImageCopy copy = {.bufferOffset = offset,
                                    .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, part, 1},
                                    .imageExtent = {WIDTH, HEIGHT, 1}};
    vkCmdCopyImageToBuffer(cmd, circles.image, VK_IMAGE_LAYOUT_GENERAL, f->download.buffer, 1, &copy);
}

enum { BYTES = WIDTH * HEIGHT * 4, MOVING = 0, FLAT, ON_SCENE, LAYERS };

/* Depths of the scene, and of a layer that has its own; another is all at 0.4 m, and one lies on the scene. The layers
 * have no color. */
static void prepare_circles(lens_fixture *f, host_image images[2])
{
    virga_lens_layer layers[LAYERS] = {[FLAT].depth_m = 0.4f, [ON_SCENE].on_scene = 1};
    virga_lens_image none;
    f->view.depth = lens_upload(f, &f->scene, true, &images[0]);
    layers[MOVING].depth = lens_upload(f, &f->layers[0], true, &images[1]);
    REQUIRE(virga_lens_set(f->lens, &f->settings) == VIRGA_OK);
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    REQUIRE(virga_lens_prepare(f->lens, cmd, &f->view, layers, LAYERS, f->time_s) == VIRGA_OK);
    for (uint32_t part = 0; part <= LAYERS; part++)
        read_circles(f, cmd, part, part * (VkDeviceSize)BYTES);
    virga_lens_circles(f->lens, LAYERS + 1, &none);
    assert_true(!none.image && !none.view && !none.width);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
    effect_fixture_complete(&f->gpu, f->context);
    host_buffer_invalidate(&f->gpu.device, &f->download);
}

static void check_part(const lens_fixture *f, uint32_t part, const float *inv_depths, float inv_depth)
{
    const float *found = (const float *)((const char *)f->download.mapped + (size_t)part * BYTES);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const double radius = expected(f, inv_depths ? inv_depths[i] : inv_depth);
        if (!(fabs((double)found[i] - radius) < 1e-5 * fabs(radius) + 2e-5))
            fail_msg("part %u, pixel %u: %g px, expected %g", part, i, (double)found[i], radius);
    }
}

static void circles_are_those_of_a_thin_lens(void **state)
{
    (void)state;
    lens_fixture f;
    uint32_t hash = 17;
    lens_fixture_open_circles(&f, WIDTH, HEIGHT, (LAYERS + 1) * BYTES);
    lens_fixture_layer(&f, 0);
    const float focuses_m[] = {0, 0.1f, 0.7f, 1e6f}, apertures_f[] = {0.5f, 8, 128};
    for (size_t i = 0; i < sizeof focuses_m / sizeof *focuses_m * 3; i++) {
        host_image images[2];
        paint_depths(&f.scene, &hash);
        paint_depths(&f.layers[0], &hash);
        f.settings.focus_m = focuses_m[i / 3];
        f.settings.aperture_f = apertures_f[i % 3];
        f.settings.max_radius_px = i % 2 ? 20 : 126; /* also more than the blur of a picture can have */
        prepare_circles(&f, images);
        check_part(&f, 0, f.scene.depth, 0);
        check_part(&f, 1 + MOVING, f.layers[0].depth, 0);
        check_part(&f, 1 + FLAT, NULL, 1 / 0.4f);
        check_part(&f, 1 + ON_SCENE, f.scene.depth, 0);
        host_image_destroy(&f.gpu.device, &images[1]);
        host_image_destroy(&f.gpu.device, &images[0]);
    }
    assert_int_equal(f.log_lines, 0);
    lens_fixture_close(&f);
}

/* A pinhole has none, and where there is no depth all is in focus. */
static void without_aperture_or_depth_they_are_zero(void **state)
{
    (void)state;
    lens_fixture f;
    uint32_t hash = 5;
    lens_fixture_open_circles(&f, WIDTH, HEIGHT, BYTES);
    for (int pinhole = 0; pinhole < 2; pinhole++) {
        host_image image;
        paint_depths(&f.scene, &hash);
        f.settings.aperture_f = pinhole ? 0 : 1;
        REQUIRE(virga_lens_set(f.lens, &f.settings) == VIRGA_OK);
        f.view.depth = lens_upload(&f, &f.scene, true, &image);
        f.view.depth = pinhole ? f.view.depth : (virga_image){0};
        const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
        REQUIRE(virga_lens_prepare(f.lens, cmd, &f.view, NULL, 0, 0) == VIRGA_OK);
        read_circles(&f, cmd, 0, 0);
        effect_fixture_complete(&f.gpu, f.context);
        host_buffer_invalidate(&f.gpu.device, &f.download);
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
            assert_true(((const float *)f.download.mapped)[i] == 0);
        host_image_destroy(&f.gpu.device, &image);
    }
    lens_fixture_close(&f);
}

static void such_a_lens_has_no_picture_and_a_draw_says_so(void **state)
{
    (void)state;
    lens_fixture f;
    lens_drawn drawn;
    host_image image;
    virga_lens_image picture;
    lens_fixture_open_circles(&f, WIDTH, HEIGHT, WIDTH * HEIGHT * 8);
    lens_create_drawn(&f, &drawn);
    f.view.depth = lens_upload(&f, &f.scene, true, &image);
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    REQUIRE(virga_lens_prepare(f.lens, cmd, &f.view, NULL, 0, 0) == VIRGA_OK);
    virga_lens_picture(f.lens, &picture);
    assert_true(!picture.image && !picture.view);
    assert_int_equal(lens_draw_and_read(&f, &drawn, cmd, LENS_WHOLE), VIRGA_ERROR_INVALID);
    assert_non_null(strstr(f.log[0], "lens_def.circles"));
    host_image_destroy(&f.gpu.device, &image);
    lens_destroy_drawn(&f, &drawn);
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(circles_are_those_of_a_thin_lens),
        cmocka_unit_test(without_aperture_or_depth_they_are_zero),
        cmocka_unit_test(such_a_lens_has_no_picture_and_a_draw_says_so),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
