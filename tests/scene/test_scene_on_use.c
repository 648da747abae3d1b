/* test_scene_on_use.c - with VIRGA_PIPELINES_ON_USE each call that can not build a pipeline says so itself: it is no
 * success, and no later call is blamed. */
#include "alone_fixture.h"

static void build_on_use(virga_context_def *def)
{
    def->pipeline_build_mode = VIRGA_PIPELINES_ON_USE;
}

static virga_result draw_occlusion(alone *a)
{
    static const double camera_m[3] = {0, 1, 0};
    const virga_occluder floor = {.vertices = a->buffer,
                                  .vertex_stride = 12,
                                  .indices = a->buffer,
                                  .index_type = VK_INDEX_TYPE_UINT32,
                                  .index_count = 3,
                                  .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
    return virga_rain_draw_occlusion(a->rain, a->cmd, camera_m, &floor, 1);
}

typedef virga_result (*recording)(alone *a);

/* The calls of an effect in a frame, in order, with the k-th call of the device failing. Returns false if there are
 * fewer than k. */
static bool fail_one(const char *effect, const recording calls[3], uint32_t k, uint32_t *unbuilt)
{
    alone a;
    bool reached = false;
    open_some(&a, effect, build_on_use);
    begin_frame(&a);
    stand_in.fail_in = k;
    stand_in.failure = VK_ERROR_OUT_OF_DEVICE_MEMORY;
    for (int i = 0; i < 3 && !reached; i++) {
        stand_in.failed = false;
        if (!calls[i])
            continue;
        const virga_result result = calls[i](&a);
        reached = stand_in.failed;
        const bool build = reached && strstr(a.last, "vkCreate"); /* a module or a pipeline */
        *unbuilt += build;
        if (build ? result != VIRGA_ERROR_DEVICE_MEMORY : !reached && result < 0)
            fail_msg("call %d, failure %u: %s, the last line: %s", i, k, virga_result_name(result), a.last);
    }
    stand_in.fail_in = 0;
    close_all(&a);
    return reached;
}

static void each_failed_build_is_an_error_of_its_call(void **state)
{
    (void)state;
    for (size_t e = 0; e < EFFECTS; e++) {
        const bool rain = !strcmp(effects[e].name, "rain");
        const bool is_empty = !strcmp(effects[e].name, "fluid"); /* without particles there is nothing to build */
        const recording calls[3] = {rain ? draw_occlusion : NULL, effects[e].step, effects[e].prepare};
        uint32_t unbuilt = 0;
        for (uint32_t k = 1; fail_one(effects[e].name, calls, k, &unbuilt); k++)
            assert_true(k < 500);
        printf("%s: %u failed builds\n", effects[e].name, unbuilt);
        assert_true(is_empty ? unbuilt == 0 : unbuilt > 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_failed_build_is_an_error_of_its_call)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
