/* gpu/pipelines.h - compute and graphics pipelines from embedded SPIR-V. Internal.
 *
 * A pipeline is built at once or later, see gpu/builds.c. Objects of one kind, e.g. the panes of a scene, need the same
 * pipelines. Each of them is built once in a context, and shared. */
#ifndef VIRGA_GPU_PIPELINES_H
#define VIRGA_GPU_PIPELINES_H

#include "gpu/retire.h"
#include "gpu/spirv.h"

/* Pipelines that are used together: nothing that uses them is recorded until all of them are built. */
typedef struct virga_pipeline_group {
    uint32_t waiting;    /* pipelines still to be built; 0 with VIRGA_PIPELINES_ON_USE */
    virga_result failed; /* result of the first that failed; VIRGA_OK: none */
} virga_pipeline_group;

/* What an effect holds: a use of a pipeline that the device has built or will build. */
typedef struct virga_pipeline {
    virga_resource resource;      /* first */
    VkPipeline pipeline;          /* null until it is built, or if the build failed */
    const char *name;             /* static */
    virga_pipeline_group *group;  /* (optional) lives until the pipeline is retired */
    struct virga_built *built;    /* the pipeline on the device */
    struct virga_pipeline *after; /* the next one that waits for the same build */
    bool waits;                   /* for the build */
    virga_result failed;
} virga_pipeline;

/* The definition of a compute pipeline. `constant` is specialisation constant 0, if the shader has one; constant 1 is
 * the context's small_views. */
typedef struct virga_compute_def {
    const virga_spirv *shader;
    struct virga_layout *layout;
    uint32_t constant;
    virga_pipeline_group *group; /* (optional) */
    const char *name;            /* static */
} virga_compute_def;

virga_result virga_compute_pipeline_create(virga_context *context, const virga_compute_def *def,
                                           virga_pipeline **pipeline);

/* Outputs of fragment shaders besides the colour, as bits. Such a shader is compiled once for each combination, see
 * shaders/meson.build. */
typedef enum virga_target_outputs {
    VIRGA_OUTPUTS_COLOR = 0,
    VIRGA_OUTPUTS_MOTION = 1,
    VIRGA_OUTPUTS_REACTIVE = 2,
    VIRGA_OUTPUTS_BOTH = 3,
    VIRGA_OUTPUTS_FORMS = 4,
} virga_target_outputs;

/* The render passes of all mesh maps are compatible. Other classes are the serials of target classes. */
#define VIRGA_PASS_OF_MESH_MAPS UINT32_MAX

/* The definition of a graphics pipeline. */
typedef struct virga_graphics_def {
    const virga_spirv *vertex, *fragment;
    struct virga_layout *layout;
    VkRenderPass render_pass; /* null: dynamic rendering into these formats */
    uint32_t pass_class;      /* compatible render passes have the same number; 0: not known, so it is not shared */
    uint32_t subpass;
    VkFormat color_formats[VIRGA_MAX_ATTACHMENTS], depth_format, stencil_format;
    uint32_t view_mask;     /* of dynamic rendering */
    uint32_t vertex_stride; /* 0: no vertex input; else one vec3 at location 0 */
    /* Attachments beyond the first are written only if they are motion_attachment or reactive_attachment. */
    uint32_t color_count;
    virga_target_outputs outputs;                    /* of the fragment shader */
    uint32_t motion_attachment, reactive_attachment; /* 0: none */
    bool blend_premultiplied, blend_add;
    bool add_all;  /* blend_add is for all attachments, not only the first */
    bool no_color; /* writes depth alone */
    bool depth_test, depth_write, reversed_depth;
    bool cull_back;    /* counter-clockwise on the screen is the front */
    bool lines;        /* lines instead of triangles; their width is dynamic */
    uint32_t constant; /* specialisation constant 0 of both shaders, if they have one */
    bool encoded;      /* specialisation constants 2 and 3 of the fragment shader, see shaders/gpu/encode.glsl */
    float blend_background;
    VkSampleCountFlagBits samples;
    virga_pipeline_group *group; /* (optional) */
    const char *name;            /* static */
} virga_graphics_def;

virga_result virga_graphics_pipeline_create(virga_context *context, const virga_graphics_def *def,
                                            virga_pipeline **pipeline);

/* A pipeline on the device, with the definition that it is found by. Exists as long as a virga_pipeline uses it. */
typedef struct virga_built {
    struct virga_built *next; /* of the context */
    const char *name;         /* static */
    bool is_graphics;
    virga_compute_def compute;
    virga_graphics_def graphics;
    VkPipeline handle; /* null until it is built */
    uint32_t users;
    bool closed;               /* the build failed or was abandoned: nobody else may use it */
    virga_pipeline *waiting;   /* the users that wait for the build */
    struct virga_build *build; /* NULL: it is not waiting to be built */
    uint32_t *code;            /* a copy of the fragment shader, if it was patched for the target; NULL once built */
    virga_spirv patched;       /* the same, as a shader */
} virga_built;

#endif
