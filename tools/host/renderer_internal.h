/* renderer_internal.h - what the files of the renderer share. */
#ifndef VIRGA_HOST_RENDERER_INTERNAL_H
#define VIRGA_HOST_RENDERER_INTERNAL_H

#include "contact.h"
#include "cull.h"
#include "descriptors.h"
#include "mirror.h"
#include "renderer.h"
#include "reuse.h"
#include "shaders/frame_gpu.h"
#include "shelter.h"
#include "skylight.h"

/* Each has two variants: with and without back-face culling. */
typedef enum host_pipeline {
    HOST_PIPELINE_DEPTH,  /* opaque, depth only */
    HOST_PIPELINE_CUTOUT, /* cut-out, depth only */
    HOST_PIPELINE_ID,     /* the same two with ids */
    HOST_PIPELINE_CUTOUT_ID,
    HOST_PIPELINE_SHADE, /* color of opaque and cut-out, where the depth is equal */
    HOST_PIPELINE_GLASS, /* blended over it */
    /* Instead of HOST_PIPELINE_SHADE; not in the mirror, where nothing is wet. */
    HOST_PIPELINE_GROUND,   /* for ground that is level */
    HOST_PIPELINE_FOOT,     /* where water may also climb */
    HOST_PIPELINE_DRY,      /* where no water can lie */
    HOST_PIPELINE_DRY_FOOT, /* nor lie, but climb */
    HOST_PIPELINE_DRY_GLASS,
    HOST_PIPELINE_CLOTH,   /* instead of HOST_PIPELINE_SHADE for all of what lets light through; not in the mirror */
    HOST_PIPELINE_DATA,    /* instead of HOST_PIPELINE_SHADE: no color */
    HOST_PIPELINE_FOOTAGE, /* what water changes of ground on a picture */
    HOST_PIPELINE_FOOTAGE_MIRROR, /* instead of the sky in the mirror, where a picture replaces the plate */
    HOST_PIPELINE_SKY,
    HOST_PIPELINE_SWEPT,       /* after all others: color of what moves while the shutter is open, blended ... */
    HOST_PIPELINE_SWEPT_DATA,  /* ... and the rest, with depth */
    HOST_PIPELINE_SWEPT_DEPTH, /* depth alone */
    HOST_PIPELINE_SWEPT_ID,    /* where it may be: ids without depth */
    HOST_PIPELINE_COUNT,
} host_pipeline;

/* Bindings of set 0, as the shaders have them. */
enum {
    FRAME_AT_UNIFORMS,
    FRAME_AT_SKY,
    FRAME_AT_REFLECTION,
    FRAME_AT_SKYLIGHT,
    FRAME_AT_WETNESS, /* of the ground, as the two below */
    FRAME_AT_SPOTS,
    FRAME_AT_RIPPLES,
    FRAME_AT_MIRROR,
    FRAME_AT_FAR_WETNESS, /* of the ground beyond the simulated window */
    FRAME_AT_MIRROR_NEAR, /* distances in the mirror */
    FRAME_AT_SHELTER,     /* where walls stay dry */
    FRAME_AT_CONTACT,     /* shade where things stand on the ground */
    FRAME_BINDINGS,
};

/* Set 1: the two textures of a material. */
extern const host_set_shape host_material_shape;

typedef struct host_entry { /* a mesh that was added */
    const host_mesh *mesh;
    VkDescriptorPool pool;
    VkDescriptorSet *sets; /* one for each material */
    uint32_t first_id;
} host_entry;

struct host_renderer {
    host_device *device;
    host_plate_parts parts;
    VkSampler samplers[HOST_SAMPLINGS];
    VkDescriptorSetLayout material_layout;
    host_bindings bindings;
    VkPipeline pipelines[HOST_PIPELINE_COUNT][2]; /* [1]: two-sided; NULL: not drawn with yet */
    VkPipeline mirror_pipelines[HOST_PIPELINE_COUNT][2];
    host_buffer frame_buffer;
    host_image white, blank_spots;
    virga_ground_maps ground; /* cells 0: none */
    host_mirror mirror;       /* width 0: none */
    double mirror_m;          /* height of its plane */
    bool mirror_drawn;        /* at least once */
    uint32_t mirror_share;    /* sub-frames of this frame that look into one picture of it */
    float mirror_shows;       /* 1: it was drawn with the scene; 0: empty */
    float mirror_clip[16];    /* its clip space from what is relative to mirror_eye_m, with its jitter */
    double mirror_eye_m[3];   /* the camera it was drawn with */
    host_reuse reuse;         /* width 0: none */
    bool found;               /* where the next sub-frame can keep shading */
    float found_px[2];        /* jitter of the one that shaded it */
    host_draw_haze draw_haze; /* draws over the mirror; NULL: none */
    void *haze_user;
    host_skylight skylight;
    host_shelter shelter;
    host_contact contact;
    bool has_contact;
    bool has_meniscus;
    host_cull cull; /* of the camera that the plate is drawn with */
    double foot_m;  /* water climbs nothing above; -DBL_MAX: nothing */
    bool has_walls; /* else all walls are dry */
    virga_walls walls;
    const host_environment *environment;
    virga_light lights[HOST_MAX_LIGHTS];
    uint32_t light_count;
    host_entry *entries;
    uint32_t entry_count;
    uint32_t next_id;
    const host_mesh *footage; /* see host_renderer_set_footage; NULL: none */
    VkDescriptorPool footage_pool;
    VkDescriptorSet footage_set; /* color and depth of the plate that it replaces */
};

/* renderer_frame.c: the uniforms of a plate. */
void host_renderer_fill_frame(const host_renderer *renderer, const host_target *target, const host_camera *camera,
                              const host_camera *previous, struct host_frame_gpu *frame);

/* Bits of the lights that may reach a primitive. */
uint32_t host_renderer_lamps(const host_renderer *renderer, const host_mesh *mesh, const host_primitive *primitive);

/* Remembers what the mirror is drawn with: the camera, and the uniforms filled for it. */
void host_renderer_place_mirror(host_renderer *renderer, const host_camera *camera, const struct host_frame_gpu *frame);

/* Uniforms of a plate that looks into the mirror as it was placed last. */
void host_renderer_look_at_mirror(const host_renderer *renderer, const host_camera *camera,
                                  struct host_frame_gpu *frame);

/* renderer_draw.c: into the plate of `target`, the scene or the environment alone. What moves, by itself or with the
 * camera, is left out; nothing is wet, and the lights are those of the renderer. */
bool host_renderer_draw_still(host_renderer *renderer, VkCommandBuffer cmd, const host_target *target,
                              const host_camera *camera, bool scene, char *error, size_t error_size);

/* renderer_pipelines.c: set layouts and the pipeline layout. */
bool host_renderer_create_bindings(host_renderer *renderer, char *error, size_t error_size);

/* A pipeline for the pass of the mirror, or else of a plate. It is built where it is not there yet. */
bool host_renderer_pipeline(host_renderer *renderer, VkRenderPass pass, host_pipeline kind, bool two_sided,
                            VkPipeline *pipeline, char *error, size_t error_size);

#endif
