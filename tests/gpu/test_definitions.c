/* test_definitions.c - every field of every definition, one at a time, with valid and with invalid numbers. Nothing is
 * built: the first call of Vulkan after the checks fails. */
#include "fields.h"
#include "small_scene.h"

typedef struct defined {
    gpu_fixture *f;
    virga_context *context;
} defined;

#define SIZE(table) (sizeof(table) / sizeof(table)[0])

/* A definition that got as far as the device was taken; where it was changed before, it said so. */
static virga_result checked(gpu_fixture *f, virga_result result)
{
    const bool refused_by_device = result == VIRGA_ERROR_DEVICE_MEMORY || result == VIRGA_ERROR_UNSUPPORTED;
    if (!refused_by_device)
        return result;
    f->lines[result == VIRGA_ERROR_UNSUPPORTED ? VIRGA_LOG_FEATURE_MISSING : VIRGA_LOG_VULKAN_CALL]--;
    return f->lines[VIRGA_LOG_CLAMPED] ? VIRGA_DEGRADED : VIRGA_OK;
}

#define CALL(effect)                                                                 \
    static virga_result create_##effect(void *user, const void *def)                 \
    {                                                                                \
        defined *d = user;                                                           \
        virga_##effect *made = NULL;                                                 \
        watch_fail(1, VK_ERROR_OUT_OF_DEVICE_MEMORY);                                \
        const virga_result result = virga_##effect##_create(d->context, def, &made); \
        watch_fail(0, VK_SUCCESS);                                                   \
        assert_null(made);                                                           \
        if (result == VIRGA_ERROR_INVALID)                                           \
            assert_true(virga_##effect##_estimate(def) == 0);                        \
        return checked(d->f, result);                                                \
    }
CALL(rain)
CALL(ground)
CALL(splash)
CALL(glass)
#undef CALL

static void check(void **state, const char *name, const void *good, size_t size, const field *fields, uint32_t count,
                  virga_result (*create)(void *user, const void *def))
{
    defined d = {*state, gpu_context(*state)};
    const field_table table = {name, good, size, fields, count, create, NULL, &d};
    fields_try(d.f, &table);
    virga_context_destroy(&d.context);
}

#define F(member, rule, low, high) FIELD(virga_rain_def, member, rule, low, high)
static void rain_def_fields(void **state)
{
    static const field fields[] = {
        F(max_drops, CLAMPED, 1024, 4194304),
        F(range_m, CLAMPED, 4, 512),
        F(max_impacts, CLAMPED, 256, 4194240),
        F(max_streaks, CLAMPED_BUT_0, 256, 4194304),
        F(max_ticks_per_step, CLAMPED, 1, 64),
        F(tick_s, CLAMPED, 1e-3, 0.05),
        F(occlusion_size, CLAMPED_BUT_0, 64, 8192),
        F(occlusion_cascades, CLAMPED, 1, 4),
        F(occlusion_slants, CLAMPED, 1, 4),
        F(max_panes, CLAMPED, 0, 8),
        F(seed, REFUSED, 0, UINT32_MAX),
    };
    const virga_rain_def good = small_rain_def();
    check(state, "rain_def", &good, sizeof good, fields, SIZE(fields), create_rain);
}
#undef F

#define F(member, rule, low, high) FIELD(virga_ground_def, member, rule, low, high)
static void ground_def_fields(void **state)
{
    static const field fields[] = {
        F(cells, CLAMPED, 128, 4096),
        F(cell_m, CLAMPED, 0.01, 0.1),
        F(cached_tiles, CLAMPED, 0, 60000),
        F(far_cells, CLAMPED, 0, 2048),
        F(ripple_texels, CLAMPED, 64, 4096),
        F(ripple_texel_m, CLAMPED, 0.002, 0.05),
        F(tick_s, CLAMPED, 1e-3, 0.05),
        F(flow_ticks, CLAMPED, 1, 60),
        F(max_impacts, CLAMPED, 256, 4194240),
        F(max_spawns, CLAMPED, 0, 1048576),
        F(max_returned_droplets, CLAMPED, 0, 4194240),
        F(max_ticks_per_step, CLAMPED, 1, 64),
    };
    const virga_ground_def good = small_ground_def();
    check(state, "ground_def", &good, sizeof good, fields, SIZE(fields), create_ground);
}
#undef F

#define F(member, rule, low, high) FIELD(virga_splash_def, member, rule, low, high)
static void splash_def_fields(void **state)
{
    static const field fields[] = {
        F(max_splashes, CLAMPED, 256, 1048576),
        F(max_spawns, CLAMPED, 256, 1048576),
        F(max_returned_droplets, CLAMPED, 256, 4194240),
        F(max_ticks_per_step, CLAMPED, 1, 64),
        F(tick_s, CLAMPED, 1e-3, 0.05),
    };
    virga_splash_def good = small_splash_def();
    check(state, "splash_def", &good, sizeof good, fields, 1, create_splash);
    good.max_returned_droplets = 1048576; /* no less than spawns */
    check(state, "splash_def", &good, sizeof good, fields + 1, 1, create_splash);
    good.max_returned_droplets = 256;
    check(state, "splash_def", &good, sizeof good, fields + 2, SIZE(fields) - 2, create_splash);
}
#undef F

#define F(member, rule, low, high) FIELD(virga_glass_def, member, rule, low, high)
static void glass_def_fields(void **state)
{
    static const field fields[] = {
        F(width_m, CLAMPED, 0.01, 10),
        F(height_m, CLAMPED, 0.01, 10),
        F(cell_m, CLAMPED, 0.0005, 0.01),
        F(max_drops, CLAMPED, 256, 262144),
        F(affinity_size_m, CLAMPED, 0.0005, 0.1),
        F(max_texels, CLAMPED, 64, 4096),
        F(texture_columns, CLAMPED, 2, 32),
        F(texture_rows, CLAMPED, 2, 32),
        F(texture_texels, CLAMPED, 8, 64),
        F(max_ticks_per_step, CLAMPED, 1, 64),
        F(tick_s, CLAMPED, 1e-3, 0.05),
    };
    const virga_glass_def good = small_glass_def();
    check(state, "glass_def", &good, sizeof good, fields, SIZE(fields), create_glass);
}
#undef F

static virga_result create_context(void *user, const void *def)
{
    const defined *d = user;
    virga_context *context = (virga_context *)user;
    const virga_result result = virga_context_create(def, &context);
    assert_int_equal(context != NULL, result == VIRGA_OK);
    virga_context_destroy(&context);
    (void)d;
    return result;
}

/* How many of the device's families of queues, from the first on, have both graphics and compute. */
static uint32_t leading_families(VkPhysicalDevice device)
{
    const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[64];
    uint32_t count = 64, leading = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families);
    while (leading < count && (families[leading].queueFlags & both) == both)
        leading++;
    return leading;
}

#define F(member, rule, low, high) FIELD(virga_context_def, member, rule, low, high)
static void context_def_fields(void **state)
{
    defined d = {*state, NULL};
    const virga_context_def good = gpu_context_def(d.f);
    const field fields[] = {F(frames_in_flight, REFUSED, 1, VIRGA_MAX_FRAMES_IN_FLIGHT),
                            F(queue_family, REFUSED, 0, leading_families(good.physical_device) - 1)};
    const field_table table = {"context_def", &good, sizeof good, fields, SIZE(fields), create_context, NULL, &d};
    fields_try(d.f, &table);
}
#undef F

static virga_result create_target(void *user, const void *def)
{
    const defined *d = user;
    virga_target *target = (virga_target *)user;
    const virga_result result = virga_target_create(d->context, def, &target);
    assert_int_equal(target != NULL, result == VIRGA_OK);
    virga_target_destroy(&target);
    return result;
}

#define F(member, rule, low, high) FIELD(virga_target_def, member, rule, low, high)
static void target_def_fields(void **state)
{
    static const field fields[] = {F(color_count, REFUSED, 1, 8), F(kind, REFUSED, 1, 1)}; /* 0 lacks a render pass */
    virga_target_def good = virga_default_target_def();
    good.kind = VIRGA_TARGET_DYNAMIC;
    good.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
    good.depth_attached = false;
    check(state, "target_def", &good, sizeof good, fields, SIZE(fields), create_target);
    static const uint32_t samples[][2] = {{1, 1}, {2, 1}, {64, 1}, {0, 0}, {3, 0}, {128, 0}, {UINT32_MAX, 0}};
    defined d = {*state, gpu_context(*state)};
    for (size_t i = 0; i < SIZE(samples); i++) {
        good.samples = (VkSampleCountFlagBits)samples[i][0];
        gpu_forget_log(d.f);
        assert_int_equal(create_target(&d, &good), samples[i][1] ? VIRGA_OK : VIRGA_ERROR_INVALID);
        assert_int_equal(field_lines(d.f), !samples[i][1]);
    }
    virga_context_destroy(&d.context);
}
#undef F

/* What cannot be blended, and depth that is none, is no target: few drivers say so. */
static void formats_are_checked(void **state)
{
    static const VkFormat wrong[][2] = {{VK_FORMAT_R8G8B8A8_UINT, VK_FORMAT_UNDEFINED},
                                        {VK_FORMAT_D32_SFLOAT, VK_FORMAT_UNDEFINED},
                                        {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R8_UNORM}};
    defined d = {*state, gpu_context(*state)};
    for (size_t i = 0; i < SIZE(wrong); i++) {
        virga_target_def def = virga_default_target_def();
        def.kind = VIRGA_TARGET_DYNAMIC;
        def.color_formats[0] = wrong[i][0];
        def.depth_format = wrong[i][1];
        def.depth_attached = def.depth_format != VK_FORMAT_UNDEFINED;
        gpu_forget_log(d.f);
        assert_int_equal(create_target(&d, &def), VIRGA_ERROR_INVALID);
        assert_one_error(d.f, VIRGA_LOG_ARGUMENT);
    }
    virga_context_destroy(&d.context);
}

/* Strides of vertices: whole floats, from a position on, and no wider than the device reads. */
static void strides_are_checked(void **state)
{
    static const uint32_t strides[][2] = {{0, 1},  {12, 1}, {2048, 1}, {1, 0},
                                          {11, 0}, {13, 0}, {8, 0},    {UINT32_MAX, 0}};
    defined d = {*state, gpu_context(*state)};
    for (size_t i = 0; i < SIZE(strides); i++) {
        virga_rain_def rain = small_rain_def();
        virga_ground_def ground = small_ground_def();
        rain.occluder_strides[3] = ground.occluder_strides[3] = strides[i][0];
        const virga_result expected = strides[i][1] ? VIRGA_OK : VIRGA_ERROR_INVALID;
        gpu_forget_log(d.f);
        assert_int_equal(create_rain(&d, &rain), expected);
        assert_int_equal(field_lines(d.f), !strides[i][1]);
        gpu_forget_log(d.f);
        assert_int_equal(create_ground(&d, &ground), expected);
        assert_int_equal(field_lines(d.f), !strides[i][1]);
    }
    virga_context_destroy(&d.context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(context_def_fields), gpu_test(target_def_fields),   gpu_test(formats_are_checked),
        gpu_test(rain_def_fields),    gpu_test(ground_def_fields),   gpu_test(splash_def_fields),
        gpu_test(glass_def_fields),   gpu_test(strides_are_checked),
    };
    return effect_fixture_close(cmocka_run_group_tests(tests, NULL, NULL));
}
