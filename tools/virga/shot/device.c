/* device.c - the device of a shot, and what is drawn into on it. */
#include "shot/internal.h"

#include "effect.h"

#include <stdio.h>

static void note_log(void *user, virga_log_level level, virga_log_id id, const char *text)
{
    shot *s = user;
    (void)id;
    if (level == VIRGA_LOG_INFO)
        return;
    snprintf(s->warning, sizeof s->warning, "%s", text);
    if (level == VIRGA_LOG_WARNING)
        fprintf(stderr, "virga: %s\n", text);
}

bool shot_open_device(shot *s, char *error, size_t error_size)
{
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index = 0;
    if (!host_instance_create_for_window(&s->instance, false, s->options.window_extensions,
                                         s->options.window_extension_count, error, error_size))
        return false;
    const uint32_t count = host_devices_list(&s->instance, infos, HOST_MAX_DEVICES);
    if (!host_device_pick(infos, count, s->options.device, &index, error, error_size)) {
        s->input_wrong = count && s->options.device;
        return false;
    }
    s->info = infos[index];
    if (!host_device_create(&s->device, &s->instance, &infos[index], error, error_size))
        return false;
    /* The anisotropic filter of software Vulkan (Mesa 22.3) needs ten seconds for a pixel with some rare gradients, and
     * three times the time of the linear filter for other pixels. Sub-frames (--samples) replace it. */
    if (s->info.type == VK_PHYSICAL_DEVICE_TYPE_CPU)
        s->device.anisotropy = 0;
    virga_context_def def = host_context_def(&s->device);
    def.frames_in_flight = HOST_FRAMES + 1;
    def.pipeline_build_mode = VIRGA_PIPELINES_ON_USE; /* a render uses a third of them or less */
    def.log = note_log;
    def.log_user = s;
    return shot_ok(s, virga_context_create(&def, &s->context), "creating a context on the device", error, error_size);
}

bool shot_begin(shot *s, VkCommandBuffer *cmd, char *error, size_t error_size)
{
    return host_begin_frame(&s->device, cmd, error, error_size) &&
           shot_ok(s, virga_frame_begin(s->context, s->device.frame, s->device.completed), "beginning a frame", error,
                   error_size);
}

/* ---- the target */

/* Into s->layers, by rising order. */
static bool list_layer(shot *s, uint32_t effect, const tool_layer *layer, char *error, size_t error_size)
{
    uint32_t at = s->layer_count;
    if (at == HOST_MAX_LAYERS)
        return host_fail(error, error_size, "the effects of this scene have more than %d layers", HOST_MAX_LAYERS);
    for (; at && s->layers[at - 1].layer->order > layer->order; at--)
        s->layers[at] = s->layers[at - 1];
    s->layers[at] = (shot_layer){.effect = effect, .layer = layer};
    s->layer_count++;
    return true;
}

static bool list_layers(shot *s, char *error, size_t error_size)
{
    s->layer_count = 0;
    for (uint32_t i = 0; s->options.parts == HOST_PLATE_WHOLE && tool_effects[i]; i++)
        for (uint32_t k = 0; k < tool_effects[i]->layer_count && tool_effect_is_used(tool_effects[i], s->scene); k++)
            if (tool_effects[i]->layers[k].draw && !list_layer(s, i, &tool_effects[i]->layers[k], error, error_size))
                return false;
    return true;
}

/* The target has its first layer from the start. */
static bool add_layers(shot *s, char *error, size_t error_size)
{
    bool behind = false;
    for (uint32_t i = 0; i < s->layer_count; i++) {
        shot_layer *to = &s->layers[i];
        behind = behind || tool_effects[to->effect]->shows_behind;
        to->output = HOST_LAYER;
        if (i && !host_target_add_layer(&s->device, &s->target, to->layer->name, to->layer->is_data, &to->output, error,
                                        error_size))
            return false;
    }
    return !behind || host_target_add_behind(&s->device, &s->target, error, error_size);
}

bool shot_create_target(shot *s, char *error, size_t error_size)
{
    const uint32_t width = s->options.width, height = s->options.height;
    const uint32_t limit = s->device.properties.limits.maxImageDimension2D;
    const bool created = host_target_create(&s->device, width, height, &s->target, error, error_size);
    s->input_wrong = !created && (width > limit || height > limit);
    return created && list_layers(s, error, error_size) && add_layers(s, error, error_size) &&
           (!s->options.water_velocity || host_target_add_moving(&s->device, &s->target, error, error_size));
}
