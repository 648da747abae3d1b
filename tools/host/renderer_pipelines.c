/* renderer_pipelines.c - layouts of the plate, and its pipelines, which are built by their first draws. */
#include <string.h>

#include "pipeline.h"
#include "renderer_internal.h"

#include "cutout_frag.spv.h"
#include "cutout_frag_id.spv.h"
#include "footage_mirror_frag.spv.h"
#include "id_frag.spv.h"
#include "scene_frag.spv.h"
#include "scene_frag_cloth.spv.h"
#include "scene_frag_data.spv.h"
#include "scene_frag_dry.spv.h"
#include "scene_frag_dry_foot.spv.h"
#include "scene_frag_foot.spv.h"
#include "scene_frag_footage.spv.h"
#include "scene_frag_ground.spv.h"
#include "scene_frag_mirror.spv.h"
#include "scene_frag_swept.spv.h"
#include "scene_vert.spv.h"
#include "scene_vert_mirror.spv.h"
#include "sky_frag.spv.h"
#include "sky_frag_mirror.spv.h"
#include "sky_vert.spv.h"
#include "swept_frag.spv.h"

#define IMAGE VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER

static const VkDescriptorType types[FRAME_BINDINGS] = {
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE, IMAGE};

const host_set_shape host_material_shape = {types + 1, 2, VK_SHADER_STAGE_FRAGMENT_BIT};

bool host_renderer_create_bindings(host_renderer *r, char *error, size_t error_size)
{
    if (!host_set_layout_create(r->device, &host_material_shape, &r->material_layout, error, error_size))
        return false;
    const host_bindings_def def = {
        .shape = {types, FRAME_BINDINGS, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT},
        .set_count = 1,
        .push_stages = VK_SHADER_STAGE_FRAGMENT_BIT,
        .push_bytes = sizeof(struct host_surface_gpu),
        .next = r->material_layout,
    };
    return host_bindings_create(r->device, &def, &r->bindings, error, error_size);
}

/* ---- one pipeline ------------------------------------------------------------------------------------------- */

enum {
    SHADER_SCENE_VERT,
    SHADER_CUTOUT,
    SHADER_ID,
    SHADER_CUTOUT_ID,
    SHADER_SCENE_FRAG,
    SHADER_GROUND_FRAG,
    SHADER_FOOT_FRAG,
    SHADER_DRY_FRAG,
    SHADER_DRY_FOOT_FRAG,
    SHADER_CLOTH_FRAG,
    SHADER_DATA_FRAG,
    SHADER_FOOTAGE_FRAG,
    SHADER_FOOTAGE_MIRROR,
    SHADER_SKY_VERT,
    SHADER_SKY_FRAG,
    SHADER_SWEPT_COLOR,
    SHADER_SWEPT,
};

#define NO_SHADER (-1)

static const struct {
    int vertex, fragment;
    bool write_depth, write_color, blend;
    VkCompareOp compare;
} recipes[HOST_PIPELINE_COUNT] = {
    [HOST_PIPELINE_DEPTH] = {SHADER_SCENE_VERT, NO_SHADER, true, false, false, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_CUTOUT] = {SHADER_SCENE_VERT, SHADER_CUTOUT, true, false, false, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_ID] = {SHADER_SCENE_VERT, SHADER_ID, true, false, false, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_CUTOUT_ID] = {SHADER_SCENE_VERT, SHADER_CUTOUT_ID, true, false, false, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_SHADE] = {SHADER_SCENE_VERT, SHADER_SCENE_FRAG, false, true, false, VK_COMPARE_OP_EQUAL},
    [HOST_PIPELINE_GLASS] = {SHADER_SCENE_VERT, SHADER_FOOT_FRAG, false, true, true, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_GROUND] = {SHADER_SCENE_VERT, SHADER_GROUND_FRAG, false, true, false, VK_COMPARE_OP_EQUAL},
    [HOST_PIPELINE_FOOT] = {SHADER_SCENE_VERT, SHADER_FOOT_FRAG, false, true, false, VK_COMPARE_OP_EQUAL},
    [HOST_PIPELINE_DRY] = {SHADER_SCENE_VERT, SHADER_DRY_FRAG, false, true, false, VK_COMPARE_OP_EQUAL},
    [HOST_PIPELINE_DRY_FOOT] = {SHADER_SCENE_VERT, SHADER_DRY_FOOT_FRAG, false, true, false, VK_COMPARE_OP_EQUAL},
    [HOST_PIPELINE_DRY_GLASS] = {SHADER_SCENE_VERT, SHADER_DRY_FOOT_FRAG, false, true, true, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_CLOTH] = {SHADER_SCENE_VERT, SHADER_CLOTH_FRAG, false, true, false, VK_COMPARE_OP_EQUAL},
    [HOST_PIPELINE_DATA] = {SHADER_SCENE_VERT, SHADER_DATA_FRAG, false, true, false, VK_COMPARE_OP_EQUAL},
    [HOST_PIPELINE_FOOTAGE] = {SHADER_SCENE_VERT, SHADER_FOOTAGE_FRAG, false, true, true, VK_COMPARE_OP_ALWAYS},
    [HOST_PIPELINE_FOOTAGE_MIRROR] = {SHADER_SKY_VERT, SHADER_FOOTAGE_MIRROR, true, true, false,
                                      VK_COMPARE_OP_LESS_OR_EQUAL},
    [HOST_PIPELINE_SKY] = {SHADER_SKY_VERT, SHADER_SKY_FRAG, false, true, false, VK_COMPARE_OP_LESS_OR_EQUAL},
    [HOST_PIPELINE_SWEPT] = {SHADER_SCENE_VERT, SHADER_SWEPT_COLOR, false, true, true, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_SWEPT_DATA] = {SHADER_SCENE_VERT, SHADER_SWEPT, true, true, false, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_SWEPT_DEPTH] = {SHADER_SCENE_VERT, SHADER_SWEPT, true, false, false, VK_COMPARE_OP_LESS},
    [HOST_PIPELINE_SWEPT_ID] = {SHADER_SCENE_VERT, SHADER_ID, false, false, false, VK_COMPARE_OP_LESS},
};

/* The shader of the plate, or of the mirror. */
static host_code code_of(int shader, bool mirror)
{
    switch (shader) {
    case SHADER_SCENE_VERT: return mirror ? HOST_CODE(scene_vert_mirror) : HOST_CODE(scene_vert);
    case SHADER_CUTOUT: return HOST_CODE(cutout_frag);
    case SHADER_ID: return HOST_CODE(id_frag);
    case SHADER_CUTOUT_ID: return HOST_CODE(cutout_frag_id);
    case SHADER_SCENE_FRAG: return mirror ? HOST_CODE(scene_frag_mirror) : HOST_CODE(scene_frag);
    case SHADER_GROUND_FRAG: return HOST_CODE(scene_frag_ground);
    case SHADER_FOOT_FRAG: return mirror ? HOST_CODE(scene_frag_mirror) : HOST_CODE(scene_frag_foot);
    case SHADER_DRY_FOOT_FRAG: return HOST_CODE(scene_frag_dry_foot);
    case SHADER_DRY_FRAG: return HOST_CODE(scene_frag_dry);
    case SHADER_CLOTH_FRAG: return HOST_CODE(scene_frag_cloth);
    case SHADER_DATA_FRAG: return HOST_CODE(scene_frag_data);
    case SHADER_FOOTAGE_FRAG: return HOST_CODE(scene_frag_footage);
    case SHADER_FOOTAGE_MIRROR: return HOST_CODE(footage_mirror_frag);
    case SHADER_SKY_VERT: return HOST_CODE(sky_vert);
    case SHADER_SKY_FRAG: return mirror ? HOST_CODE(sky_frag_mirror) : HOST_CODE(sky_frag);
    case SHADER_SWEPT_COLOR: return HOST_CODE(scene_frag_swept);
    case SHADER_SWEPT: return HOST_CODE(swept_frag);
    default: return (host_code){0};
    }
}

/* Glass only changes the color. Normal, velocity, id and depth are those of the surface behind it. */
static void fill_blend(host_pipeline kind, VkPipelineColorBlendAttachmentState states[HOST_PLATE_COLORS])
{
    memset(states, 0, HOST_PLATE_COLORS * sizeof *states);
    for (int i = 0; i < HOST_PLATE_COLORS; i++)
        if (recipes[kind].write_color && (i == 0 || !recipes[kind].blend || kind == HOST_PIPELINE_FOOTAGE))
            states[i] = recipes[kind].blend && i == 0 ? host_blend_over : host_blend_replace;
    if (kind == HOST_PIPELINE_ID || kind == HOST_PIPELINE_CUTOUT_ID || kind == HOST_PIPELINE_SWEPT_ID)
        states[HOST_ID] = host_blend_replace;
    if (kind == HOST_PIPELINE_SWEPT_DATA) /* the color is there */
        states[0].colorWriteMask = 0;
}

static bool create_pipeline(host_renderer *r, VkRenderPass pass, host_pipeline kind, bool two_sided,
                            VkPipeline *pipeline, char *error, size_t error_size)
{
    const bool mirror = pass == r->mirror.pass;
    VkPipelineColorBlendAttachmentState colors[HOST_PLATE_COLORS];
    fill_blend(kind, colors);
    const host_graphics_def def = {
        .vertex = code_of(recipes[kind].vertex, mirror),
        .fragment = code_of(recipes[kind].fragment, mirror),
        .layout = r->bindings.layout,
        .pass = pass,
        .attribute_count = recipes[kind].vertex == SHADER_SKY_VERT ? 0 : 3,
        .cull = two_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT,
        .front = mirror ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE,
        .depth_test = true,
        .depth_write = recipes[kind].write_depth,
        .compare = recipes[kind].compare,
        .colors = colors,
        .color_count = mirror ? 2 : HOST_PLATE_COLORS,
    };
    return host_graphics_create(r->device, &def, pipeline, error, error_size);
}

/* A scene draws with a few of them, and a driver takes as long for each as for a small picture. */
bool host_renderer_pipeline(host_renderer *r, VkRenderPass pass, host_pipeline kind, bool two_sided,
                            VkPipeline *pipeline, char *error, size_t error_size)
{
    VkPipeline *built = &(pass == r->mirror.pass ? r->mirror_pipelines : r->pipelines)[kind][two_sided];
    const bool ok = *built || create_pipeline(r, pass, kind, two_sided, built, error, error_size);
    *pipeline = *built;
    return ok;
}
