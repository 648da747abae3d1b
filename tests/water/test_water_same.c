/* The bits of water: state, surfels, spray, foam and picture, with any number of threads, in any vector width, and with
 * both variants of passes. */
#include "water_picture_fixture.h"

#include "../host/same_runs.h"

enum { SIDE = 96, STEPS = 5 };

#define STEP_S (1.0 / 64)

/* A pool and a cloud of fast particles over it: spray, and foam where they meet. */
static void put_water(water_fixture *f)
{
    const double low[3] = {-0.2, 0, -0.2};
    const uint32_t counts[3] = {20, 6, 20};
    uint32_t hash = 11;
    water_fixture_box(f, low, counts, 0.02, 0.2);
    for (uint32_t i = 0; i < 500; i++) {
        virga_particle_gpu *p = water_fixture_add(f, water_random(&hash, -0.2, 0.2), water_random(&hash, 0.1, 0.3),
                                                  water_random(&hash, -0.2, 0.2));
        for (int k = 0; k < 3; k++)
            p->velocity[k] = (float)water_random(&hash, -2, 2);
    }
}

/* The next step has moved particles, in another order. */
static void move(water_fixture *f)
{
    f->time_s += STEP_S;
    for (uint32_t i = 0; i < f->count; i++)
        for (int k = 0; k < 3; k++)
            f->particles[i].position[k] += (float)STEP_S * f->particles[i].velocity[k];
    const virga_particle_gpu first = f->particles[0];
    memmove(f->particles, f->particles + 1, (f->count - 1) * sizeof first);
    f->particles[f->count - 1] = first;
}

static void add_state(same_bits *bits, water_fixture *f)
{
    host_buffer blob;
    REQUIRE(host_buffer_create(&f->gpu.device, virga_water_state_bytes(f->water), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "state", &blob, f->gpu.error, sizeof f->gpu.error));
    const virga_state_range range = {blob.buffer, 0, blob.size};
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    REQUIRE(virga_water_save(f->water, cmd, &range) == VIRGA_OK);
    effect_fixture_complete(&f->gpu, f->context);
    host_buffer_invalidate(&f->gpu.device, &blob);
    same_add(bits, "state", blob.mapped, blob.size);
    host_buffer_destroy(&f->gpu.device, &blob);
}

static void run_water(same_bits *bits, virga_water_kernel kernel)
{
    shot s;
    virga_water_def def = water_fixture_def();
    def.max_foam = 4096;
    def.max_width = def.max_height = SIDE;
    shot_open_with(&s, &def, SIDE, SIDE, false);
    s.f.settings.spacing_m = 0.02f;
    s.f.settings.spray_density = 0.45f;
    s.f.settings.kernel = kernel;
    put_water(&s.f);
    for (int i = 0; i < STEPS; i++) {
        water_fixture_step(&s.f);
        move(&s.f);
    }
    REQUIRE(s.f.stats.surfels > 1000 && s.f.stats.droplets > 100 && s.f.stats.foam > 20);
    same_add(bits, "densities", s.f.densities, s.f.count * sizeof *s.f.densities);
    same_add(bits, "surfels", s.f.surfels, s.f.stats.surfels * sizeof *s.f.surfels);
    same_add(bits, "droplets", s.f.droplets, s.f.stats.droplets * sizeof *s.f.droplets);
    add_state(bits, &s.f);
    shot_aim(&s, (const double[3]){0.4, 0.5, 0.9}, (const double[3]){0, 0.1, 0});
    same_add(bits, "picture", shot_draw(&s), (size_t)SIDE * SIDE * 16);
    bits->pictures = 1;
    shot_close(&s);
}

static void balls(same_bits *bits)
{
    run_water(bits, VIRGA_WATER_KERNEL_ISOTROPIC);
}

static void ellipsoids(same_bits *bits)
{
    run_water(bits, VIRGA_WATER_KERNEL_ANISOTROPIC);
}

static void threads_and_variants_change_no_bit(void **state)
{
    (void)state;
    same_for_threads_and_variants(balls);
    same_for_threads_and_variants(ellipsoids);
}

static void vector_widths_change_no_bit(void **state)
{
    (void)state;
    same_in_widths(SAME_CACHES, ellipsoids);
}

int main(int argc, char **argv)
{
    int code;
    if (same_runs_child(argc, argv, ellipsoids, &code))
        return code;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_and_variants_change_no_bit),
        cmocka_unit_test(vector_widths_change_no_bit),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
