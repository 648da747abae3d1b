/* test_lens_narrow.c - on GPUs one pass gathers narrow discs at half resolution. It gives the same picture as the
 * passes for discs of any width. */
#include "lens_kinds.h"
#include "lens_reference.h"

#define WIDTH  LENS_KINDS_WIDTH
#define HEIGHT LENS_KINDS_HEIGHT
#define COUNT  (4u * WIDTH * HEIGHT)

static const lens_kind kinds[] = {{.aperture_scale = 1},
                                  {.aperture_scale = 2, .cats_eye = 0.5f},
                                  {.aperture_scale = 0.7f, .layers = 1},
                                  {.aperture_scale = 1, .layers = 2, .flat = true}};

static void open_kind(lens_fixture *f, virga_pass_variants variants, const lens_kind *kind, bool encoded)
{
    effect_fixture_variants = variants;
    lens_fixture_open(f, WIDTH, HEIGHT, true);
    lens_set_up(f, kind);
    f->settings.max_radius_px = 16;
    f->view.color_encoding = encoded ? VIRGA_ENCODING_SRGB : VIRGA_ENCODING_NOT_GIVEN;
    /* Sides and a corner that are odd. */
    f->view.viewport[0] = 3;
    f->view.viewport[1] = 1;
    f->view.viewport[2] = WIDTH - 5;
    f->view.viewport[3] = HEIGHT - 7;
}

/* Samples are kept as half floats, and fields and pictures are truncated to half floats. */
static void one_pass_gives_the_same_picture_as_many(void **state)
{
    (void)state;
    static float many[COUNT];
    const size_t count = (size_t)(WIDTH - 5) * (HEIGHT - 7) * 4;
    for (size_t i = 0; i < 2 * sizeof kinds / sizeof *kinds; i++) {
        lens_fixture f;
        double worst = 0, light[2] = {0};
        for (int one = 0; one < 2; one++) {
            open_kind(&f, one ? VIRGA_VARIANTS_GPU : VIRGA_VARIANTS_SOFTWARE, &kinds[i / 2], i & 1);
            lens_fixture_run(&f);
            for (size_t k = 0; k < count; k++) {
                light[one] += (double)f.result[k];
                if (one)
                    worst = fmax(worst, fabs((double)f.result[k] - (double)many[k]) / (0.02 + (double)many[k]));
            }
            memcpy(many, f.result, sizeof many);
            lens_fixture_close(&f);
        }
        printf("kind %zu: up to %.2g apart, light %.2g\n", i, worst, light[1] / light[0] - 1);
        assert_true(worst < 4.0 / 1024);
        assert_float_equal(light[1] / light[0], 1, 5e-4);
    }
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
}

/* A plane behind the focus in double precision: r px at the top, and more below. */
typedef struct plane {
    double top_px, more_px; /* over all rows */
} plane;

typedef struct plane_texel {
    double gray, radius; /* texels */
} plane_texel;

enum { COLUMNS = WIDTH / 2, ROWS = HEIGHT / 2 };

static double plane_px(const plane *p, uint32_t y)
{
    return p->top_px + p->more_px * y / HEIGHT;
}

/* The mean of four pixels, weighted by how near they are to the nearest one: shaders/lens/sample.glsl. */
static plane_texel plane_texel_at(const plane *p, const lens_picture *scene, int column, int row)
{
    plane_texel texel = {0, 0};
    const uint32_t x = 2 * (uint32_t)lens_inside(column, COLUMNS), y = 2 * (uint32_t)lens_inside(row, ROWS);
    const double nearest = 0.5 * plane_px(p, y);
    double weights = 0;
    for (uint32_t i = 0; i < 4; i++) {
        const double radius = 0.5 * plane_px(p, y + i / 2), weight = 1 - (radius - nearest) / nearest;
        texel.gray += weight * (double)lens_pixel(scene, x + i % 2, y + i / 2)[0];
        texel.radius += weight * radius;
        weights += weight;
    }
    return (plane_texel){texel.gray / weights, texel.radius / weights};
}

/* Samples reach as far as they do themselves, and no farther than the texel that they cover: see gather.glsl. */
static double plane_far(const plane *p, const lens_picture *scene, int column, int row)
{
    const double own = plane_texel_at(p, scene, column, row).radius;
    double sum = 0, weights = 0;
    for (int y = -9; y <= 9; y++)
        for (int x = -9; x <= 9; x++) {
            const plane_texel from = plane_texel_at(p, scene, column + x, row + y);
            const double cut = fmin(from.radius, own), covers = fmin(fmax(cut + 0.5 - hypot(x, y), 0), 1);
            const double weight = covers / (M_PI * (cut * cut + 1.0 / 12) + 0.1);
            sum += weight * from.gray;
            weights += weight;
        }
    return sum / weights;
}

static void fill_plane_field(const plane *p, const lens_picture *scene, double field[ROWS][COLUMNS])
{
    for (int row = 0; row < ROWS; row++)
        for (int column = 0; column < COLUMNS; column++)
            field[row][column] = plane_far(p, scene, column, row);
}

/* Between four texels. */
static double plane_pixel(double field[ROWS][COLUMNS], uint32_t x, uint32_t y)
{
    const double column = (x + 0.5) / 2 - 0.5, row = (y + 0.5) / 2 - 0.5;
    const int left = (int)floor(column), top = (int)floor(row);
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        const double right = column - left, down = row - top;
        const double share = (i & 1 ? right : 1 - right) * (i & 2 ? down : 1 - down);
        sum += share * field[lens_inside(top + i / 2, ROWS)][lens_inside(left + i % 2, COLUMNS)];
    }
    return sum;
}

/* Discs on one plane. Radii of the first two planes are even, as shaders/lens/even.glsl has it; those of the third are
 * not. What is even may put a lamp's edge r g away, with g the difference of radii from texel to texel: here up to
 * 4 x 0.001 texels of a lamp of 20 that has an area of 50, 0.0016. Half floats are 0.001 of what is there, twice. */
static void discs_on_a_plane_are_those_of_a_reference(void **state)
{
    static const plane planes[] = {{8, 0}, {7.9, 0.1}, {5, 4}};
    static double field[ROWS][COLUMNS];
    (void)state;
    for (size_t i = 0; i < sizeof planes / sizeof *planes; i++) {
        lens_fixture f;
        uint32_t hash = 7;
        double worst = 0, light[2] = {0};
        effect_fixture_variants = VIRGA_VARIANTS_GPU;
        lens_fixture_open(&f, WIDTH, HEIGHT, true);
        f.settings.max_radius_px = 16;
        for (uint32_t k = 0; k < WIDTH * HEIGHT; k++)
            lens_paint(&f.scene, k % WIDTH, k / WIDTH, lens_random(&hash) < 0.01 ? 20 : lens_gray(&hash),
                       1 / (1 - plane_px(&planes[i], k / WIDTH) / 10));
        lens_fixture_run(&f);
        fill_plane_field(&planes[i], &f.scene, field);
        for (uint32_t k = 0; k < WIDTH * HEIGHT; k++) {
            const double expected = plane_pixel(field, k % WIDTH, k / WIDTH);
            const double found = lens_result(&f, k % WIDTH, k / WIDTH);
            worst = fmax(worst, fabs(found - expected) / (0.02 + expected));
            light[0] += expected;
            light[1] += found;
        }
        printf("plane %zu: up to %.2g apart, light %.2g\n", i, worst, light[1] / light[0] - 1);
        assert_true(worst < 5.0 / 1024);
        assert_float_equal(light[1] / light[0], 1, 1e-3);
        lens_fixture_close(&f);
    }
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
}

static void a_picture_of_one_pixel_is_itself(void **state)
{
    (void)state;
    lens_fixture f;
    effect_fixture_variants = VIRGA_VARIANTS_GPU;
    lens_fixture_open(&f, 1, 1, true);
    f.settings.max_radius_px = 16;
    lens_paint_all(&f.scene, 3, 0.6);
    lens_fixture_run(&f);
    assert_float_equal(lens_result(&f, 0, 0), 3, 4e-3);
    lens_fixture_close(&f);
    effect_fixture_variants = VIRGA_VARIANTS_OF_DEVICE;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_pass_gives_the_same_picture_as_many),
        cmocka_unit_test(discs_on_a_plane_are_those_of_a_reference),
        cmocka_unit_test(a_picture_of_one_pixel_is_itself),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
