/* test_exr_rgb.c - environments of every kind read from OpenEXR pictures, and pictures that are refused. */
#include "check_io.h"
#include "exr.h"
#include "make_exr.h"

#include <math.h>

#define DWAA 8
#define DWAB 9

/* Smooth, so that lossy packing stays close; between 0.25 and 4. */
static float *make_samples(int width, int height, int channels)
{
    float *samples = malloc(sizeof(float) * (size_t)(width * height * channels));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < channels; c++)
                samples[(y * width + x) * channels + c] =
                    0.25f + 3.75f * (float)(x + (c + 1) * y) / (float)(width + (channels + 1) * height);
    return samples;
}

static void assert_reads_rgb(exr_recipe recipe, float tolerance)
{
    uint32_t width, height;
    uint64_t repaired;
    float *rgb, *samples = make_samples(recipe.width, recipe.height, 3);
    recipe.channels = "RGB";
    recipe.samples = samples;
    assert_true(make_exr(in_folder("e.exr"), &recipe));
    if (!exr_read_rgb(in_folder("e.exr"), &width, &height, &rgb, &repaired, error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(width, recipe.width);
    assert_int_equal(height, recipe.height);
    assert_int_equal(repaired, 0);
    for (int i = 0; i < recipe.width * recipe.height * 3; i++)
        if (!(fabsf(rgb[i] - samples[i]) <= tolerance))
            fail_msg("sample %d is %g, expected %g", i, (double)rgb[i], (double)samples[i]);
    free(rgb);
    free(samples);
}

static void dwa_is_read(void **state)
{
    (void)state;
    /* DWA loses a little: 1 % of the largest value is well above what it does at its default quality */
    assert_reads_rgb((exr_recipe){.width = 128, .height = 64, .compression = DWAA, .half = true}, 0.04f);
    assert_reads_rgb((exr_recipe){.width = 128, .height = 64, .compression = DWAB, .half = true}, 0.04f);
}

static void lossless_compressions_are_read(void **state)
{
    (void)state;
    for (int compression = 0; compression <= 4; compression++)
        assert_reads_rgb((exr_recipe){.width = 67, .height = 35, .compression = compression}, 0.0f);
}

static void tiles_are_read(void **state)
{
    (void)state;
    assert_reads_rgb((exr_recipe){.width = 70, .height = 50, .compression = 3, .tile = 32}, 0.0f);
    assert_reads_rgb((exr_recipe){.width = 70, .height = 50, .compression = DWAB, .tile = 32, .half = true}, 0.04f);
}

static void mip_levels_are_passed_over(void **state)
{
    (void)state;
    assert_reads_rgb((exr_recipe){.width = 64, .height = 32, .compression = 3, .tile = 32, .mip = true}, 0.0f);
}

static void a_data_window_may_lie_anywhere(void **state)
{
    (void)state;
    assert_reads_rgb((exr_recipe){.width = 33, .height = 17, .left = -100, .top = 50, .compression = 3}, 0.0f);
}

static void the_first_of_many_parts_is_read(void **state)
{
    (void)state;
    uint32_t width, height;
    float *rgb;
    assert_true(make_exr_parts(in_folder("e.exr")));
    if (!exr_read_rgb(in_folder("e.exr"), &width, &height, &rgb, NULL, error, sizeof error))
        fail_msg("%s", error);
    assert_true(width == 4 && height == 2 && rgb[0] == 0.5f && rgb[23] == 0.5f);
    free(rgb);
}

/* A picture with `count` samples in it, of which `repaired` are not as they were. */
static void assert_rgb_is(const exr_recipe *recipe, const float *expected, size_t count, uint64_t repaired)
{
    uint32_t width, height;
    uint64_t found;
    float *rgb;
    assert_true(make_exr(in_folder("e.exr"), recipe));
    assert_true(exr_read_rgb(in_folder("e.exr"), &width, &height, &rgb, &found, error, sizeof error));
    assert_memory_equal(rgb, expected, count * sizeof *expected);
    assert_int_equal(found, repaired);
    free(rgb);
}

static void luminance_is_read_as_grey(void **state)
{
    (void)state;
    const float grey[] = {0.5f, 2.0f, -1.0f, 0.25f};
    const exr_recipe recipe = {.width = 2, .height = 2, .channels = "Y", .samples = grey};
    const float expected[] = {0.5f, 0.5f, 0.5f, 2.0f, 2.0f, 2.0f, 0.0f, 0.0f, 0.0f, 0.25f, 0.25f, 0.25f};
    assert_rgb_is(&recipe, expected, COUNT(expected), 1);
}

static void impossible_light_is_repaired_and_counted(void **state)
{
    (void)state;
    const float samples[] = {NAN, INFINITY, -INFINITY, -2.0f, -0.0f, 1e9f};
    const float expected[] = {0.0f, 65504.0f, 0.0f, 0.0f, -0.0f, 1e9f};
    const exr_recipe recipe = {.width = 2, .height = 1, .channels = "RGB", .samples = samples};
    assert_rgb_is(&recipe, expected, COUNT(expected), 4);
}

static void a_real_environment_is_read(void **state)
{
    (void)state;
    static const char path[] = SOURCE_ROOT "/../shared/environments/city.exr";
    uint32_t width, height;
    uint64_t repaired;
    float *rgb;
    double sum = 0.0;
    if (access(path, R_OK) != 0)
        skip();
    if (!exr_read_rgb(path, &width, &height, &rgb, &repaired, error, sizeof error))
        fail_msg("%s", error);
    for (size_t i = 0; i < (size_t)width * height * 3; i++)
        sum += (double)rgb[i];
    assert_true(width == 2 * height && sum > 0.0);
    free(rgb);
}

static void assert_rgb_refused(const char *path, const char *reason)
{
    uint32_t width, height;
    float *rgb;
    assert_false(exr_read_rgb(path, &width, &height, &rgb, NULL, error, sizeof error));
    assert_error(path, reason);
    assert_null(rgb);
    assert_int_equal(width, 0);
}

static void assert_recipe_refused(exr_recipe recipe, const char *reason)
{
    float *samples = make_samples(recipe.width, recipe.height, (int)strlen(recipe.channels));
    recipe.samples = samples;
    assert_true(make_exr(in_folder("e.exr"), &recipe));
    assert_rgb_refused(in_folder("e.exr"), reason);
    free(samples);
}

static void missing_channels_are_named(void **state)
{
    (void)state;
    const exr_recipe small = {.width = 4, .height = 4, .channels = "RA"};
    assert_recipe_refused(small, "missing channels G, B (the file has A, R)");
    assert_recipe_refused((exr_recipe){.width = 4, .height = 4, .channels = "RGA"}, "missing channel B (");
    assert_recipe_refused((exr_recipe){.width = 4, .height = 4, .channels = "Z"}, "missing channels R, G, B (");
}

static void subsampled_channels_are_refused(void **state)
{
    (void)state;
    assert_recipe_refused((exr_recipe){.width = 4, .height = 4, .channels = "RGB", .sampling = 2}, "subsampled");
}

static void absurd_sizes_are_refused(void **state)
{
    (void)state;
    assert_recipe_refused((exr_recipe){.width = 17000, .height = 1, .channels = "RGB"}, "17000 x 1 pixels");
}

static void deep_pictures_are_refused(void **state)
{
    (void)state;
    assert_true(make_exr_deep(in_folder("e.exr")));
    assert_rgb_refused(in_folder("e.exr"), "cannot read");
}

static void incomplete_pictures_are_refused(void **state)
{
    (void)state;
    assert_recipe_refused((exr_recipe){.width = 32, .height = 32, .channels = "RGB", .rows = 20}, "incomplete");
}

static void what_is_no_picture_is_refused(void **state)
{
    (void)state;
    put_file(in_folder("empty"), "", 0);
    put_file(in_folder("text"), "hello, this is text\n", 20);
    put_file(in_folder("magic"), "\x76\x2f\x31\x01", 4);
    assert_rgb_refused(in_folder("empty"), "the file is empty");
    assert_rgb_refused(in_folder("text"), "not an OpenEXR file");
    assert_rgb_refused(in_folder("magic"), "damaged");
    assert_rgb_refused(in_folder("none"), "No such file or directory");
    assert_rgb_refused(folder, "Is a directory");
}

/* A small DWA picture in memory, to be broken. */
static char *make_victim(size_t *size)
{
    exr_recipe recipe = {.width = 64, .height = 32, .compression = DWAB, .half = true, .channels = "RGB"};
    float *samples = make_samples(64, 32, 3);
    recipe.samples = samples;
    assert_true(make_exr(in_folder("e.exr"), &recipe));
    free(samples);
    return get_file(in_folder("e.exr"), size);
}

static void cut_pictures_are_refused_at_every_length(void **state)
{
    (void)state;
    size_t size;
    char *file = make_victim(&size);
    for (size_t length = 1; length < size; length += 1 + size / 150) {
        put_file(in_folder("cut.exr"), file, length);
        assert_rgb_refused(in_folder("cut.exr"), "cannot read");
    }
    free(file);
}

static void a_damaged_chunk_is_refused(void **state)
{
    (void)state;
    size_t size;
    char *file = make_victim(&size);
    memset(file + size - 200, 0xA5, 150);
    put_file(in_folder("bad.exr"), file, size);
    assert_rgb_refused(in_folder("bad.exr"), "damaged");
    free(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(dwa_is_read),
        TEST_IN_FOLDER(lossless_compressions_are_read),
        TEST_IN_FOLDER(tiles_are_read),
        TEST_IN_FOLDER(mip_levels_are_passed_over),
        TEST_IN_FOLDER(a_data_window_may_lie_anywhere),
        TEST_IN_FOLDER(the_first_of_many_parts_is_read),
        TEST_IN_FOLDER(luminance_is_read_as_grey),
        TEST_IN_FOLDER(impossible_light_is_repaired_and_counted),
        TEST_IN_FOLDER(a_real_environment_is_read),
        TEST_IN_FOLDER(missing_channels_are_named),
        TEST_IN_FOLDER(subsampled_channels_are_refused),
        TEST_IN_FOLDER(absurd_sizes_are_refused),
        TEST_IN_FOLDER(deep_pictures_are_refused),
        TEST_IN_FOLDER(incomplete_pictures_are_refused),
        TEST_IN_FOLDER(what_is_no_picture_is_refused),
        TEST_IN_FOLDER(cut_pictures_are_refused_at_every_length),
        TEST_IN_FOLDER(a_damaged_chunk_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
