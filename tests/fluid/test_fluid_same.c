/* The solver's bits: water that falls on a body that floats, with any number of threads, in any vector width, and with
 * both variants of passes. */
#include "body_fixture.h"

#include "../host/same_runs.h"

static void collapse(same_bits *bits)
{
    const box_mesh box = box_of(0.16, 0.16, 0.16);
    fluid_fixture f;
    body_fixture_open(&f);
    fluid_fixture_box(&f, 0.04, 0.8, 0.8, 0.6);
    fluid_fixture_block(&f, 0, 0, 0, 0.4, 0.4, 0.6);
    virga_fluid_body body = body_of(&box, 0.7, 0.6, 0.2, 0.29);
    body.rotation[0] = 0.3f;
    body.rotation[3] = 1;
    body_fixture_add(&f, &body);
    fluid_fixture_run(&f, 12);
    fluid_fixture_block(&f, 0.4, 0.6, 0.1, 0.6, 0.8, 0.3);
    fluid_fixture_run(&f, 12);
    const virga_fluid_pose pose = pose_of(&f, 0);
    assert_int_equal(f.count, 1500 + 125);
    same_add(bits, "particles", f.particles, f.count * sizeof *f.particles);
    same_add(bits, "pressures", f.pressures, f.count * sizeof *f.pressures);
    same_add(bits, "body", &pose, sizeof pose);
    fluid_fixture_close(&f);
}

static void threads_and_variants_change_no_bit(void **state)
{
    (void)state;
    same_for_threads_and_variants(collapse);
}

static void vector_widths_change_no_bit(void **state)
{
    (void)state;
    same_in_widths(SAME_CACHES, collapse);
}

int main(int argc, char **argv)
{
    int code;
    if (same_runs_child(argc, argv, collapse, &code))
        return code;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_and_variants_change_no_bit),
        cmocka_unit_test(vector_widths_change_no_bit),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
