/* test_amd.c - all pipelines of the library through the compiler of AMD's GPUs, without a GPU.
 *
 * usage: amd-compile CARD TABLE [--write]
 *
 * Mesa's driver for AMD makes a null device for a CARD of RADV_FORCE_FAMILY. It compiles to the code that players have,
 * and says what that code needs; it can do nothing else, so a stand-in answers all other calls. TABLE has a row for
 * each pass and stage. Fails if a stage spills registers or uses scratch memory, or needs more than its row says.
 * --write writes the table instead. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>
#include <unistd.h>

#include <virga/virga.h>

#include "../gpu/small_scene.h"

#include "amd_driver.h"
#include "amd_table.h"

/* Set by main. */
static amd_driver driver;
static const char *table_path;
static bool write_table;

static void print_error_line(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    (void)user;
    if (level == VIRGA_LOG_ERROR)
        fprintf(stderr, "%s: %s\n", virga_log_name(id), text);
}

static virga_context *open_context(void)
{
    virga_context_def def = virga_default_context_def();
    virga_context *context;
    def.instance = stand_in_instance();
    def.physical_device = stand_in_physical();
    def.device = stand_in_device(0);
    def.get_instance_proc_addr = amd_driver_get;
    def.log = print_error_line;
    assert_int_equal(virga_context_create(&def, &context), VIRGA_OK);
    return context;
}

/* ---- targets */

typedef struct target_kind {
    bool render_pass, temporal, no_depth, reversed, writes_depth, samples_4, encoded, two_views;
} target_kind;

/* Each option changes shaders, or states that a compiler sees. Each is once on and once off, not in all combinations:
 * a kind takes a compiler ten seconds. */
static const target_kind target_kinds[] = {
    {.samples_4 = true},
    {.no_depth = true, .encoded = true},
    {.temporal = true, .two_views = true, .writes_depth = true},
    {.render_pass = true, .temporal = true, .reversed = true},
};
enum { TARGET_KINDS = sizeof target_kinds / sizeof target_kinds[0] };

static VkAttachmentDescription attachment(VkFormat format, VkImageLayout layout)
{
    return (VkAttachmentDescription){.format = format,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD,
                                     .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
                                     .initialLayout = layout,
                                     .finalLayout = layout};
}

/* Three colors and depth, one sample. */
static VkRenderPass open_render_pass(const virga_target_def *def)
{
    const VkImageLayout color = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkImageLayout depth = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    const VkAttachmentDescription attachments[4] = {
        attachment(def->color_formats[0], color), attachment(def->color_formats[1], color),
        attachment(def->color_formats[2], color), attachment(VK_FORMAT_D32_SFLOAT, depth)};
    const VkAttachmentReference colors[3] = {{0, color}, {1, color}, {2, color}}, depth_of = {3, depth};
    const VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                          .colorAttachmentCount = 3,
                                          .pColorAttachments = colors,
                                          .pDepthStencilAttachment = &depth_of};
    const VkRenderPassCreateInfo info = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                         .attachmentCount = 4,
                                         .pAttachments = attachments,
                                         .subpassCount = 1,
                                         .pSubpasses = &subpass};
    VkRenderPass pass;
    assert_int_equal(driver.create_render_pass(driver.device, &info, NULL, &pass), VK_SUCCESS);
    return pass;
}

static virga_target *open_target(virga_context *context, const target_kind *kind, VkRenderPass *pass)
{
    virga_target_def def = virga_default_target_def();
    virga_target *target;
    def.kind = kind->render_pass ? VIRGA_TARGET_RENDER_PASS : VIRGA_TARGET_DYNAMIC;
    def.color_formats[0] = kind->encoded ? VK_FORMAT_R8G8B8A8_UNORM : VK_FORMAT_R16G16B16A16_SFLOAT;
    if (kind->temporal) {
        def.color_formats[1] = VK_FORMAT_R16G16_SFLOAT;
        def.color_formats[2] = VK_FORMAT_R8_UNORM;
        def.color_count = 3;
        def.motion_attachment = 1;
        def.reactive_attachment = 2;
    }
    def.depth_attached = !kind->no_depth;
    def.depth_format = kind->no_depth ? VK_FORMAT_UNDEFINED : VK_FORMAT_D32_SFLOAT;
    def.depth_written = kind->writes_depth;
    def.reversed_depth = kind->reversed;
    def.samples = kind->samples_4 ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
    def.encoding = kind->encoded ? VIRGA_ENCODING_SRGB : VIRGA_ENCODING_NOT_GIVEN;
    def.view_mask = kind->two_views ? 3 : 0;
    *pass = kind->render_pass ? open_render_pass(&def) : VK_NULL_HANDLE;
    if (kind->render_pass) {
        def.render_pass = *pass;
        def.depth_format = VK_FORMAT_UNDEFINED;
    }
    assert_int_equal(virga_target_create(context, &def, &target), VIRGA_OK);
    return target;
}

/* ---- effects */

/* Each style has its own pipelines. */
static void set_style(virga_glass *pane, virga_glass_style style, float textured_px)
{
    virga_glass_settings settings = virga_default_glass_settings();
    settings.style = style;
    settings.textured_px = textured_px;
    assert_int_equal(virga_glass_set(pane, &settings), VIRGA_OK);
}

static virga_scene *open_scene(virga_context *context)
{
    virga_glass_def panes[SMALL_PANES];
    virga_scene_def def = small_scene_def(panes);
    virga_scene *scene;
    panes[0].max_texels = panes[1].max_texels = 256; /* so fine that beads of film have shapes: a pass of their own */
    def.with_water = true;
    assert_int_equal(virga_scene_create(context, &def, &scene), VIRGA_OK);
    assert_int_equal(small_shapes_set(scene), VIRGA_OK);
    set_style(virga_scene_glass(scene, 0), VIRGA_GLASS_STYLE_PHYSICAL, 8);
    set_style(virga_scene_glass(scene, 1), VIRGA_GLASS_STYLE_PAPER, 0);
    set_style(virga_scene_glass(scene, 2), VIRGA_GLASS_STYLE_FRONT, 0);
    return scene;
}

/* `in_place_px`: the largest radius in place; 0: not in place. */
static virga_lens *open_lens(virga_context *context, uint32_t half_resolution, uint32_t circles, float in_place_px)
{
    virga_lens_def def = virga_default_lens_def();
    virga_lens *lens;
    def.half_resolution = half_resolution;
    def.circles = circles;
    def.in_place = in_place_px > 0;
    assert_int_equal(virga_lens_create(context, &def, &lens), VIRGA_OK);
    virga_lens_settings settings = virga_default_lens_settings();
    settings.style = VIRGA_LENS_STYLE_PAPER; /* the filters are the same for all */
    if (in_place_px > 0) {
        settings = virga_default_lens_settings();
        settings.max_radius_px = in_place_px; /* discs up to 16 px have passes of their own, and up to 32 px others */
    }
    if (!half_resolution || in_place_px > 0)
        assert_int_equal(virga_lens_set(lens, &settings), VIRGA_OK);
    return lens;
}

static virga_fluid *open_fluid(virga_context *context)
{
    const virga_fluid_def def = virga_default_fluid_def();
    virga_fluid *fluid;
    assert_int_equal(virga_fluid_create(context, &def, &fluid), VIRGA_OK);
    return fluid;
}

static virga_environment *open_environment(virga_context *context)
{
    virga_environment_def def = virga_default_environment_def();
    virga_environment *environment;
    def.panorama_width = 256;
    assert_int_equal(virga_environment_create(context, &def, &environment), VIRGA_OK);
    return environment;
}

/* Features that a rain can be made without. */
static virga_rain *open_plain_rain(virga_context *context)
{
    virga_rain_def def = small_rain_def();
    virga_rain *rain;
    def.wind_texture = def.points = false;
    def.max_panes = 0;
    def.occlusion_size = 0;
    assert_int_equal(virga_rain_create(context, &def, &rain), VIRGA_OK);
    return rain;
}

#define LENSES 4 /* that draw */

static void compile_all(void)
{
    virga_context *context = open_context();
    virga_scene *scene = open_scene(context);
    virga_lens *lens[LENSES] = {open_lens(context, 0, 0, 0), open_lens(context, 1, 0, 0), open_lens(context, 1, 0, 16),
                                open_lens(context, 1, 0, 32)};
    virga_lens *circles = open_lens(context, 0, 1, 0);
    virga_fluid *fluid = open_fluid(context);
    virga_environment *environment = open_environment(context);
    virga_rain *plain = open_plain_rain(context);
    for (int i = 0; i < TARGET_KINDS; i++) {
        VkRenderPass pass;
        virga_target *target = open_target(context, &target_kinds[i], &pass);
        assert_int_equal(virga_scene_attach(scene, target), VIRGA_OK);
        assert_int_equal(virga_ground_attach(virga_scene_ground(scene), target), VIRGA_OK);
        assert_int_equal(virga_rain_attach(plain, target), VIRGA_OK);
        for (int k = 0; k < LENSES; k++)
            assert_int_equal(virga_lens_attach(lens[k], target), VIRGA_OK);
        virga_target_destroy(&target);
        if (pass)
            driver.destroy_render_pass(driver.device, pass, NULL);
    }
    virga_rain_destroy(&plain);
    virga_environment_destroy(&environment);
    virga_fluid_destroy(&fluid);
    virga_lens_destroy(&circles);
    for (int k = 0; k < LENSES; k++)
        virga_lens_destroy(&lens[k]);
    virga_scene_destroy(&scene);
    virga_context_destroy(&context);
}

static void all_pipelines_compile_as_their_rows_say(void **state)
{
    amd_table *table = *state;
    compile_all();
    assert_true(amd_table_count(table) > 150);
    assert_int_equal(amd_table_print_spills(table), 0);
    if (write_table)
        assert_true(amd_table_write(table, table_path, driver.name));
    else
        assert_int_equal(amd_table_print_losses(table, table_path, driver.name), 0);
}

int main(int argc, char **argv)
{
    if (argc < 3) {
        fprintf(stderr, "usage: %s CARD TABLE [--write]\n", argv[0]);
        return 2;
    }
    table_path = argv[2];
    write_table = argc > 3 && !strcmp(argv[3], "--write");
    amd_table *table = amd_table_open();
    stand_in_open();
    const char *missing = amd_driver_open(&driver, argv[1], table);
    if (missing) {
        printf("skipped: %s\n", missing);
        return 77;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test_prestate(all_pipelines_compile_as_their_rows_say, table)};
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    amd_driver_close(&driver);
    amd_table_close(table);
    return failed;
}
