/* test_scene_multiview.c - passes of several views: each effect's layers are, byte for byte, what passes of one view
 * show; and what such a pass lacks is an error. */
#include "layered_pass.h"
#include "views_fixture.h"

#include <dlfcn.h>

#define FORMAT VK_FORMAT_R32G32B32A32_SFLOAT

enum { EYES = 2, LAYER = SIDE * SIDE * 4 }; /* floats of a layer */

/* Replaces the loader's: tools/host does not enable what it does not use. */
VKAPI_ATTR VkResult VKAPI_CALL vkCreateDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo *info,
                                              const VkAllocationCallbacks *allocator, VkDevice *device)
{
    PFN_vkCreateDevice create = NULL;
    void *symbol = dlsym(RTLD_NEXT, "vkCreateDevice");
    memcpy(&create, &symbol, sizeof create);
    VkPhysicalDeviceMultiviewFeatures feature = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES,
                                                 .pNext = (void *)(uintptr_t)info->pNext,
                                                 .multiview = VK_TRUE};
    VkDeviceCreateInfo more = *info;
    more.pNext = &feature;
    return create(physical, &more, allocator, device);
}

typedef enum drawn {
    RAIN,
    RAIN_PARTS,
    SPLASH,
    GLASS,
    REFRACTION,
    WATER,
    WATER_DATA,
    FOAM,
    WET,
    HAZE,
    LENS,
    LENS_PART,
    DRAWN
} drawn;
static const char *const names[DRAWN] = {"rain",       "parts of rain", "splash",     "glass",
                                         "refraction", "water",         "water data", "foam",
                                         "wet ground", "haze",          "lens",       "scene of lens"};

typedef struct stereo {
    views_run run;
    virga_lens *lens;
    host_image depth, color;
    layered_pass single, both;
    virga_target *single_target, *both_target;
    virga_prepared lens_views[EYES];
} stereo;

static virga_target *make_target(stereo *s, const layered_pass *pass)
{
    virga_target_def def = virga_default_target_def();
    virga_target *target = NULL;
    def.render_pass = pass->pass;
    def.depth_attached = false;
    def.view_mask = pass->view_mask;
    REQUIRE(virga_target_create(s->run.context, &def, &target) == VIRGA_OK);
    REQUIRE(virga_scene_attach(s->run.scene, target) == VIRGA_OK);
    REQUIRE(virga_lens_attach(s->lens, target) == VIRGA_OK);
    REQUIRE(virga_ground_attach(virga_scene_ground(s->run.scene), target) == VIRGA_OK);
    return target;
}

/* The ground, a metre below the cameras, and the sky; and a picture of one color. */
static void give_scene(stereo *s)
{
    static float depth[SIDE * SIDE];
    static uint8_t color[SIDE * SIDE][4];
    static const uint8_t texel[4] = {200, 90, 40, 255};
    fixture *gpu = &s->run.f->gpu;
    for (int i = 0; i < SIDE * SIDE; i++)
        memcpy(color[i], texel, sizeof texel);
    host_parts_depth(SIDE, depth);
    const virga_image seen = host_parts_picture(gpu, VK_FORMAT_R32_SFLOAT, SIDE, depth, &s->depth);
    const virga_image behind = host_parts_picture(gpu, VK_FORMAT_R8G8B8A8_UNORM, SIDE, color, &s->color);
    for (int i = 0; i < EYES; i++) {
        s->run.views[i].depth = seen;
        s->run.views[i].color = behind;
    }
}

/* Its particles come nearer to each other, which traps air. */
static void make_foam(stereo *s)
{
    virga_water_settings settings;
    virga_water *water = virga_scene_water(s->run.scene);
    virga_water_get(water, &settings);
    settings.foam_air_hz = 1e5f;
    settings.foam_radius_m = 0.01f;
    settings.spray_density = 0;
    REQUIRE(virga_water_set(water, &settings) == VIRGA_OK);
}

static void open_stereo(stereo *s, gpu_fixture *f)
{
    virga_lens_def lens = virga_default_lens_def();
    memset(s, 0, sizeof *s);
    open_run(&s->run, f, EYES);
    lens.max_width = lens.max_height = SIDE;
    lens.max_views = EYES;
    REQUIRE(virga_lens_create(s->run.context, &lens, &s->lens) == VIRGA_OK);
    layered_pass_open(&s->single, &f->gpu, FORMAT, 16, SIDE, SIDE, 1, 0);
    layered_pass_open(&s->both, &f->gpu, FORMAT, 16, SIDE, SIDE, EYES, (1 << EYES) - 1);
    s->single_target = make_target(s, &s->single);
    s->both_target = make_target(s, &s->both);
    give_scene(s);
    make_foam(s);
    for (uint32_t i = 0; i < EYES; i++) {
        virga_view *view = &s->run.views[i];
        view->viewport[0] = 0;
        view->position_m[0] = view->open_position_m[0] = 0.06 * i - 0.03;
        view->multiview_index = i;
    }
    play(&s->run);
}

static void close_stereo(stereo *s)
{
    host_device *device = &s->run.f->gpu.device;
    virga_lens_destroy(&s->lens);
    virga_target_destroy(&s->single_target);
    virga_target_destroy(&s->both_target);
    layered_pass_close(&s->single);
    layered_pass_close(&s->both);
    host_image_destroy(device, &s->depth);
    host_image_destroy(device, &s->color);
    close_run(&s->run);
}

/* What belongs to one eye, from the views of one prepare of all. */
static virga_result draw_eye(stereo *s, VkCommandBuffer cmd, const virga_target *target, drawn what, uint32_t eye,
                             const virga_prepared *prepared)
{
    virga_scene *scene = s->run.scene;
    const virga_ground_wet wet = virga_default_ground_wet();
    switch (what) {
    case RAIN_PARTS:
        return virga_rain_draw_parts_view(virga_scene_rain(scene), cmd, target, prepared[RAIN], VIRGA_RAIN_STREAKS);
    case FOAM: return virga_water_draw_foam_view(virga_scene_water(scene), cmd, target, prepared[WATER]);
    case WET: return virga_ground_draw_wet(virga_scene_ground(scene), cmd, &s->run.views[eye], &wet, target);
    case LENS_PART: return virga_lens_draw_part_view(s->lens, cmd, target, prepared[LENS], 0);
    case RAIN: return virga_rain_draw_view(virga_scene_rain(scene), cmd, target, prepared[RAIN]);
    case SPLASH: return virga_splash_draw_view(virga_scene_splash(scene), cmd, target, prepared[SPLASH]);
    case GLASS: return virga_glass_draw_view(virga_scene_glass(scene, 0), cmd, target, prepared[GLASS]);
    case REFRACTION: return virga_glass_draw_refraction_view(virga_scene_glass(scene, 0), cmd, target, prepared[GLASS]);
    case WATER: return virga_water_draw_view(virga_scene_water(scene), cmd, target, prepared[WATER]);
    case WATER_DATA:
        return virga_water_draw_data_view(virga_scene_water(scene), cmd, target, prepared[WATER],
                                          VIRGA_WATER_DATA_THICKNESS);
    case HAZE: return virga_rain_draw_haze(virga_scene_rain(scene), cmd, &s->run.views[eye], NULL, target);
    default: return virga_lens_draw_view(s->lens, cmd, target, prepared[LENS]);
    }
}

static void prepare_eye(stereo *s, VkCommandBuffer cmd, uint32_t eye, virga_prepared *prepared)
{
    const virga_view *view = &s->run.views[eye];
    virga_rain *rain = virga_scene_rain(s->run.scene);
    const virga_glass_pose pose = {.position_m = {-0.1, 1, -0.3}};
    const double time_s = virga_rain_time(rain);
    virga_glass *glass = virga_scene_glass(s->run.scene, 0);
    assert_int_equal(virga_rain_prepare_view(rain, cmd, view, time_s, &prepared[RAIN]), VIRGA_OK);
    assert_int_equal(virga_splash_prepare_view(virga_scene_splash(s->run.scene), cmd, view, time_s, &prepared[SPLASH]),
                     VIRGA_OK);
    assert_int_equal(virga_glass_prepare_view(glass, cmd, view, &pose, virga_glass_time(glass), &prepared[GLASS]),
                     VIRGA_OK);
    assert_int_equal(virga_water_prepare_view(virga_scene_water(s->run.scene), cmd, view, &prepared[WATER]), VIRGA_OK);
    assert_int_equal(virga_lens_prepare_view(s->lens, cmd, view, NULL, 0, time_s, &prepared[LENS]), VIRGA_OK);
}

/* Draws the eyes from `first` on, `count` of them, in one pass. */
static const float *draw_pass(stereo *s, const layered_pass *pass, const virga_target *target, drawn what,
                              uint32_t first, uint32_t count)
{
    virga_prepared prepared[EYES][DRAWN];
    VkCommandBuffer cmd = gpu_begin_frame(s->run.f, s->run.context);
    assert_int_equal(record(&s->run, cmd, 0, 0, 0), VIRGA_OK);
    for (uint32_t eye = 0; eye < EYES; eye++)
        prepare_eye(s, cmd, eye, prepared[eye]);
    layered_pass_begin(pass, cmd, 0);
    for (uint32_t eye = first; eye < first + count; eye++)
        assert_int_equal(draw_eye(s, cmd, target, what, eye, prepared[eye]), VIRGA_OK);
    layered_pass_end(pass, cmd);
    gpu_submit(s->run.f);
    gpu_wait(s->run.f);
    return layered_pass_pixels(pass);
}

static uint32_t count_lit(const float *layer)
{
    uint32_t lit = 0;
    for (uint32_t i = 0; i < LAYER; i += 4)
        lit += layer[i] != 0 || layer[i + 1] != 0 || layer[i + 3] != 0;
    return lit;
}

static void layers_of_one_pass_are_as_passes_of_one_view(void **state)
{
    static float alone[EYES][LAYER];
    static stereo s;
    open_stereo(&s, *state);
    for (drawn what = RAIN; what < DRAWN; what++) {
        for (uint32_t eye = 0; eye < EYES; eye++)
            memcpy(alone[eye], draw_pass(&s, &s.single, s.single_target, what, eye, 1), sizeof alone[eye]);
        const float *both = draw_pass(&s, &s.both, s.both_target, what, 0, EYES);
        printf("%s: %u and %u pixels\n", names[what], count_lit(alone[0]), count_lit(alone[1]));
        assert_true(count_lit(alone[0]) > 0 && count_lit(alone[1]) > 0);
        for (uint32_t eye = 0; eye < EYES; eye++)
            assert_memory_equal(&both[eye * LAYER], alone[eye], sizeof alone[eye]);
        /* Depth and color are the same for both eyes. */
        const bool even = what == HAZE || what == LENS || what == LENS_PART;
        assert_int_equal(!memcmp(alone[0], alone[1], sizeof alone[0]), even);
    }
    assert_int_equal(s.run.f->errors, 0);
    close_stereo(&s);
}

/* ---- mistakes */

static void draws_of_a_view_that_the_pass_lacks_are_refused(void **state)
{
    static stereo s;
    virga_prepared prepared[DRAWN];
    open_stereo(&s, *state);
    s.run.views[0].multiview_index = EYES;
    VkCommandBuffer cmd = gpu_begin_frame(s.run.f, s.run.context);
    assert_int_equal(record(&s.run, cmd, 0, 0, 0), VIRGA_OK);
    prepare_eye(&s, cmd, 0, prepared);
    layered_pass_begin(&s.both, cmd, 0);
    for (drawn what = RAIN; what < DRAWN; what++) {
        gpu_forget_log(s.run.f);
        assert_int_equal(draw_eye(&s, cmd, s.both_target, what, 0, prepared), VIRGA_ERROR_INVALID);
        assert_one_error(s.run.f, VIRGA_LOG_ARGUMENT);
        assert_non_null(strstr(s.run.f->last, "view_mask"));
    }
    layered_pass_end(&s.both, cmd);
    gpu_submit(s.run.f);
    gpu_wait(s.run.f);
    close_stereo(&s);
}

static VKAPI_ATTR void VKAPI_CALL features_without_multiview(VkPhysicalDevice device, VkPhysicalDeviceFeatures2 *all)
{
    vkGetPhysicalDeviceFeatures2(device, all);
    for (VkBaseOutStructure *at = all->pNext; at; at = at->pNext)
        if (at->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MULTIVIEW_FEATURES)
            ((VkPhysicalDeviceMultiviewFeatures *)(void *)at)->multiview = VK_FALSE;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL find_without_multiview(VkInstance instance, const char *name)
{
    return strcmp(name, "vkGetPhysicalDeviceFeatures2") ? watch_get_instance_proc_addr(instance, name)
                                                        : (PFN_vkVoidFunction)features_without_multiview;
}

static void expect(gpu_fixture *f, virga_context *context, const virga_target_def *def, virga_result expected,
                   const char *line)
{
    virga_target *target = NULL;
    gpu_forget_log(f);
    assert_int_equal(virga_target_create(context, def, &target), expected);
    assert_int_equal(f->errors, 1);
    if (!strstr(f->last, line))
        fail_msg("expected '%s' in: %s", line, f->last);
}

static void a_wrong_view_mask_and_a_device_without_multiview_are_told(void **state)
{
    gpu_fixture *f = *state;
    virga_context_def without = gpu_context_def(f);
    virga_context *context = gpu_context(f);
    const uint32_t mask = 3;
    const VkRenderPassMultiviewCreateInfo views = {
        .sType = VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO, .subpassCount = 1, .pViewMasks = &mask};
    const VkAttachmentDescription attachment = {.format = FORMAT, .samples = VK_SAMPLE_COUNT_1_BIT};
    const VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    const VkSubpassDescription subpass = {.colorAttachmentCount = 1, .pColorAttachments = &color};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .pNext = &views,
                                         .attachmentCount = 1,
                                         .pAttachments = &attachment,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    layered_pass pass;
    virga_target_def def = virga_default_target_def();
    layered_pass_open(&pass, &f->gpu, FORMAT, 16, 4, 4, 2, mask);
    def.render_pass = pass.pass;
    def.render_pass_info = &info;
    def.depth_attached = false;
    expect(f, context, &def, VIRGA_ERROR_INVALID, "view_mask: expected 0x3");
    def.render_pass_info = NULL;
    def.view_mask = 1u << 31;
    expect(f, context, &def, VIRGA_ERROR_INVALID, "view_mask: expected the bits of up to");
    virga_context_destroy(&context);
    without.get_instance_proc_addr = find_without_multiview;
    REQUIRE(virga_context_create(&without, &context) == VIRGA_OK);
    def.view_mask = mask;
    expect(f, context, &def, VIRGA_ERROR_UNSUPPORTED, "lacks the feature multiview");
    virga_context_destroy(&context);
    layered_pass_close(&pass);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_kept_test(layers_of_one_pass_are_as_passes_of_one_view),
        gpu_kept_test(draws_of_a_view_that_the_pass_lacks_are_refused),
        gpu_kept_test(a_wrong_view_mask_and_a_device_without_multiview_are_told),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("multiview", tests, NULL, NULL));
}
