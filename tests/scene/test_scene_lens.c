/* test_scene_lens.c - a host's frame with a lens: scene, rain as a layer over it, and both out of focus. */
#include "../lens/lens_fixture.h"

#include "target.h"

#define WIDTH  96 /* pixels of the picture */
#define HEIGHT 64

typedef struct lens_host {
    fixture gpu;
    virga_context *context;
    virga_scene *scene;
    virga_lens *lens;
    virga_lens_settings settings;
    host_target target;
    virga_target *layer;
    virga_view view;
    host_buffer download;
    float plate; /* the scene's color, everywhere */
    float layer_depth_m;
} lens_host;

static void log_nothing(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user, (void)level, (void)id, (void)text;
}

/* Rain in the open, and a camera at eye height that looks along -Z. */
static void open_host(lens_host *h)
{
    memset(h, 0, sizeof *h);
    h->context = effect_fixture_open(&h->gpu, false, log_nothing, NULL);
    virga_scene_def def = virga_default_scene_def();
    def.rain.max_drops = 8192;
    def.rain.range_m = 8;
    def.rain.occlusion_size = 0;
    def.rain.max_ticks_per_step = 32;
    REQUIRE(virga_scene_create(h->context, &def, &h->scene) == VIRGA_OK);
    virga_lens_def lens = virga_default_lens_def();
    lens.max_width = WIDTH;
    lens.max_height = HEIGHT;
    REQUIRE(virga_lens_create(h->context, &lens, &h->lens) == VIRGA_OK);
    h->settings = virga_default_lens_settings();
    h->plate = 0.25f;
    virga_rain_settings rain;
    virga_rain_get(virga_scene_rain(h->scene), &rain);
    rain.rate_mm_h = 100;
    rain.transition_s = 0;
    rain.haze = 0;
    REQUIRE(virga_rain_set(virga_scene_rain(h->scene), &rain) == VIRGA_OK);

    virga_target_def layer = virga_default_target_def();
    REQUIRE(host_target_create(&h->gpu.device, WIDTH, HEIGHT, &h->target, h->gpu.error, sizeof h->gpu.error));
    host_target_describe_layer(&h->target, &layer);
    REQUIRE(virga_target_create(h->context, &layer, &h->layer) == VIRGA_OK);
    REQUIRE(virga_scene_attach(h->scene, h->layer) == VIRGA_OK);
    REQUIRE(host_buffer_create(&h->gpu.device, WIDTH * HEIGHT * 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "picture down", &h->download, h->gpu.error, sizeof h->gpu.error));
    static const float lens_of_view[16] = {2, 0, 0, 0, 0, -3, 0, 0, 0, 0, -1.001f, -1, 0, 0, -0.1001f, 0};
    h->view = virga_default_view();
    memcpy(h->view.clip_from_view, lens_of_view, sizeof lens_of_view);
    memcpy(h->view.open_clip_from_view, lens_of_view, sizeof lens_of_view);
    h->view.viewport[2] = WIDTH;
    h->view.viewport[3] = HEIGHT;
    h->view.depth = host_target_depth(&h->target);
}

static void close_host(lens_host *h)
{
    virga_target_destroy(&h->layer);
    virga_lens_destroy(&h->lens);
    virga_scene_destroy(&h->scene);
    virga_context_destroy(&h->context);
    host_target_destroy(&h->gpu.device, &h->target);
    host_buffer *const buffers[] = {&h->download};
    assert_int_equal(effect_fixture_end(&h->gpu, buffers, 1), 0);
}

static void draw_plate(lens_host *h, VkCommandBuffer cmd)
{
    const VkClearAttachment clear[2] = {
        {VK_IMAGE_ASPECT_COLOR_BIT, HOST_COLOR, {.color = {.float32 = {h->plate, h->plate, h->plate, 1}}}},
        {VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {1, 0}}}};
    const VkClearRect all = {{{0, 0}, {WIDTH, HEIGHT}}, 0, 1};
    host_target_begin_plate(&h->target, cmd);
    vkCmdClearAttachments(cmd, 2, clear, 1, &all);
    host_target_end_plate(&h->target, cmd);
}

/* A frame in the order of engine/README.md: step, the host's scene, Virga's layer, the lens. */
static void draw_frame(lens_host *h, double dt_s)
{
    virga_lens_image picture;
    const virga_scene_frame frame = {.dt_s = dt_s, .view = &h->view};
    const VkCommandBuffer cmd = effect_fixture_begin(&h->gpu, h->context);
    REQUIRE(virga_scene_record(h->scene, cmd, &frame) == VIRGA_OK);
    draw_plate(h, cmd);
    host_target_begin_layer(&h->target, cmd);
    REQUIRE(virga_scene_draw(h->scene, cmd, h->layer) == VIRGA_OK);
    host_target_end_layer(&h->target, cmd);
    host_target_read_layer(&h->target, cmd, HOST_LAYER);
    virga_view seen = h->view;
    seen.color = host_target_color(&h->target);
    const virga_lens_layer rain = {.color = host_target_layer(&h->target, HOST_LAYER), .depth_m = h->layer_depth_m};
    REQUIRE(virga_lens_set(h->lens, &h->settings) == VIRGA_OK);
    REQUIRE(virga_lens_prepare(h->lens, cmd, &seen, &rain, 1, 0) == VIRGA_OK);
    virga_lens_picture(h->lens, &picture);
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {picture.width, picture.height, 1}};
    vkCmdCopyImageToBuffer(cmd, picture.image, VK_IMAGE_LAYOUT_GENERAL, h->download.buffer, 1, &copy);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                        VK_ACCESS_HOST_READ_BIT);
    host_image_barrier(cmd, &h->target.images[HOST_LAYER], VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0,
                       VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT);
    host_target_copy_out(&h->target, cmd, 1u << HOST_LAYER);
    effect_fixture_complete(&h->gpu, h->context);
    host_buffer_invalidate(&h->gpu.device, &h->download);
}

static double shown(const lens_host *h, uint32_t pixel)
{
    return lens_half_float(((const uint16_t *)h->download.mapped)[4 * pixel]);
}

/* The plate under the layer as it was drawn. */
static double expected(const lens_host *h, const float *layer, uint32_t pixel)
{
    return (double)layer[4 * pixel] + (1 - (double)layer[4 * pixel + 3]) * (double)h->plate;
}

static void rain_in_a_layer_is_put_over_the_scene(void **state)
{
    (void)state;
    lens_host h;
    double coverage = 0;
    open_host(&h);
    h.settings.aperture_f = 0;
    h.layer_depth_m = 3;
    draw_frame(&h, 0.5);
    const float *layer = host_target_floats(&h.gpu.device, &h.target, HOST_LAYER);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        coverage += (double)layer[4 * i + 3];
        assert_true(fabs(shown(&h, i) - expected(&h, layer, i)) < 1e-3 * expected(&h, layer, i) + 1e-4);
    }
    assert_true(coverage > 1);
    close_host(&h);
}

/* Streaks as wide as the lens blurs them, in a layer at the focus: the lens leaves them as they are. */
static void rain_that_is_out_of_focus_already_is_left_so(void **state)
{
    (void)state;
    lens_host h;
    open_host(&h);
    h.settings.aperture_f = 0.7f;
    h.settings.focus_m = 1;
    REQUIRE(virga_lens_set(h.lens, &h.settings) == VIRGA_OK);
    virga_lens_fill_view(h.lens, &h.view);
    assert_true(h.view.aperture_m > 0.07f && h.view.focus_m == 1);
    h.layer_depth_m = 1;
    draw_frame(&h, 0.5);
    const float *layer = host_target_floats(&h.gpu.device, &h.target, HOST_LAYER);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_true(fabs(shown(&h, i) - expected(&h, layer, i)) < 1e-3 * expected(&h, layer, i) + 1e-4);
    close_host(&h);
}

/* A layer of one depth is spread by it: what it adds stays, its contrast goes. Light near the border gets lost. */
static void rain_in_a_layer_before_the_focus_is_spread(void **state)
{
    (void)state;
    lens_host h;
    double sharp = 0, sharp_square = 0, soft = 0, soft_square = 0;
    open_host(&h);
    h.settings.aperture_f = 0.7f;
    h.settings.focus_m = 0;
    h.layer_depth_m = 1.2f; /* 2.9 px */
    h.plate = 0;
    draw_frame(&h, 0.5);
    const float *layer = host_target_floats(&h.gpu.device, &h.target, HOST_LAYER);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const double before = expected(&h, layer, i), after = shown(&h, i);
        sharp += before;
        sharp_square += before * before;
        soft += after;
        soft_square += after * after;
    }
    printf("%.3f became %.3f, squares %.4f became %.4f\n", sharp, soft, sharp_square, soft_square);
    assert_true(fabs(soft - sharp) < 0.02 * sharp && soft_square < 0.5 * sharp_square);
    close_host(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rain_in_a_layer_is_put_over_the_scene),
        cmocka_unit_test(rain_that_is_out_of_focus_already_is_left_so),
        cmocka_unit_test(rain_in_a_layer_before_the_focus_is_spread),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
