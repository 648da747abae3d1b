/* test_water_mesh.c - the surface of water as triangles: closed, with the volume of the particles, normals and
 * velocities. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "mesh_volume.h"

#include <virga/shared/random.h>

#define D 0.02

enum { MAX_PARTICLES = 20000 };

static virga_particle_gpu particles[MAX_PARTICLES];
static uint32_t count;

static void add(double x, double y, double z)
{
    assert_true(count < MAX_PARTICLES);
    particles[count] = (virga_particle_gpu){.position = {(float)x, (float)y, (float)z}, .share = 1, .id = count};
    count++;
}

static double jitter(uint32_t index, uint32_t axis)
{
    return 0.2 * D * (2 * (double)virga_unit(virga_hash3(5, index, axis)) - 1);
}

/* A ball of particles that are out of order. */
static void add_ball(double x, double y, double z, double radius)
{
    const int n = (int)(radius / D) + 1;
    for (int i = 0; i < (2 * n + 1) * (2 * n + 1) * (2 * n + 1); i++) {
        const double at[3] = {D * (i % (2 * n + 1) - n), D * (i / (2 * n + 1) % (2 * n + 1) - n),
                              D * (i / (2 * n + 1) / (2 * n + 1) - n)};
        if (at[0] * at[0] + at[1] * at[1] + at[2] * at[2] <= radius * radius)
            add(x + at[0] + jitter(count, 0), y + at[1] + jitter(count, 1), z + at[2] + jitter(count, 2));
    }
}

static water_mesh make_mesh(void)
{
    const field_def def = {particles, count, D, D * D * D, 2};
    field made;
    water_mesh mesh;
    assert_true(field_create(&made, &def));
    assert_true(water_mesh_create(&mesh, &made, 0.5));
    field_destroy(&made);
    return mesh;
}

/* ---- closed */

typedef struct edge {
    uint32_t from, to;
} edge;

static int compare_edges(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(edge));
}

/* Each edge of a triangle is, the other way round, that of one other triangle. */
static void assert_closed(const water_mesh *mesh)
{
    const size_t edges = (size_t)mesh->triangle_count * 3;
    edge *one = malloc(edges * sizeof *one + 1), *other = malloc(edges * sizeof *other + 1);
    assert_true(one && other);
    for (size_t i = 0; i < edges; i++) {
        const uint32_t *corners = mesh->triangles[i / 3];
        one[i] = (edge){corners[i % 3], corners[(i + 1) % 3]};
        other[i] = (edge){one[i].to, one[i].from};
        assert_true(one[i].from < mesh->vertex_count && one[i].from != one[i].to);
    }
    qsort(one, edges, sizeof *one, compare_edges);
    qsort(other, edges, sizeof *other, compare_edges);
    for (size_t i = 0; i < edges; i++) {
        assert_memory_equal(&one[i], &other[i], sizeof *one);
        assert_true(i == 0 || compare_edges(&one[i - 1], &one[i]) != 0);
    }
    free(one);
    free(other);
}

/* Balls that touch and lone particles, on both sides of the origin, where blocks begin. */
static void the_mesh_is_closed(void **state)
{
    (void)state;
    count = 0;
    add_ball(0, 0, 0, 0.12);
    add_ball(0.2, 0.05, -0.1, 0.1);
    for (uint32_t i = 0; i < 500; i++)
        add(2 * jitter(i, 7) / D, 2 * jitter(i, 8) / D, 2 * jitter(i, 9) / D);
    particles[3].share = 0.3f;
    particles[4].share = 0;
    particles[5].position[1] = NAN;
    particles[6].velocity[1] = INFINITY;
    particles[7].position[0] = 1e20f;
    water_mesh mesh = make_mesh();
    assert_true(mesh.triangle_count > 10000);
    assert_closed(&mesh);
    for (uint32_t i = 0; i < mesh.vertex_count; i++)
        for (int axis = 0; axis < 3; axis++)
            assert_true(isfinite(mesh.vertices[i].position[axis]) && isfinite(mesh.vertices[i].velocity[axis]) &&
                        isfinite(mesh.vertices[i].normal[axis]));
    water_mesh_destroy(&mesh);
}

/* On the density of half of the inside. A ball of particles has edges, so 3 %. */
static void its_volume_is_that_of_the_particles(void **state)
{
    (void)state;
    count = 0;
    add_ball(0.003, -0.21, 0.4, 0.24);
    water_mesh mesh = make_mesh();
    const double volume = mesh_volume(&mesh), expected = count * D * D * D;
    if (fabs(volume / expected - 1) > 0.03)
        fail_msg("%g m^3, expected %g", volume, expected);
    assert_closed(&mesh);
    water_mesh_destroy(&mesh);
}

static void normals_and_velocities_are_those_of_the_water(void **state)
{
    (void)state;
    count = 0;
    add_ball(0, 0, 0, 0.16);
    for (uint32_t i = 0; i < count; i++) { /* turns around Y */
        particles[i].velocity[0] = 3 * particles[i].position[2];
        particles[i].velocity[2] = -3 * particles[i].position[0];
    }
    water_mesh mesh = make_mesh();
    for (uint32_t i = 0; i < mesh.vertex_count; i++) {
        const mesh_vertex *v = &mesh.vertices[i];
        double out = 0, length2 = 0, n2 = 0;
        for (int axis = 0; axis < 3; axis++) {
            out += (double)v->normal[axis] * (double)v->position[axis];
            length2 += (double)v->position[axis] * (double)v->position[axis];
            n2 += (double)v->normal[axis] * (double)v->normal[axis];
        }
        assert_true(fabs(n2 - 1) < 1e-5);
        assert_true(out / sqrt(length2) > 0.8);
        /* Particles inside pull the mean velocity down. */
        assert_true(fabs((double)v->velocity[0] - 3 * (double)v->position[2]) < 3 * D);
        assert_true(fabs((double)v->velocity[2] + 3 * (double)v->position[0]) < 3 * D);
        assert_true(v->velocity[1] == 0);
    }
    water_mesh_destroy(&mesh);
}

static void no_particles_have_no_mesh(void **state)
{
    (void)state;
    count = 0;
    water_mesh mesh = make_mesh();
    assert_int_equal(mesh.vertex_count, 0);
    assert_int_equal(mesh.triangle_count, 0);
    water_mesh_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_mesh_is_closed),
        cmocka_unit_test(its_volume_is_that_of_the_particles),
        cmocka_unit_test(normals_and_velocities_are_those_of_the_water),
        cmocka_unit_test(no_particles_have_no_mesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
