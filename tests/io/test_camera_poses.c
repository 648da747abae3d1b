/* test_camera_poses.c - files of poses against closed forms: a circle on which the camera rolls, in every format and
 * world; damage of each kind; and 200 random ones. */
#include "check_io.h"

#include <math.h>

#include "camera_poses.h"

#define PI     3.14159265358979323846
#define RADIUS 5.0
#define HEIGHT 1.25

enum { POSES = 15 };

/* ---- what is true: a curve to the left, the first camera looks along -Z ---- */

typedef struct truth {
    double position[3], axes[3][3]; /* right, up, back */
} truth;

static void mix(const double a[3], double by_a, const double b[3], double by_b, double out[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = by_a * a[c] + by_b * b[c];
}

/* Rolled clockwise by 50 degrees a pose, through more than a turn, and pitched. */
static truth true_pose(int i, double roll_deg, double pitch_deg)
{
    const double turn = 2 * PI * i / POSES, roll = i * roll_deg * PI / 180, pitch = pitch_deg * PI / 180;
    const double right[3] = {cos(turn), 0, -sin(turn)}, up[3] = {0, 1, 0}, back[3] = {sin(turn), 0, cos(turn)};
    double tilted[3];
    truth t = {.position = {RADIUS * (cos(turn) - 1), HEIGHT, -RADIUS * sin(turn)}};
    mix(back, cos(pitch), up, -sin(pitch), t.axes[2]);
    mix(up, cos(pitch), back, sin(pitch), tilted);
    mix(right, cos(roll), tilted, -sin(roll), t.axes[0]);
    mix(right, sin(roll), tilted, cos(roll), t.axes[1]);
    return t;
}

/* ---- as a file has it ---- */

/* Rows: the axes of a file's world, seen in ours. The first is no axis at all. */
static const double worlds[][3][3] = {
    [CAMERA_POSES_UP_CAMERA] = {{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}},
    [CAMERA_POSES_UP_Y] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    [CAMERA_POSES_UP_Z] = {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    [CAMERA_POSES_UP_MINUS_Y] = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
    [CAMERA_POSES_UP_MINUS_Z] = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
};

typedef struct in_file {
    double position[3], turn[3][3]; /* camera to world: its columns are right, down, ahead */
} in_file;

static in_file seen_in(const truth *t, const double world[3][3], double scale)
{
    static const double offset[3] = {7, -3, 20};
    in_file f;
    for (int row = 0; row < 3; row++) {
        f.position[row] = offset[row];
        for (int c = 0; c < 3; c++)
            f.position[row] += world[row][c] * t->position[c] / scale;
        for (int axis = 0; axis < 3; axis++) {
            f.turn[row][axis] = 0;
            for (int c = 0; c < 3; c++)
                f.turn[row][axis] += (axis ? -1 : 1) * world[row][c] * t->axes[axis][c];
        }
    }
    return f;
}

/* x y z w. No rotation here is one by half a turn. */
static void quaternion(const double m[3][3], double q[4])
{
    q[3] = 0.5 * sqrt(fmax(0, 1 + m[0][0] + m[1][1] + m[2][2]));
    for (int i = 0; i < 3; i++) {
        const int a = (i + 1) % 3, b = (i + 2) % 3;
        q[i] = copysign(0.5 * sqrt(fmax(0, 1 + m[i][i] - m[a][a] - m[b][b])), m[b][a] - m[a][b]);
    }
}

static int put_kitti(char *text, const in_file *f)
{
    int length = 0;
    for (int row = 0; row < 3; row++)
        length += sprintf(text + length, "%.15g %.15g %.15g %.15g%s", f->turn[row][0], f->turn[row][1], f->turn[row][2],
                          f->position[row], row < 2 ? " " : "\n");
    return length;
}

static int put_tum(char *text, const in_file *f, int i)
{
    double q[4];
    quaternion(f->turn, q);
    return sprintf(text, "%.6f %.15g %.15g %.15g %.15g %.15g %.15g %.15g\n", 1305031102.25 + 0.04 * i, f->position[0],
                   f->position[1], f->position[2], q[0], q[1], q[2], q[3]);
}

/* World to camera. */
static int put_colmap(char *text, const in_file *f, int i, const char *points)
{
    double back[3][3], q[4], moved[3] = {0, 0, 0};
    for (int row = 0; row < 3; row++)
        for (int c = 0; c < 3; c++) {
            back[row][c] = f->turn[c][row];
            moved[row] -= f->turn[c][row] * f->position[c];
        }
    quaternion(back, q);
    return sprintf(text, "%d %.15g %.15g %.15g %.15g %.15g %.15g %.15g 1 street/%04d.jpg\n%s\n", i + 1, q[3], q[0],
                   q[1], q[2], moved[0], moved[1], moved[2], 10 + i, points);
}

/* Images in another order than that of their names. */
static void put_poses(const camera_poses_def *def, double roll_deg, char *text)
{
    int length = sprintf(text, "# made by a test\n\n");
    for (int i = 0; i < POSES; i++) {
        const int number = def->format == CAMERA_POSES_COLMAP ? (7 * i + 3) % POSES : i;
        const truth t = true_pose(number, roll_deg, def->up == CAMERA_POSES_UP_CAMERA ? def->pitch_deg : -20);
        const in_file f = seen_in(&t, worlds[def->up], def->scale);
        length += def->format == CAMERA_POSES_KITTI ? put_kitti(text + length, &f)
                  : def->format == CAMERA_POSES_TUM ? put_tum(text + length, &f, number)
                                                    : put_colmap(text + length, &f, number, i % 2 ? "" : "10.5 20 -1");
    }
}

static void put_text(const char *name, const char *text)
{
    put_file(in_folder(name), text, strlen(text));
}

static camera_poses_def of_format(camera_poses_format format)
{
    static char path[4096];
    snprintf(path, sizeof path, "%s", in_folder("poses.txt"));
    return (camera_poses_def){
        .file = path, .format = format, .rate_hz = 25, .scale = 1, .height_m = HEIGHT, .first_frame = 10};
}

static void near(double value, double wanted, double within)
{
    if (!(fabs(value - wanted) <= within))
        fail_msg("got %.17g, expected %.17g", value, wanted);
}

static void expect(const camera_poses_def *def, double roll_deg, double first_s)
{
    camera_pose *poses;
    uint32_t count;
    if (!camera_poses_read(def, &poses, &count, error, sizeof error))
        fail_msg("%s", error);
    assert_int_equal(count, POSES);
    for (int i = 0; i < POSES; i++) {
        const truth t = true_pose(i, roll_deg, def->up == CAMERA_POSES_UP_CAMERA ? def->pitch_deg : -20);
        near(poses[i].time_s, first_s + 0.04 * i, 1e-6);
        for (int c = 0; c < 3; c++) {
            near(poses[i].position_m[c], t.position[c], 1e-6);
            for (int axis = 0; axis < 3; axis++)
                near(poses[i].axes[axis][c], t.axes[axis][c], 1e-7);
        }
    }
    free(poses);
}

static void a_circle_in_all_formats_and_worlds(void **state)
{
    (void)state;
    char text[16384];
    for (int format = CAMERA_POSES_KITTI; format <= CAMERA_POSES_COLMAP; format++)
        for (int up = CAMERA_POSES_UP_CAMERA; up <= CAMERA_POSES_UP_MINUS_Z; up++) {
            camera_poses_def def = of_format((camera_poses_format)format);
            def.up = (camera_poses_up)up;
            def.scale = 2.5;
            def.pitch_deg = -7;
            put_poses(&def, 50, text);
            put_text("poses.txt", text);
            expect(&def, 50, 0);
        }
}

static void times_of_a_file_and_numbers_of_images(void **state)
{
    (void)state;
    char text[16384], times[4096];
    int length = 0;
    for (int i = 0; i < POSES; i++)
        length += sprintf(times + length, "%.3f\n", 100 + 0.04 * i);
    put_text("times.txt", times);
    snprintf(times, sizeof times, "%s", in_folder("times.txt"));
    for (int format = CAMERA_POSES_KITTI; format <= CAMERA_POSES_COLMAP; format += 2) {
        camera_poses_def def = of_format((camera_poses_format)format);
        put_poses(&def, 0, text);
        put_text("poses.txt", text);
        def.times = times;
        def.rate_hz = 1;
        expect(&def, 0, 0);
    }
    camera_poses_def def = of_format(CAMERA_POSES_COLMAP); /* the poses are of frames 10 to 24 */
    def.images = CAMERA_POSES_BY_NUMBER;
    expect(&def, 0, 0);
    def.first_frame = 5;
    expect(&def, 0, 0.2);
}

/* ---- damage ---- */

#define LEVEL  "1 0 0 0 0 1 0 0 0 0 1 0"
#define SQUARE "0 0 0 0 0 0 1"

static const struct {
    camera_poses_format format;
    const char *text, *said;
} damaged[] = {
    {CAMERA_POSES_KITTI, "", "poses.txt: expected at least one pose, got none"},
    {CAMERA_POSES_KITTI, "# nothing\n\n", "poses.txt: expected at least one pose, got none"},
    {CAMERA_POSES_KITTI, LEVEL "\nhello\n", "poses.txt:2: expected 12 numbers of a pose (KITTI), got 'hello'"},
    {CAMERA_POSES_KITTI, "1 0 0 0 0 1 0 0 0 0 1\n",
     "poses.txt:1: expected 12 numbers of a pose (KITTI), got 11 numbers"},
    {CAMERA_POSES_KITTI, LEVEL " 7\n", "poses.txt:1: expected 12 numbers of a pose (KITTI), got more"},
    {CAMERA_POSES_KITTI, "1 0 0 nan 0 1 0 0 0 0 1 0", "poses.txt:1: expected 12 numbers of a pose (KITTI), got 'nan'"},
    {CAMERA_POSES_KITTI, "1 0 0 1e999 0 1 0 0 0 0 1 0", "got '1e999'"},
    {CAMERA_POSES_KITTI, "1 0 0 5m 0 1 0 0 0 0 1 0", "got '5m'"},
    {CAMERA_POSES_KITTI, LEVEL "\n2 0 0 0 0 1 0 0 0 0 1 0", "poses.txt:2: expected a rotation in the first 3 columns"},
    {CAMERA_POSES_KITTI, "-1 0 0 0 0 1 0 0 0 0 1 0", "poses.txt:1: expected a rotation in the first 3 columns"},
    {CAMERA_POSES_KITTI, LEVEL "\n1 0 0 1e9 0 1 0 0 0 0 1 0", "poses.txt:2: expected a pose less than 1000 km"},
    {CAMERA_POSES_TUM, "1 0 0 0 0 0 0 0.5\n", "poses.txt:1: expected a quaternion of length 1, got one of length 0.5"},
    {CAMERA_POSES_TUM, "1 " SQUARE "\n1 " SQUARE "\n", "poses.txt:2: expected a time after the one before, got 1"},
    {CAMERA_POSES_TUM, "1 " SQUARE "\n# a\n0.5 " SQUARE, "poses.txt:3: expected a time after the one before, got 0.5"},
    {CAMERA_POSES_TUM, "1 2 3\n", "poses.txt:1: expected 8 numbers: time, position, quaternion (TUM), got 3 numbers"},
    {CAMERA_POSES_COLMAP, "1 1 0 0 0 0 0 0 1\n",
     "poses.txt:1: expected an image: 9 numbers and a name (COLMAP's "
     "images.txt), got no name"},
    {CAMERA_POSES_COLMAP, "1 0 0 0 0 0 0 0 1 a.png\n\n", "poses.txt:1: expected a quaternion of length 1"},
    {CAMERA_POSES_COLMAP, "1 1 0 0 0 0 0 0 1 a.png\n2 1 0 0 0 0 0 0 1 b.png\n",
     "poses.txt:2: expected the points of the image before (the line may be empty), got an image"},
    {CAMERA_POSES_COLMAP, "1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 0 0 0 1 a.png\n\n",
     "poses.txt:3: expected each frame once, got a.png"},
};

static void refuse(const camera_poses_def *def, const char *said)
{
    camera_pose *poses;
    uint32_t count;
    error[0] = 0;
    if (camera_poses_read(def, &poses, &count, error, sizeof error))
        fail_msg("taken as right, expected: %s", said);
    assert_null(poses);
    assert_null(strchr(error, '\n'));
    if (!strstr(error, said))
        fail_msg("got: %s\nexpected: %s", error, said);
}

static void damage_is_one_line_with_its_place(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof damaged / sizeof damaged[0]; i++) {
        const camera_poses_def def = of_format(damaged[i].format);
        put_text("poses.txt", damaged[i].text);
        refuse(&def, damaged[i].said);
    }
    camera_poses_def def = of_format(CAMERA_POSES_COLMAP);
    def.images = CAMERA_POSES_BY_NUMBER;
    put_text("poses.txt", "1 1 0 0 0 0 0 0 1 left.png\n\n");
    refuse(&def, "poses.txt:1: expected a number up to 1000000 in the image's name, got left.png");
    put_text("poses.txt", "1 1 0 0 0 0 0 0 1 a7.png\n\n1 1 0 0 0 0 0 0 1 b07.png\n\n");
    refuse(&def, "expected each frame once, got");
    def.file = "/none/poses.txt";
    refuse(&def, "cannot read /none/poses.txt: No such file");
}

static void damaged_times(void **state)
{
    (void)state;
    char path[4096];
    camera_poses_def def = of_format(CAMERA_POSES_KITTI);
    put_text("poses.txt", LEVEL "\n" LEVEL "\n");
    snprintf(path, sizeof path, "%s", in_folder("times.txt"));
    def.times = path;
    put_text("times.txt", "0\n");
    refuse(&def, "times.txt: expected 2 times, one for each pose, got 1");
    put_text("times.txt", "0\n1\n2\n");
    refuse(&def, "times.txt:3: expected the end of the file, got more than 2 times, one for each pose");
    put_text("times.txt", "0\n0\n");
    refuse(&def, "times.txt:2: expected a time after the one before, got 0");
    put_text("times.txt", "0\nsoon\n");
    refuse(&def, "times.txt:2: expected a time in seconds, got 'soon'");
}

static void millions_of_lines_and_long_ones(void **state)
{
    (void)state;
    enum { SIZE = 4 << 20 };
    const size_t length = sizeof LEVEL; /* its 0 becomes the end of the line */
    char *text = malloc(SIZE);
    camera_poses_def def = of_format(CAMERA_POSES_KITTI);
    for (size_t at = 0; at + length <= SIZE; at += length) {
        memcpy(text + at, LEVEL, length);
        text[at + length - 1] = '\n';
    }
    put_file(in_folder("poses.txt"), text, SIZE / length * length);
    refuse(&def, "poses.txt:100001: expected the end of the file, got more than 100000 poses");
    memset(text, '1', SIZE);
    put_file(in_folder("poses.txt"), text, SIZE);
    refuse(&def, "poses.txt:1: expected 12 numbers");
    memset(text, 0, SIZE);
    put_file(in_folder("poses.txt"), text, SIZE);
    refuse(&def, "poses.txt:1: expected 12 numbers");
    def.format = CAMERA_POSES_COLMAP;
    memset(text, '\n', SIZE);
    put_file(in_folder("poses.txt"), text, SIZE);
    refuse(&def, "poses.txt: expected at least one pose, got none");
    free(text);
}

static void random_damage_never_crashes(void **state)
{
    (void)state;
    static const char bytes[] = "0123456789.-+eE \n\t\rnax#\"\x00\xff";
    char text[16384] = "", harmed[16384];
    uint64_t seed = 1;
    for (int i = 0; i < 200; i++) {
        camera_poses_def def = of_format((camera_poses_format)(i % 3));
        camera_pose *poses;
        uint32_t count;
        put_poses(&def, 10, text);
        const size_t size = strlen(text);
        memcpy(harmed, text, sizeof harmed);
        for (uint32_t k = random_bits(&seed) % 8; k < 8; k++)
            harmed[random_bits(&seed) % size] = bytes[random_bits(&seed) % (sizeof bytes - 1)];
        put_file(in_folder("poses.txt"), harmed, i % 4 ? size : random_bits(&seed) % size);
        def.images = (camera_poses_images)(i % 2);
        error[0] = 0;
        if (!camera_poses_read(&def, &poses, &count, error, sizeof error)) {
            assert_true(error[0] && !strchr(error, '\n'));
            continue;
        }
        for (uint32_t p = 0; p < count; p++)
            assert_true(isfinite(poses[p].time_s + poses[p].position_m[0] + poses[p].axes[2][2]));
        free(poses);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_circle_in_all_formats_and_worlds, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(times_of_a_file_and_numbers_of_images, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(damage_is_one_line_with_its_place, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(damaged_times, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(millions_of_lines_and_long_ones, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(random_damage_never_crashes, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
