/* test_particle_spacing.c - the spacing that is guessed from positions, on sets whose spacing is known. */
#include "../host/test_particles.h"
#include "check_io.h"
#include "particle_spacing.h"

#include <math.h>

static particles make_lattice(uint32_t side, float spacing, float jitter)
{
    particles made = {.count = side * side * side};
    uint64_t random = 7;
    made.position = malloc(made.count * sizeof *made.position);
    assert_non_null(made.position);
    for (uint32_t i = 0; i < made.count; i++) {
        const uint32_t at[3] = {i % side, i / side % side, i / side / side};
        for (int axis = 0; axis < 3; axis++)
            made.position[i][axis] =
                spacing * ((float)at[axis] + jitter * (2 * (float)(random_bits(&random) & 0xffff) / 65535 - 1));
    }
    return made;
}

static void assert_spacing(const particles *frame, double expected, double within)
{
    particle_spacing guess;
    if (!particle_spacing_guess(frame, &guess))
        fail_msg("no guess, expected %g", expected);
    if (fabs(guess.spacing / expected - 1) > within)
        fail_msg("guessed %g, expected %g within %g %%", guess.spacing, expected, 100 * within);
}

static void a_lattice_has_its_spacing(void **state)
{
    (void)state;
    static const float spacings[] = {1e-4f, 0.025f, 1, 300};
    for (size_t i = 0; i < COUNT(spacings); i++) {
        particles frame = make_lattice(20, spacings[i], 0);
        assert_spacing(&frame, (double)spacings[i], 0.01);
        particles_free(&frame);
    }
}

static void a_jittered_set_has_that_of_its_lattice(void **state)
{
    (void)state;
    static const float jitters[] = {0.1f, 0.25f, 0.4f};
    for (size_t i = 0; i < COUNT(jitters); i++) {
        particles frame = make_lattice(24, 0.02f, jitters[i]);
        assert_spacing(&frame, 0.02, 0.04);
        particles_free(&frame);
    }
}

static void what_flew_off_or_is_no_number_does_not_count(void **state)
{
    (void)state;
    particles frame = make_lattice(20, 0.025f, 0.1f);
    frame.position[5][0] = 1e20f;
    frame.position[6][1] = -3e6f;
    frame.position[7][2] = NAN;
    frame.position[8][2] = INFINITY;
    assert_spacing(&frame, 0.025, 0.03);
    particles_free(&frame);
}

static void too_few_particles_give_no_guess(void **state)
{
    (void)state;
    particle_spacing guess;
    particles frame = make_lattice(10, 0.025f, 0);
    for (frame.count = 0; frame.count < 64; frame.count++)
        assert_false(particle_spacing_guess(&frame, &guess));
    frame.count = 1000;
    memset(frame.position, 0, 1000 * sizeof *frame.position);
    assert_false(particle_spacing_guess(&frame, &guess));
    for (uint32_t i = 0; i < 1000; i++)
        frame.position[i][i % 3] = NAN;
    assert_false(particle_spacing_guess(&frame, &guess));
    particles_free(&frame);
}

static void bounds_leave_out_what_is_no_number(void **state)
{
    (void)state;
    float low[3], high[3];
    uint32_t invalid;
    particles frame = make_lattice(3, 1, 0);
    frame.position[0][0] = NAN;
    frame.position[26][1] = INFINITY;
    assert_true(particles_bounds(&frame, low, high, &invalid));
    assert_int_equal(invalid, 2);
    assert_true(low[0] == 0 && low[1] == 0 && low[2] == 0 && high[0] == 2 && high[1] == 2 && high[2] == 2);
    frame.count = 1;
    assert_false(particles_bounds(&frame, low, high, &invalid));
    assert_int_equal(invalid, 1);
    particles_free(&frame);
}

/* Files of another program; they are not part of the project. It gives particles a volume of 0.8 d^3, so those inside
 * settled water are 0.8^(1/3) d apart. */
static void settled_water_of_splishsplash_has_its_volume(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double spacing;
    } frames[] = {{"dam_break_0000.ply", 0.025}, {"dam_break_0060.ply", 0.0232}, {"dam_break_0120.ply", 0.0232}};
    for (size_t i = 0; i < COUNT(frames); i++) {
        particles frame;
        if (!test_particles_have(frames[i].name))
            skip();
        assert_true(particles_read(test_particles_path(frames[i].name), &frame, error, sizeof error));
        assert_spacing(&frame, frames[i].spacing, 0.02);
        particles_free(&frame);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST_IN_FOLDER(a_lattice_has_its_spacing),
        TEST_IN_FOLDER(a_jittered_set_has_that_of_its_lattice),
        TEST_IN_FOLDER(what_flew_off_or_is_no_number_does_not_count),
        TEST_IN_FOLDER(too_few_particles_give_no_guess),
        TEST_IN_FOLDER(bounds_leave_out_what_is_no_number),
        TEST_IN_FOLDER(settled_water_of_splishsplash_has_its_volume),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
