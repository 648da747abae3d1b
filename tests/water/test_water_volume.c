/* The volume inside the surface of water that the solver has let settle. */
#include "../fluid/fluid_fixture.h"

#include "mesh_volume.h"

static fluid_fixture f;

/* With the density of the surface at a half, on the walls as well as on the free surface. */
static void it_is_that_of_the_particles_within_3_percent(void **state)
{
    const double d = 0.02, expected = 0.4 * 0.2 * 0.3;
    (void)state;
    fluid_fixture_open(&f);
    fluid_fixture_box(&f, d, 0.4, 0.4, 0.3);
    fluid_fixture_block(&f, 0, 0, 0, 0.4, 0.2, 0.3);
    fluid_fixture_run(&f, 30);
    const field_def def = {f.particles, f.count, d, d * d * d, 2};
    field made;
    water_mesh mesh;
    REQUIRE(field_create(&made, &def) && water_mesh_create(&mesh, &made, 0.5));
    const double share = mesh_volume(&mesh) / expected;
    printf("the surface has %.4f of the volume of %u particles\n", share, f.count);
    REQUIRE(fabs(share - 1) < 0.03);
    water_mesh_destroy(&mesh);
    field_destroy(&made);
    fluid_fixture_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_that_of_the_particles_within_3_percent)};
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
