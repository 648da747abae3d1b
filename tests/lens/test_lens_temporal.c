/* test_lens_temporal.c - a lens in a host with temporal anti-aliasing: before or after it, and motion vectors stay. */
#include "lens_fixture.h"

#include "../host/temporal_picture.h"

#define WIDTH  48
#define HEIGHT 32
#define FRAMES 16

/* ---- motion vectors */

/* The left half has the motion of a host's scene, 3 px right and 2 up, and is half reactive. */
static void put_motion(VkCommandBuffer cmd)
{
    const VkClearAttachment clears[2] = {
        {VK_IMAGE_ASPECT_COLOR_BIT, PICTURE_MOTION, {.color = {.float32 = {3, -2}}}},
        {VK_IMAGE_ASPECT_COLOR_BIT, PICTURE_REACTIVE, {.color = {.float32 = {0.6f}}}},
    };
    const VkClearRect left = {{{0, 0}, {WIDTH / 2, HEIGHT}}, 0, 1};
    vkCmdClearAttachments(cmd, 2, clears, 1, &left);
}

static void draw_over_motion(lens_fixture *f, temporal_picture *picture, const virga_target *target)
{
    host_image image;
    f->view.color = lens_upload(f, &f->scene, false, &image);
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    REQUIRE(virga_lens_prepare(f->lens, cmd, &f->view, NULL, 0, 0) == VIRGA_OK);
    picture_begin(picture, cmd);
    put_motion(cmd);
    REQUIRE(virga_lens_draw(f->lens, cmd, target) == VIRGA_OK);
    picture_end(picture, cmd);
    effect_fixture_complete(&f->gpu, f->context);
    picture_read(&f->gpu.device, picture);
    host_image_destroy(&f->gpu.device, &image);
}

static void motion_vectors_and_the_reactive_mask_stay(void **state)
{
    (void)state;
    lens_fixture f;
    temporal_picture picture;
    virga_target *target;
    lens_fixture_open(&f, WIDTH, HEIGHT, false);
    picture_open(&f.gpu.device, WIDTH, HEIGHT, &picture);
    const virga_target_def def = picture_target(&picture);
    REQUIRE(virga_target_create(f.context, &def, &target) == VIRGA_OK);
    REQUIRE(virga_lens_attach(f.lens, target) == VIRGA_OK);
    lens_paint_all(&f.scene, 0.5f, 2);
    draw_over_motion(&f, &picture, target);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const bool left = i % WIDTH < WIDTH / 2;
        assert_true(picture.color[4 * i] == 0.5f);
        assert_true(picture.motion[2 * i] == (left ? 3 : NO_MOTION));
        assert_true(picture.motion[2 * i + 1] == (left ? -2 : NO_MOTION));
        assert_float_equal(picture.reactive[i], left ? 0.6 : 0, 1.0 / 255);
    }
    virga_target_destroy(&target);
    picture_close(&f.gpu.device, &picture);
    lens_fixture_close(&f);
}

/* ---- jittered frames */

/* A wall of bright and dark bars behind the focus, a leaning pole in focus and a leaning bar before it. */
static float scene_at(double x, double y, double *depth_m)
{
    if (fabs(x - 0.3 * y - 32) < 2.5) {
        *depth_m = 0.6;
        return 0.9f;
    }
    if (fabs(x + 0.2 * y - 16) < 1.5) {
        *depth_m = 1;
        return 0.1f;
    }
    *depth_m = 2;
    return fmod(x + 0.1 * y, 9) < 3 ? 1.0f : 0.2f;
}

/* Base 2 and 3 of Halton's sequence, as engines jitter. */
static double halton(uint32_t index, uint32_t base)
{
    double sum = 0, part = 1;
    for (; index; index /= base) {
        part /= base;
        sum += part * (index % base);
    }
    return sum;
}

/* The scene at the jittered centres of pixels; NULL: at the centres. */
static void paint_scene(lens_fixture *f, const double *jitter)
{
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) {
            double depth_m;
            const float gray = scene_at(x + (jitter ? jitter[0] : 0.5), y + (jitter ? jitter[1] : 0.5), &depth_m);
            lens_paint(&f->scene, x, y, gray, depth_m);
        }
}

typedef struct moments {
    double mean[WIDTH * HEIGHT], square[WIDTH * HEIGHT];
} moments;

static void add_frame(moments *sums, const float *color)
{
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        sums->mean[i] += (double)color[4 * i] / FRAMES;
        sums->square[i] += (double)color[4 * i] * (double)color[4 * i] / FRAMES;
    }
}

/* Mean over the picture of how far frames are from each other. */
static double flicker(const moments *sums)
{
    double sum = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        sum += sqrt(fmax(sums->square[i] - sums->mean[i] * sums->mean[i], 0)) / (WIDTH * HEIGHT);
    return sum;
}

/* What temporal anti-aliasing makes of still frames is their mean. The lens after it gets that mean. Before it, the
 * lens gets each frame, and the mean is that of its pictures. Blur is linear, so both are equal but in pixels at the
 * edge of something nearer: there the resolved picture has a mixed color at one depth, which shows most in focus. */
static void before_and_after_antialiasing_give_one_picture(void **state)
{
    (void)state;
    lens_fixture f;
    moments *frames = calloc(2, sizeof *frames), *blurred = frames + 1;
    double worst = 0, mean = 0;
    REQUIRE(frames);
    lens_fixture_open(&f, WIDTH, HEIGHT, false);
    for (uint32_t i = 0; i < FRAMES; i++) {
        paint_scene(&f, (const double[2]){halton(i + 1, 2), halton(i + 1, 3)});
        lens_fixture_run(&f);
        add_frame(frames, f.scene.color);
        add_frame(blurred, f.result);
    }
    paint_scene(&f, NULL);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++)
        f.scene.color[4 * i] = (float)frames->mean[i];
    lens_fixture_run(&f);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        const double apart = fabs((double)f.result[4 * i] - blurred->mean[i]);
        worst = fmax(worst, apart);
        mean += apart / (WIDTH * HEIGHT);
    }
    printf("apart by %.4f, at most %.4f; flicker %.4f becomes %.4f\n", mean, worst, flicker(frames), flicker(blurred));
    assert_true(mean < 0.01 && worst < 0.3);
    assert_true(flicker(blurred) < 0.4 * flicker(frames)); /* so the history has less to do */
    free(frames);
    lens_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(motion_vectors_and_the_reactive_mask_stay),
        cmocka_unit_test(before_and_after_antialiasing_give_one_picture),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
