/* environment/environment.c - spherical harmonics and a panorama of a host's surroundings, from its images. */
#include "core/settings.h"
#include "gpu/context.h"
#include "gpu/effect.h"
#include "gpu/errors.h"
#include "gpu/record.h"
#include "gpu/timers.h"
#include "gpu/view.h"

#include <virga/environment.h>
#include <virga/light.h>
#include <virga/shared/environment_gpu.h>

#define EFFECT environment
#include "gpu/effect_rows.h"

#include "shaders/environment_shaders.h"

#include <stdio.h>
#include <string.h>

struct virga_environment {
    virga_effect base; /* first */
    virga_environment_def def;
    virga_environment_settings settings;
    virga_buffer *sums, *result;
    virga_image_2d *panorama, *blank_color;
    virga_ring info_ring;
    virga_bindings *bindings;
    virga_pipeline *project, *cube_project, *sum, *panorama_pass, *cube_panorama;
    uint64_t frame; /* of the newest harmonics; 0: none */
    float sh[9][3];
};

/* ---- tables */

static const virga_setting_row def_rows[] = {
    DEF(U32, panorama_width, 1, 4096, 1),
};

static const virga_setting_row setting_rows[] = {
    SETTING(FLOAT, gain, 0, 1e6, 1),
};

enum { COUNT_GROUPS = 1, COUNT_WIDTH, COUNT_HEIGHT };

static void count(const void *given, VkDeviceSize counts[VIRGA_EFFECT_MAX_COUNTS])
{
    const virga_environment_def *def = given;
    counts[COUNT_GROUPS] = VIRGA_ENVIRONMENT_GROUPS;
    counts[COUNT_WIDTH] = def->panorama_width;
    counts[COUNT_HEIGHT] = def->panorama_width > 1 ? def->panorama_width / 2 : 1;
}

static const virga_effect_buffer buffers[] = {
    {"environment.sums", AT(sums), VIRGA_USE_STORAGE, DEVICE, 0, sizeof(virga_environment_sum_gpu), COUNT_GROUPS, FILL},
    {"environment.harmonics", AT(result), VIRGA_USE_STORAGE, DEVICE, 27 * sizeof(float), .first = FILL},
};

static const virga_effect_ring rings[] = {
    {"environment.info", AT(info_ring), VIRGA_USE_UNIFORM, VIRGA_RING_BYTES(virga_environment_gpu), VIRGA_COUNT_ONE},
};

static const virga_effect_image images[] = {
    {"environment.panorama", AT(panorama), VK_FORMAT_R16G16B16A16_SFLOAT, COLOR,
     VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT, COUNT_WIDTH,
     COUNT_HEIGHT, 1, VIRGA_FIRST_STORAGE},
    BLANK_COLOR("environment.blank_color", blank_color),
};

enum { BIND_FLAT = 3, BIND_CUBE, BIND_PANORAMA, BINDINGS };

/* As shaders/environment declares them. Passes read the flat image or the cube map. */
static const virga_binding_kind bindings[BINDINGS] = {
    RING(COMPUTE, info_ring, virga_environment_gpu), /* 0 */
    BUFFER(sums),                                    /* 1 */
    BUFFER(result),                                  /* 2 */
    [BIND_FLAT] = {SAMPLED, COMPUTE},                /* 3 */
    [BIND_CUBE] = {SAMPLED, COMPUTE},                /* 4 */
    [BIND_PANORAMA] = STORAGE_IMAGE(panorama),       /* 5 */
};

static const virga_effect_layout layouts[] = {{AT(bindings), bindings, BINDINGS, 1, sizeof(uint32_t)}};

static const virga_effect_pass passes[] = {
    PASS(project),       PASS(cube_project),
    PASS(sum),           {"environment.panorama", AT(panorama_pass), VIRGA_SPIRV(environment_panorama_comp)},
    PASS(cube_panorama),
};

static void describe(const void *object, char *line, size_t size)
{
    const virga_environment *environment = object;
    snprintf(line, size, "environment: a panorama of %u columns", environment->def.panorama_width);
}

static void read_statistics(void *object, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data)
{
    virga_environment *environment = object;
    (void)ring_slot;
    (void)parts;
    environment->frame = frame;
    memcpy(environment->sh, data, sizeof environment->sh);
}

static const virga_effect_type environment_type = {
    VIRGA_EFFECT_TABLES(environment, "the environment", "environment_settings"),
    VIRGA_TABLE(image),
    .readback_bytes = 27 * sizeof(float),
    VIRGA_CALLBACKS(read_statistics),
};

VIRGA_EFFECT_FUNCTIONS(environment)

/* ---- record */

static virga_result check_size(const virga_log *log, const char *name, uint32_t size)
{
    return size >= 1 && size <= 16384
               ? VIRGA_OK
               : virga_wrong_argument(log, "environment_info.%s: expected 1 to 16384 pixels, got %u", name, size);
}

static bool is_rotated(const virga_environment_info *info)
{
    for (int i = 0; i < 9; i++)
        if (info->image_from_world[i] != 0) /* also true for NaN */
            return true;
    return false;
}

static virga_result check_info(const virga_environment *environment, const virga_environment_info *info)
{
    const virga_log *log = &environment->base.context->log;
    if ((uint32_t)info->kind > VIRGA_ENVIRONMENT_PICTURE)
        return virga_wrong_argument(log, "environment_info.kind: there is no kind %d", (int)info->kind);
    virga_result result = virga_image_check(log, "environment_info.image", &info->image);
    if (!result && !info->image.view)
        result = virga_wrong_argument(log, "environment_info.image: expected an image, got none");
    if (!result)
        result = virga_encoding_check(log, "environment_info.encoding", info->encoding, info->image.format);
    if (result)
        return result;
    if (info->kind == VIRGA_ENVIRONMENT_PICTURE) {
        if (!info->view)
            return virga_wrong_argument(log, "environment_info.view: expected the picture's view, got NULL");
        result = virga_view_check(environment->base.context, info->view, 0);
        return result ? result : virga_settings_check_finite(log, "environment_info.rest_sh", info->rest_sh[0], 9 * 3);
    }
    if (check_size(log, "width", info->width) || check_size(log, "height", info->height))
        return VIRGA_ERROR_INVALID;
    if (info->kind == VIRGA_ENVIRONMENT_CUBE && info->width != info->height)
        return virga_wrong_argument(log, "environment_info.height: expected the width of a face (%u), got %u",
                                    info->width, info->height);
    return is_rotated(info)
               ? virga_settings_check_rotation(log, "environment_info.image_from_world", info->image_from_world, 3)
               : VIRGA_OK;
}

static void fill_picture(const virga_view *view, virga_environment_gpu *out)
{
    const virga_lighting none = {.light_count = 0};
    virga_view_gpu filled;
    virga_view_fill(view, &none, view->position_m, 0, 0, &filled);
    out->left = (uint32_t)(view->viewport[0] > 0 ? view->viewport[0] : 0);
    out->top = (uint32_t)(view->viewport[1] > 0 ? view->viewport[1] : 0);
    out->width = (uint32_t)view->viewport[2];
    out->height = (uint32_t)view->viewport[3];
    memcpy(out->right, filled.right, sizeof out->right);
    memcpy(out->up, filled.up, sizeof out->up);
    memcpy(out->ahead, filled.ahead, sizeof out->ahead);
    memcpy(out->clip_from_rel, filled.clip_from_rel, sizeof out->clip_from_rel);
}

static void fill(const virga_environment *environment, const virga_environment_info *info, virga_environment_gpu *out)
{
    static const float identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    *out = (virga_environment_gpu){.kind = (uint32_t)info->kind, .width = info->width, .height = info->height};
    out->color_given = info->encoding == VIRGA_ENCODING_SRGB ? VIRGA_COLOR_SRGB : VIRGA_COLOR_LINEAR;
    out->gain = environment->settings.gain;
    memcpy(out->image_from_world, is_rotated(info) ? info->image_from_world : identity, sizeof identity);
    memcpy(out->rest_sh, info->rest_sh, sizeof out->rest_sh);
    if (info->kind == VIRGA_ENVIRONMENT_PICTURE)
        fill_picture(info->view, out);
    const uint32_t texels = out->width * out->height * (info->kind == VIRGA_ENVIRONMENT_CUBE ? 6 : 1);
    const uint32_t groups = virga_groups_of(texels, VIRGA_ENVIRONMENT_GROUP);
    out->groups = groups < VIRGA_ENVIRONMENT_GROUPS ? groups : VIRGA_ENVIRONMENT_GROUPS;
}

static VkDescriptorSet write_set(virga_environment *environment, const virga_environment_info *info)
{
    virga_context *context = environment->base.context;
    const bool cube = info->kind == VIRGA_ENVIRONMENT_CUBE;
    const VkSampler sampler = virga_color_sampler(context, &info->image);
    virga_bound bound[VIRGA_MAX_BINDINGS];
    virga_effect_bound(&environment->base, environment->bindings, bound);
    bound[BIND_FLAT] = virga_bound_or_blank(cube ? NULL : &info->image, environment->blank_color, sampler);
    bound[BIND_CUBE] = virga_bound_or_blank(cube ? &info->image : NULL, environment->blank_color, sampler);
    return virga_bindings_write(context, environment->bindings, 0, bound);
}

virga_result virga_environment_record(virga_environment *environment, VkCommandBuffer cmd,
                                      const virga_environment_info *info)
{
    if (!environment)
        return VIRGA_ERROR_INVALID;
    virga_context *context = environment->base.context;
    virga_effect *base = &environment->base;
    virga_result result = virga_effect_check_one_step(base, "virga_environment_record", cmd, info);
    if (!result)
        result = check_info(environment, info);
    if (!result)
        result = virga_effect_ready(base);
    if (result)
        return result;
    virga_environment_gpu filled;
    fill(environment, info, &filled);
    const uint32_t offset = virga_ring_push(context, &environment->info_ring, &filled, sizeof filled);
    const bool cube = info->kind == VIRGA_ENVIRONMENT_CUBE;
    virga_effect_begin_step(base, cmd);
    virga_effect_first_contents(base, cmd);
    virga_bind(context, cmd, VK_PIPELINE_BIND_POINT_COMPUTE, environment->bindings, write_set(environment, info), 1,
               &offset);
    const virga_pass_scope scope = virga_pass_begin(context, cmd, "environment.record");
    virga_wait(context, cmd, VIRGA_PASSES | VIRGA_COPIES | VIRGA_FRAGMENTS, VIRGA_PASSES);
    virga_dispatch_and_barrier(context, cmd, cube ? environment->cube_project : environment->project, filled.groups);
    virga_dispatch_and_barrier(context, cmd, environment->sum, 1);
    const uint32_t width = environment->def.panorama_width;
    if (width > 1)
        virga_dispatch_2d(context, cmd, cube ? environment->cube_panorama : environment->panorama_pass,
                          virga_groups_of(width, 8), virga_groups_of(width / 2, 8));
    virga_wait(context, cmd, VIRGA_PASSES, VIRGA_PASSES | VIRGA_COPIES | VIRGA_FRAGMENTS);
    virga_pass_end(context, cmd, scope);
    virga_effect_copy_statistics(base, cmd, 0, environment->result, 0, 0, 27 * sizeof(float));
    return virga_recording_result(context);
}

/* ---- queries */

uint64_t virga_environment_harmonics(virga_environment *environment, float sh[9][3])
{
    if (!environment || !sh)
        return 0;
    virga_effect_read_statistics(&environment->base);
    if (environment->frame)
        memcpy(sh, environment->sh, sizeof environment->sh);
    return environment->frame;
}

void virga_environment_panorama(const virga_environment *environment, virga_image *panorama)
{
    if (!panorama)
        return;
    *panorama = (virga_image){.image = VK_NULL_HANDLE};
    if (!environment || !environment->base.contents || environment->def.panorama_width < 2)
        return;
    const virga_image_2d *image = environment->panorama;
    *panorama = (virga_image){.image = image->image,
                              .view = image->layer_views[0],
                              .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                              .extent = {environment->def.panorama_width, environment->def.panorama_width / 2, 1},
                              .layers = 1,
                              .before = {.layout = VK_IMAGE_LAYOUT_GENERAL}};
}
