/* test_picture.c - other people's pictures: what is written comes back, and what is wrong is said in one line. */
#include "picture.h"

#include "check_io.h"
#include "exr.h"
#include "file.h"

#include <math.h>

static const struct {
    const char *name;
    picture_format format;
    double within; /* of 255 codes */
} kinds[] = {
    {"p.png", {PICTURE_PNG, 8}, 0},    {"p.PNG", {PICTURE_PNG, 16}, 0},  {"p.tif", {PICTURE_TIFF, 8}, 0},
    {"p.tiff", {PICTURE_TIFF, 16}, 0}, {"p.TIF", {PICTURE_TIFF, 32}, 0}, {"p.jpg", {PICTURE_JPEG, 8}, 6},
};

enum { WIDTH = 48, HEIGHT = 32, SAMPLES = WIDTH * HEIGHT * 3 };

/* A smooth picture, as a JPEG is exact for no other. */
static double value_at(int i)
{
    const int x = i / 3 % WIDTH, y = i / 3 / WIDTH;
    return 0.5 + 0.4 * sin(0.11 * x + i % 3) * cos(0.13 * y);
}

static void fill(picture_format format, void *samples, float *expected)
{
    const int largest = format.bits == 8 ? 255 : 65535;
    for (int i = 0; i < SAMPLES; i++) {
        const long code = lrint(value_at(i) * largest);
        expected[i] = format.bits == 32 ? (float)value_at(i) : (float)code / (float)largest;
        if (format.bits == 8)
            ((uint8_t *)samples)[i] = (uint8_t)code;
        else if (format.bits == 16)
            ((uint16_t *)samples)[i] = (uint16_t)code;
        else
            ((float *)samples)[i] = expected[i];
    }
}

static void every_format_comes_back(void **state)
{
    (void)state;
    static float samples[SAMPLES], expected[SAMPLES];
    for (size_t k = 0; k < COUNT(kinds); k++) {
        picture p;
        picture_kind kind;
        assert_true(picture_kind_of(kinds[k].name, &kind));
        assert_int_equal(kind, kinds[k].format.kind);
        fill(kinds[k].format, samples, expected);
        assert_true(
            picture_write(in_folder(kinds[k].name), kinds[k].format, WIDTH, HEIGHT, samples, error, sizeof error));
        if (!picture_read(in_folder(kinds[k].name), &p, error, sizeof error))
            fail_msg("%s", error);
        assert_int_equal(p.width, WIDTH);
        assert_int_equal(p.height, HEIGHT);
        assert_int_equal(p.channels, 3);
        assert_int_equal(p.format.bits, kinds[k].format.bits);
        for (int i = 0; i < SAMPLES; i++)
            if (fabs((double)(p.rgb[i] - expected[i])) * 255 > kinds[k].within + 1e-4)
                fail_msg("%s of %u bits: %.6f, expected %.6f", kinds[k].name, kinds[k].format.bits, (double)p.rgb[i],
                         (double)expected[i]);
        free(p.rgb);
    }
}

static void the_same_samples_give_the_same_bytes(void **state)
{
    (void)state;
    static float samples[SAMPLES], expected[SAMPLES];
    for (size_t k = 0; k < COUNT(kinds); k++) {
        void *first, *again;
        size_t first_size, again_size;
        const char *path = in_folder(kinds[k].name);
        fill(kinds[k].format, samples, expected);
        assert_true(picture_write(path, kinds[k].format, WIDTH, HEIGHT, samples, error, sizeof error));
        assert_true(file_read(path, 1 << 20, &first, &first_size, error, sizeof error));
        usleep(kinds[k].format.kind == PICTURE_TIFF ? 1100000 : 0); /* its time of day has seconds */
        assert_true(picture_write(path, kinds[k].format, WIDTH, HEIGHT, samples, error, sizeof error));
        assert_true(file_read(path, 1 << 20, &again, &again_size, error, sizeof error));
        assert_int_equal(first_size, again_size);
        assert_memory_equal(first, again, first_size);
        free(first);
        free(again);
    }
}

static void an_exr_is_read_as_floats(void **state)
{
    (void)state;
    const float pixels[6] = {0.25f, 0.5f, 2, 3, 0, 1};
    const exr_channel channels[] = {{"R", EXR_SAMPLE_FLOAT, pixels, 12, 0},
                                    {"G", EXR_SAMPLE_FLOAT, pixels + 1, 12, 0},
                                    {"B", EXR_SAMPLE_FLOAT, pixels + 2, 12, 0}};
    const exr_frame frame = {.width = 2, .height = 1, .channels = channels, .channel_count = 3};
    picture p;
    assert_true(exr_write(in_folder("p.exr"), &frame, error, sizeof error));
    assert_true(picture_read(in_folder("p.exr"), &p, error, sizeof error));
    assert_int_equal(p.format.bits, 32);
    assert_int_equal(picture_curve(TRANSFER_AUTO, p.format), TRANSFER_LINEAR);
    assert_memory_equal(p.rgb, pixels, sizeof pixels);
    free(p.rgb);
}

static void write_bytes(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static void refused(const char *name, const char *why)
{
    picture p;
    assert_false(picture_read(in_folder(name), &p, error, sizeof error));
    assert_null(p.rgb);
    assert_non_null(strstr(error, name));
    if (!strstr(error, why) || strchr(error, '\n'))
        fail_msg("'%s' does not say '%s' on one line", error, why);
}

static void wrong_files_are_refused(void **state)
{
    (void)state;
    write_bytes("p.txt", "words", 5);
    refused("p.txt", "ends in .exr, .png, .jpg or .tif");
    refused("none.png", "No such file");
    write_bytes("p.png", "words", 5);
    refused("p.png", "not a PNG picture");
    write_bytes("p.jpg", "\x89PNG\r\n\x1a\n", 8);
    refused("p.jpg", "not a JPEG picture");
    write_bytes("p.tif", "", 0);
    refused("p.tif", "not a TIFF picture");
}

/* Any part of a file, and any wrong byte: read as something, or refused in one line. */
static void damage_never_crashes(void **state)
{
    (void)state;
    static float samples[SAMPLES], expected[SAMPLES];
    for (size_t k = 0; k < COUNT(kinds); k++) {
        uint8_t *bytes;
        size_t size;
        uint64_t seed = k;
        fill(kinds[k].format, samples, expected);
        assert_true(
            picture_write(in_folder(kinds[k].name), kinds[k].format, WIDTH, HEIGHT, samples, error, sizeof error));
        assert_true(file_read(in_folder(kinds[k].name), 1 << 20, (void **)&bytes, &size, error, sizeof error));
        for (int i = 0; i < 60; i++) {
            picture p;
            const size_t at = random_bits(&seed) % size;
            const uint8_t before = bytes[at];
            bytes[at] = (uint8_t)random_bits(&seed);
            write_bytes(kinds[k].name, bytes, i % 2 ? size : at);
            bytes[at] = before;
            error[0] = 0;
            if (picture_read(in_folder(kinds[k].name), &p, error, sizeof error))
                free(p.rgb);
            else
                assert_true(error[0] && !strchr(error, '\n'));
        }
        free(bytes);
    }
}

int main(void)
{
    if (!picture_has_codecs()) {
        printf("skipped: built without OpenImageIO\n");
        return 77;
    }
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_format_comes_back, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(the_same_samples_give_the_same_bytes, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(an_exr_is_read_as_floats, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(wrong_files_are_refused, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(damage_never_crashes, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
