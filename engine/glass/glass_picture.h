/* glass/glass_picture.h - declares the resources and pipelines that render a pane: height map and draws. Internal.
 *
 *   glass_picture.c  create, destroy, descriptor sets
 *   glass_draw.c     prepare, attach, draw
 *   glass_textures.c drops as textures
 *   glass_temporal.c motion of a pane since the previous frame
 */
#ifndef VIRGA_GLASS_PICTURE_H
#define VIRGA_GLASS_PICTURE_H

#include "gpu/effect.h"

#include <virga/glass.h>
#include <virga/shared/glass_gpu.h>
#include <virga/shared/glass_picture_gpu.h>
#include <virga/shared/view_gpu.h>

/* Index of each pipeline of a target.
 * Physical style: one for each combination of VIRGA_GLASS_DRAW_... bits.
 * Paper style and mist: without and with the scene's depth, without and with the host's color image.
 * Refraction vectors: in either style, without and with the scene's depth.
 * Mist also has pipelines for opaque surfaces.
 * Drops as textures, and their refraction vectors: without and with the scene's depth.
 * Drops on the camera's front element: without and with lights.
 * Fog: without and with the scene's depth; of droplets that are too small to be seen, and of others. On opaque surfaces
 * the same. */
enum {
    GLASS_DRAW_PHYSICAL = 0,
    GLASS_DRAW_PAPER = 16,
    GLASS_DRAW_REFRACTION = 20,
    GLASS_DRAW_MIST = 24,
    GLASS_DRAW_TEXTURED = 32,
    GLASS_DRAW_TEXTURED_REFRACTION = 34,
    GLASS_DRAW_FRONT = 36,
    GLASS_DRAW_FOG = 38,
    GLASS_DRAW_SOLID_FOG = 42,
    GLASS_DRAW_OF_DROPLETS = 2, /* (fog) offset of those for droplets that are seen */
    GLASS_DRAW_OF_PAPER = 2,    /* (refraction) offset of the paper style */
    GLASS_DRAW_OF_PLATE = 2,    /* (paper, mist) offset of those with the host's color image */
    GLASS_DRAW_OF_SOLID = 4,    /* (mist) offset of those for opaque surfaces */
    GLASS_DRAW_ROWS = 9
};

#define GLASS_GATHER_FILM        16u   /* tiles with film */
#define GLASS_GATHER_MAP         32u   /* the host reads the height map */
#define GLASS_GATHER_BEADS       64u   /* the view is near enough to show beads of film as drops */
#define GLASS_GATHER_PAPER       128u  /* paper style: writes packed densities; heights only if the host reads them */
#define GLASS_GATHER_USUAL_STEPS 256u  /* at most VIRGA_GLASS_USUAL_STEPS of compression */
#define GLASS_GATHER_MASKED      512u  /* (paper) some cells may have no glass */
#define GLASS_GATHER_PINNED      1024u /* outlines are uneven */
#define GLASS_MIST_SEVERAL       1u    /* several cells per texel */
#define GLASS_MIST_MASKED        2u    /* some cells may have no glass */
#define GLASS_MIST_FORMS         4     /* passes, by these bits */
/* Combinations of GLASS_GATHER_... bits. Two or three are created per density, blend, style and compression in use. */
#define GLASS_GATHERS 2048

#define GLASS_ALL_TEXTURED 1e30f /* virga_glass_picture_gpu.textured_px: all drops are drawn as textures */

/* The uniform block of a view. */
typedef struct glass_view_block {
    virga_view_gpu view;
    virga_glass_picture_gpu look;
} glass_view_block;

/* What is known of each view besides virga_effect_view. */
typedef struct glass_prepared {
    bool has_written;                /* `written` is valid for every tile */
    virga_glass_style written_style; /* the style for which `written` is valid */

    bool has_textures;              /* all textures were made for some view */
    glass_view_block textures_view; /* of the newest prepare: what textures depend on */
    uint32_t next_texture;          /* the one whose turn it is */
    uint32_t late_textures;         /* those that do not show that view yet */
    bool has_copies;                /* its own copies of the plate are those of the newest prepare */

    /* Of its newest prepare. */
    bool plate;
    uint32_t draw; /* VIRGA_GLASS_DRAW_... */
    virga_glass_style style;
    bool shapes, textures; /* drops are drawn from the height map; as quads */
    bool front;            /* on the camera's front element */
    bool fog;              /* the pane may have some */
    bool fog_before;       /* it is on the eye's side of the pane */
} glass_prepared;

struct glass_picture {
    uint32_t max_columns, max_rows;           /* texels of the height map */
    uint32_t max_tile_columns, max_tile_rows; /* tiles of the height map */
    uint32_t max_entries;
    VkExtent2D max_mist; /* texels of the mist map, whole blocks */
    virga_buffer *balls, *tiles, *entries, *mist;
    VIRGA_PER_VIEW(virga_buffer, written);
    VIRGA_PER_VIEW(virga_buffer, work);
    VIRGA_PER_VIEW(virga_buffer, corners);
    virga_ring view_ring;
    uint32_t view_offset; /* of the newest view */
    VIRGA_PER_VIEW(virga_image_2d, map);
    bool whole_map; /* the host reads the map: it is also written where there is only mist */
    /* Inputs of the draws: in the paper style, see shaders/glass/draw/paper_texel.glsl, and in other styles. */
    VIRGA_PER_VIEW(virga_image_2d, paper_map);
    VIRGA_PER_VIEW(virga_image_2d, relief);
    VIRGA_PER_VIEW(virga_image_2d, copies);
    VIRGA_PER_VIEW(virga_image_2d, mist_map);
    VIRGA_PER_VIEW(virga_image_2d, textures);
    VIRGA_PER_VIEW(virga_image_2d, fog_map);
    bool filtered;                             /* the device can filter the relief */
    virga_image_2d *blank_depth, *blank_color; /* bound where a view has none */
    virga_bindings *bindings;
    virga_pipeline *ball_passes[2];    /* without and with drops as textures */
    virga_pipeline *texture_passes[2]; /* without and with the scene's depth */
    virga_pipeline *drop_quads, *front_quads, *mist_blocks, *film_tiles, *tile_list, *tile_fill, *tile_quads,
        *plate_copy, *plate_shrink, *fog_map_pass;
    virga_pipeline *mist_passes[GLASS_MIST_FORMS]; /* by GLASS_MIST_... */
    virga_pipeline *relief_passes[2];              /* without and with a mask */
    virga_pipeline *gather_passes[GLASS_GATHERS];  /* by GLASS_GATHER_... bits; NULL: not needed yet */
    uint32_t lanes; /* of a subgroup that exchanges values by shuffles; 0: by shared memory */

    uint32_t view_index; /* of the newest prepare in its frame */

    glass_prepared prepared[VIRGA_MAX_VIEWS]; /* by index of the view */
    uint32_t columns, rows;                   /* texels of the height map that the newest prepare uses */
    VkExtent2D mist_size;                     /* the same of the mist map */
    uint32_t mist_cells;
    bool any_beads; /* beads of film may be drawn as drops in some view */
    bool beads;     /* the same in the newest prepare */
};

/* ---- glass_picture.c */

enum { GLASS_PICTURE_BINDINGS = 33 };
extern const virga_binding_kind glass_picture_bindings[GLASS_PICTURE_BINDINGS];

/* Fills the max_... members of `sizes` from a definition. Creates nothing. */
void glass_picture_fill_sizes(const virga_glass_def *def, struct glass_picture *sizes);

/* The first word of the quads of fog in the buffer of corners: the words of all others. */
VkDeviceSize glass_fog_offset(const struct glass_picture *sizes, const virga_glass_def *def);

/* Creates the passes that depend on the device or on settings. The buffers, images and layouts must exist. */
virga_result glass_picture_create(virga_glass *glass);
void glass_picture_destroy(virga_glass *glass);

/* Whether a bead of film is large enough for a shape, on a height map with texels of this side. */
bool glass_picture_has_beads(float cell_m, float texel_m);

/* Creates the missing pipelines that these settings need, see virga_context_def.pipeline_build_mode. */
virga_result glass_picture_need(virga_glass *glass, const virga_glass_settings *settings);

/* GLASS_GATHER_... bits for these settings, without GLASS_GATHER_FILM and _BEADS. */
uint32_t glass_picture_gather(const virga_glass *glass, const virga_glass_settings *settings);

/* Writes the descriptor set of a view of this frame. `copies` of the plate are those of another pane; NULL: its own. */
VkDescriptorSet glass_picture_write_set(virga_glass *glass, uint32_t index, const virga_view *view, VkImageView copies);

/* All tiles and textures of all views hold unknown contents. */
void glass_picture_forget(virga_glass *glass);

/* ---- glass_textures.c */

/* A side of a texture: the next power of two. */
uint32_t glass_texture_texels(uint32_t asked);
/* Whether the pane is the camera's front element. */
bool glass_is_front(const virga_glass_settings *settings);
/* Whether all drops are drawn as quads, without a height map, and whether any are. */
bool glass_is_all_textured(const virga_glass_settings *settings);
bool glass_is_textured(const virga_glass_settings *settings);
/* Fills what the passes need to know of textures, and chooses those that this prepare makes. */
void glass_fill_textures(virga_glass *glass, glass_view_block *block);
/* Whether this prepare makes no texture, because what is behind the pane is as before: nor copies of the plate then. */
bool glass_keeps_textures(const virga_glass *glass, const glass_view_block *block);
/* Records the passes that make textures and quads. The descriptor set is bound. */
void glass_record_textures(virga_glass *glass, VkCommandBuffer cmd, const glass_view_block *block);

/* ---- glass_fog.c */

/* Whether views of the pane show fog. */
bool glass_shows_fog(const virga_glass_settings *settings);
void glass_fill_fog_look(const virga_glass *glass, virga_glass_picture_gpu *look);
/* Records the pass that makes the fog map. The descriptor set is bound. */
void glass_record_fog_map(virga_glass *glass, VkCommandBuffer cmd);

/* ---- glass_draw.c */
extern const virga_effect_draw glass_draws[GLASS_DRAW_ROWS];
uint32_t glass_wanted_draws(const void *glass, const void *settings);
uint32_t glass_draw_constant(const void *glass);
virga_result glass_draw(virga_glass *glass, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                        const char *call);

/* Fills the pane's motion since the previous frame. look->world_from_pane must be filled. In glass_temporal.c. */
void glass_fill_before(const virga_view *view, const virga_glass_pose *pose, virga_glass_picture_gpu *look);

/* Recreates the passes for a subgroup of `lanes` lanes. 0: they exchange balls through shared memory. For tests and
 * measurements, on a device that supports shuffles. The results are bit-identical. */
virga_result glass_picture_use_lanes(virga_glass *glass, uint32_t lanes);

#endif
