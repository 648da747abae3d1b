/* nothing.c - the whole of an effect: its tables, its defaults, its setting, its one pass. */
#include "nothing.h"

#include "gpu/context.h"
#include "gpu/record.h"
#include "gpu/timers.h"
#include "nothing_effect.h"
#include "scene/scene_internal.h"

#include "nothing_add_comp.spv.h" /* this one is not in the library */

#include <stdio.h>
#include <string.h>

typedef struct nothing_def {
    uint32_t size, cookie;
} nothing_def;

struct virga_nothing {
    virga_effect base; /* first */
    nothing_def def;
    virga_nothing_settings settings;
    virga_nothing_stats stats;
    virga_buffer *sum;
    virga_bindings *bindings;
    virga_pipeline *add;
};

static const virga_spirv nothing_add_comp_shader = {nothing_add_comp_spv, sizeof nothing_add_comp_spv};

#define AT(member) offsetof(virga_nothing, member)

static const virga_effect_buffer buffers[] = {
    {"nothing.sum", AT(sum), VIRGA_USE_STORAGE, VIRGA_HEAP_DEVICE, sizeof(uint32_t), .first = VIRGA_FIRST_FILL},
};

static const virga_binding_kind bindings[] = {
    {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT, VIRGA_SOURCE_BUFFER, AT(sum)},
};

static const virga_effect_layout layouts[] = {{AT(bindings), bindings, VIRGA_ROWS(bindings), 1, sizeof(uint32_t)}};

static const virga_effect_pass passes[] = {{"nothing.add", AT(add), VIRGA_SPIRV(nothing_add_comp)}};

static const virga_setting_row setting_rows[] = {
    VIRGA_SETTING_ROW(nothing_settings, virga_nothing_settings, U32, weight, 0, 100, 1),
};

virga_nothing_settings virga_default_nothing_settings(void)
{
    virga_nothing_settings settings;
    virga_effect_default_settings(&nothing_type, &settings);
    return settings;
}

static void describe(const void *object, char *line, size_t size)
{
    (void)object;
    snprintf(line, size, "nothing");
}

static void read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    virga_nothing *nothing = object;
    (void)ring_slot;
    (void)parts;
    nothing->stats.frame_index = frame;
    memcpy(&nothing->stats.sum, data, sizeof nothing->stats.sum);
}

static virga_result step(void *object, VkCommandBuffer cmd, const virga_effect_step *step)
{
    virga_nothing *nothing = object;
    virga_context *context = nothing->base.context;
    virga_bound bound[VIRGA_MAX_BINDINGS];
    const virga_result result = virga_effect_check_step(&nothing->base, "virga_nothing_step", cmd, step);
    if (result)
        return result;
    virga_timers_reset(context, cmd);
    virga_effect_read_statistics(&nothing->base);
    virga_effect_first_contents(&nothing->base, cmd);
    virga_effect_bound(&nothing->base, nothing->bindings, bound);
    const VkDescriptorSet descriptors = virga_bindings_write(context, nothing->bindings, 0, bound);
    const VkPipelineLayout layout = nothing->bindings->layout;
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "nothing.add");
    context->vk.CmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &descriptors, 0, NULL);
    context->vk.CmdPushConstants(cmd, layout, VIRGA_ALL_STAGES, 0, sizeof(uint32_t), &nothing->settings.weight);
    for (uint32_t i = 0; i < step->ticks; i++)
        virga_dispatch_and_barrier(context, cmd, nothing->add, 1);
    virga_pass_end(context, cmd, scope);
    virga_effect_copy_statistics(&nothing->base, cmd, 0, nothing->sum, 0, 0, sizeof(uint32_t));
    return VIRGA_OK;
}

const virga_effect_type nothing_type = {
    .name = "nothing",
    .log_name = "nothing_settings",
    .size = sizeof(virga_nothing),
    .def = {"nothing_def", sizeof(nothing_def), AT(def)},
    .settings = {"nothing_settings", sizeof(virga_nothing_settings), AT(settings), setting_rows,
                 VIRGA_ROWS(setting_rows)},
    VIRGA_TABLE(buffer),
    VIRGA_TABLE(layout),
    .passes = passes,
    .pass_count = VIRGA_ROWS(passes),
    .readback_name = "nothing.readback",
    .readback_bytes = sizeof(uint32_t),
    .describe = describe,
    .read_statistics = read_statistics,
    .step = step,
};

virga_result virga_nothing_set(virga_nothing *nothing, const virga_nothing_settings *settings)
{
    return nothing ? virga_effect_set(&nothing->base, "virga_nothing_set", settings) : VIRGA_ERROR_INVALID;
}

VIRGA_EFFECT_STATISTICS_FUNCTION(nothing)

virga_nothing *virga_scene_nothing(virga_scene *scene)
{
    return scene_find(scene, &nothing_type, 0);
}
