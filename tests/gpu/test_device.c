/* test_device.c - taking a device into use: what it must have, and what is said where it has it not. */
#include "gpu_fixture.h"

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
    def.wide_lines = false;
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
    assert_int_equal(f->gpu.device.instance->messages, 0);
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

static void lie_lines(VkPhysicalDeviceFeatures2 *features)
{
    features->features.wideLines = VK_FALSE;
}

/* It cannot have been made with them. */
static void wide_lines_that_a_device_lacks_are_refused(void **state)
{
    gpu_fixture *f = *state;
    watch.lie_features = lie_lines;
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    def.wide_lines = true;
    gpu_forget_log(f);
    assert_int_equal(virga_context_create(&def, &context), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_ARGUMENT);
    assert_non_null(strstr(f->last, "wide_lines"));
    def.wide_lines = false;
    assert_int_equal(virga_context_create(&def, &context), VIRGA_OK);
    virga_context_destroy(&context);
}

/* The context's log line names the variants of passes, and that they were demanded. */
static void check_variants(gpu_fixture *f, virga_pass_variants variants, const char *expected)
{
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    def.variants = variants;
    gpu_forget_log(f);
    assert_int_equal(virga_context_create(&def, &context), VIRGA_OK);
    if (!strstr(f->last, expected))
        fail_msg("expected '%s' in '%s'", expected, f->last);
    virga_context_destroy(&context);
}

static void variants_of_passes_are_named_in_the_log(void **state)
{
    gpu_fixture *f = *state;
    const bool software = f->gpu.device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    check_variants(f, VIRGA_VARIANTS_OF_DEVICE, software ? "passes for software Vulkan, 3" : "passes for a GPU, 3");
    check_variants(f, VIRGA_VARIANTS_SOFTWARE, "passes for software Vulkan as demanded, 3");
    check_variants(f, VIRGA_VARIANTS_GPU, "passes for a GPU as demanded, 3");
}

static void variants_that_do_not_exist_are_refused(void **state)
{
    gpu_fixture *f = *state;
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    def.variants = (virga_pass_variants)3;
    gpu_forget_log(f);
    assert_int_equal(virga_context_create(&def, &context), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_ARGUMENT);
    assert_non_null(strstr(f->last, "variants: there is no 3"));
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
    check_refusal(*state, "apiVersion to 1.2", VIRGA_LOG_FUNCTION_MISSING);
}

/* Loaders give its functions, and drivers then tell of no feature: the instance is to blame, and not the device. */
static void instance_of_vulkan_1_0_is_named(void **state)
{
    const VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                           .apiVersion = VK_API_VERSION_1_0};
    const VkInstanceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                       .pApplicationInfo = &application};
    VkPhysicalDevice devices[8];
    uint32_t count = 8;
    VkInstance instance;
    char reason[256] = "";
    (void)state;
    REQUIRE(vkCreateInstance(&info, NULL, &instance) == VK_SUCCESS);
    REQUIRE(vkEnumeratePhysicalDevices(instance, &count, devices) >= 0 && count);
    assert_int_equal(virga_check_device(vkGetInstanceProcAddr, instance, devices[0], reason, sizeof reason),
                     VIRGA_ERROR_UNSUPPORTED);
    if (!strstr(reason, "apiVersion to 1.2"))
        fail_msg("no word of the instance in the reason: %s", reason);
    vkDestroyInstance(instance, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(required_features_are_enough_for_every_pipeline),
        gpu_test(required_features_are_data),
        gpu_test(enable_features_sets_the_listed_flags_alone),
        gpu_test(enable_features_refuses_a_chain_that_lacks_a_struct),
        gpu_test(device_that_is_as_it_should_be_is_taken),
        gpu_test(old_device_is_refused),
        gpu_test(device_with_small_workgroups_is_refused),
        gpu_test(device_with_few_storage_buffers_is_refused),
        gpu_test(device_without_a_required_feature_is_refused),
        gpu_test(wide_lines_that_a_device_lacks_are_refused),
        gpu_test(variants_of_passes_are_named_in_the_log),
        gpu_test(variants_that_do_not_exist_are_refused),
        gpu_test(device_without_a_format_is_refused),
        gpu_test(instance_without_a_function_is_refused),
        gpu_test(instance_of_vulkan_1_0_is_named),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
