/* test_video.c - frames of videos, of which each has its number as colors: all in order and in any order, exactly. The
 * videos are made by the program ffmpeg. */
#include "video.h"

#include "check_io.h"

#include <math.h>

enum { WIDTH = 32, HEIGHT = 24, FRAMES = 40 };

static uint32_t code_of(int frame, int x, int y, int c, uint32_t largest)
{
    const uint32_t bits = (uint32_t)frame * 2654435761u ^ (uint32_t)(x / 4 + 64 * (y / 4) + 4096 * c) * 40503u;
    return (bits >> 7 ^ bits >> 19) % (largest + 1);
}

/* Raw frames of 8 bits (rgb24) or 10 (gbrp10le: green, blue and red, one after the other). */
static void make_video(const char *name, uint32_t bits, const char *how)
{
    static const int order[3] = {1, 2, 0};
    char command[1024];
    FILE *raw = fopen(in_folder("raw"), "wb");
    assert_non_null(raw);
    for (int frame = 0; frame < FRAMES; frame++)
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
            const int pixel = bits == 8 ? i / 3 : i % (WIDTH * HEIGHT);
            const int c = bits == 8 ? i % 3 : order[i / (WIDTH * HEIGHT)];
            const uint32_t code = code_of(frame, pixel % WIDTH, pixel / WIDTH, c, (1u << bits) - 1);
            const uint8_t bytes[2] = {(uint8_t)code, (uint8_t)(code >> 8)};
            fwrite(bytes, 1, bits == 8 ? 1 : 2, raw);
        }
    fclose(raw);
    snprintf(command, sizeof command,
             "ffmpeg -v error -y -f rawvideo -pix_fmt %s -s %dx%d -r 24 -i %s/raw %s %s/%s </dev/null",
             bits == 8 ? "rgb24" : "gbrp10le", WIDTH, HEIGHT, folder, how, folder, name);
    if (system(command))
        fail_msg("%s", command);
}

static void check_frame(video *v, int frame, uint32_t bits)
{
    picture p;
    if (!video_read(v, (uint32_t)frame, &p, error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(p.width, WIDTH);
    assert_int_equal(p.height, HEIGHT);
    assert_int_equal(p.format.bits, bits == 8 ? 8 : 16);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++) {
        const uint32_t largest = (1u << bits) - 1;
        const uint32_t wanted = code_of(frame, i / 3 % WIDTH, i / 3 / WIDTH, i % 3, largest);
        if (fabs((double)p.rgb[i] * largest - wanted) > 1e-3)
            fail_msg("frame %d, value %d: %g, expected %u", frame, i, (double)p.rgb[i] * largest, wanted);
    }
    free(p.rgb);
}

static void check_video(const char *name, uint32_t bits)
{
    static const int any[] = {39, 0, 17, 16, 18, 18, 5, 38, 24, 23, 1};
    video *v;
    if (!video_open(&v, in_folder(name), error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(video_count(v), FRAMES);
    for (int frame = 0; frame < FRAMES; frame++)
        check_frame(v, frame, bits);
    for (size_t i = 0; i < COUNT(any); i++)
        check_frame(v, any[i], bits);
    video_close(&v);
    assert_null(v);
}

static void frames_of_ffv1_are_exact(void **state)
{
    (void)state;
    make_video("a.mkv", 8, "-c:v ffv1 -g 1 -pix_fmt bgr0");
    check_video("a.mkv", 8);
    make_video("a.avi", 8, "-c:v ffv1 -g 12 -pix_fmt bgr0");
    check_video("a.avi", 8);
    make_video("a.mov", 10, "-c:v ffv1 -level 3 -pix_fmt gbrp10le");
    check_video("a.mov", 10);
}

/* Frames that are stored in another order than they are shown in, far from those that decoding can begin with. */
static void frames_between_others_are_exact(void **state)
{
    (void)state;
    make_video("b.mp4", 8,
               "-c:v libx264rgb -qp 0 -bf 3 -g 16 -preset ultrafast -x264-params b-pyramid=normal:open-gop=1");
    check_video("b.mp4", 8);
}

/* White, grey and black of video range; with one code of 8 bits for the filters. */
static void yuv_becomes_rgb(void **state)
{
    (void)state;
    static const struct {
        uint8_t luma;
        double code;
    } greys[] = {{235, 1}, {16, 0}, {126, 110.0 / 219}};
    char command[512];
    for (size_t i = 0; i < COUNT(greys); i++) {
        picture p;
        video *v;
        FILE *raw = fopen(in_folder("raw"), "wb");
        for (int k = 0; k < WIDTH * HEIGHT * 3 / 2; k++)
            fputc(k < WIDTH * HEIGHT ? greys[i].luma : 128, raw);
        fclose(raw);
        snprintf(command, sizeof command,
                 "ffmpeg -v error -y -f rawvideo -pix_fmt yuv420p -s %dx%d -i %s/raw -c:v ffv1 %s/y.mkv </dev/null",
                 WIDTH, HEIGHT, folder, folder);
        assert_int_equal(system(command), 0);
        assert_true(video_open(&v, in_folder("y.mkv"), error, sizeof error));
        assert_true(video_read(v, 0, &p, error, sizeof error));
        for (int k = 0; k < WIDTH * HEIGHT * 3; k++)
            if (fabs((double)p.rgb[k] - greys[i].code) > 1.0 / 255)
                fail_msg("luma %u: %g, expected %g", greys[i].luma, (double)p.rgb[k], greys[i].code);
        free(p.rgb);
        video_close(&v);
    }
}

static void what_is_wrong_is_one_line(void **state)
{
    video *v;
    picture p;
    (void)state;
    assert_true(video_is_name("a/b.MOV") && !video_is_name("a.mov/b.png") && !video_is_name("mov"));
    make_video("a.mkv", 8, "-c:v ffv1 -g 1 -pix_fmt bgr0");
    assert_true(video_open(&v, in_folder("a.mkv"), error, sizeof error));
    assert_false(video_read(v, FRAMES, &p, error, sizeof error));
    assert_non_null(strstr(error, "a.mkv has 40 frames, expected frame 40"));
    video_close(&v);
    assert_false(video_open(&v, in_folder("none.mkv"), error, sizeof error));
    assert_true(strstr(error, "none.mkv") && !strchr(error, '\n'));
    assert_false(video_open(&v, in_folder("raw"), error, sizeof error));
    assert_null(v);
    /* The first half. A frame is read, or refused with one line. */
    assert_int_equal(truncate(in_folder("a.mkv"), 20000), 0);
    if (video_open(&v, in_folder("a.mkv"), error, sizeof error))
        for (uint32_t i = 0; i < video_count(v); i++) {
            error[0] = 0;
            if (video_read(v, i, &p, error, sizeof error))
                free(p.rgb);
            else
                assert_true(error[0] && !strchr(error, '\n'));
        }
    video_close(&v);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(frames_of_ffv1_are_exact, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(frames_between_others_are_exact, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(yuv_becomes_rgb, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(what_is_wrong_is_one_line, make_folder, remove_folder),
    };
    video *v;
    const bool opened = video_open(&v, "/none.mkv", error, sizeof error);
    if (opened || strstr(error, "without FFmpeg") || system("ffmpeg -version >/dev/null 2>&1")) {
        print_message("skipped: built without FFmpeg, or no program ffmpeg\n");
        return 77;
    }
    return cmocka_run_group_tests(tests, NULL, NULL);
}
