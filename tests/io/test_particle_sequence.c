/* test_particle_sequence.c - particles between files: curves, fading, and files that are missing. */
#include "check_io.h"
#include "particle_sequence.h"
#include "ply.h"

#include <math.h>

typedef struct row {
    float position[3], velocity[3];
    uint32_t id;
} row;

static const ply_property columns[] = {
    {"id", PLY_UINT, offsetof(row, id)},
    {"x", PLY_FLOAT, offsetof(row, position)},
    {"y", PLY_FLOAT, offsetof(row, position) + 4},
    {"z", PLY_FLOAT, offsetof(row, position) + 8},
    {"vx", PLY_FLOAT, offsetof(row, velocity)},
    {"vy", PLY_FLOAT, offsetof(row, velocity) + 4},
    {"vz", PLY_FLOAT, offsetof(row, velocity) + 8},
};

enum { WITH_ID = 1, WITH_VELOCITY = 2 };

static void put_frame(uint32_t number, const row *rows, uint32_t count, int with)
{
    char name[32];
    const bool ids = with & WITH_ID;
    snprintf(name, sizeof name, "p_%04u.ply", number);
    if (!ply_write(in_folder(name), columns + !ids, ids + 3u + (with & WITH_VELOCITY ? 3 : 0), rows, sizeof *rows,
                   count, NULL, error, sizeof error))
        fail_msg("%s", error);
}

static particle_sequence *open_with(particle_sequence_def def)
{
    particle_sequence *opened;
    def.files = in_folder("p_%04d.ply");
    if (!particle_sequence_open(&opened, &def, error, sizeof error))
        fail_msg("%s", error);
    return opened;
}

/* 10 numbers a second, from the smallest on. */
static const particle_sequence_def plain = {.rate_hz = 10, .step = 1, .first = -1};

static const particle_sample *sample(particle_sequence *sequence, double time_s, uint32_t *count)
{
    const particle_sample *samples;
    if (!particle_sequence_at(sequence, time_s, &samples, count, error, sizeof error))
        fail_msg("%s", error);
    return samples;
}

/* ---- curves */

#define RADIUS 0.5
#define OMEGA  3.0

static void orbit(uint32_t id, double time_s, row *out)
{
    const double angle = OMEGA * time_s + id;
    *out = (row){{(float)(RADIUS * cos(angle)), (float)(RADIUS * sin(angle)), (float)(0.25 * time_s)},
                 {(float)(-RADIUS * OMEGA * sin(angle)), (float)(RADIUS * OMEGA * cos(angle)), 0.25f},
                 id};
}

/* A Hermite curve is off by h^4 / 384 times the fourth derivative, which is R omega^4; floats add 1e-7. */
static void an_orbit_is_followed_by_id(void **state)
{
    (void)state;
    enum { COUNT_OF = 50, FRAMES = 8 };
    const double h = 0.1, epsilon = RADIUS * pow(OMEGA * h, 4) / 384 + 3e-7, speed_epsilon = 0.01;
    for (uint32_t f = 0; f < FRAMES; f++) {
        row rows[COUNT_OF];
        for (uint32_t i = 0; i < COUNT_OF; i++)
            orbit((i * 7 + f * 13) % COUNT_OF, f * h, &rows[i]); /* in another order in each file */
        put_frame(20 + f, rows, COUNT_OF, WITH_ID | WITH_VELOCITY);
    }
    particle_sequence *sequence = open_with(plain);
    double worst = 0;
    for (double t = 0; t <= (FRAMES - 1) * h; t += 0.0137) {
        uint32_t count;
        const particle_sample *samples = sample(sequence, t, &count);
        assert_int_equal(count, COUNT_OF);
        for (uint32_t i = 0; i < count; i++) {
            row exact;
            orbit(samples[i].id, t, &exact);
            assert_true(samples[i].share == 1);
            for (int axis = 0; axis < 3; axis++) {
                worst = fmax(worst, fabs((double)samples[i].position[axis] - (double)exact.position[axis]));
                assert_true(fabs((double)samples[i].velocity[axis] - (double)exact.velocity[axis]) < speed_epsilon);
            }
        }
    }
    if (worst > epsilon)
        fail_msg("off by %g m, expected at most %g m", worst, epsilon);
    particle_sequence_close(sequence);
}

static void rows_are_ids_if_so_requested(void **state)
{
    (void)state;
    const row a = {{0, 0, 0}, {1, 0, 0}, 0}, b = {{0.1f, 0, 0}, {1, 0, 0}, 0};
    put_frame(0, &a, 1, WITH_VELOCITY);
    put_frame(1, &b, 1, WITH_VELOCITY);
    particle_sequence_def rows = plain;
    rows.ids = PARTICLE_IDS_ROWS;
    particle_sequence *sequence = open_with(rows);
    uint32_t count;
    const particle_sample *samples = sample(sequence, 0.05, &count);
    assert_int_equal(count, 1);
    assert_true(samples[0].share == 1 && fabsf(samples[0].position[0] - 0.05f) < 1e-7f);
    particle_sequence_close(sequence);
}

static void without_velocities_the_path_is_a_line(void **state)
{
    (void)state;
    const row a = {{0, 1, 0}, {0}, 5}, b = {{0.2f, 3, 0}, {0}, 5};
    put_frame(0, &a, 1, WITH_ID);
    put_frame(1, &b, 1, WITH_ID);
    particle_sequence *sequence = open_with(plain);
    uint32_t count;
    const particle_sample *samples = sample(sequence, 0.025, &count);
    assert_int_equal(count, 1);
    assert_int_equal(samples[0].id, 5);
    assert_true(fabsf(samples[0].position[0] - 0.05f) < 1e-6f && fabsf(samples[0].position[1] - 1.5f) < 1e-6f);
    assert_true(fabsf(samples[0].velocity[0] - 2) < 1e-5f && fabsf(samples[0].velocity[1] - 20) < 1e-4f);
    particle_sequence_close(sequence);
}

/* ---- fading */

static double sum_of_shares(const particle_sample *samples, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += (double)samples[i].share;
    return sum;
}

/* Each file's particles go on along their own velocities, with shares of 1 - w and w: w = 3 s^2 - 2 s^3. Here the
 * velocities do not lead from one file to the other, so the two sets stay apart. */
static void without_ids_both_files_fade_and_move_by_their_velocities(void **state)
{
    (void)state;
    enum { COUNT_OF = 10 };
    const double h = 0.1;
    row files[2][COUNT_OF];
    for (uint32_t i = 0; i < COUNT_OF; i++) {
        const float n = 0.1f * (float)i;
        files[0][i] = (row){{n, 0, -n}, {1 + n, -2, 3 * n}, 0};
        files[1][COUNT_OF - 1 - i] = (row){{n, -0.5f, n}, {-2, n - 1, 4}, 0};
    }
    put_frame(0, files[0], COUNT_OF, WITH_VELOCITY);
    put_frame(1, files[1], COUNT_OF, WITH_VELOCITY);
    particle_sequence *sequence = open_with(plain);
    for (int step = 0; step < 10; step++) {
        uint32_t count;
        const double s = 0.1 * step, faded = s * s * (3 - 2 * s);
        const particle_sample *samples = sample(sequence, s * h, &count);
        assert_int_equal(count, step ? 2 * COUNT_OF : COUNT_OF);
        assert_true(fabs(sum_of_shares(samples, count) - COUNT_OF) < 1e-5);
        for (uint32_t i = 0; i < count; i++) {
            const bool second = i >= COUNT_OF;
            const row *from = &files[second][i % COUNT_OF];
            const double dt = second ? (s - 1) * h : s * h;
            assert_true(fabs((double)samples[i].share - (second ? faded : 1 - faded)) < 1e-6);
            for (int axis = 0; axis < 3; axis++) {
                const double v = (double)from->velocity[axis];
                assert_true(fabs((double)samples[i].position[axis] - ((double)from->position[axis] + v * dt)) < 1e-6);
                assert_true((double)samples[i].velocity[axis] == v);
            }
        }
    }
    particle_sequence_close(sequence);
}

/* Particle 1 is in all files, 2 only in the middle one. */
static void particles_appear_and_vanish_without_a_jump(void **state)
{
    (void)state;
    const row only = {{0, 0, 0}, {0, 0, 0}, 1};
    const row both[2] = {only, {{1, 0, 0}, {2, 0, 0}, 2}};
    put_frame(0, &only, 1, WITH_ID | WITH_VELOCITY);
    put_frame(1, both, 2, WITH_ID | WITH_VELOCITY);
    put_frame(2, &only, 1, WITH_ID | WITH_VELOCITY);
    particle_sequence *sequence = open_with(plain);
    const double dt = 0.0005, steepest = 1.5 / 0.1; /* of 3 s^2 - 2 s^3 */
    double before = 0;
    for (double t = 0; t < 0.25; t += dt) {
        uint32_t count;
        const particle_sample *samples = sample(sequence, t, &count);
        double share = 0;
        assert_true(samples[0].id == 1 && samples[0].share == 1);
        if (count > 1) {
            assert_int_equal(samples[1].id, 2);
            share = (double)samples[1].share;
            assert_true(fabs((double)samples[1].position[0] - (1 + 2 * (t - 0.1))) < 1e-6);
        }
        assert_true(fabs(share - before) <= steepest * dt * 1.01);
        if (fabs(t - 0.1) < dt / 2)
            assert_true(share > 0.999);
        before = share;
    }
    assert_true(before == 0);
    particle_sequence_close(sequence);
}

/* What a particle's share should be: what has appeared less what has vanished, each along 3 s^2 - 2 s^3 over the time
 * of fading around the middle between two files. */
static double faded_share(double time_s, double appears_s, double vanishes_s, double fade_s)
{
    const double in = fmin(fmax((time_s - appears_s) / fade_s + 0.5, 0), 1);
    const double out = fmin(fmax((time_s - vanishes_s) / fade_s + 0.5, 0), 1);
    return in * in * (3 - 2 * in) * (1 - out * out * (3 - 2 * out));
}

/* Particle 1 is in all files, 2 in the files 4 to 7, 10 files a second; times in any order. */
static void a_fade_may_be_longer_than_the_time_between_files(void **state)
{
    (void)state;
    const double fade_s = 0.45;
    particle_sequence_def def = plain;
    for (uint32_t i = 0; i < 12; i++) {
        const row both[2] = {{{0}, {0}, 1}, {{0.2f * (float)i, 0, 0}, {2, 0, 0}, 2}};
        put_frame(i, both, i >= 4 && i <= 7 ? 2 : 1, WITH_ID | WITH_VELOCITY);
    }
    def.fade_s = fade_s;
    particle_sequence *sequence = open_with(def);
    for (int step = 0; step < 110; step++) {
        const double t = 0.01 * (step * 37 % 110), expected = faded_share(t, 0.35, 0.75, fade_s);
        uint32_t count;
        const particle_sample *samples = sample(sequence, t, &count);
        assert_int_equal(count, expected > 0 ? 2 : 1);
        assert_true(samples[0].id == 1 && samples[0].share == 1);
        if (count > 1) {
            assert_true(samples[1].id == 2 && fabs((double)samples[1].share - expected) < 1e-6);
            assert_true(fabs((double)samples[1].position[0] - 2 * t) < 1e-5);
        }
    }
    particle_sequence_close(sequence);
}

/* It is gone for one file of many, so it never vanishes, and nobody is there twice. */
static void a_particle_that_is_missing_for_a_file_fades_a_little(void **state)
{
    (void)state;
    particle_sequence_def def = plain;
    for (uint32_t i = 0; i < 9; i++) {
        const row one = {{0.1f * (float)i, 0, 0}, {1, 0, 0}, 5};
        put_frame(i, &one, i != 4, WITH_ID | WITH_VELOCITY);
    }
    def.fade_s = 0.6;
    particle_sequence *sequence = open_with(def);
    for (double t = 0; t <= 0.8; t += 0.02) {
        uint32_t count;
        const particle_sample *samples = sample(sequence, t, &count);
        const double out = faded_share(t, -9, 0.35, 0.6), in = faded_share(t, 0.45, 9, 0.6);
        assert_int_equal(count, 1);
        assert_true(fabs((double)samples[0].share - fmin(in + out, 1)) < 1e-6 && samples[0].share > 0.6f);
        assert_true(fabs((double)samples[0].position[0] - t) < 1e-5);
    }
    particle_sequence_close(sequence);
}

static void a_particle_without_a_position_fades_like_one_that_vanished(void **state)
{
    (void)state;
    const row a[2] = {{{0, 0, 0}, {1, 0, 0}, 1}, {{NAN, 0, 0}, {0}, 2}};
    const row b[2] = {{{0, INFINITY, 0}, {0}, 1}, {{3, 0, 0}, {NAN, 0, 0}, 2}};
    put_frame(0, a, 2, WITH_ID | WITH_VELOCITY);
    put_frame(1, b, 2, WITH_ID | WITH_VELOCITY);
    particle_sequence *sequence = open_with(plain);
    uint32_t count;
    const particle_sample *samples = sample(sequence, 0.05, &count);
    assert_int_equal(count, 2);
    assert_true(samples[0].id == 1 && samples[0].share == 0.5f && samples[0].position[0] == 0.05f);
    assert_true(samples[1].id == 2 && samples[1].share == 0.5f && samples[1].position[0] == 3);
    sample(sequence, 0, &count);
    assert_int_equal(count, 1);
    particle_sequence_close(sequence);
}

static void files_may_have_no_particles(void **state)
{
    (void)state;
    const row one = {{0, 0, 0}, {1, 0, 0}, 1};
    put_frame(0, NULL, 0, WITH_ID | WITH_VELOCITY);
    put_frame(1, &one, 1, WITH_ID | WITH_VELOCITY);
    put_frame(2, NULL, 0, WITH_ID | WITH_VELOCITY);
    particle_sequence *sequence = open_with(plain);
    static const uint32_t expected[] = {0, 1, 1, 1, 0};
    for (uint32_t i = 0; i < COUNT(expected); i++) {
        uint32_t count;
        sample(sequence, 0.05 * i, &count);
        assert_int_equal(count, expected[i]);
    }
    particle_sequence_close(sequence);
}

/* ---- which files */

static void outside_the_files_particles_stand_still(void **state)
{
    (void)state;
    const row a = {{0, 0, 0}, {1, 0, 0}, 1}, b = {{0.1f, 0, 0}, {1, 0, 0}, 1};
    put_frame(5, &a, 1, WITH_ID | WITH_VELOCITY);
    put_frame(6, &b, 1, WITH_ID | WITH_VELOCITY);
    particle_sequence *sequence = open_with(plain);
    uint32_t count;
    assert_true(fabs(particle_sequence_duration(sequence) - 0.1) < 1e-12);
    const particle_sample *samples = sample(sequence, -3, &count);
    assert_true(samples[0].position[0] == 0 && samples[0].velocity[0] == 0 && samples[0].share == 1);
    samples = sample(sequence, 1e9, &count);
    assert_true(samples[0].position[0] == 0.1f && samples[0].velocity[0] == 0 && samples[0].share == 1);
    particle_sequence_close(sequence);
}

static void steps_leave_out_numbers_between_them(void **state)
{
    (void)state;
    const row rows[] = {{{0, 0, 0}, {0}, 1}, {{9, 0, 0}, {0}, 1}, {{2, 0, 0}, {0}, 1}};
    put_frame(10, &rows[0], 1, WITH_ID);
    put_frame(15, &rows[1], 1, WITH_ID);
    put_frame(20, &rows[2], 1, WITH_ID);
    particle_sequence_def def = plain;
    def.step = 10;
    particle_sequence *sequence = open_with(def);
    uint32_t count;
    const particle_sample *samples = sample(sequence, 0.5, &count);
    assert_int_equal(particle_sequence_length(sequence), 2);
    assert_true(samples[0].position[0] == 1);
    particle_sequence_close(sequence);
}

static void one_file_is_for_all_times(void **state)
{
    (void)state;
    const row one = {{4, 0, 0}, {1, 0, 0}, 1};
    particle_sequence *sequence;
    particle_sequence_def def = plain;
    put_frame(3, &one, 1, WITH_VELOCITY);
    def.files = in_folder("p_0003.ply");
    assert_true(particle_sequence_open(&sequence, &def, error, sizeof error));
    for (double t = -1; t < 2; t++) {
        uint32_t count;
        const particle_sample *samples = sample(sequence, t, &count);
        assert_true(count == 1 && samples[0].position[0] == 4 && samples[0].velocity[0] == 0);
    }
    particle_sequence_close(sequence);
}

static void assert_not_opened(const char *files, int64_t first, uint32_t step, const char *one, const char *other)
{
    particle_sequence *sequence;
    particle_sequence_def def = plain;
    def.files = in_folder(files);
    def.first = first;
    def.step = step;
    assert_false(particle_sequence_open(&sequence, &def, error, sizeof error));
    assert_null(sequence);
    assert_error(one, other);
}

static void missing_files_are_one_line(void **state)
{
    (void)state;
    const row one = {{0, 0, 0}, {1, 0, 0}, 1};
    static const uint32_t numbers[] = {0, 1, 2, 4, 8};
    for (size_t i = 0; i < COUNT(numbers); i++)
        put_frame(numbers[i], &one, 1, WITH_ID);
    assert_not_opened("p_%04d.ply", -1, 1, "p_0003.ply is missing", "expected the numbers 0 to 8 in steps of 1");
    assert_not_opened("p_%04d.ply", 3, 1, "p_0003.ply is missing", "3 to 8");
    assert_not_opened("p_%04d.ply", 9, 1, "p_0009.ply is missing", "9 to 8");
    assert_not_opened("p_%04d.ply", 2, 2, "p_0006.ply is missing", "steps of 2");
    assert_not_opened("q_%04d.ply", -1, 1, "q_%04d.ply", "no file has such a name");
    assert_not_opened("p_%d.ply", -1, 1, "p_%d.ply", "no file has such a name");
    assert_not_opened("none/p_%d.ply", -1, 1, "none", "No such file");
    assert_not_opened("p_%s.ply", -1, 1, "p_%s.ply", "expected one number like %04d");
    assert_not_opened("p_%04d_%04d.ply", -1, 1, "p_%04d", "expected one number");
    assert_not_opened("p%", -1, 1, "p%", "expected one number");
    assert_not_opened("p_%04d.ply", -1, 0, "steps of 0", "expected more than 0");
}

static void an_id_that_is_there_twice_is_one_line(void **state)
{
    (void)state;
    const row rows[3] = {{{0}, {0}, 7}, {{0}, {0}, 8}, {{0}, {0}, 7}};
    put_frame(0, rows, 2, WITH_ID);
    put_frame(1, rows, 3, WITH_ID);
    particle_sequence *sequence = open_with(plain);
    const particle_sample *samples;
    uint32_t count;
    assert_false(particle_sequence_at(sequence, 0.05, &samples, &count, error, sizeof error));
    assert_error("p_0001.ply", "particle 2 has the id 7");
    particle_sequence_close(sequence);
}

static void a_damaged_file_is_one_line_when_its_time_comes(void **state)
{
    (void)state;
    const row one = {{0, 0, 0}, {1, 0, 0}, 1};
    put_frame(0, &one, 1, WITH_ID);
    put_frame(1, &one, 1, WITH_ID);
    put_file(in_folder("p_0002.ply"), "ply\n", 4);
    particle_sequence *sequence = open_with(plain);
    const particle_sample *samples;
    uint32_t count;
    sample(sequence, 0.05, &count);
    assert_false(particle_sequence_at(sequence, 0.15, &samples, &count, error, sizeof error));
    assert_error("p_0002.ply", "line 2");
    sample(sequence, 0.05, &count); /* and goes on */
    assert_int_equal(count, 1);
    particle_sequence_close(sequence);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(an_orbit_is_followed_by_id),
        TEST_IN_FOLDER(rows_are_ids_if_so_requested),
        TEST_IN_FOLDER(without_velocities_the_path_is_a_line),
        TEST_IN_FOLDER(without_ids_both_files_fade_and_move_by_their_velocities),
        TEST_IN_FOLDER(particles_appear_and_vanish_without_a_jump),
        TEST_IN_FOLDER(a_fade_may_be_longer_than_the_time_between_files),
        TEST_IN_FOLDER(a_particle_that_is_missing_for_a_file_fades_a_little),
        TEST_IN_FOLDER(a_particle_without_a_position_fades_like_one_that_vanished),
        TEST_IN_FOLDER(files_may_have_no_particles),
        TEST_IN_FOLDER(outside_the_files_particles_stand_still),
        TEST_IN_FOLDER(steps_leave_out_numbers_between_them),
        TEST_IN_FOLDER(one_file_is_for_all_times),
        TEST_IN_FOLDER(missing_files_are_one_line),
        TEST_IN_FOLDER(an_id_that_is_there_twice_is_one_line),
        TEST_IN_FOLDER(a_damaged_file_is_one_line_when_its_time_comes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
