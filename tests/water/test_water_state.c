/* test_water_state.c - saved water goes on bit for bit with its spray and foam, and a state whose contents are wrong
 * does no harm.
 * Usage: water-state [NUMBER]: so many wrong states. */
#include "../host/wrong_words.h"
#include "water_fixture.h"

#include "gpu/state_bytes.h"

#define STEP_S (1.0 / 64)

static uint32_t number = 12;
static water_fixture f;
static host_buffer foam_down;

/* A cloud of fast particles, most of them alone: spray, and foam where they meet. */
static void open_cloud(void)
{
    uint32_t hash = 11;
    virga_water_def def = water_fixture_def();
    def.max_foam = 4096;
    water_fixture_open_with(&f, &def, false);
    f.settings.spacing_m = 0.02f;
    f.settings.spray_density = 0.45f;
    REQUIRE(virga_water_set(f.water, &f.settings) == VIRGA_OK);
    for (uint32_t i = 0; i < 600; i++) {
        virga_particle_gpu *p = water_fixture_add(&f, water_random(&hash, 0, 0.3), water_random(&hash, 0.1, 0.3),
                                                  water_random(&hash, 0, 0.3));
        for (int k = 0; k < 3; k++)
            p->velocity[k] = (float)water_random(&hash, -2, 2);
    }
    REQUIRE(host_buffer_create(&f.gpu.device, f.water->foam.particles->size, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                               HOST_BUFFER_READBACK, "foam down", &foam_down, f.gpu.error, sizeof f.gpu.error));
}

static void close_cloud(void)
{
    host_buffer_destroy(&f.gpu.device, &foam_down);
    water_fixture_close(&f);
}

static void open_blob(host_buffer *blob)
{
    REQUIRE(host_buffer_create(&f.gpu.device, virga_water_state_bytes(f.water),
                               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                               HOST_BUFFER_READBACK, "state", blob, f.gpu.error, sizeof f.gpu.error));
}

static void run(uint32_t steps)
{
    for (uint32_t i = 0; i < steps; i++) {
        f.time_s += STEP_S;
        REQUIRE(water_fixture_try(&f) == VIRGA_OK);
    }
}

static void save(const host_buffer *to)
{
    const virga_state_range range = {to->buffer, 0, to->size};
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    REQUIRE(virga_water_save(f.water, cmd, &range) == VIRGA_OK);
    effect_fixture_complete(&f.gpu, f.context);
    host_buffer_invalidate(&f.gpu.device, to);
}

static virga_result load(const host_buffer *from)
{
    const virga_state_source source = {from->mapped, from->size, from->buffer, 0};
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    const virga_result result = virga_water_load(f.water, cmd, &source);
    effect_fixture_complete(&f.gpu, f.context);
    return result;
}

/* The foam's bytes, to be freed. */
static virga_foam_gpu *read_foam(void)
{
    VkDeviceSize offset = 0;
    const VkCommandBuffer cmd = effect_fixture_begin(&f.gpu, f.context);
    effect_fixture_transfers(cmd);
    const void *foam =
        effect_fixture_copy(cmd, f.water->foam.particles->buffer, f.water->foam.particles->size, &foam_down, &offset);
    effect_fixture_complete(&f.gpu, f.context);
    host_buffer_invalidate(&f.gpu.device, &foam_down);
    virga_foam_gpu *kept = malloc(f.water->foam.particles->size);
    assert_non_null(kept);
    memcpy(kept, foam, f.water->foam.particles->size);
    return kept;
}

static virga_spray_gpu *read_droplets(void)
{
    virga_spray_gpu *kept = malloc(f.water->spray.droplets->size);
    assert_non_null(kept);
    memcpy(kept, f.droplets, f.water->spray.droplets->size);
    return kept;
}

static void loaded_water_goes_on_with_the_same_bits(void **state)
{
    (void)state;
    host_buffer blob;
    open_cloud();
    open_blob(&blob);
    run(4);
    save(&blob);
    REQUIRE(virga_state_seal(blob.mapped, blob.size, f.gpu.device.frame, NULL) == VIRGA_OK);
    const double saved_s = f.time_s;
    run(3);
    const uint32_t count = f.stats.droplets;
    virga_spray_gpu *droplets = read_droplets();
    virga_foam_gpu *foam = read_foam();
    uint32_t alive = 0;
    for (uint32_t i = 0; i < f.water->def.max_foam; i++)
        alive += foam[i].life_s > 0;

    run(2); /* what the load is to forget */
    REQUIRE(load(&blob) == VIRGA_OK);
    f.time_s = saved_s;
    run(3);
    virga_foam_gpu *found = read_foam();
    assert_true(count > 50 && alive > 50);
    assert_int_equal(f.stats.droplets, count);
    assert_memory_equal(f.droplets, droplets, count * sizeof *droplets);
    assert_memory_equal(found, foam, f.water->foam.particles->size);
    free(droplets);
    free(foam);
    free(found);
    host_buffer_destroy(&f.gpu.device, &blob);
    close_cloud();
}

static void wrong_contents_do_no_harm(void **state)
{
    (void)state;
    host_buffer whole, wrong;
    uint32_t refused = 0;
    open_cloud();
    open_blob(&whole);
    open_blob(&wrong);
    run(4);
    save(&whole);
    const uint64_t frame = f.gpu.device.frame;
    const double saved_s = f.time_s;
    for (uint32_t i = 0; i < number; i++) {
        memcpy(wrong.mapped, whole.mapped, whole.size);
        wrong_words(wrong.mapped, wrong.size, i);
        REQUIRE(virga_state_seal(wrong.mapped, wrong.size, frame, NULL) == VIRGA_OK);
        refused += load(&wrong) < VIRGA_OK;
        for (uint32_t k = 1; k <= 2; k++) {
            f.time_s = saved_s + k * STEP_S;
            (void)water_fixture_try(&f);
        }
    }
    print_message("%u states, %u refused\n", number, refused);
    host_buffer_destroy(&f.gpu.device, &whole);
    host_buffer_destroy(&f.gpu.device, &wrong);
    close_cloud();
}

/* The load says one line with these words, and the water goes on as if nobody had tried. */
static void check_refused(const host_buffer *blob, const char *words)
{
    f.lines = 0;
    REQUIRE(load(blob) == VIRGA_ERROR_INVALID);
    if (f.lines != 1 || !strstr(f.said, words))
        fail_msg("%u lines, the last '%s'; expected one with '%s'", f.lines, f.said, words);
    run(1);
    assert_int_equal(f.lines, 1);
}

static void a_state_of_an_older_format_is_refused_with_one_line(void **state)
{
    (void)state;
    host_buffer blob;
    open_cloud();
    open_blob(&blob);
    run(2);
    save(&blob);
    virga_state_header *header = blob.mapped;
    virga_state_section *section = (virga_state_section *)(header + 1);
    header->version = VIRGA_STATE_VERSION - 1;
    REQUIRE(virga_state_seal(blob.mapped, blob.size, header->frame_index, NULL) == VIRGA_OK);
    check_refused(&blob, "format version 0, expected 1");

    /* Of the same version, by a program whose foam had smaller particles. */
    header->version = VIRGA_STATE_VERSION;
    section->device_bytes -= 1024;
    REQUIRE(virga_state_seal(blob.mapped, blob.size, header->frame_index, NULL) == VIRGA_OK);
    check_refused(&blob, "the state of water_def has ");
    host_buffer_destroy(&f.gpu.device, &blob);
    close_cloud();
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(loaded_water_goes_on_with_the_same_bits),
        cmocka_unit_test(wrong_contents_do_no_harm),
        cmocka_unit_test(a_state_of_an_older_format_is_refused_with_one_line),
    };
    number = count > 1 ? (uint32_t)strtoul(arguments[1], NULL, 10) : number;
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
