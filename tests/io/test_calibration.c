/* test_calibration.c - calibrations of COLMAP, KITTI and Cityscapes against numbers worked out by hand; in a scene;
 * damage of each kind; and 200 random ones. */
#include "check_io.h"

#include <math.h>

#include "camera_calibration.h"
#include "effect.h"

/* ---- files as their tools write them, with numbers that are easy to follow ---- */

#define COLMAP                                          \
    "# Camera list with one line of data per camera:\n" \
    "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n"   \
    "1 SIMPLE_PINHOLE 640 480 500 320.5 240.5\n"        \
    "2 PINHOLE 640 480 500 510 320 241\n"               \
    "3 SIMPLE_RADIAL 640 480 500 320 240 -0.125\n"      \
    "4 RADIAL 640 480 500 320 240 -0.125 0.25\n"        \
    "7 OPENCV 640 480 500 510 320 241 -0.125 0.25 1e-3 -2e-3\n"

#define RAW                                                                           \
    "calib_time: 09-Jan-2012 13:57:47\n"                                              \
    "corner_dist: 9.950000e-02\n"                                                     \
    "S_00: 1.392000e+03 5.120000e+02\n"                                               \
    "K_00: 9.8e+02 0.0e+00 6.9e+02 0.0e+00 9.7e+02 2.3e+02 0.0e+00 0.0e+00 1.0e+00\n" \
    "D_00: -3.7e-01 2.0e-01 1.5e-03 1.8e-03 -7.0e-02\n"                               \
    "R_00: 1 0 0 0 1 0 0 0 1\n"                                                       \
    "T_00: 0 0 0\n"                                                                   \
    "S_rect_00: 1.242000e+03 3.750000e+02\n"                                          \
    "R_rect_00: 1 0 0 0 1 0 0 0 1\n"                                                  \
    "P_rect_00: 7.2e+02 0 6.1e+02 0 0 7.2e+02 1.7e+02 0 0 0 1 0\n"                    \
    "S_02: 1.392000e+03 5.120000e+02\n"                                               \
    "K_02: 9.6e+02 0 6.95e+02 0 9.5e+02 2.25e+02 0 0 1\n"                             \
    "D_02: -3.5e-01 1.5e-01 5.0e-04 -1.0e-03 -5.0e-02\n"                              \
    "S_rect_02: 1.242000e+03 3.750000e+02\n"                                          \
    "P_rect_02: 7.25e+02 0 6.05e+02 4.4e+01 0 7.21e+02 1.75e+02 2.1e-01 0 0 1 2.7e-03\n"

#define ODOMETRY                                      \
    "P0: 718.5 0 607.25 0 0 718.5 185.25 0 0 0 1 0\n" \
    "P1: 707 0 601 -380 0 709 183 0 0 0 1 0\n"        \
    "Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n"

#define CITYSCAPES                                                                \
    "{\n    \"extrinsic\": {\n        \"baseline\": 0.209313\n    },\n"           \
    "    \"intrinsic\": {\n        \"fx\": 2262.5, \n        \"fy\": 2265.25, \n" \
    "        \"u0\": 1096.5, \n        \"v0\": 513\n    }\n}"

static void put_text(const char *name, const char *text)
{
    put_file(in_folder(name), text, strlen(text));
}

static const struct {
    const char *text, *camera;
    camera_calibration is;
} right[] = {
    {COLMAP, "1", {{640, 480}, {500, 500}, {320, 240}, {0}, 0}},
    {COLMAP, "2", {{640, 480}, {500, 510}, {319.5, 240.5}, {0}, 0}},
    {COLMAP, "3", {{640, 480}, {500, 500}, {319.5, 239.5}, {-0.125}, 0}},
    {COLMAP, "4", {{640, 480}, {500, 500}, {319.5, 239.5}, {-0.125, 0.25}, 0}},
    {COLMAP, "7", {{640, 480}, {500, 510}, {319.5, 240.5}, {-0.125, 0.25, 1e-3, -2e-3}, 0}},
    {"5 PINHOLE 64 48 50 51 32 24\r\n", NULL, {{64, 48}, {50, 51}, {31.5, 23.5}, {0}, 0}},
    {RAW, "02", {{1242, 375}, {725, 721}, {605, 175}, {0}, -44.0 / 725}},
    {RAW, "2", {{1242, 375}, {725, 721}, {605, 175}, {0}, -44.0 / 725}},
    {RAW, "00 raw", {{1392, 512}, {980, 970}, {690, 230}, {-0.37, 0.2, 1.5e-3, 1.8e-3, -0.07}, 0}},
    {RAW, "02 raw", {{1392, 512}, {960, 950}, {695, 225}, {-0.35, 0.15, 5e-4, -1e-3, -0.05}, 0}},
    {ODOMETRY, "0", {{0, 0}, {718.5, 718.5}, {607.25, 185.25}, {0}, 0}},
    {ODOMETRY, "1", {{0, 0}, {707, 709}, {601, 183}, {0}, 380.0 / 707}},
    {CITYSCAPES, NULL, {{2048, 1024}, {2262.5, 2265.25}, {1096.5, 513}, {0}, 0}},
};

static void near(double value, double wanted)
{
    if (!(fabs(value - wanted) <= 1e-12 * fmax(1, fabs(wanted))))
        fail_msg("got %.17g, expected %.17g", value, wanted);
}

static void numbers_of_each_form(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(right); i++) {
        camera_calibration got;
        put_text("camera", right[i].text);
        if (!camera_calibration_read(in_folder("camera"), right[i].camera, &got, error, sizeof error))
            fail_msg("%s", error);
        for (int axis = 0; axis < 2; axis++) {
            assert_int_equal(got.size_px[axis], right[i].is.size_px[axis]);
            near(got.focal_px[axis], right[i].is.focal_px[axis]);
            near(got.center_px[axis], right[i].is.center_px[axis]);
        }
        for (int k = 0; k < 5; k++)
            near(got.distortion[k], right[i].is.distortion[k]);
        near(got.right_m, right[i].is.right_m);
    }
}

/* ---- damage ---- */

#define MATRIX            "P0: 718 0 607 0 0 718 185 0 0 0 1"
#define RECTIFIED(matrix) "S_02: 1392 512\nS_rect_02: 1242 375\nP_rect_02: " matrix
#define UNRECTIFIED(lens) "S_02: 1392 512\nK_02: 960 0 695 0 950 225 0 0 1\nD_02: " lens

static const struct {
    const char *text, *camera, *said;
} damaged[] = {
    {"", NULL, "camera: expected a calibration, got none"},
    {"# Camera list\n\n", NULL, "camera: expected a calibration, got none"},
    {"hello\n", NULL, "camera:1: expected COLMAP's cameras.txt, KITTI's calib_cam_to_cam.txt or calib.txt"},
    {"\x89PNG\r\n\x1a\n", NULL, "camera:1: expected COLMAP's cameras.txt"},
    /* COLMAP */
    {COLMAP, NULL, "camera: expected camera to be one of 1, 2, 3, 4, 7, got none"},
    {COLMAP, "5", "camera: expected camera to be one of 1, 2, 3, 4, 7, got 5"},
    {COLMAP, "left", "camera: expected camera to be one of 1, 2, 3, 4, 7, got left"},
    {COLMAP, "1 raw", "camera: expected camera to be one of 1, 2, 3, 4, 7, got 1 raw"},
    {"1 FULL_OPENCV 640 480 5 5 3 2 0 0 0 0 0 0 0 0\n", NULL,
     "camera:1: expected a model of SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL and OPENCV, got 'FULL_OPENCV'"},
    {"1 OPENCV_FISHEYE 640 480 5 5 3 2 0 0 0 0\n", NULL, "RADIAL and OPENCV, got 'OPENCV_FISHEYE'"},
    {"1 0.8 0.1 0.2 0.5 0 0 0 1 a.jpg\n", NULL, "camera:1: expected a model of SIMPLE_PINHOLE, PINHOLE"},
    {"# a\n1 PINHOLE 640 480 500 510 320\n", NULL,
     "camera:2: expected 6 numbers of a camera PINHOLE: width, height, parameters, got 5 numbers"},
    {"1 PINHOLE\n", NULL, "parameters, got 0 numbers"},
    {"1 PINHOLE 640 480 500 510 320 240 0\n", NULL, "camera:1: expected 6 numbers of a camera PINHOLE: width"},
    {"1 PINHOLE 640 480 nan 510 320 240\n", NULL, "got 'nan'"},
    {"1 PINHOLE 640 480 1e999 510 320 240\n", NULL, "got '1e999'"},
    {"1 PINHOLE 640 480 500px 510 320 240\n", NULL, "got '500px'"},
    {"1 PINHOLE 640.5 480 500 510 320 240\n", NULL,
     "camera:1: expected width and height as whole numbers from 1 to 65536, got 640.5"},
    {"1 PINHOLE 640 0 500 510 320 240\n", NULL, "from 1 to 65536, got 0"},
    {"1 PINHOLE 640 480 -500 510 320 240\n", NULL,
     "camera:1: expected a focal length above 0 and up to 1000000 pixels, got -500"},
    {"1 PINHOLE 640 480 500 510 320 1e6\n", NULL, "camera:1: expected a principal point up to 100000 pixels away"},
    {"1 PINHOLE 640 480 500 510 0.5 0.5\n", NULL, "camera:1: expected a principal point beside the upper left pixel"},
    {"1 RADIAL 640 480 500 320 240 -0.125 2000\n", NULL, "camera:1: expected distortion from -1000 to 1000, got 2000"},
    {"1 PINHOLE 640 480 500 510 320 240\n1 PINHOLE 640 480 5 5 3 2\n", NULL,
     "camera:2: expected each camera once, got camera 1 again"},
    {"1 PINHOLE 640 480 500 510 320 240\nx\n", NULL,
     "camera:2: expected a camera: number, model, width, height, parameters (COLMAP's cameras.txt), got x"},
    /* KITTI, raw */
    {RAW, NULL, "camera: expected camera to be one of 00, 02, got none"},
    {RAW, "01", "camera: expected camera to be one of 00, 02, got 01"},
    {RAW, "01 raw", "camera: expected camera to be one of 00, 02, got 01"},
    {RAW, "02 rectified", "camera: expected camera to be one of 00, 02, got 02 rectified"},
    {"calib_time: 09-Jan-2012 13:57:47\n", "02", "camera: expected at least one camera, got none"},
    {"S_02: 1392 512\n", "02", "camera: expected a line S_rect_02: of the camera, got none"},
    {"S_02: 1392 512\nS_rect_02: 1242 375\n", "02", "camera: expected a line P_rect_02: of the camera, got none"},
    {"S_02: 1392 512\nK_02: 960 0 695 0 950 225 0 0 1\n", "02 raw", "expected a line D_02: of the camera, got none"},
    {"S_02: 1392\n", "02 raw", "camera:1: expected 2 numbers of S_02 (KITTI), got 1 numbers"},
    {RECTIFIED("725 0 605 44 0 721 175"), "02", "camera:3: expected 12 numbers of P_rect_02 (KITTI), got 7 numbers"},
    {RECTIFIED("725 1 605 44 0 721 175 0 0 0 1 0\nR_rect_02: 1\n"), NULL,
     "camera:3: expected rows fx 0 cx, 0 fy cy, 0 0 1 of a camera matrix, got another matrix"},
    {RECTIFIED("0 0 605 44 0 721 175 0 0 0 1 0\n# end\n"), NULL, "camera:3: expected a focal length above 0"},
    {RECTIFIED("725 0 605 44 0 721 175 0 0 0 1 0\nS_rect_02: 1242 375\n"), NULL,
     "camera:4: expected each line once, got S_rect_02:"},
    {UNRECTIFIED("-0.3 0.1 0 0"), "02 raw", "camera:3: expected 5 numbers of D_02 (KITTI), got 4 numbers"},
    {UNRECTIFIED("-0.3 inf 0 0 0"), "02 raw", "camera:3: expected 5 numbers of D_02 (KITTI), got 'inf'"},
    /* KITTI, odometry */
    {ODOMETRY, NULL, "camera: expected camera to be one of 0, 1, got none"},
    {ODOMETRY, "2", "camera: expected camera to be one of 0, 1, got 2"},
    {MATRIX "\n", NULL, "camera:1: expected 12 numbers of P0 (KITTI), got 11 numbers"},
    {MATRIX " 0\n" MATRIX " 0\n", NULL, "camera:2: expected each camera once, got camera 0 again"},
    /* Cityscapes */
    {CITYSCAPES, "1", "camera: expected no camera, as the file has one, got 1"},
    {"{\n\"intrinsic\": {\"fx\": 2262.5,\n", NULL, "camera:3: expected JSON of Cityscapes:"},
    {"{\"intrinsic\": {\"fx\": NaN}}\n", NULL, "camera:1: expected JSON of Cityscapes:"},
    {"{\"fx\": 1}", NULL, "camera: expected a number intrinsic.fx (Cityscapes), got none"},
    {"{\"intrinsic\": {\"fx\": 1, \"fy\": \"1\"}}", NULL,
     "camera: expected a number intrinsic.fy (Cityscapes), got something else"},
    {"{\"intrinsic\": {\"fx\": 1, \"fy\": 0, \"u0\": 1, \"v0\": 1}}", NULL,
     "camera: expected a focal length above 0 and up to 1000000 pixels, got 0"},
};

static void refuse(const char *camera, const char *said)
{
    camera_calibration got;
    static const camera_calibration none;
    error[0] = 0;
    if (camera_calibration_read(in_folder("camera"), camera, &got, error, sizeof error))
        fail_msg("taken as right, expected: %s", said);
    assert_memory_equal(&got, &none, sizeof got);
    assert_null(strchr(error, '\n'));
    if (!strstr(error, said))
        fail_msg("got: %s\nexpected: %s", error, said);
}

static void damage_is_one_line_with_its_place(void **state)
{
    (void)state;
    refuse(NULL, "camera: No such file");
    for (size_t i = 0; i < COUNT(damaged); i++) {
        put_text("camera", damaged[i].text);
        refuse(damaged[i].camera, damaged[i].said);
    }
}

static void many_cameras_and_long_lines(void **state)
{
    (void)state;
    enum { SIZE = 2 << 20 };
    char *text = malloc(SIZE);
    int length = 0;
    for (int i = 0; i < 300; i++)
        length += sprintf(text + length, "%d PINHOLE 640 480 500 510 320 240\n", i);
    put_text("camera", text);
    refuse(NULL, "camera:257: expected the end of the file, got more than 256 cameras");
    *strstr(text, "200 PINHOLE") = 0;
    put_text("camera", text);
    refuse(NULL, ", ..., got none");
    memset(text, '1', SIZE);
    put_file(in_folder("camera"), text, SIZE);
    refuse(NULL, "camera:1: expected COLMAP's cameras.txt");
    memset(text, 0, SIZE);
    put_file(in_folder("camera"), text, SIZE);
    refuse(NULL, "camera:1: expected COLMAP's cameras.txt");
    memset(text, '{', SIZE);
    put_file(in_folder("camera"), text, SIZE);
    refuse(NULL, "camera");
    free(text);
}

static void random_damage_never_crashes(void **state)
{
    (void)state;
    static const char bytes[] = "0123456789.-+eE \n\t\rnaxPKSD_:{}#\"\x00\xff";
    static const struct {
        const char *text, *camera;
    } from[] = {{COLMAP, "7"}, {RAW, "02"}, {RAW, "00 raw"}, {ODOMETRY, "1"}, {CITYSCAPES, NULL}};
    char harmed[4096];
    uint64_t seed = 1;
    int taken = 0;
    for (int i = 0; i < 200; i++) {
        const size_t size = strlen(from[i % 5].text);
        camera_calibration got;
        memcpy(harmed, from[i % 5].text, size);
        for (uint32_t k = random_bits(&seed) % 8; k < 8; k++)
            harmed[random_bits(&seed) % size] = bytes[random_bits(&seed) % (sizeof bytes - 1)];
        put_file(in_folder("camera"), harmed, i % 4 ? size : random_bits(&seed) % size);
        error[0] = 0;
        if (!camera_calibration_read(in_folder("camera"), from[i % 5].camera, &got, error, sizeof error)) {
            assert_true(error[0] && !strchr(error, '\n'));
            continue;
        }
        taken++;
        assert_true(got.focal_px[0] > 0 && got.focal_px[1] > 0 && isfinite(got.center_px[0] + got.center_px[1]));
        for (int k = 0; k < 5; k++)
            assert_true(fabs(got.distortion[k]) <= 1e3);
    }
    assert_in_range(taken, 10, 190); /* both ways were tried */
}

/* ---- in a scene ---- */

static bool load(const char *calibration, const char *override, scene_file **scene)
{
    char text[512];
    snprintf(text, sizeof text, "virga: 1\ncamera:\n  speed_m_s: 0\n  calibration: {%s}\nframes: {size: [160, 90]}\n",
             calibration);
    put_text("s.yaml", text);
    return scene_file_load(in_folder("s.yaml"), tool_effect_sections, &override, override ? 1 : 0, scene, error,
                           sizeof error);
}

static void a_scene_has_the_numbers_of_the_file(void **state)
{
    (void)state;
    scene_file *scene;
    uint32_t size[2];
    double center[2];
    put_text("k.txt", RAW);
    if (!load("file: k.txt, camera: 02 raw", NULL, &scene))
        fail_msg("%s", error);
    const distortion lens = scene_camera_distortion(scene);
    scene_camera_calibrated_size(scene, size);
    scene_camera_calibrated_center(scene, center);
    assert_true(scene_camera_is_calibrated(scene));
    assert_int_equal(size[0], 1392);
    near(center[0], 695.5);
    near(lens.k3, -0.05);
    near(scene_camera_fov_deg(scene), 2 * atan(256.0 / 950) * 180 / 3.14159265358979323846);
    const uint64_t hash = scene_file_hash(scene);
    scene_file_free(scene);
    if (!load("file: k.txt", "camera.calibration.camera=02", &scene))
        fail_msg("%s", error);
    near(scene->camera.calibration.focal_px[0], 725);
    assert_true(scene_file_hash(scene) != hash);
    scene_file_free(scene);
    put_text("k.txt", ODOMETRY); /* has no size, so frames.size it is */
    if (!load("file: k.txt, camera: 0", NULL, &scene))
        fail_msg("%s", error);
    scene_camera_calibrated_size(scene, size);
    assert_int_equal(size[0], 160);
    scene_file_free(scene);
}

static const struct {
    const char *calibration, *override, *said;
} mistakes[] = {
    {"file: k.txt", NULL, "s.yaml:4: camera.calibration.file: "},
    {"file: k.txt, camera: 05", NULL, "k.txt: expected camera to be one of 1, 2, 3, 4, 7, got 05"},
    {"file: none.txt", NULL, "camera.calibration.file: cannot read"},
    {"file: ., camera: 1", NULL, "camera.calibration.file: expected a file"},
    {"camera: 1", NULL, "s.yaml:4: camera.calibration.camera: expected it with a file"},
    {"file: k.txt, camera: 1, focal_px: [500, 500]", NULL,
     "s.yaml:4: camera.calibration.focal_px: expected it without camera.calibration.file, which has it"},
    {"file: k.txt, camera: 1, distortion: [0, 0, 0, 0, 0]", NULL, "camera.calibration.distortion: expected it without"},
    {"file: k.txt, camera: 1, size_px: [640, 480]", NULL, "camera.calibration.size_px: expected it without"},
    {"file: k.txt, camera: 1", "camera.calibration.center_px=[1, 2]",
     "--set camera.calibration.center_px=[1, 2]: camera.calibration.center_px: expected it without"},
    {"file: k.txt, camera: 1", "camera.focal_mm=50", "camera.focal_mm: expected it without camera.calibration"},
};

static void mistakes_in_a_scene(void **state)
{
    (void)state;
    put_text("k.txt", COLMAP);
    for (size_t i = 0; i < COUNT(mistakes); i++) {
        scene_file *scene;
        error[0] = 0;
        if (load(mistakes[i].calibration, mistakes[i].override, &scene))
            fail_msg("taken as right: %s", mistakes[i].said);
        assert_null(scene);
        assert_null(strchr(error, '\n'));
        if (!strstr(error, mistakes[i].said))
            fail_msg("got: %s\nexpected: %s", error, mistakes[i].said);
    }
    /* what the numbers of a file mean is checked as that of keys is */
    scene_file *scene;
    put_text("k.txt", "1 PINHOLE 640 480 3 3 320 240\n");
    assert_false(load("file: k.txt", NULL, &scene));
    assert_non_null(strstr(error, "expected an angle of view of 1 to 170 degrees"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(numbers_of_each_form, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(damage_is_one_line_with_its_place, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(many_cameras_and_long_lines, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(random_damage_never_crashes, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(a_scene_has_the_numbers_of_the_file, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(mistakes_in_a_scene, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
