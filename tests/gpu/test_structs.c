/* test_structs.c - structs that a default function did not fill, and definitions and views with wrong numbers in them.
 * */
#include "gpu_fixture.h"

#include <math.h>

typedef virga_result (*try_fn)(void *object, uint32_t size_change, uint32_t cookie_change);

/* Refused with one line each, and taken when as it should be. */
static void check_struct(gpu_fixture *f, try_fn try, void *object)
{
    static const uint32_t changes[][2] = {{1, 0}, {(uint32_t)-1, 0}, {0, 1}, {0, 0x80000000u}, {4, 4}};
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        gpu_forget_log(f);
        assert_int_equal(try(object, changes[i][0], changes[i][1]), VIRGA_ERROR_INVALID);
        assert_one_error(f, VIRGA_LOG_COOKIE);
    }
    gpu_forget_log(f);
    assert_int_equal(try(object, 0, 0), VIRGA_OK);
    assert_int_equal(f->errors, 0);
}

static virga_result try_context(void *object, uint32_t size, uint32_t cookie)
{
    virga_context_def def = gpu_context_def(object);
    virga_context *context = NULL;
    def.size += size;
    def.cookie ^= cookie;
    const virga_result result = virga_context_create(&def, &context);
    assert_int_equal(context != NULL, result == VIRGA_OK);
    virga_context_destroy(&context);
    return result;
}

static virga_result try_target(void *object, uint32_t size, uint32_t cookie)
{
    virga_target_def def = virga_default_target_def();
    virga_target *target = NULL;
    def.kind = VIRGA_TARGET_DYNAMIC;
    def.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
    def.depth_attached = false;
    def.size += size;
    def.cookie ^= cookie;
    const virga_result result = virga_target_create(object, &def, &target);
    assert_int_equal(target != NULL, result == VIRGA_OK);
    virga_target_destroy(&target);
    return result;
}

static virga_result try_rain(void *object, uint32_t size, uint32_t cookie)
{
    virga_rain_def def = gpu_rain_def();
    virga_rain *rain = NULL;
    def.size += size;
    def.cookie ^= cookie;
    assert_int_equal(virga_rain_estimate(&def) == 0, size || cookie);
    const virga_result result = virga_rain_create(object, &def, &rain);
    assert_int_equal(rain != NULL, result == VIRGA_OK);
    virga_rain_destroy(&rain);
    return result;
}

static virga_result try_scene(void *object, uint32_t size, uint32_t cookie)
{
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    def.rain = gpu_rain_def();
    def.size += size;
    def.cookie ^= cookie;
    const virga_result result = virga_scene_create(object, &def, &scene);
    assert_int_equal(scene != NULL, result == VIRGA_OK);
    virga_scene_destroy(&scene);
    return result;
}

/* The scene's own struct is right, the one inside it is not. */
static virga_result try_scene_rain(void *object, uint32_t size, uint32_t cookie)
{
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    def.rain = gpu_rain_def();
    def.rain.size += size;
    def.rain.cookie ^= cookie;
    const virga_result result = virga_scene_create(object, &def, &scene);
    assert_int_equal(scene != NULL, result == VIRGA_OK);
    virga_scene_destroy(&scene);
    return result;
}

static virga_result try_settings(void *object, uint32_t size, uint32_t cookie)
{
    virga_rain_settings settings = virga_default_rain_settings();
    settings.size += size;
    settings.cookie ^= cookie;
    settings.rate_mm_h = 33;
    const virga_result result = virga_rain_set(object, &settings);
    virga_rain_get(object, &settings);
    assert_int_equal(settings.rate_mm_h == 33, result == VIRGA_OK);
    return result;
}

static void context_def_is_checked(void **state)
{
    check_struct(*state, try_context, *state);
}

static void target_def_is_checked(void **state)
{
    virga_context *context = gpu_context(*state);
    check_struct(*state, try_target, context);
    virga_context_destroy(&context);
}

/* Each is refused with one line that names it. */
static void attachments_of_motion_and_mask_are_checked(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    const struct {
        uint32_t motion, reactive;
        VkFormat format;
        const char *named;
    } rows[] = {
        {4, 0, VK_FORMAT_R16G16_SFLOAT, "motion_attachment"},
        {0, 4, VK_FORMAT_R16G16_SFLOAT, "reactive_attachment"},
        {2, 2, VK_FORMAT_R16G16_SFLOAT, "reactive_attachment"},
        {3, 0, VK_FORMAT_UNDEFINED, "color_formats[3]"},
        {0, 3, VK_FORMAT_R32_UINT, "color_formats[3]"}, /* which can not be blended */
        {3, 2, VK_FORMAT_R16G16_SFLOAT, NULL},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        virga_target_def def = virga_default_target_def();
        virga_target *target = NULL;
        def.kind = VIRGA_TARGET_DYNAMIC;
        def.depth_attached = false;
        def.color_count = 4;
        def.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
        def.color_formats[2] = VK_FORMAT_R8G8_UNORM;
        def.color_formats[3] = rows[i].format;
        def.motion_attachment = rows[i].motion;
        def.reactive_attachment = rows[i].reactive;
        gpu_forget_log(f);
        assert_int_equal(virga_target_create(context, &def, &target), rows[i].named ? VIRGA_ERROR_INVALID : VIRGA_OK);
        assert_int_equal(f->errors, rows[i].named ? 1 : 0);
        if (rows[i].named && !strstr(f->last, rows[i].named))
            fail_msg("'%s' does not name %s", f->last, rows[i].named);
        virga_target_destroy(&target);
    }
    virga_context_destroy(&context);
}

static void spoil_view(virga_view *view, uint32_t how)
{
    virga_temporal *t = &view->temporal;
    float *const numbers[] = {&t->motion_scale[0], &t->motion_scale[1], &t->motion_coverage,
                              &t->motion_coverage, &t->reactive_gain,   &t->clip_from_view[3]};
    const float wrong[] = {0, NAN, 0, 1.5f, -1, INFINITY};
    if (how < 6)
        *numbers[how] = wrong[how];
    else if (how == 6)
        t->frame_interval_s = -1;
    else
        t->position_m[1] = NAN;
}

static void views_with_a_wrong_past_are_refused(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context);
    gpu_picture picture;
    gpu_picture_open(f, context, &picture);
    VkCommandBuffer cmd = gpu_begin_frame(f, context);
    for (uint32_t how = 0; how < 8; how++) {
        virga_view view = gpu_view(&picture);
        spoil_view(&view, how);
        gpu_forget_log(f);
        assert_int_equal(virga_rain_prepare(rain, cmd, &view, 0), VIRGA_ERROR_INVALID);
        assert_int_equal(f->errors, 1);
        assert_non_null(strstr(f->last, "view.temporal."));
    }
    gpu_submit(f);
    gpu_wait(f);
    gpu_picture_close(f, &picture);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

static void rain_def_is_checked(void **state)
{
    virga_context *context = gpu_context(*state);
    check_struct(*state, try_rain, context);
    virga_context_destroy(&context);
}

static void scene_def_is_checked(void **state)
{
    virga_context *context = gpu_context(*state);
    check_struct(*state, try_scene, context);
    check_struct(*state, try_scene_rain, context);
    virga_context_destroy(&context);
}

static void rain_settings_are_checked(void **state)
{
    virga_context *context = gpu_context(*state);
    virga_rain *rain = gpu_rain(context);
    check_struct(*state, try_settings, rain);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

static void view_is_checked(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context);
    gpu_picture picture;
    gpu_picture_open(f, context, &picture);
    const VkCommandBuffer cmd = gpu_begin_frame(f, context);
    const virga_rain_step_info step = {.dt_s = 0.02};
    REQUIRE(virga_rain_step(rain, cmd, &step) == VIRGA_OK);
    virga_view wrong_size = gpu_view(&picture), wrong_cookie = wrong_size;
    wrong_size.size--;
    wrong_cookie.cookie ^= 1;
    gpu_forget_log(f);
    assert_int_equal(virga_rain_prepare(rain, cmd, &wrong_size, 0), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_COOKIE);
    gpu_forget_log(f);
    assert_int_equal(virga_rain_prepare(rain, cmd, &wrong_cookie, 0), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_COOKIE);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&rain);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(context_def_is_checked),
        gpu_kept_test(target_def_is_checked),
        gpu_kept_test(attachments_of_motion_and_mask_are_checked),
        gpu_kept_test(views_with_a_wrong_past_are_refused),
        gpu_kept_test(rain_def_is_checked),
        gpu_kept_test(scene_def_is_checked),
        gpu_kept_test(rain_settings_are_checked),
        gpu_kept_test(view_is_checked),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
