/* test_targets.c - targets come and go: no number of them is too large, and compatible ones share their pipelines. */
#include "gpu_fixture.h"

typedef struct targets {
    gpu_fixture *f;
    virga_context *context;
    virga_rain *rain;
    gpu_picture picture;
} targets;

static void open_targets(targets *t, void **state, virga_pipeline_build_mode mode)
{
    *t = (targets){.f = *state};
    virga_context_def def = gpu_context_def(t->f);
    def.pipeline_build_mode = mode;
    REQUIRE(virga_context_create(&def, &t->context) == VIRGA_OK);
    t->rain = gpu_rain(t->context);
    gpu_picture_open(t->f, t->context, &t->picture);
    gpu_forget_log(t->f);
}

static void close_targets(targets *t)
{
    gpu_wait(t->f);
    virga_rain_destroy(&t->rain);
    gpu_picture_close(t->f, &t->picture);
    virga_context_destroy(&t->context);
}

static virga_target *make_target(targets *t, uint64_t render_pass_class)
{
    virga_target_def def = virga_default_target_def();
    virga_target *target = NULL;
    host_target_describe_layer(&t->picture.images, &def);
    def.render_pass_class = render_pass_class;
    REQUIRE(virga_target_create(t->context, &def, &target) == VIRGA_OK);
    return target;
}

/* Draws rain into a target that is remade in each frame. */
static void draw_remade(targets *t, uint64_t render_pass_class)
{
    virga_target_destroy(&t->picture.target);
    t->picture.target = make_target(t, render_pass_class);
    assert_int_equal(virga_rain_attach(t->rain, t->picture.target), VIRGA_OK);
    gpu_record(gpu_begin_frame(t->f, t->context), t->rain, &t->picture);
    gpu_submit(t->f);
}

static void an_engine_remakes_its_target_at_each_resize(void **state)
{
    targets t;
    open_targets(&t, state, VIRGA_PIPELINES_IMMEDIATE);
    uint32_t most = 0;
    for (uint32_t i = 0; i < 20; i++) {
        draw_remade(&t, 0);
        if (i == 5) /* those of the frames in flight, and of this one */
            most = watch.live[WATCH_Pipeline];
    }
    assert_true(watch.live[WATCH_Pipeline] <= most);
    assert_int_equal(t.f->errors, 0);
    close_targets(&t);
}

static void compatible_targets_compile_nothing(void **state)
{
    targets t;
    open_targets(&t, state, VIRGA_PIPELINES_IMMEDIATE);
    draw_remade(&t, 7);
    const uint32_t made = watch.made[WATCH_Pipeline];
    virga_target *second = make_target(&t, 7);
    assert_int_equal(virga_rain_attach(t.rain, second), VIRGA_OK);
    for (uint32_t i = 0; i < 4; i++)
        draw_remade(&t, 7);
    assert_int_equal(watch.made[WATCH_Pipeline], made);
    virga_target_destroy(&second);
    draw_remade(&t, 8); /* another class */
    assert_true(watch.made[WATCH_Pipeline] > made);
    close_targets(&t);
}

static void pipelines_of_destroyed_targets_are_released(void **state)
{
    targets t;
    open_targets(&t, state, VIRGA_PIPELINES_IMMEDIATE);
    const uint32_t alone = watch.live[WATCH_Pipeline];
    draw_remade(&t, 0);
    assert_true(watch.live[WATCH_Pipeline] > alone);
    gpu_wait(t.f);
    virga_target_destroy(&t.picture.target);
    REQUIRE(virga_frame_completed(t.context, t.f->gpu.device.completed) == VIRGA_OK);
    gpu_begin_frame(t.f, t.context);
    gpu_submit(t.f);
    gpu_begin_frame(t.f, t.context);
    gpu_submit(t.f);
    gpu_wait(t.f);
    REQUIRE(virga_frame_completed(t.context, t.f->gpu.device.completed) == VIRGA_OK);
    gpu_begin_frame(t.f, t.context);
    gpu_submit(t.f);
    assert_int_equal(watch.live[WATCH_Pipeline], alone);
    close_targets(&t);
}

/* The render pass of the first target ends with it, before the pipelines are built. */
static void waiting_pipelines_move_to_another_target_of_the_class(void **state)
{
    targets t;
    uint32_t left;
    open_targets(&t, state, VIRGA_PIPELINES_DEFERRED);
    virga_target *first = make_target(&t, 7);
    virga_target_destroy(&t.picture.target);
    t.picture.target = make_target(&t, 7);
    assert_int_equal(virga_rain_attach(t.rain, first), VIRGA_OK);
    assert_int_equal(virga_rain_attach(t.rain, t.picture.target), VIRGA_OK);
    virga_target_destroy(&first);
    assert_int_equal(virga_pipelines_build(t.context, UINT32_MAX, &left), VIRGA_OK);
    gpu_record(gpu_begin_frame(t.f, t.context), t.rain, &t.picture);
    gpu_submit(t.f);
    close_targets(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(an_engine_remakes_its_target_at_each_resize),
        gpu_kept_test(compatible_targets_compile_nothing),
        gpu_kept_test(pipelines_of_destroyed_targets_are_released),
        gpu_kept_test(waiting_pipelines_move_to_another_target_of_the_class),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("targets", tests, NULL, NULL));
}
