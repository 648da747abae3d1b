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

/* ---- objects of one kind */

static void a_second_object_compiles_nothing(void **state)
{
    targets t;
    open_targets(&t, state, VIRGA_PIPELINES_IMMEDIATE);
    const uint32_t none = watch.live[WATCH_Pipeline] / 2; /* rain's own, and none of a target */
    draw_remade(&t, 7);
    const uint32_t made = watch.made[WATCH_Pipeline], layouts = watch.made[WATCH_PipelineLayout];
    virga_rain *first = t.rain;
    t.rain = gpu_rain(t.context);
    draw_remade(&t, 7);
    assert_int_equal(watch.made[WATCH_Pipeline], made);
    assert_int_equal(watch.made[WATCH_PipelineLayout], layouts);
    gpu_wait(t.f);
    virga_rain_destroy(&first);
    draw_remade(&t, 7); /* it goes on with pipelines that the first one asked for */
    assert_true(watch.live[WATCH_Pipeline] > none);
    assert_int_equal(t.f->errors, 0);
    close_targets(&t);
    assert_int_equal(watch.live[WATCH_Pipeline], 0);
    assert_int_equal(watch.live[WATCH_PipelineLayout], 0);
}

/* The first of two objects ends while both wait for the same builds. Builds that read a render pass are not shared. */
static void builds_go_on_for_another_object(void **state)
{
    targets t;
    uint32_t alone, both, left;
    open_targets(&t, state, VIRGA_PIPELINES_DEFERRED);
    virga_pipelines_build(t.context, 0, &alone);
    virga_rain *first = t.rain;
    t.rain = gpu_rain(t.context);
    assert_int_equal(virga_rain_ready(t.rain), VIRGA_NOT_READY);
    virga_pipelines_build(t.context, 0, &both);
    assert_in_range(both, alone, alone + alone / 4);
    virga_rain_destroy(&first);
    virga_pipelines_build(t.context, 1, &left);
    assert_int_equal(left, alone - 1);
    assert_int_equal(virga_rain_attach(t.rain, t.picture.target), VIRGA_OK);
    assert_int_equal(virga_pipelines_build(t.context, UINT32_MAX, &left), VIRGA_OK);
    assert_int_equal(virga_rain_ready(t.rain), VIRGA_OK);
    gpu_record(gpu_begin_frame(t.f, t.context), t.rain, &t.picture);
    gpu_submit(t.f);
    close_targets(&t);
}

/* ---- pipelines that settings want */

/* A pane builds the pipelines of its own style, and those of another one when it gets it. */
static void another_style_builds_its_pipelines(void **state)
{
    targets t;
    uint32_t made[4];
    open_targets(&t, state, VIRGA_PIPELINES_IMMEDIATE);
    virga_glass_def def = virga_default_glass_def();
    virga_glass_settings settings = virga_default_glass_settings();
    virga_glass *pane = NULL;
    def.max_drops = 256;
    REQUIRE(virga_glass_create(t.context, &def, &pane) == VIRGA_OK);
    assert_int_equal(virga_glass_attach(pane, t.picture.target), VIRGA_OK);
    made[0] = watch.made[WATCH_Pipeline];
    settings.style = VIRGA_GLASS_STYLE_FRONT;
    assert_int_equal(virga_glass_set(pane, &settings), VIRGA_OK);
    made[1] = watch.made[WATCH_Pipeline];
    assert_in_range(made[1] - made[0], 1, 3);
    settings.style = VIRGA_GLASS_STYLE_PHYSICAL;
    assert_int_equal(virga_glass_set(pane, &settings), VIRGA_OK);
    settings.style = VIRGA_GLASS_STYLE_FRONT;
    assert_int_equal(virga_glass_set(pane, &settings), VIRGA_OK);
    assert_int_equal(watch.made[WATCH_Pipeline], made[1]);
    settings.style = VIRGA_GLASS_STYLE_PAPER;
    assert_int_equal(virga_glass_set(pane, &settings), VIRGA_OK);
    made[2] = watch.made[WATCH_Pipeline];
    assert_true(made[2] > made[1]);
    virga_target *second = make_target(&t, 0); /* of another class: it needs those of the style that is set */
    assert_int_equal(virga_glass_attach(pane, second), VIRGA_OK);
    made[3] = watch.made[WATCH_Pipeline];
    assert_true(made[3] > made[2]);
    virga_target_destroy(&second);
    virga_glass_destroy(&pane);
    close_targets(&t);
}

/* ---- a render pass, by what it was created with */

static void refuse(targets *t, const virga_target_def *def, const char *why)
{
    virga_target *target = NULL;
    gpu_forget_log(t->f);
    assert_int_equal(virga_target_create(t->context, def, &target), VIRGA_ERROR_INVALID);
    assert_null(target);
    assert_one_error(t->f, VIRGA_LOG_ARGUMENT);
    if (!strstr(t->f->last, why))
        fail_msg("expected '%s' in: %s", why, t->f->last);
}

static void a_target_that_is_not_its_render_pass_is_refused(void **state)
{
    targets t;
    open_targets(&t, state, VIRGA_PIPELINES_IMMEDIATE);
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkAttachmentDescription attachment = {.format = VK_FORMAT_R32G32B32A32_SFLOAT, .samples = VK_SAMPLE_COUNT_1_BIT};
    VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    virga_target_def def = virga_default_target_def(), wrong;
    host_target_describe_layer(&t.picture.images, &def);
    def.render_pass_info = &info;
    virga_target *target = NULL;
    assert_int_equal(virga_target_create(t.context, &def, &target), VIRGA_OK);
    virga_target_destroy(&target);
    wrong = def;
    wrong.subpass = 1;
    refuse(&t, &wrong, "target_def.subpass");
    wrong = def;
    wrong.depth_attached = true;
    refuse(&t, &wrong, "target_def.depth_attached");
    wrong = def;
    wrong.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
    refuse(&t, &wrong, "color_formats[0]");
    attachment.samples = VK_SAMPLE_COUNT_4_BIT;
    refuse(&t, &def, "target_def.samples");
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.format = VK_FORMAT_R8G8B8A8_UINT;
    wrong = def;
    wrong.color_formats[0] = VK_FORMAT_UNDEFINED;
    refuse(&t, &wrong, "blend");
    subpass.colorAttachmentCount = 0;
    refuse(&t, &def, "target_def.color_count");
    close_targets(&t);
}

static void strict_contexts_ask_for_it(void **state)
{
    targets t = {.f = *state};
    virga_context_def def = gpu_context_def(t.f);
    virga_target_def target = virga_default_target_def();
    host_target images;
    def.strict = true;
    REQUIRE(virga_context_create(&def, &t.context) == VIRGA_OK);
    REQUIRE(host_target_create(&t.f->gpu.device, 16, 16, &images, t.f->gpu.error, sizeof t.f->gpu.error));
    host_target_describe_layer(&images, &target);
    refuse(&t, &target, "render_pass_info");
    host_target_destroy(&t.f->gpu.device, &images);
    virga_context_destroy(&t.context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(an_engine_remakes_its_target_at_each_resize),
        gpu_kept_test(compatible_targets_compile_nothing),
        gpu_kept_test(pipelines_of_destroyed_targets_are_released),
        gpu_kept_test(waiting_pipelines_move_to_another_target_of_the_class),
        gpu_kept_test(a_second_object_compiles_nothing),
        gpu_kept_test(builds_go_on_for_another_object),
        gpu_kept_test(another_style_builds_its_pipelines),
        gpu_kept_test(a_target_that_is_not_its_render_pass_is_refused),
        gpu_kept_test(strict_contexts_ask_for_it),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("targets", tests, NULL, NULL));
}
