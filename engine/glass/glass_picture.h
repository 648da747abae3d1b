/* glass/glass_picture.h - the object behind the height map and the draws of a pane. Internal.
 *
 *   glass_picture.c  create, destroy, what sets hold
 *   glass_draw.c     prepare, attach, draw
 *   glass_temporal.c where a pane was in the previous frame's picture
 */
#ifndef VIRGA_GLASS_PICTURE_H
#define VIRGA_GLASS_PICTURE_H

#include "gpu/effect.h"

#include <virga/glass.h>
#include <virga/shared/glass_gpu.h>
#include <virga/shared/glass_picture_gpu.h>
#include <virga/shared/view_gpu.h>

/* Pipelines of a target: by Snell for each of VIRGA_GLASS_DRAW_..., the paper's, and refraction vectors by either,
 * without and with the scene's depth; then mist, also on what is not glass. The paper's and mist are made for a picture
 * of the host's and for none. */
enum {
    GLASS_DRAW_PHYSICAL = 0,
    GLASS_DRAW_PAPER = 16,
    GLASS_DRAW_REFRACTION = 20,
    GLASS_DRAW_MIST = 24,
    GLASS_DRAW_OF_PAPER = 2, /* what is added for refraction vectors in the paper's style */
    GLASS_DRAW_OF_PLATE = 2, /* (paper, mist) for a picture of the host's */
    GLASS_DRAW_OF_SOLID = 4, /* (mist) and for what is not glass */
    GLASS_DRAW_ROWS = 4
};

#define GLASS_GATHER_FILM        16u  /* tiles with film */
#define GLASS_GATHER_MAP         32u  /* the host wants the map */
#define GLASS_GATHER_BEADS       64u  /* in a view that is near enough to show beads of film as drops */
#define GLASS_GATHER_PAPER       128u /* words of densities, for the paper's style; heights only for the host */
#define GLASS_GATHER_USUAL_STEPS 256u /* not more than VIRGA_GLASS_USUAL_STEPS of compression */
#define GLASS_GATHER_MASKED      512u /* (paper) there may be cells without glass */
#define GLASS_MIST_SEVERAL       1u   /* cells to a texel */
#define GLASS_MIST_MASKED        2u   /* there may be cells without glass */
#define GLASS_MIST_FORMS         4    /* passes by these bits */
/* Three are made for each density, blend, style and length of compression in use. */
#define GLASS_GATHERS 1024

/* What a view's uniform block holds. */
typedef struct glass_view_block {
    virga_view_gpu view;
    virga_glass_picture_gpu look;
} glass_view_block;

struct glass_picture {
    uint32_t max_columns, max_rows;           /* texels of the map */
    uint32_t max_tile_columns, max_tile_rows; /* and tiles */
    uint32_t max_entries;
    VkExtent2D max_mist; /* texels of the mist's map, whole blocks */
    virga_buffer *balls, *tiles, *entries, *mist, *written, *work, *corners;
    virga_ring view_ring;
    uint32_t view_offset; /* of the newest view */
    virga_image_2d *map;
    bool whole_map;            /* the host wants it, also where there is only mist */
    virga_image_2d *paper_map; /* what the paper's style draws from, see shaders/glass/draw/paper_texel.glsl */
    virga_image_2d *relief;    /* what others do */
    virga_image_2d *copies, *mist_map;
    bool filtered;                             /* the device filters the relief */
    virga_image_2d *blank_depth, *blank_color; /* for what a view has not */
    virga_bindings *bindings;
    virga_pipeline *ball_pass, *mist_blocks, *film_tiles, *tile_list, *tile_fill, *tile_quads, *plate_copy,
        *plate_shrink;
    virga_pipeline *mist_passes[GLASS_MIST_FORMS]; /* by GLASS_MIST_... */
    virga_pipeline *relief_passes[2];              /* without and with a mask */
    virga_pipeline *gather_passes[GLASS_GATHERS];  /* by density, blend and film; NULL: not needed yet */
    uint32_t lanes;                  /* of a subgroup that passes hand values around in; 0: they use shared memory */
    bool has_written;                /* `written` says something of every tile */
    virga_glass_style written_style; /* that `written` says of what its images hold */

    bool prepared_plate;
    uint32_t prepared_draw; /* VIRGA_GLASS_DRAW_... */
    virga_glass_style prepared_style;
    uint32_t columns, rows; /* texels in use since the newest prepare */
    VkExtent2D mist_size;   /* and of the mist's map */
    uint32_t mist_cells;
    bool beads; /* may have a shape in this view */
};

/* ---- glass_picture.c */

enum { GLASS_PICTURE_BINDINGS = 29 };
extern const virga_binding_kind glass_picture_bindings[GLASS_PICTURE_BINDINGS];

/* The sizes of a definition's picture: fills `sizes`, in which nothing is made. */
void glass_picture_fill_sizes(const virga_glass_def *def, struct glass_picture *sizes);

/* Makes the passes that are chosen by the device and by settings. The rows' buffers, images and layouts are there. */
virga_result glass_picture_create(virga_glass *glass);
void glass_picture_destroy(virga_glass *glass);

/* Pipelines that these settings need and that are not there yet, see virga_context_def.pipeline_build_mode. */
virga_result glass_picture_need(virga_glass *glass, const virga_glass_settings *settings);

/* Of the gathers, those for these settings: without GLASS_GATHER_FILM and _BEADS. */
uint32_t glass_picture_gather(const virga_glass *glass, const virga_glass_settings *settings);

/* Writes the set of a frame's view. */
VkDescriptorSet glass_picture_write_set(virga_glass *glass, uint32_t index, const virga_view *view);

/* ---- glass_draw.c */
extern const virga_effect_draw glass_draws[GLASS_DRAW_ROWS];
uint32_t glass_draw_constant(const void *glass);

/* Where the pane was in the previous frame's picture; world_from_pane is filled. In glass_temporal.c. */
void glass_fill_before(const virga_view *view, const virga_glass_pose *pose, virga_glass_picture_gpu *look);

/* Makes the passes anew as for a subgroup of so many lanes, 0: as for a device that hands balls around in shared
 * memory. For tests and measurements, on a device that may shuffle. The same bits. */
virga_result glass_picture_use_lanes(virga_glass *glass, uint32_t lanes);

#endif
