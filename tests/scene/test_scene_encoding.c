/* test_scene_encoding.c - targets and pictures whose values are encoded: over grey, the UNORM picture of each effect is
 * the linear one, encoded; a host's encoded picture is read as its light. */
#include "layered_pass.h"
#include "views_fixture.h"

#include <math.h>

enum { MIDDLE = 1 };
enum { RAIN, SPLASH, GLASS, WATER, EFFECTS };
static const char *const effect_names[EFFECTS] = {"rain", "splash", "glass", "water"};

#define GREY 0.18f

/* IEC 61966-2-1. */
static double encoded(double light)
{
    return light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
}

static double decoded(double value)
{
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static virga_target *attach(views_run *run, const layered_pass *pass, VkFormat format, virga_encoding encoding)
{
    virga_target_def def = virga_default_target_def();
    virga_target *target = NULL;
    def.render_pass = pass->pass;
    def.color_formats[0] = format;
    def.depth_attached = false;
    def.encoding = encoding;
    def.blend_background = GREY;
    REQUIRE(virga_target_create(run->context, &def, &target) == VIRGA_OK);
    REQUIRE(virga_scene_attach(run->scene, target) == VIRGA_OK);
    return target;
}

static virga_result draw_effect(const views_run *run, VkCommandBuffer cmd, const virga_target *target, int effect)
{
    switch (effect) {
    case RAIN: return virga_rain_draw(virga_scene_rain(run->scene), cmd, target);
    case SPLASH: return virga_splash_draw(virga_scene_splash(run->scene), cmd, target);
    case GLASS: return virga_glass_draw(virga_scene_glass(run->scene, 0), cmd, target);
    default: return virga_water_draw(virga_scene_water(run->scene), cmd, target);
    }
}

/* From low above the ground, down to it. */
static void look_at_splashes(virga_view *view)
{
    static const float down[16] = {1, 0, 0, 0, 0, 0.5f, 0.8660254f, 0, 0, -0.8660254f, 0.5f, 0, 0, 0, 0, 1};
    memcpy(view->view_from_world, down, sizeof down);
    memcpy(view->open_view_from_world, down, sizeof down);
    view->position_m[1] = view->open_position_m[1] = 0.12;
}

/* One effect alone, from the camera in the middle. */
static const void *draw_over(views_run *run, const layered_pass *pass, const virga_target *target, int effect,
                             float background)
{
    VkCommandBuffer cmd = gpu_begin_frame(run->f, run->context);
    const virga_view level = run->views[MIDDLE];
    if (effect == SPLASH)
        look_at_splashes(&run->views[MIDDLE]);
    assert_int_equal(record(run, cmd, 0, MIDDLE, 1), VIRGA_OK);
    run->views[MIDDLE] = level;
    layered_pass_begin(pass, cmd, background);
    assert_int_equal(draw_effect(run, cmd, target, effect), VIRGA_OK);
    layered_pass_end(pass, cmd);
    gpu_submit(run->f);
    gpu_wait(run->f);
    return layered_pass_pixels(pass);
}

/* A light of the environment that is not grey, and bright enough that encoding matters. */
static void set_light(views_run *run)
{
    virga_lighting lighting = virga_default_lighting();
    for (int c = 0; c < 3; c++)
        lighting.environment_sh[0][c] = (float[]){0.9f, 1.3f, 2.1f}[c];
    assert_int_equal(virga_scene_lighting_set(run->scene, &lighting), VIRGA_OK);
}

typedef struct difference {
    uint32_t drawn, off; /* pixels; those that are off by more than 2/255 */
    double most;
} difference;

static difference compare(const float *linear, const uint8_t *unorm, float background)
{
    difference d = {0};
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        double most = 0, change = 0;
        for (uint32_t c = 0; c < 3; c++) {
            const double expected = encoded(fmin((double)linear[4 * i + c], 1));
            most = fmax(most, fabs(unorm[4 * i + c] / 255.0 - expected));
            change = fmax(change, fabs((double)linear[4 * i + c] - (double)background));
        }
        d.drawn += change > 1e-3;
        d.off += most > 2.0 / 255;
        d.most = fmax(d.most, most);
    }
    return d;
}

/* Over grey, what lies over other water is off a little, as blending is exact over the grey alone; and each layer that
 * is blended is rounded to 1/255. */
static void over_grey_an_encoded_picture_is_the_linear_one_encoded(void **state)
{
    static float linear[SIDE * SIDE * 4];
    static views_run run;
    layered_pass floats, bytes;
    open_run(&run, *state, 1);
    run.views[MIDDLE].viewport[0] = 0;
    set_light(&run);
    layered_pass_open(&floats, &run.f->gpu, VK_FORMAT_R32G32B32A32_SFLOAT, 16, SIDE, SIDE, 1, 0);
    layered_pass_open(&bytes, &run.f->gpu, VK_FORMAT_R8G8B8A8_UNORM, 4, SIDE, SIDE, 1, 0);
    virga_target *plain = attach(&run, &floats, VK_FORMAT_R32G32B32A32_SFLOAT, VIRGA_ENCODING_NOT_GIVEN);
    virga_target *screen = attach(&run, &bytes, VK_FORMAT_R8G8B8A8_UNORM, VIRGA_ENCODING_SRGB);
    play(&run);
    for (int effect = 0; effect < EFFECTS; effect++) {
        memcpy(linear, draw_over(&run, &floats, plain, effect, GREY), sizeof linear);
        const uint8_t *pixels = draw_over(&run, &bytes, screen, effect, (float)encoded((double)GREY));
        const difference d = compare(linear, pixels, GREY);
        printf("%s: %u pixels drawn, %u off by more than 2/255, the most %.1f/255\n", effect_names[effect], d.drawn,
               d.off, 255 * d.most);
        assert_true(d.drawn > 10);
        assert_true(d.off * 10 <= d.drawn && d.most < 6.0 / 255);
    }
    assert_int_equal(run.f->lines[VIRGA_LOG_ENCODING], 0);
    virga_target_destroy(&plain);
    virga_target_destroy(&screen);
    layered_pass_close(&floats);
    layered_pass_close(&bytes);
    close_run(&run);
}

/* ---- a host's picture */

static const uint8_t picture_bytes[4] = {40, 128, 220, 255};

static virga_image give_picture(views_run *run, host_image *made, VkFormat format, const void *texel, uint32_t bytes)
{
    static uint8_t data[PIXELS * 16];
    fixture *gpu = &run->f->gpu;
    const host_image_def def = {
        .format = format, .extent = {SIDE * VIEWS, SIDE, 1}, .usage = VK_IMAGE_USAGE_SAMPLED_BIT, .name = "color"};
    for (uint32_t i = 0; i < PIXELS; i++)
        memcpy(&data[i * bytes], texel, bytes);
    REQUIRE(host_image_create_with(&gpu->device, &def, data, (VkDeviceSize)PIXELS * bytes, bytes, made, gpu->error,
                                   sizeof gpu->error));
    return (virga_image){.image = made->image,
                         .view = made->view,
                         .format = format,
                         .before = {.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}};
}

static double largest_difference(const float *a, const float *b)
{
    double most = 0;
    for (uint32_t i = 0; i < SIDE * SIDE * 4; i++)
        most = fmax(most, fabs((double)a[i] - (double)b[i]));
    return most;
}

static void an_encoded_picture_is_read_as_its_light(void **state)
{
    static float expected[SIDE * SIDE * 4];
    static views_run run;
    float light[4] = {0, 0, 0, 1};
    host_image images[2];
    layered_pass floats;
    for (int c = 0; c < 3; c++)
        light[c] = (float)decoded(picture_bytes[c] / 255.0);
    open_run(&run, *state, 1);
    run.views[MIDDLE].viewport[0] = 0;
    layered_pass_open(&floats, &run.f->gpu, VK_FORMAT_R32G32B32A32_SFLOAT, 16, SIDE, SIDE, 1, 0);
    virga_target *target = attach(&run, &floats, VK_FORMAT_R32G32B32A32_SFLOAT, VIRGA_ENCODING_LINEAR);
    const virga_image linear = give_picture(&run, &images[0], VK_FORMAT_R32G32B32A32_SFLOAT, light, sizeof light);
    const virga_image bytes = give_picture(&run, &images[1], VK_FORMAT_R8G8B8A8_UNORM, picture_bytes, 4);
    play(&run);
    virga_view *view = &run.views[MIDDLE];
    for (int effect = GLASS; effect < EFFECTS; effect++) { /* for splashes, which are small here: splash/draw */
        view->color = linear;
        view->color_encoding = VIRGA_ENCODING_LINEAR;
        memcpy(expected, draw_over(&run, &floats, target, effect, 0), sizeof expected);
        view->color = bytes;
        const double wrong = largest_difference(expected, draw_over(&run, &floats, target, effect, 0));
        view->color_encoding = VIRGA_ENCODING_SRGB;
        const double off = largest_difference(expected, draw_over(&run, &floats, target, effect, 0));
        printf("%s: off by %.5f, and by %.3f if it is not decoded\n", effect_names[effect], off, wrong);
        assert_true(off < 2e-3 && wrong > 0.05);
    }
    virga_target_destroy(&target);
    layered_pass_close(&floats);
    for (int i = 0; i < 2; i++)
        host_image_destroy(&run.f->gpu.device, &images[i]);
    close_run(&run);
}

/* A pinhole shows the picture as it is: bytes that are decoded and encoded again are the same bytes. */
static void a_lens_returns_the_bytes_of_an_encoded_picture(void **state)
{
    views_run run = {.f = *state};
    host_image image;
    layered_pass bytes;
    virga_lens *lens = NULL;
    virga_lens_def def = virga_default_lens_def();
    virga_lens_settings settings = virga_default_lens_settings();
    virga_target_def target_def = virga_default_target_def();
    virga_target *target = NULL;
    run.context = gpu_context(run.f);
    aim(&run);
    run.views[MIDDLE].viewport[0] = 0;
    layered_pass_open(&bytes, &run.f->gpu, VK_FORMAT_R8G8B8A8_UNORM, 4, SIDE, SIDE, 1, 0);
    target_def.render_pass = bytes.pass;
    target_def.depth_attached = false;
    target_def.encoding = VIRGA_ENCODING_SRGB;
    REQUIRE(virga_target_create(run.context, &target_def, &target) == VIRGA_OK);
    def.max_width = def.max_height = SIDE;
    settings.aperture_f = 0;
    REQUIRE(virga_lens_create(run.context, &def, &lens) == VIRGA_OK);
    REQUIRE(virga_lens_set(lens, &settings) == VIRGA_OK);
    REQUIRE(virga_lens_attach(lens, target) == VIRGA_OK);
    run.views[MIDDLE].color = give_picture(&run, &image, VK_FORMAT_R8G8B8A8_UNORM, picture_bytes, 4);
    run.views[MIDDLE].color_encoding = VIRGA_ENCODING_SRGB;
    VkCommandBuffer cmd = gpu_begin_frame(run.f, run.context);
    assert_int_equal(virga_lens_prepare(lens, cmd, &run.views[MIDDLE], NULL, 0, 0), VIRGA_OK);
    layered_pass_begin(&bytes, cmd, 0);
    assert_int_equal(virga_lens_draw(lens, cmd, target), VIRGA_OK);
    layered_pass_end(&bytes, cmd);
    gpu_submit(run.f);
    gpu_wait(run.f);
    const uint8_t *pixels = layered_pass_pixels(&bytes);
    for (uint32_t i = 0; i < SIDE * SIDE; i++)
        assert_memory_equal(&pixels[4 * i], picture_bytes, 4);
    virga_lens_destroy(&lens);
    virga_target_destroy(&target);
    layered_pass_close(&bytes);
    host_image_destroy(&run.f->gpu.device, &image);
    virga_context_destroy(&run.context);
}

/* ---- what is said */

static void a_unorm_target_without_an_encoding_is_told_once(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_target_def def = virga_default_target_def();
    virga_target *target = NULL;
    layered_pass pass;
    layered_pass_open(&pass, &f->gpu, VK_FORMAT_R8G8B8A8_UNORM, 4, 4, 4, 1, 0);
    def.render_pass = pass.pass;
    def.depth_attached = false;
    def.color_formats[0] = VK_FORMAT_R8G8B8A8_UNORM;
    for (int given = VIRGA_ENCODING_NOT_GIVEN; given <= VIRGA_ENCODING_SRGB; given++) {
        gpu_forget_log(f);
        def.encoding = (virga_encoding)given;
        assert_int_equal(virga_target_create(context, &def, &target), VIRGA_OK);
        assert_int_equal(f->lines[VIRGA_LOG_ENCODING], given == VIRGA_ENCODING_NOT_GIVEN);
        virga_target_destroy(&target);
    }
    gpu_forget_log(f);
    def.color_formats[0] = VK_FORMAT_R8G8B8A8_SRGB; /* would be encoded twice */
    assert_int_equal(virga_target_create(context, &def, &target), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_ARGUMENT);
    layered_pass_close(&pass);
    virga_context_destroy(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(over_grey_an_encoded_picture_is_the_linear_one_encoded),
        gpu_kept_test(an_encoded_picture_is_read_as_its_light),
        gpu_kept_test(a_lens_returns_the_bytes_of_an_encoded_picture),
        gpu_kept_test(a_unorm_target_without_an_encoding_is_told_once),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("encoding", tests, NULL, NULL));
}
