/* test_fluid_state.c - a saved fluid goes on bit for bit, and one whose contents are wrong does no harm.
 * Usage: fluid-state [NUMBER]: so many wrong states. */
#include "../host/wrong_words.h"
#include "fluid_fixture.h"

static uint32_t number = 12;

/* A column in a box. */
static void open_column(fluid_fixture *f)
{
    const virga_fluid_def def = fluid_fixture_def();
    memset(f, 0, sizeof *f);
    fluid_fixture_open_with(f, &def, false);
    fluid_fixture_box(f, 0.05, 1, 1, 0.5);
}

static void open_blob(fluid_fixture *f, host_buffer *blob)
{
    REQUIRE(host_buffer_create(&f->gpu.device, virga_fluid_state_bytes(f->fluid),
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                               HOST_BUFFER_READBACK, "state", blob, f->gpu.error, sizeof f->gpu.error));
}

/* A step, with a save after it or a load before it. */
static virga_result step_with(fluid_fixture *f, const host_buffer *to, const host_buffer *from)
{
    virga_result result = VIRGA_OK;
    const VkCommandBuffer cmd = effect_fixture_begin(&f->gpu, f->context);
    const virga_fluid_step_info info = {.dt_s = 1.0f / 60};
    if (from) {
        const virga_state_source source = {from->mapped, from->size, from->buffer, 0};
        result = virga_fluid_load(f->fluid, cmd, &source);
    }
    if (result == VIRGA_OK)
        result = virga_fluid_step(f->fluid, cmd, &info);
    if (to) {
        const virga_state_range range = {to->buffer, 0, to->size};
        REQUIRE(virga_fluid_save(f->fluid, cmd, &range) == VIRGA_OK);
    }
    effect_fixture_complete(&f->gpu, f->context);
    if (to)
        host_buffer_invalidate(&f->gpu.device, to);
    return result;
}

static void a_loaded_fluid_goes_on_with_the_same_bits(void **state)
{
    (void)state;
    fluid_fixture f;
    host_buffer blob;
    open_column(&f);
    open_blob(&f, &blob);
    fluid_fixture_block(&f, 0, 0, 0, 0.3, 0.8, 0.5);
    fluid_fixture_run(&f, 4);
    REQUIRE(step_with(&f, &blob, NULL) == VIRGA_OK);
    REQUIRE(virga_state_seal(blob.mapped, blob.size, f.gpu.device.frame, NULL) == VIRGA_OK);
    fluid_fixture_run(&f, 3);
    const uint32_t count = f.count;
    virga_particle_gpu *wanted = malloc(count * sizeof *wanted);
    assert_non_null(wanted);
    memcpy(wanted, f.particles, count * sizeof *wanted);

    fluid_fixture_run(&f, 2); /* what the load is to forget */
    REQUIRE(step_with(&f, NULL, &blob) == VIRGA_OK);
    fluid_fixture_run(&f, 2);
    assert_int_equal(f.count, count);
    assert_true(count > 500);
    assert_memory_equal(f.particles, wanted, count * sizeof *wanted);
    free(wanted);
    host_buffer_destroy(&f.gpu.device, &blob);
    fluid_fixture_close(&f);
}

static void wrong_contents_do_no_harm(void **state)
{
    (void)state;
    fluid_fixture f;
    host_buffer whole, wrong;
    uint32_t refused = 0;
    open_column(&f);
    open_blob(&f, &whole);
    open_blob(&f, &wrong);
    fluid_fixture_block(&f, 0, 0, 0, 0.3, 0.6, 0.5);
    fluid_fixture_run(&f, 2);
    REQUIRE(step_with(&f, &whole, NULL) == VIRGA_OK);
    const uint64_t frame = f.gpu.device.frame;
    for (uint32_t i = 0; i < number; i++) {
        memcpy(wrong.mapped, whole.mapped, whole.size);
        wrong_words(wrong.mapped, wrong.size, i);
        REQUIRE(virga_state_seal(wrong.mapped, wrong.size, frame, NULL) == VIRGA_OK);
        refused += step_with(&f, NULL, &wrong) < VIRGA_OK;
        (void)fluid_fixture_try(&f, 1.0 / 60, 0, true);
        assert_true(f.count <= f.fluid->def.max_particles);
    }
    print_message("%u states, %u refused\n", number, refused);
    host_buffer_destroy(&f.gpu.device, &whole);
    host_buffer_destroy(&f.gpu.device, &wrong);
    fluid_fixture_close(&f);
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_loaded_fluid_goes_on_with_the_same_bits),
        cmocka_unit_test(wrong_contents_do_no_harm),
    };
    number = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : number;
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
