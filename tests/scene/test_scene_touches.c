/* test_scene_touches.c - what each call changes in a command buffer is what the list in virga/vulkan.h says. On a
 * stand-in for a device, whose commands are looked at.
 *
 * usage: scene-touches VULKAN_H */
#include "alone_fixture.h"

#include <stdlib.h>

/* Bits of what is changed, in the order of the list's words. */
enum { COMPUTE = 1, GRAPHICS = 2, PUSH = 4, INDICES = 8, VERTICES = 16, LINES = 32, ALL = 63, AREA = 64 };

static const char *const words[] = {"compute",      "graphics",        "push constants",
                                    "index buffer", "vertex buffer 0", "line width"};

static uint32_t touched;

/* ---- commands that change something, before the stand-in sees them */

/* The stand-in's own function. */
#define REAL(name) ((PFN_vk##name)stand_in_get(stand_in_instance(), "vk" #name))

static VKAPI_ATTR void VKAPI_CALL see_pipeline(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipeline pipeline)
{
    touched |= point == VK_PIPELINE_BIND_POINT_COMPUTE ? COMPUTE : GRAPHICS;
    REAL(CmdBindPipeline)(cmd, point, pipeline);
}

static VKAPI_ATTR void VKAPI_CALL see_sets(VkCommandBuffer cmd, VkPipelineBindPoint point, VkPipelineLayout layout,
                                           uint32_t first, uint32_t count, const VkDescriptorSet *sets,
                                           uint32_t offset_count, const uint32_t *offsets)
{
    assert_true(first == 0 && count == 1);
    touched |= point == VK_PIPELINE_BIND_POINT_COMPUTE ? COMPUTE : GRAPHICS;
    REAL(CmdBindDescriptorSets)(cmd, point, layout, first, count, sets, offset_count, offsets);
}

static VKAPI_ATTR void VKAPI_CALL see_push(VkCommandBuffer cmd, VkPipelineLayout layout, VkShaderStageFlags stages,
                                           uint32_t offset, uint32_t size, const void *values)
{
    touched |= PUSH;
    REAL(CmdPushConstants)(cmd, layout, stages, offset, size, values);
}

static VKAPI_ATTR void VKAPI_CALL see_vertices(VkCommandBuffer cmd, uint32_t first, uint32_t count,
                                               const VkBuffer *buffers, const VkDeviceSize *offsets)
{
    assert_true(first == 0 && count == 1);
    touched |= VERTICES;
    REAL(CmdBindVertexBuffers)(cmd, first, count, buffers, offsets);
}

static VKAPI_ATTR void VKAPI_CALL see_indices(VkCommandBuffer cmd, VkBuffer buffer, VkDeviceSize offset,
                                              VkIndexType type)
{
    touched |= INDICES;
    REAL(CmdBindIndexBuffer)(cmd, buffer, offset, type);
}

static VKAPI_ATTR void VKAPI_CALL see_viewport(VkCommandBuffer cmd, uint32_t first, uint32_t count,
                                               const VkViewport *viewports)
{
    assert_true(first == 0 && count == 1);
    touched |= AREA;
    REAL(CmdSetViewport)(cmd, first, count, viewports);
}

static VKAPI_ATTR void VKAPI_CALL see_scissor(VkCommandBuffer cmd, uint32_t first, uint32_t count, const VkRect2D *all)
{
    assert_true(first == 0 && count == 1);
    touched |= AREA;
    REAL(CmdSetScissor)(cmd, first, count, all);
}

static VKAPI_ATTR void VKAPI_CALL see_line_width(VkCommandBuffer cmd, float width)
{
    touched |= LINES;
    REAL(CmdSetLineWidth)(cmd, width);
}

/* Those that change nothing which a later command of the host would use. */
static bool is_harmless(const char *name)
{
    static const char *const names[] = {"Dispatch",
                                        "DispatchIndirect",
                                        "Draw",
                                        "DrawIndexed",
                                        "DrawIndirect",
                                        "BeginRenderPass",
                                        "DrawIndexedIndirect",
                                        "EndRenderPass",
                                        "CopyBuffer",
                                        "CopyBufferToImage",
                                        "CopyImage",
                                        "CopyImageToBuffer",
                                        "FillBuffer",
                                        "UpdateBuffer",
                                        "PipelineBarrier",
                                        "ResetQueryPool",
                                        "BeginDebugUtilsLabelEXT",
                                        "WriteTimestamp",
                                        "EndDebugUtilsLabelEXT",
                                        "ClearColorImage"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (!strcmp(name, names[i]))
            return true;
    return false;
}

static PFN_vkVoidFunction VKAPI_CALL look_of_device(VkDevice device, const char *name);

static PFN_vkVoidFunction VKAPI_CALL look(VkInstance instance, const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } seen[] = {
        {"BindPipeline", (PFN_vkVoidFunction)see_pipeline},   {"BindDescriptorSets", (PFN_vkVoidFunction)see_sets},
        {"PushConstants", (PFN_vkVoidFunction)see_push},      {"BindVertexBuffers", (PFN_vkVoidFunction)see_vertices},
        {"BindIndexBuffer", (PFN_vkVoidFunction)see_indices}, {"SetViewport", (PFN_vkVoidFunction)see_viewport},
        {"SetScissor", (PFN_vkVoidFunction)see_scissor},      {"SetLineWidth", (PFN_vkVoidFunction)see_line_width},
    };
    const char *command = strncmp(name, "vkCmd", 5) ? NULL : name + 5;
    for (size_t i = 0; command && i < sizeof seen / sizeof seen[0]; i++)
        if (!strcmp(command, seen[i].name))
            return seen[i].function;
    if (command && !is_harmless(command))
        fail_msg("%s: a command that this test does not know", name);
    if (!strcmp(name, "vkGetDeviceProcAddr"))
        return (PFN_vkVoidFunction)look_of_device;
    return stand_in_get(instance, name);
}

static PFN_vkVoidFunction VKAPI_CALL look_of_device(VkDevice device, const char *name)
{
    (void)device;
    return look(stand_in_instance(), name);
}

static void change_context(virga_context_def *def)
{
    stand_in.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_CPU;
    stand_in.properties.limits.strictLines = VK_TRUE;
    def->get_instance_proc_addr = look;
    def->wide_lines = true;
}

/* ---- calls */

static virga_occluder ground_mesh(const alone *a)
{
    return (virga_occluder){.vertices = a->buffer,
                            .vertex_stride = 12,
                            .indices = a->buffer,
                            .index_type = VK_INDEX_TYPE_UINT32,
                            .index_count = 3,
                            .world_from_mesh = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0},
                            .ground = true};
}

static virga_result draw_occlusion(alone *a)
{
    const virga_occluder mesh = ground_mesh(a);
    return virga_rain_draw_occlusion(a->rain, a->cmd, (const double[3]){0}, &mesh, 1);
}

static virga_result find_hits(alone *a)
{
    const virga_rain_pane pane = {.along_u = {1, 0, 0}, .along_v = {0, 1, 0}, .width_m = 1, .height_m = 1};
    virga_rain_buffer hits;
    return virga_rain_find_hits(a->rain, a->cmd, &pane, &hits);
}

static virga_result write_points(alone *a)
{
    virga_rain_buffer points;
    uint32_t count;
    double origin[3];
    return virga_rain_write_points(a->rain, a->cmd, &points, &count, origin);
}

static virga_result save_rain(alone *a)
{
    const virga_state_range range = {a->buffer, 0, virga_rain_state_bytes(a->rain)};
    return virga_rain_save(a->rain, a->cmd, &range);
}

static virga_result draw_rain(alone *a)
{
    return virga_rain_draw(a->rain, a->cmd, a->target);
}

static virga_result draw_haze(alone *a)
{
    return virga_rain_draw_haze(a->rain, a->cmd, &a->view, NULL, a->target);
}

static virga_result draw_splash(alone *a)
{
    return virga_splash_draw(a->splash, a->cmd, a->target);
}

static virga_result draw_glass(alone *a)
{
    return virga_glass_draw(a->glass, a->cmd, a->target);
}

static virga_result draw_refraction(alone *a)
{
    return virga_glass_draw_refraction(a->glass, a->cmd, a->target);
}

static virga_result draw_water(alone *a)
{
    return virga_water_draw(a->water, a->cmd, a->target);
}

static virga_result draw_data(alone *a)
{
    return virga_water_draw_data(a->water, a->cmd, a->target, VIRGA_WATER_DATA_NORMAL);
}

static virga_result draw_foam(alone *a)
{
    return virga_water_draw_foam(a->water, a->cmd, a->target);
}

static virga_result draw_lens(alone *a)
{
    return virga_lens_draw(a->lens, a->cmd, a->target);
}

static virga_result draw_lens_part(alone *a)
{
    return virga_lens_draw_part(a->lens, a->cmd, a->target, 0);
}

/* In the order of a frame. */
static const struct {
    const char *name;
    virga_result (*call)(alone *a);
} calls[] = {
    {"virga_rain_draw_occlusion", draw_occlusion},
    {"virga_rain_step", step_rain},
    {"virga_rain_find_hits", find_hits},
    {"virga_rain_write_points", write_points},
    {"virga_ground_step", step_ground},
    {"virga_splash_step", step_splash},
    {"virga_glass_step", step_glass},
    {"virga_water_step", step_water},
    {"virga_fluid_step", step_fluid},
    {"virga_environment_record", step_environment},
    {"virga_rain_save", save_rain},
    {"virga_rain_prepare", prepare_rain},
    {"virga_splash_prepare", prepare_splash},
    {"virga_glass_prepare", prepare_glass},
    {"virga_water_prepare", prepare_water},
    {"virga_lens_prepare", prepare_lens},
    {"virga_rain_draw", draw_rain},
    {"virga_rain_draw_haze", draw_haze},
    {"virga_splash_draw", draw_splash},
    {"virga_glass_draw", draw_glass},
    {"virga_glass_draw_refraction", draw_refraction},
    {"virga_water_draw", draw_water},
    {"virga_water_draw_data", draw_data},
    {"virga_water_draw_foam", draw_foam},
    {"virga_lens_draw", draw_lens},
    {"virga_lens_draw_part", draw_lens_part},
    {"virga_ground_draw_wet", draw_wet},
};

/* ---- the list */

static char header[1 << 16];

static void read_header(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    header[fread(header, 1, sizeof header - 1, file)] = 0;
    fclose(file);
}

/* The words behind a call's name in the list; ALL + 1: it has no row. */
static uint32_t listed(const char *name)
{
    char row[96];
    uint32_t bits = 0;
    snprintf(row, sizeof row, " *     %s ", name);
    const char *at = strstr(header, row);
    if (!at)
        return ALL + 1;
    at += strlen(row);
    snprintf(row, sizeof row, "%.*s", (int)strcspn(at, "\n"), at);
    for (char *word = strtok(row, ","); word; word = strtok(NULL, ",")) {
        word += strspn(word, " ");
        uint32_t i = 0;
        while (i < sizeof words / sizeof words[0] && strcmp(word, words[i]))
            i++;
        if (i == sizeof words / sizeof words[0])
            fail_msg("%s: no such word: %s", name, word);
        bits |= 1u << i;
    }
    return bits;
}

static void print_bits(const char *what, uint32_t bits)
{
    fprintf(stderr, "%s:", what);
    for (uint32_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (bits & 1u << i)
            fprintf(stderr, " %s,", words[i]);
    fprintf(stderr, "\n");
}

/* `touched` of all calls of that name. */
static void compare(const char *name, uint32_t found)
{
    const bool outside = !strstr(name, "_draw") || strstr(name, "_occlusion");
    uint32_t expected = listed(outside ? "others outside rendering" : name);
    const uint32_t own = listed(name);
    if (own <= ALL)
        expected = own;
    if (!!(found & AREA) != !!(found & GRAPHICS))
        fail_msg("%s: viewport and scissor are not set with a pipeline", name);
    found &= ALL;
    if (outside) /* some have first contents only */
        found |= COMPUTE | PUSH;
    if (found == expected)
        return;
    print_bits("changed", found);
    print_bits("listed", expected);
    fail_msg("%s: the list in virga/vulkan.h is wrong", name);
}

static void open_touched(alone *a)
{
    virga_water_def water = virga_default_water_def();
    virga_rain_def rain = virga_default_rain_def();
    const virga_fluid_block block = {.high_m = {0.2f, 0.2f, 0.2f}};
    open_some(a, NULL, change_context);
    virga_water_destroy(&a->water);
    virga_rain_destroy(&a->rain);
    water.max_width = water.max_height = 64;
    water.max_foam = 256;
    rain.max_panes = 1;
    rain.points = true;
    assert_int_equal(virga_water_create(a->context, &water, &a->water), VIRGA_OK);
    assert_int_equal(virga_rain_create(a->context, &rain, &a->rain), VIRGA_OK);
    assert_int_equal(virga_rain_attach(a->rain, a->target), VIRGA_OK);
    assert_int_equal(virga_splash_attach(a->splash, a->target), VIRGA_OK);
    assert_int_equal(virga_glass_attach(a->glass, a->target), VIRGA_OK);
    assert_int_equal(virga_water_attach(a->water, a->target), VIRGA_OK);
    assert_int_equal(virga_lens_attach(a->lens, a->target), VIRGA_OK);
    assert_int_equal(virga_fluid_add(a->fluid, &block), VIRGA_OK);
}

static void calls_change_what_the_header_lists(void **state)
{
    static alone a;
    static uint32_t found[sizeof calls / sizeof calls[0]];
    (void)state;
    open_touched(&a);
    for (int frame = 0; frame < 3; frame++) {
        begin_frame(&a);
        for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++) {
            touched = 0;
            const virga_result result = calls[i].call(&a);
            if (result)
                fail_msg("%s: %s", calls[i].name, virga_result_name(result));
            found[i] |= touched;
        }
    }
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++)
        compare(calls[i].name, found[i]);
    close_all(&a);
}

/* All effects at once. */
static void so_does_a_scene(void **state)
{
    static alone a;
    virga_glass_def pane = virga_default_glass_def();
    virga_scene_def def = virga_default_scene_def();
    virga_scene *scene = NULL;
    uint32_t recorded = 0, drawn = 0;
    (void)state;
    open_some(&a, NULL, change_context);
    def.with_ground = def.with_splash = true;
    def.panes = &pane;
    def.pane_count = 1;
    assert_int_equal(virga_scene_create(a.context, &def, &scene), VIRGA_OK);
    assert_int_equal(virga_scene_attach(scene, a.target), VIRGA_OK);
    for (int frame = 0; frame < 3; frame++) {
        const virga_occluder mesh = ground_mesh(&a);
        const virga_scene_pane panes[1] = {{.shelter = 0}};
        const virga_scene_frame info = {
            .dt_s = 1.0 / 30, .view = &a.view, .occluders = &mesh, .occluder_count = 1, .panes = panes};
        begin_frame(&a);
        touched = 0;
        assert_int_equal(virga_scene_record(scene, a.cmd, &info), VIRGA_OK);
        recorded |= touched;
        touched = 0;
        assert_int_equal(virga_scene_draw(scene, a.cmd, a.target), VIRGA_OK);
        drawn |= touched;
    }
    compare("virga_scene_record", recorded);
    compare("virga_scene_draw", drawn);
    virga_scene_destroy(&scene);
    close_all(&a);
}

/* Without lines, the line width stays as it is. */
static void change_to_gpu(virga_context_def *def)
{
    def->get_instance_proc_addr = look;
}

static void without_lines_none_sets_their_width(void **state)
{
    static alone a;
    (void)state;
    open_some(&a, NULL, change_to_gpu);
    assert_int_equal(virga_rain_attach(a.rain, a.target), VIRGA_OK);
    begin_frame(&a);
    assert_int_equal(step_rain(&a), VIRGA_OK);
    assert_int_equal(prepare_rain(&a), VIRGA_OK);
    touched = 0;
    assert_int_equal(draw_rain(&a), VIRGA_OK);
    assert_int_equal(touched, GRAPHICS | AREA | INDICES);
    close_all(&a);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(calls_change_what_the_header_lists),
        cmocka_unit_test(so_does_a_scene),
        cmocka_unit_test(without_lines_none_sets_their_width),
    };
    if (argc != 2)
        return 2;
    read_header(argv[1]);
    return cmocka_run_group_tests_name("touches", tests, NULL, NULL);
}
