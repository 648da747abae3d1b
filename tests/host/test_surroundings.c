/* test_surroundings.c - light around a place against closed forms: the open, a box, a floor, a panel. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>

#include "plate_fixture.h"

#define SKY 1.0f /* radiance from all around */

static const float glow[3] = {20, 40, 60}; /* radiance of what stands there; its surface reflects 1 % of the sky's */
static const double place[3] = {3, 2, -5};

typedef struct scene {
    fixture base;
    host_renderer *renderer;
    host_environment environment;
    host_surroundings surroundings;
    host_mesh mesh[2];
    uint32_t count;
} scene;

static void begin(scene *s, float zenith, float ground)
{
    memset(s, 0, sizeof *s);
    if (!fixture_begin(&s->base))
        skip();
    const host_environment_def sky = {.zenith = {zenith, zenith, zenith},
                                      .horizon = {SKY, SKY, SKY},
                                      .ground = {ground, ground, ground},
                                      .intensity = 1};
    char *error = s->base.error;
    const size_t size = sizeof s->base.error;
    if (!host_renderer_create(&s->base.device, &s->renderer, error, size) ||
        !host_environment_create(&s->base.device, &sky, &s->environment, error, size) ||
        !host_renderer_set_environment(s->renderer, &s->environment, error, size) ||
        !host_surroundings_create(&s->base.device, &s->surroundings, error, size))
        fail_msg("%s", error);
}

static void end(scene *s)
{
    host_surroundings_destroy(&s->base.device, &s->surroundings);
    host_renderer_destroy(&s->renderer);
    for (uint32_t i = 0; i < s->count; i++)
        host_mesh_destroy(&s->base.device, &s->mesh[i]);
    host_environment_destroy(&s->base.device, &s->environment);
    assert_int_equal(fixture_end(&s->base), 0);
}

/* A box that glows on both of its sides. */
static host_mesh *add_box(scene *s, const double low[3], const double high[3])
{
    host_vertex v[24];
    uint32_t indices[36];
    const host_material material = {.base_color = {0, 0, 0, 1},
                                    .emissive = {glow[0], glow[1], glow[2]},
                                    .roughness = 1,
                                    .two_sided = true,
                                    .base_texture = -1,
                                    .emissive_texture = -1};
    host_mesh *mesh = &s->mesh[s->count++];
    memset(v, 0, sizeof v);
    for (uint32_t face = 0; face < 6; face++) {
        const uint32_t axis = face / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
        for (uint32_t corner = 0; corner < 4; corner++) {
            host_vertex *out = &v[face * 4 + corner];
            out->position[axis] = (float)(face % 2 ? high : low)[axis];
            out->position[b] = (float)(corner == 1 || corner == 2 ? high : low)[b];
            out->position[c] = (float)(corner >= 2 ? high : low)[c];
            out->normal[axis] = face % 2 ? 1.0f : -1.0f;
        }
        const uint32_t quad[6] = {0, 1, 2, 0, 2, 3};
        for (uint32_t i = 0; i < 6; i++)
            indices[face * 6 + i] = face * 4 + quad[i];
    }
    if (!host_mesh_create(&s->base.device, v, 24, indices, 36, &material, mesh, s->base.error, sizeof s->base.error) ||
        !host_renderer_add(s->renderer, mesh, s->base.error, sizeof s->base.error))
        fail_msg("%s", s->base.error);
    return mesh;
}

static void light_at(scene *s, const double at_m[3], float sh[9][3])
{
    if (!host_surroundings_light(&s->surroundings, s->renderer, at_m, sh, s->base.error, sizeof s->base.error))
        fail_msg("%s", s->base.error);
}

static void assert_light(float sh[9][3], const double expected[9][3], double epsilon)
{
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            if (!(fabs((double)sh[k][c] - expected[k][c]) <= epsilon))
                fail_msg("harmonic %d of colour %d is %g, expected %g", k, c, (double)sh[k][c], expected[k][c]);
}

static void the_open_has_the_light_of_the_environment(void **state)
{
    scene s;
    float sh[9][3];
    (void)state;
    begin(&s, 5, 0.2f);
    add_box(&s, (double[]){-1e4, -1e4, -1e4}, (double[]){-9e3, -9e3, -9e3}); /* beyond sight */
    light_at(&s, place, sh);
    assert_memory_equal(sh, s.environment.sh, sizeof sh);
    end(&s);
}

/* All directions have one radiance: L sqrt(4 pi) in the first harmonic, 0 in all others. Of the sky nothing is left,
 * but for the difference of its two ways of summation, 0.2 % of it. */
static void a_box_has_its_own_light(void **state)
{
    scene s;
    float sh[9][3];
    double expected[9][3] = {{0}};
    (void)state;
    begin(&s, 5, 0.2f);
    add_box(&s, (double[]){1, 1, -7}, (double[]){7, 4, -4});
    light_at(&s, place, sh);
    for (int c = 0; c < 3; c++)
        expected[0][c] = (double)glow[c] * sqrt(4 * M_PI);
    assert_light(sh, expected, 0.01 * 60);
    end(&s);
}

/* L below the horizon and 1 above: (1 + L) / 2 and the step's first moment, sqrt(3 / (4 pi)) pi (1 - L), along Y. The
 * second degree is even, and a step has none of it. */
static void a_floor_hides_the_lower_half(void **state)
{
    scene s;
    float sh[9][3];
    double expected[9][3] = {{0}};
    (void)state;
    begin(&s, SKY, SKY);
    add_box(&s, (double[]){-1900, -1, -1900}, (double[]){1900, 0, 1900});
    light_at(&s, place, sh);
    for (int c = 0; c < 3; c++) {
        expected[0][c] = 0.5 * (1 + (double)glow[c]) * sqrt(4 * M_PI);
        expected[1][c] = sqrt(3 / (4 * M_PI)) * M_PI * (1 - (double)glow[c]);
    }
    assert_light(sh, expected, 0.01 * 60);
    end(&s);
}

/* A panel 5 m wide is 10 m away: seen under W = 4 atan(1 / sqrt(288)) sr it adds (L - 1) W Y(d) to the harmonic of the
 * first degree along d, but for the cosines of its corners, 2 %. It covers 8 x 8 whole pixels. */
static void a_panel_is_where_it_stands(void **state)
{
    (void)state;
    for (int direction = 0; direction < 6; direction++) {
        const int axis = direction / 2;
        static const int first_degree[3] = {3, 1, 2};
        double low[3], high[3];
        scene s;
        float sh[9][3];
        begin(&s, SKY, SKY);
        for (int i = 0; i < 3; i++) {
            low[i] = place[i] - (i == axis ? 0.005 : 2.5);
            high[i] = place[i] + (i == axis ? 0.005 : 2.5);
        }
        low[axis] += direction % 2 ? 10 : -10;
        high[axis] += direction % 2 ? 10 : -10;
        add_box(&s, low, high);
        light_at(&s, place, sh);
        for (int i = 0; i < 3; i++) {
            const double side = i != axis ? 0 : direction % 2 ? 1 : -1;
            const double more = ((double)glow[1] - 1) * 4 * atan(1 / sqrt(288)) * sqrt(3 / (4 * M_PI));
            assert_true(fabs((double)sh[first_degree[i]][1] - side * more) < 0.04 * more);
        }
        end(&s);
    }
}

/* A place's light does not depend on what was asked for before, and what moves is not in it. */
static void only_what_stands_counts(void **state)
{
    scene s;
    float first[9][3], again[9][3], other[9][3];
    const double elsewhere[3] = {90, 3, 90};
    (void)state;
    begin(&s, 5, 0.2f);
    add_box(&s, (double[]){4, 0, -9}, (double[]){6, 8, 7});
    light_at(&s, place, first);
    light_at(&s, elsewhere, other);
    add_box(&s, (double[]){-4, 0, -9}, (double[]){-2, 8, 7})->moves = true;
    light_at(&s, place, again);
    assert_memory_equal(first, again, sizeof first);
    assert_memory_not_equal(first, other, sizeof first);
    s.mesh[1].moves = false;
    light_at(&s, place, again);
    assert_memory_not_equal(first, again, sizeof first);
    end(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_open_has_the_light_of_the_environment),
        cmocka_unit_test(a_box_has_its_own_light),
        cmocka_unit_test(a_floor_hides_the_lower_half),
        cmocka_unit_test(a_panel_is_where_it_stands),
        cmocka_unit_test(only_what_stands_counts),
    };
    return fixture_result(cmocka_run_group_tests(tests, NULL, NULL));
}
