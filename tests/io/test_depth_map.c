/* test_depth_map.c - distances of a picture's pixels from each format, against the numbers that were written. */
#include "depth_map.h"

#include "check_io.h"
#include "exr.h"
#include "npy.h"
#include "picture.h"

#include <math.h>

enum { WIDTH = 5, HEIGHT = 3, PIXELS = WIDTH * HEIGHT };

static void write_bytes(const char *name, const void *bytes, size_t size)
{
    FILE *file = fopen(in_folder(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

/* As numpy.save writes it: the header is filled up with spaces to a multiple of 64. */
static size_t write_npy(const char *name, const char *type, const char *order, const char *shape, const void *elements,
                        size_t size)
{
    static const char begin[10] = {'\x93', 'N', 'U', 'M', 'P', 'Y', 1, 0, 118, 0};
    char bytes[1024];
    memset(bytes, ' ', 128);
    memcpy(bytes, begin, sizeof begin);
    const int length =
        snprintf(bytes + 10, 118, "{'descr': '%s', 'fortran_order': %s, 'shape': %s, }", type, order, shape);
    bytes[10 + length] = ' ';
    bytes[127] = '\n';
    memcpy(bytes + 128, elements, size);
    write_bytes(name, bytes, 128 + size);
    return 128 + size;
}

static double metres_of(int i)
{
    return 1 + 6.25 * i; /* exact in 1/256 m */
}

static void expect(const char *name, const depth_map_def *def, double within)
{
    float *metres;
    uint32_t width, height;
    if (!depth_map_read(in_folder(name), def, &width, &height, &metres, error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(width, WIDTH);
    assert_int_equal(height, HEIGHT);
    for (int i = 0; i < PIXELS; i++)
        if (fabs((double)metres[i] - metres_of(i)) > within * metres_of(i))
            fail_msg("%s: %.6f m at %d, expected %.6f", name, (double)metres[i], i, metres_of(i));
    free(metres);
}

static void numpy_arrays_are_read(void **state)
{
    (void)state;
    const depth_map_def def = {.kind = DEPTH_MAP_AXIS};
    float narrow[PIXELS];
    double wide[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        wide[i] = narrow[i] = (float)metres_of(i);
    write_npy("a.npy", "<f4", "False", "(3, 5)", narrow, sizeof narrow);
    expect("a.npy", &def, 0);
    write_npy("a.npy", "<f8", "False", "(1, 3, 5, 1)", wide, sizeof wide);
    expect("a.npy", &def, 0);
    for (int i = 0; i < PIXELS; i++)
        narrow[i] *= 100; /* centimetres */
    write_npy("a.npy", "<f4", "False", "(3, 5)", narrow, sizeof narrow);
    const depth_map_def scaled = {.kind = DEPTH_MAP_AXIS, .scale = 0.01};
    expect("a.npy", &scaled, 1e-6);
}

static void channel_z_of_exr_is_read(void **state)
{
    (void)state;
    const depth_map_def def = {.kind = DEPTH_MAP_AXIS};
    float z[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        z[i] = (float)metres_of(i);
    const exr_channel channels[] = {{"Z", EXR_SAMPLE_FLOAT, z, 0, 0}};
    const exr_frame frame = {.width = WIDTH, .height = HEIGHT, .channels = channels, .channel_count = 1};
    assert_true(exr_write(in_folder("a.exr"), &frame, error, sizeof error));
    expect("a.exr", &def, 0);
}

static void write_numbers(const char *name, const uint16_t *numbers)
{
    const picture_format format = {PICTURE_PNG, 16};
    uint16_t samples[PIXELS * 3];
    for (int i = 0; i < PIXELS * 3; i++)
        samples[i] = numbers[i / 3];
    assert_true(picture_write(in_folder(name), format, WIDTH, HEIGHT, samples, error, sizeof error));
}

static void whole_numbers_are_kittis(void **state)
{
    (void)state;
    const depth_map_def def = {.kind = DEPTH_MAP_AXIS};
    uint16_t numbers[PIXELS];
    if (!picture_has_codecs())
        skip();
    for (int i = 0; i < PIXELS; i++)
        numbers[i] = (uint16_t)lrint(256 * metres_of(i));
    write_numbers("a.png", numbers);
    expect("a.png", &def, 0);
}

/* Cityscapes: disparity is (number - 1) / 256 pixels. */
static void disparity_is_cityscapes(void **state)
{
    (void)state;
    const depth_map_def def = {.kind = DEPTH_MAP_DISPARITY, .baseline_m = 0.209313, .focal_px = 2262.52};
    uint16_t numbers[PIXELS];
    if (!picture_has_codecs())
        skip();
    for (int i = 0; i < PIXELS; i++)
        numbers[i] = (uint16_t)lrint(1 + 256 * 0.209313 * 2262.52 / (metres_of(i) + 10));
    write_numbers("a.png", numbers);
    float *metres;
    uint32_t width, height;
    assert_true(depth_map_read(in_folder("a.png"), &def, &width, &height, &metres, error, sizeof error));
    for (int i = 0; i < PIXELS; i++)
        assert_true(fabs((double)metres[i] / (metres_of(i) + 10) - 1) < 1e-3); /* half a number of 1,200 or more */
    free(metres);
}

/* Three pixels from the middle, where a pixel is a quarter as wide as far away. */
static void rays_are_longer_than_the_axis(void **state)
{
    (void)state;
    const depth_map_def def = {.kind = DEPTH_MAP_RAY, .focal = {0.8, 4.0 / 3}, .center = {0.5, 0.5}};
    float along[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        const double x = 0.25 * (i % WIDTH - 2), y = 0.25 * (i / WIDTH - 1);
        along[i] = (float)(metres_of(i) * sqrt(1 + x * x + y * y));
    }
    write_npy("a.npy", "<f4", "False", "(3, 5)", along, sizeof along);
    expect("a.npy", &def, 1e-6);
}

/* As of a picture that was cut at its left and above: pixels a quarter wide and an eighth high, the axis goes through
 * the middle of the first. */
static void rays_start_at_the_axis_of_the_camera(void **state)
{
    (void)state;
    const depth_map_def def = {.kind = DEPTH_MAP_RAY, .focal = {0.8, 8.0 / 3}, .center = {0.1, 1.0 / 6}};
    float along[PIXELS];
    for (int i = 0; i < PIXELS; i++)
        along[i] = (float)(metres_of(i) * sqrt(1 + pow(0.25 * (i % WIDTH), 2) + pow(0.125 * (double)(i / WIDTH), 2)));
    write_npy("a.npy", "<f4", "False", "(3, 5)", along, sizeof along);
    expect("a.npy", &def, 1e-6);
}

/* A barrel; the test finds the directions by halves. */
static void rays_of_a_lens_are_undone(void **state)
{
    (void)state;
    const depth_map_def def = {
        .kind = DEPTH_MAP_RAY, .focal = {0.8, 4.0 / 3}, .center = {0.5, 0.5}, .lens = {.k1 = -0.4, .k2 = 0.1}};
    float along[PIXELS];
    for (int i = 0; i < PIXELS; i++) {
        const double seen = hypot(0.25 * (i % WIDTH - 2), 0.25 * (i / WIDTH - 1));
        double low = 0, high = 1;
        for (int k = 0; k < 60; k++) {
            const double r = 0.5 * (low + high);
            *(r * (1 - 0.4 * r * r + 0.1 * pow(r, 4)) < seen ? &low : &high) = r;
        }
        along[i] = (float)(metres_of(i) * sqrt(1 + low * low));
    }
    write_npy("a.npy", "<f4", "False", "(3, 5)", along, sizeof along);
    expect("a.npy", &def, 1e-6);
}

static void what_is_not_known_is_zero(void **state)
{
    (void)state;
    const depth_map_def axis = {.kind = DEPTH_MAP_AXIS},
                        disparity = {.kind = DEPTH_MAP_DISPARITY, .baseline_m = 0.2, .focal_px = 1000};
    const float values[PIXELS] = {0, -3, NAN, INFINITY, -INFINITY, 1e30f};
    uint32_t width, height;
    float *metres;
    write_npy("a.npy", "<f4", "False", "(3, 5)", values, sizeof values);
    assert_true(depth_map_read(in_folder("a.npy"), &axis, &width, &height, &metres, error, sizeof error));
    for (int i = 0; i < PIXELS; i++)
        assert_true(metres[i] == 0);
    free(metres);
    const uint16_t numbers[PIXELS] = {0, 1, 0, 1};
    if (!picture_has_codecs())
        skip();
    write_numbers("a.png", numbers);
    assert_true(depth_map_read(in_folder("a.png"), &disparity, &width, &height, &metres, error, sizeof error));
    for (int i = 0; i < PIXELS; i++)
        assert_true(metres[i] == 0);
    free(metres);
}

static void refused(const char *name, const char *why)
{
    const depth_map_def def = {.kind = DEPTH_MAP_AXIS};
    uint32_t width, height;
    float *metres;
    assert_false(depth_map_read(in_folder(name), &def, &width, &height, &metres, error, sizeof error));
    assert_null(metres);
    if (!strstr(error, name) || !strstr(error, why) || strchr(error, '\n'))
        fail_msg("'%s' does not say '%s' on one line", error, why);
}

static void wrong_files_are_refused(void **state)
{
    (void)state;
    const float values[PIXELS] = {1};
    write_npy("i.npy", "<i4", "False", "(3, 5)", values, sizeof values);
    refused("i.npy", "expected float32 or float64, got '<i4'");
    write_npy("f.npy", "<f4", "True", "(3, 5)", values, sizeof values);
    refused("f.npy", "expected C order");
    write_npy("d.npy", "<f4", "False", "(3, 5, 2)", values, sizeof values);
    refused("d.npy", "expected two dimensions of at most 16384, got (3, 5, 2)");
    write_npy("n.npy", "<f4", "False", "(15,)", values, sizeof values);
    refused("n.npy", "expected two dimensions");
    write_npy("l.npy", "<f4", "False", "(3, 99999999999999999999)", values, sizeof values);
    refused("l.npy", "expected two dimensions");
    write_npy("c.npy", "<f4", "False", "(3, 6)", values, sizeof values);
    refused("c.npy", "incomplete");
    write_bytes("t.npy", "text", 4);
    refused("t.npy", "not an array of NumPy");
    write_bytes("h.npy", "\x93NUMPY\x01\x00\xff\xff{}", 12);
    refused("h.npy", "incomplete");
    refused("a.jpg", "ends in .exr, .png, .tif or .npy");
}

/* Any wrong byte: read as something, or refused in one line. */
static void damage_never_crashes(void **state)
{
    (void)state;
    const float values[PIXELS] = {1};
    uint64_t seed = 1;
    uint8_t bytes[1024];
    const size_t size = write_npy("a.npy", "<f4", "False", "(3, 5)", values, sizeof values);
    FILE *file = fopen(in_folder("a.npy"), "rb");
    assert_int_equal(fread(bytes, 1, sizeof bytes, file), size);
    fclose(file);
    for (int i = 0; i < 500; i++) {
        const size_t at = random_bits(&seed) % 128;
        const uint8_t before = bytes[at];
        uint32_t width, height;
        float *read;
        bytes[at] = (uint8_t)random_bits(&seed);
        write_bytes("a.npy", bytes, i % 5 ? size : at);
        bytes[at] = before;
        error[0] = 0;
        if (npy_read(in_folder("a.npy"), &width, &height, &read, error, sizeof error))
            free(read);
        else
            assert_true(error[0] && !strchr(error, '\n'));
    }
}

/* Known are two pixels: nothing above the higher one is filled, and what is below gets the nearest. */
static void holes_get_the_nearest_known_depth(void **state)
{
    enum { W = 40, H = 6 };
    float metres[W * H] = {0};
    (void)state;
    metres[2 * W + 3] = 5;
    metres[4 * W + 13] = 9;
    assert_true(depth_map_fill(metres, W, H));
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const int near = abs(x - 3) + abs(y - 2), far = abs(x - 13) + abs(y - 4);
            const float got = metres[y * W + x];
            if (y < 2 || x > 13 + 8 || (x > 3 + 8 && y < 4))
                assert_true(got == 0);
            else if (near < far - 2)
                assert_true(got == 5);
            else if (far < near - 2)
                assert_true(got == 9);
        }
    float none[4] = {0};
    assert_true(depth_map_fill(none, 2, 2));
    assert_true(none[0] == 0 && none[3] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(numpy_arrays_are_read, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(channel_z_of_exr_is_read, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(whole_numbers_are_kittis, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(disparity_is_cityscapes, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(rays_are_longer_than_the_axis, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(rays_start_at_the_axis_of_the_camera, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(rays_of_a_lens_are_undone, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(what_is_not_known_is_zero, make_folder, remove_folder),
        cmocka_unit_test(holes_get_the_nearest_known_depth),
        cmocka_unit_test_setup_teardown(wrong_files_are_refused, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(damage_never_crashes, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
