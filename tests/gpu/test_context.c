/* test_context.c - taking a device into use: what it must have, what a host may get wrong, and what is left when the
 * device fails half-way. */
#include "gpu_fixture.h"

#include <math.h>

/* ---- create and destroy */

static void context_is_made_and_says_so(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_memory_stats stats;
    virga_memory_get(context, &stats);
    assert_int_equal(f->lines[VIRGA_LOG_CREATED], 1);
    assert_int_equal(f->errors, 0);
    assert_int_equal(stats.objects, watch_sum(watch.live));
    assert_int_equal(stats.device_bytes, 0);
    virga_context_destroy(&context);
    assert_null(context);
    assert_int_equal(watch_sum(watch.live), 0);
}

static void destroy_accepts_null(void **state)
{
    (void)state;
    virga_context *context = NULL;
    virga_target *target = NULL;
    virga_rain *rain = NULL;
    virga_scene *scene = NULL;
    virga_context_destroy(NULL);
    virga_context_destroy(&context);
    virga_target_destroy(NULL);
    virga_target_destroy(&target);
    virga_rain_destroy(NULL);
    virga_rain_destroy(&rain);
    virga_scene_destroy(NULL);
    virga_scene_destroy(&scene);
}

static void destroy_sets_handles_to_null(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context);
    gpu_picture picture;
    gpu_picture_open(f, context, &picture);
    virga_scene *scene = NULL;
    virga_scene_def def = virga_default_scene_def();
    def.rain = gpu_rain_def();
    REQUIRE(virga_scene_create(context, &def, &scene) == VIRGA_OK);
    virga_scene_destroy(&scene);
    assert_null(scene);
    virga_rain_destroy(&rain);
    assert_null(rain);
    virga_target_destroy(&picture.target);
    assert_null(picture.target);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
    assert_null(context);
}

static void two_contexts_live_side_by_side(void **state)
{
    gpu_fixture *f = *state;
    virga_context *first = gpu_context(f), *second = gpu_context(f);
    virga_rain *rain = gpu_rain(first), *other = gpu_rain(second);
    virga_rain_destroy(&rain);
    virga_context_destroy(&first);
    gpu_picture picture;
    gpu_picture_open(f, second, &picture);
    REQUIRE(virga_rain_attach(other, picture.target) == VIRGA_OK);
    gpu_record(gpu_begin_frame(f, second), other, &picture);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&other);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&second);
}

/* ---- what a device must have */

/* A device with what virga_enable_features asks for, and nothing else. */
static VkDevice bare_device(const gpu_fixture *f)
{
    VkPhysicalDeviceVulkan12Features features12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &features12};
    REQUIRE(virga_enable_features(&features) == VIRGA_OK);
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                           .queueFamilyIndex = f->gpu.device.queue_family,
                                           .queueCount = 1,
                                           .pQueuePriorities = &priority};
    const VkDeviceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                     .pNext = &features,
                                     .queueCreateInfoCount = 1,
                                     .pQueueCreateInfos = &queue};
    VkDevice device = VK_NULL_HANDLE;
    REQUIRE(vkCreateDevice(f->gpu.device.physical, &info, NULL, &device) == VK_SUCCESS);
    return device;
}

/* A pass with several colour attachments, of which Virga leaves all but the first alone. */
static VkRenderPass three_attachments(VkDevice device)
{
    VkAttachmentDescription attachments[3];
    VkAttachmentReference references[3];
    for (uint32_t i = 0; i < 3; i++) {
        attachments[i] = (VkAttachmentDescription){.format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                                   .samples = VK_SAMPLE_COUNT_1_BIT,
                                                   .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                                   .finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
        references[i] = (VkAttachmentReference){i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    }
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 3,
                                          .pColorAttachments = references};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 3,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    VkRenderPass pass = VK_NULL_HANDLE;
    REQUIRE(vkCreateRenderPass(device, &info, NULL, &pass) == VK_SUCCESS);
    return pass;
}

/* Validation names a feature that a shader or a pipeline uses and the device was not made with. */
static void required_features_are_enough_for_every_pipeline(void **state)
{
    gpu_fixture *f = *state;
    const VkDevice device = bare_device(f);
    virga_context_def def = gpu_context_def(f);
    def.device = device;
    virga_context *context = NULL;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    virga_rain *rain = gpu_rain(context);
    const VkRenderPass pass = three_attachments(device);
    virga_target_def target_def = virga_default_target_def();
    target_def.render_pass = pass;
    target_def.color_count = 3;
    target_def.depth_attached = false;
    virga_target *target = NULL;
    REQUIRE(virga_target_create(context, &target_def, &target) == VIRGA_OK);
    assert_int_equal(virga_rain_attach(rain, target), VIRGA_OK);
    virga_rain_destroy(&rain);
    virga_target_destroy(&target);
    virga_context_destroy(&context);
    vkDestroyRenderPass(device, pass, NULL);
    vkDestroyDevice(device, NULL);
    assert_int_equal(f->gpu.instance.messages, 0);
}

/* Features that are data lie within their structs, and are booleans that a device knows. */
static void required_features_are_data(void **state)
{
    gpu_fixture *f = *state;
    VkPhysicalDeviceVulkan12Features there12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 there = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &there12};
    vkGetPhysicalDeviceFeatures2(f->gpu.device.physical, &there);
    uint32_t count = 0;
    const virga_feature *features = virga_required_features(&count);
    assert_true(count > 0);
    for (uint32_t i = 0; i < count; i++) {
        const bool core = features[i].struct_type == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
        assert_true(core || features[i].struct_type == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
        const size_t size = core ? sizeof there : sizeof there12;
        assert_true(features[i].offset >= offsetof(VkPhysicalDeviceFeatures2, features));
        assert_true(features[i].offset + sizeof(VkBool32) <= size);
        assert_true(strlen(features[i].name) > 0 && strlen(features[i].why) > 0);
        const char *flags = core ? (const char *)&there : (const char *)&there12;
        VkBool32 flag;
        memcpy(&flag, flags + features[i].offset, sizeof flag);
        assert_int_equal(flag, VK_TRUE);
    }
}

/* The flags that are set are the listed ones; each of the others stays as the host had it. */
static void enable_features_sets_the_listed_flags_alone(void **state)
{
    (void)state;
    VkPhysicalDeviceVulkan12Features set12 = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 set = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &set12};
    VkPhysicalDeviceVulkan12Features expected12 = set12;
    VkPhysicalDeviceFeatures2 expected = set;
    uint32_t count = 0;
    const virga_feature *features = virga_required_features(&count);
    const VkBool32 on = VK_TRUE;
    for (uint32_t i = 0; i < count; i++) {
        const bool core = features[i].struct_type == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
        memcpy((core ? (char *)&expected : (char *)&expected12) + features[i].offset, &on, sizeof on);
    }
    assert_int_equal(virga_enable_features(&set), VIRGA_OK);
    assert_memory_equal(&set, &expected, sizeof set);
    assert_memory_equal(&set12, &expected12, sizeof set12);
}

static void enable_features_refuses_a_chain_that_lacks_a_struct(void **state)
{
    (void)state;
    VkPhysicalDeviceFeatures2 set = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    const VkPhysicalDeviceFeatures2 before = set;
    assert_int_equal(virga_enable_features(&set), VIRGA_ERROR_INVALID);
    assert_memory_equal(&set, &before, sizeof set);
    assert_int_equal(virga_enable_features(NULL), VIRGA_ERROR_INVALID);
}

/* ---- devices that are refused */

static void lie_version(VkPhysicalDeviceProperties *properties)
{
    properties->apiVersion = VK_API_VERSION_1_1;
}

static void lie_invocations(VkPhysicalDeviceProperties *properties)
{
    properties->limits.maxComputeWorkGroupInvocations = 128;
}

static void lie_group_size(VkPhysicalDeviceProperties *properties)
{
    properties->limits.maxComputeWorkGroupSize[0] = 128;
}

/* Vulkan promises four storage buffers to a stage; rain's passes see ten. */
static void lie_storage_buffers(VkPhysicalDeviceProperties *properties)
{
    properties->limits.maxPerStageDescriptorStorageBuffers = 4;
}

static const virga_feature *lie_feature; /* that the device has not */

static void lie_features(VkPhysicalDeviceFeatures2 *features)
{
    const VkBool32 off = VK_FALSE;
    for (VkBaseOutStructure *at = (VkBaseOutStructure *)features; at; at = at->pNext)
        if (at->sType == lie_feature->struct_type)
            memcpy((char *)at + lie_feature->offset, &off, sizeof off);
}

static VkFormat lie_format_name; /* that cannot be drawn into */

static void lie_format(VkFormat format, VkFormatProperties *properties)
{
    if (format == lie_format_name)
        properties->optimalTilingFeatures &= ~(VkFormatFeatureFlags)(VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                                                     VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT);
}

/* The device as it is lied about now is refused, by check and by create, with a reason that has `word` in it. */
static void check_refusal(gpu_fixture *f, const char *word, virga_log_id id)
{
    char reason[256] = "", small[8];
    assert_int_equal(virga_check_device(watch_get_instance_proc_addr, f->gpu.instance.instance, f->gpu.device.physical,
                                        reason, sizeof reason),
                     VIRGA_ERROR_UNSUPPORTED);
    if (!strstr(reason, word))
        fail_msg("no word of %s in the reason: %s", word, reason);
    assert_null(strchr(reason, '\n'));

    memset(small, '#', sizeof small);
    assert_int_equal(virga_check_device(watch_get_instance_proc_addr, f->gpu.instance.instance, f->gpu.device.physical,
                                        small, sizeof small - 1),
                     VIRGA_ERROR_UNSUPPORTED);
    assert_int_equal(small[6], 0);
    assert_int_equal(small[7], '#');
    assert_int_equal(
        virga_check_device(watch_get_instance_proc_addr, f->gpu.instance.instance, f->gpu.device.physical, NULL, 0),
        VIRGA_ERROR_UNSUPPORTED);

    const virga_context_def def = gpu_context_def(f);
    virga_context *context = (virga_context *)f;
    gpu_forget_log(f);
    assert_int_equal(virga_context_create(&def, &context), VIRGA_ERROR_UNSUPPORTED);
    assert_null(context);
    assert_one_error(f, id);
    if (!strstr(f->last, word))
        fail_msg("no word of %s in the log: %s", word, f->last);
    assert_int_equal(watch_sum(watch.live), 0);
}

static void device_that_is_as_it_should_be_is_taken(void **state)
{
    gpu_fixture *f = *state;
    char reason[64] = "untouched";
    assert_int_equal(virga_check_device(watch_get_instance_proc_addr, f->gpu.instance.instance, f->gpu.device.physical,
                                        reason, sizeof reason),
                     VIRGA_OK);
    assert_int_equal(watch_sum(watch.made), 0);
    assert_int_equal(virga_check_device(NULL, f->gpu.instance.instance, f->gpu.device.physical, NULL, 0),
                     VIRGA_ERROR_INVALID);
}

static void old_device_is_refused(void **state)
{
    watch.lie_properties = lie_version;
    check_refusal(*state, "1.1", VIRGA_LOG_FEATURE_MISSING);
}

static void device_with_small_workgroups_is_refused(void **state)
{
    watch.lie_properties = lie_invocations;
    check_refusal(*state, "256", VIRGA_LOG_FEATURE_MISSING);
    watch.lie_properties = lie_group_size;
    check_refusal(*state, "256", VIRGA_LOG_FEATURE_MISSING);
}

static void device_with_few_storage_buffers_is_refused(void **state)
{
    watch.lie_properties = lie_storage_buffers;
    check_refusal(*state, "storage buffers", VIRGA_LOG_FEATURE_MISSING);
}

static void device_without_a_required_feature_is_refused(void **state)
{
    uint32_t count = 0;
    const virga_feature *features = virga_required_features(&count);
    watch.lie_features = lie_features;
    for (uint32_t i = 0; i < count; i++) {
        lie_feature = &features[i];
        check_refusal(*state, features[i].name, VIRGA_LOG_FEATURE_MISSING);
    }
}

static void device_without_a_format_is_refused(void **state)
{
    watch.lie_format = lie_format;
    lie_format_name = VK_FORMAT_D32_SFLOAT;
    check_refusal(*state, "D32_SFLOAT", VIRGA_LOG_FEATURE_MISSING);
    lie_format_name = VK_FORMAT_R32_UINT;
    check_refusal(*state, "R32_UINT", VIRGA_LOG_FEATURE_MISSING);
}

static void instance_without_a_function_is_refused(void **state)
{
    watch.hidden = "vkGetPhysicalDeviceFeatures2";
    check_refusal(*state, "vkGetPhysicalDeviceFeatures2", VIRGA_LOG_FUNCTION_MISSING);
}

/* ---- structs that a default function did not fill */

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
        t->ago_s = -1;
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

static void wrong_context_arguments_are_refused(void **state)
{
    gpu_fixture *f = *state;
    const virga_context_def good = gpu_context_def(f);
    virga_context_def bad[8];
    for (int i = 0; i < 8; i++)
        bad[i] = good;
    bad[0].instance = VK_NULL_HANDLE;
    bad[1].physical_device = VK_NULL_HANDLE;
    bad[2].device = VK_NULL_HANDLE;
    bad[3].get_instance_proc_addr = NULL;
    bad[4].frames_in_flight = 0;
    bad[5].frames_in_flight = VIRGA_MAX_FRAMES_IN_FLIGHT + 1;
    bad[6].host_memory.alloc = (void *(*)(void *, size_t))(uintptr_t)8; /* without free */
    bad[7].device_memory.free = (void (*)(void *, const virga_memory_block *))(uintptr_t)8;
    for (int i = 0; i < 8; i++) {
        virga_context *context = (virga_context *)f;
        gpu_forget_log(f);
        assert_int_equal(virga_context_create(&bad[i], &context), VIRGA_ERROR_INVALID);
        assert_null(context);
        assert_one_error(f, VIRGA_LOG_ARGUMENT);
    }
    assert_int_equal(virga_context_create(&good, NULL), VIRGA_ERROR_INVALID);
    virga_context *context = (virga_context *)f;
    assert_int_equal(virga_context_create(NULL, &context), VIRGA_ERROR_INVALID);
    assert_null(context);
}

/* ---- frames */

static void step_before_the_first_frame_is_refused(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context);
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&f->gpu.device, &cmd, f->gpu.error, sizeof f->gpu.error));
    const virga_rain_step_info step = {.dt_s = 0.02};
    gpu_forget_log(f);
    assert_int_equal(virga_rain_step(rain, cmd, &step), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_ARGUMENT);
    assert_true(virga_rain_time(rain) == 0);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

/* Occlusion too records with what belongs to a frame: its timers and its place in the rings. */
static void occlusion_before_the_first_frame_is_refused(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context);
    const double camera[3] = {0, 0, 0};
    VkCommandBuffer cmd;
    REQUIRE(host_begin_frame(&f->gpu.device, &cmd, f->gpu.error, sizeof f->gpu.error));
    gpu_forget_log(f);
    assert_int_equal(virga_rain_occlusion(rain, cmd, camera, NULL, 0), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_ARGUMENT);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

/* begin refuses, says so once, and goes on as if it had not been called. */
static void check_refused_frame(gpu_fixture *f, virga_context *context, uint64_t frame, uint64_t completed)
{
    gpu_forget_log(f);
    if (virga_frame_begin(context, frame, completed) != VIRGA_ERROR_INVALID)
        fail_msg("frame %d with %d completed was taken", (int)frame, (int)completed);
    assert_one_error(f, VIRGA_LOG_FRAME_ORDER);
}

static void frames_rise_and_completed_stays_behind(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    check_refused_frame(f, context, 0, 0); /* indices start at 1 */
    check_refused_frame(f, context, 1, 1); /* complete before it was recorded */
    check_refused_frame(f, context, 1, 2);
    check_refused_frame(f, context, 4, 0); /* four frames in flight, of three */
    assert_int_equal(virga_frame_begin(context, 3, 0), VIRGA_OK);
    check_refused_frame(f, context, 3, 0); /* the same again */
    check_refused_frame(f, context, 2, 0); /* backwards */
    check_refused_frame(f, context, 4, 4);
    check_refused_frame(f, context, UINT64_MAX, 0);
    assert_int_equal(virga_frame_begin(context, 5, 3), VIRGA_OK);
    check_refused_frame(f, context, 6, 2);                           /* what was complete stays so */
    assert_int_equal(virga_frame_begin(context, 100, 97), VIRGA_OK); /* by any amount */
    assert_int_equal(virga_frame_begin(NULL, 1, 0), VIRGA_ERROR_INVALID);
    virga_context_destroy(&context);
}

/* ---- timings */

static VkPhysicalDeviceType lie_type_name;

static void lie_type(VkPhysicalDeviceProperties *properties)
{
    properties->deviceType = lie_type_name;
}

/* Barriers at which everything waits for everything in a frame of rain on such a device, and passes that were timed. */
static uint32_t full_barriers(gpu_fixture *f, VkPhysicalDeviceType type, bool timings, uint32_t *timed)
{
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    def.timings = timings;
    lie_type_name = type;
    watch.lie_properties = lie_type;
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    watch.lie_properties = NULL;
    virga_rain *rain = gpu_rain(context);
    gpu_picture picture;
    gpu_picture_open(f, context, &picture);
    REQUIRE(virga_rain_attach(rain, picture.target) == VIRGA_OK);
    watch.full_barriers = 0;
    gpu_record(gpu_begin_frame(f, context), rain, &picture);
    const uint32_t found = watch.full_barriers;
    gpu_submit(f);
    gpu_wait(f);
    REQUIRE(virga_frame_completed(context, f->gpu.device.completed) == VIRGA_OK);
    *timed = virga_timings_get(context, NULL, 0);
    virga_rain_destroy(&rain);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
    return found;
}

/* A GPU would drain at each, also where timings are on by default. */
static void passes_are_timed_one_by_one_on_processors_alone(void **state)
{
    gpu_fixture *f = *state;
    uint32_t on_processor = 0, on_gpu = 0, none = 0;
    assert_true(full_barriers(f, VK_PHYSICAL_DEVICE_TYPE_CPU, true, &on_processor) > 0);
    assert_int_equal(full_barriers(f, VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, true, &on_gpu), 0);
    assert_int_equal(full_barriers(f, VK_PHYSICAL_DEVICE_TYPE_CPU, false, &none), 0);
    assert_true(on_processor > 0);
    assert_int_equal(on_gpu, on_processor);
    assert_int_equal(none, 0);
}

/* A frame that was never begun cannot have completed, whatever comes after it. */
static void completed_does_not_pass_the_newest_frame(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    const uint64_t wrong[] = {3, 1, UINT64_MAX};
    assert_int_equal(virga_frame_completed(context, 0), VIRGA_OK);
    assert_int_equal(virga_frame_begin(context, 2, 0), VIRGA_OK);
    assert_int_equal(virga_frame_completed(context, 2), VIRGA_OK);
    for (int i = 0; i < 3; i++) {
        gpu_forget_log(f);
        assert_int_equal(virga_frame_completed(context, wrong[i]), VIRGA_ERROR_INVALID);
        assert_one_error(f, VIRGA_LOG_FRAME_ORDER);
    }
    assert_int_equal(virga_frame_completed(NULL, 1), VIRGA_ERROR_INVALID);
    virga_context_destroy(&context);
}

/* ---- a device that is lost */

static void lost_device_is_sticky_and_said_once(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = gpu_context(f);
    virga_rain *rain = gpu_rain(context), *other = NULL;
    virga_target *target = NULL;
    const virga_rain_def def = gpu_rain_def();
    virga_target_def target_def = virga_default_target_def();
    const VkCommandBuffer cmd = gpu_begin_frame(f, context);
    const virga_rain_step_info step = {.dt_s = 0.02};
    const double camera[3] = {0, 0, 0};
    const virga_view view = virga_default_view();
    size_t size = 0;
    gpu_forget_log(f);
    watch_fail(1, VK_ERROR_DEVICE_LOST);
    assert_int_equal(virga_rain_create(context, &def, &other), VIRGA_ERROR_DEVICE_LOST);
    assert_null(other);
    watch_fail(0, VK_SUCCESS);
    assert_int_equal(virga_rain_create(context, &def, &other), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_target_create(context, &target_def, &target), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_rain_occlusion(rain, cmd, camera, NULL, 0), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_rain_step(rain, cmd, &step), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_rain_prepare(rain, cmd, &view, 0), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_frame_begin(context, 100, 99), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_frame_completed(context, 1), VIRGA_ERROR_DEVICE_LOST);
    assert_int_equal(virga_pipeline_cache_get(context, &size, NULL), VIRGA_ERROR_DEVICE_LOST);
    assert_one_error(f, VIRGA_LOG_DEVICE_LOST);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(context_is_made_and_says_so),
        gpu_test(destroy_accepts_null),
        gpu_test(destroy_sets_handles_to_null),
        gpu_test(two_contexts_live_side_by_side),
        gpu_test(required_features_are_enough_for_every_pipeline),
        gpu_test(required_features_are_data),
        gpu_test(enable_features_sets_the_listed_flags_alone),
        gpu_test(enable_features_refuses_a_chain_that_lacks_a_struct),
        gpu_test(device_that_is_as_it_should_be_is_taken),
        gpu_test(old_device_is_refused),
        gpu_test(device_with_small_workgroups_is_refused),
        gpu_test(device_with_few_storage_buffers_is_refused),
        gpu_test(device_without_a_required_feature_is_refused),
        gpu_test(device_without_a_format_is_refused),
        gpu_test(instance_without_a_function_is_refused),
        gpu_test(context_def_is_checked),
        gpu_test(target_def_is_checked),
        gpu_test(attachments_of_motion_and_mask_are_checked),
        gpu_test(views_with_a_wrong_past_are_refused),
        gpu_test(rain_def_is_checked),
        gpu_test(scene_def_is_checked),
        gpu_test(rain_settings_are_checked),
        gpu_test(view_is_checked),
        gpu_test(wrong_context_arguments_are_refused),
        gpu_test(step_before_the_first_frame_is_refused),
        gpu_test(occlusion_before_the_first_frame_is_refused),
        gpu_test(frames_rise_and_completed_stays_behind),
        gpu_test(completed_does_not_pass_the_newest_frame),
        gpu_test(passes_are_timed_one_by_one_on_processors_alone),
        gpu_test(lost_device_is_sticky_and_said_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
