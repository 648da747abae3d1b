/* test_lens_parts.c - the scene and layers out of focus, each alone: what lies on the scene is blurred with it, what is
 * behind its near field is cut by it, and the parts over each other are the picture. */
#include "lens_drawn.h"

#define WIDTH  32
#define HEIGHT 24

typedef struct parts {
    lens_fixture f;
    lens_drawn made;
    host_image images[4];
    virga_lens_layer layers[2];
    float (*pixels)[WIDTH * HEIGHT][4]; /* of each part, and then of the picture */
} parts;

/* A wall in focus, something bright in front of it, and something behind it. */
static void open_parts(parts *p, bool half_resolution)
{
    uint32_t hash = 7;
    memset(p, 0, sizeof *p);
    lens_fixture_open(&p->f, WIDTH, HEIGHT, half_resolution);
    lens_create_drawn(&p->f, &p->made);
    for (uint32_t y = 0; y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++)
            lens_paint(&p->f.scene, x, y, (float)lens_random(&hash), x < 10 ? 0.75 : x < 20 ? 1 : 1.4);
    lens_fixture_layer(&p->f, 1);
    lens_fixture_layer(&p->f, 1);
    p->pixels = calloc(4, sizeof *p->pixels);
    assert_non_null(p->pixels);
}

static void close_parts(parts *p)
{
    for (int i = 0; i < 4; i++)
        host_image_destroy(&p->f.gpu.device, &p->images[i]);
    free(p->pixels);
    lens_destroy_drawn(&p->f, &p->made);
    lens_fixture_close(&p->f);
}

/* One frame for each part, as the result of a frame is read once. */
static void draw_parts(parts *p, uint32_t layer_count)
{
    lens_fixture *f = &p->f;
    f->view.color = lens_upload(f, &f->scene, false, &p->images[0]);
    f->view.depth = lens_upload(f, &f->scene, true, &p->images[1]);
    for (uint32_t i = 0; i < layer_count; i++)
        p->layers[i].color = lens_upload(f, &f->layers[i], false, &p->images[2 + i]);
    REQUIRE(virga_lens_set(f->lens, &f->settings) == VIRGA_OK);
    for (uint32_t part = 0; part < layer_count + 2; part++) {
        const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
        REQUIRE(virga_lens_prepare(f->lens, cmd, &f->view, p->layers, layer_count, 0) == VIRGA_OK);
        REQUIRE(lens_draw_and_read(f, &p->made, cmd, part > layer_count ? LENS_WHOLE : part) == VIRGA_OK);
        const uint16_t *halves = f->download.mapped;
        for (uint32_t i = 0; i < WIDTH * HEIGHT * 4; i++)
            p->pixels[part][i / 4][i % 4] = (float)lens_half_float(halves[i]);
    }
}

static void a_layer_that_is_as_the_scene_is_blurred_as_the_scene(void **state)
{
    (void)state;
    parts p;
    open_parts(&p, false);
    memcpy(p.f.layers[0].color, p.f.scene.color, sizeof(float) * WIDTH * HEIGHT * 4);
    p.layers[0].on_scene = 1;
    draw_parts(&p, 1);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 4; c++)
            assert_float_equal(p.pixels[1][i][c], p.pixels[0][i][c], 2e-3);
    close_parts(&p);
}

/* Haze, and a layer at the focus: in the left third it is behind what is blurred in front of it. */
static void parts_over_each_other_are_the_picture(void **state)
{
    (void)state;
    parts p;
    open_parts(&p, false);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        for (int c = 0; c < 4; c++) {
            p.f.layers[0].color[4 * i + (uint32_t)c] = c < 3 ? 0.1f : 0.2f;
            p.f.layers[1].color[4 * i + (uint32_t)c] = c < 3 ? 0.3f : 0.6f;
        }
    p.layers[0].on_scene = 1;
    p.layers[1].depth_m = 1;
    draw_parts(&p, 2);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        const double haze = (double)p.pixels[1][i][0] + (1 - (double)p.pixels[1][i][3]) * (double)p.pixels[0][i][0];
        const double all = (double)p.pixels[2][i][0] + (1 - (double)p.pixels[2][i][3]) * haze;
        assert_float_equal(p.pixels[3][i][0], all, 2e-3);
    }
    assert_float_equal(p.pixels[2][12 * WIDTH + 2][3], 0, 1e-3);
    assert_float_equal(p.pixels[2][12 * WIDTH + 16][3], 0.6, 1e-3);
    assert_float_equal(p.pixels[1][12 * WIDTH + 2][3], 0.2, 1e-3); /* haze lies on the near field */
    close_parts(&p);
}

/* At half resolution, where no field is computed for what nothing out of focus reaches. */
static void a_part_in_focus_has_nothing_of_the_frame_before(void **state)
{
    (void)state;
    parts p;
    open_parts(&p, true);
    lens_paint_all(&p.f.scene, 0.9f, 0.5);
    lens_fixture_run(&p.f);
    lens_paint_all(&p.f.scene, 0.25f, 1);
    draw_parts(&p, 0);
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        assert_float_equal(p.pixels[0][i][0], 0.25, 0);
    close_parts(&p);
}

static void parts_that_are_not_there_are_refused(void **state)
{
    (void)state;
    parts p;
    open_parts(&p, false);
    p.layers[0].depth_m = 1;
    draw_parts(&p, 1);
    const VkCommandBuffer cmd = effect_fixture_begin(&p.f.gpu, p.f.context);
    p.layers[1] = p.layers[0];
    p.layers[0].on_scene = p.layers[1].on_scene = 1;
    assert_int_equal(virga_lens_prepare(p.f.lens, cmd, &p.f.view, p.layers, 2, 0), VIRGA_ERROR_INVALID);
    assert_non_null(strstr(p.f.log[(p.f.log_lines - 1) % 8], "one on_scene"));
    assert_int_equal(lens_draw_and_read(&p.f, &p.made, cmd, 2), VIRGA_ERROR_INVALID);
    assert_non_null(strstr(p.f.log[(p.f.log_lines - 1) % 8], "expected up to 1"));
    close_parts(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_layer_that_is_as_the_scene_is_blurred_as_the_scene),
        cmocka_unit_test(parts_over_each_other_are_the_picture),
        cmocka_unit_test(a_part_in_focus_has_nothing_of_the_frame_before),
        cmocka_unit_test(parts_that_are_not_there_are_refused),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
