/* lens/lens_internal.h - defines the struct of virga_lens and the functions its files share. Internal.
 *
 *   lens.c           create, destroy, settings, queries
 *   lens_aperture.c  the area of the aperture's image on a grid of pixels
 *   lens_prepare.c   prepare
 *   lens_draw.c      draw
 */
#ifndef VIRGA_LENS_LENS_INTERNAL_H
#define VIRGA_LENS_LENS_INTERNAL_H

#include "gpu/context.h"
#include "gpu/effect.h"

#include <virga/lens.h>
#include <virga/shared/lens_gpu.h>

/* Bindings of the passes. */
enum {
    LENS_BIND_DEPTH = 4,
    LENS_BIND_COLOR,
    LENS_BIND_FIELDS_WRITTEN = 11,
    LENS_BIND_FIELDS,
    LENS_BIND_LAYER_COLORS = 15,
    LENS_BIND_LAYER_DEPTHS = LENS_BIND_LAYER_COLORS + VIRGA_LENS_LAYERS,
    LENS_BIND_SPREADS = LENS_BIND_LAYER_DEPTHS + VIRGA_LENS_LAYERS,
    LENS_BIND_ON_SCENE,
    LENS_BIND_CIRCLES,
    LENS_BIND_LISTS,
    LENS_BIND_FOCUS,
    LENS_BIND_BLOCKS,
    LENS_BIND_BLOCKS_WRITTEN,
    LENS_BIND_FAR,
    LENS_BIND_COARSE_WRITTEN,
    LENS_BIND_COARSE_NEAR,
    LENS_BIND_COARSE_FAR,
    LENS_BIND_PACKED_WRITTEN,
    LENS_BIND_FIRST_LAYER,
    LENS_BIND_FIRST_COARSE_LAYER,
    LENS_BIND_COARSE,
    LENS_BIND_FOCUS_WRITTEN,
    LENS_BIND_CIRCLES_OF_NEAR_WRITTEN,
    LENS_BIND_CIRCLES_OF_NEAR,
    LENS_BINDINGS,
};

/* Pipelines of passes. */
enum {
    LENS_SAMPLES = 4,      /* by VIRGA_LENS_LINEAR and _ON_SCENE */
    LENS_GATHERS = 8,      /* by VIRGA_LENS_SHAPED, _ON_SCENE and _NO_NEAR */
    LENS_LAYER_FORMS = 4,  /* by VIRGA_LENS_SHAPED and _DEPTHS */
    LENS_NARROWS = 8,      /* by VIRGA_LENS_SHAPED, _NARROW_LINEAR and _ALONE */
    LENS_LAYER_SCALES = 4, /* by VIRGA_LENS_SHAPED and _QUARTER */
};

/* What is known of the newest prepare of each view besides virga_effect_view. */
typedef struct lens_prepared {
    double time_s;
    bool has_time;
    uint32_t width, height, layers;
    bool all_sharp; /* nothing is out of focus, as far as is known without the pictures */
    uint32_t tiles; /* with an entry for each in place of lists; 0: there are lists, see shaders/lens/narrow.glsl */
    bool wide;      /* there are coarse fields */
} lens_prepared;

struct virga_lens {
    virga_effect base; /* first */
    virga_lens_def def;
    virga_lens_settings settings;
    float areas[VIRGA_LENS_SPREADS];

    VIRGA_PER_VIEW(virga_buffer, state);
    VIRGA_PER_VIEW(virga_buffer, focused); /* a copy of it, see shaders/lens/focus.comp */
    virga_buffer *tiles, *reaches;
    VIRGA_PER_VIEW(virga_buffer, lists);     /* tiles to draw, if def.in_place */
    VIRGA_PER_VIEW(virga_image_2d, picture); /* NULL if def.in_place */
    VIRGA_PER_VIEW(virga_image_2d, fields);
    VIRGA_PER_VIEW(virga_image_2d, coarse);       /* likewise at half of that resolution; NULL unless def.in_place */
    VIRGA_PER_VIEW(virga_image_2d, packed);       /* the far field in 32 bits; NULL unless def.in_place */
    VIRGA_PER_VIEW(virga_image_2d, near_circles); /* of the near field, if wide; NULL unless def.in_place */
    VIRGA_PER_VIEW(virga_image_2d, circles);      /* NULL unless def.circles, and then those of the picture are */
    virga_image_2d *aperture, *samples, *spreads, *blocks, *blank_depth, *blank_color;
    virga_ring view_ring;
    lens_prepared prepared[VIRGA_MAX_VIEWS]; /* by index of the view */
    virga_bindings *bindings;
    virga_pipeline *focus, *aperture_reach, *sample[LENS_SAMPLES], *tile[VIRGA_LENS_LAYERS + 1], *reach,
        *block[VIRGA_LENS_BLOCK_FORMS], *gather[LENS_GATHERS], *narrow[LENS_NARROWS], *wide[LENS_NARROWS],
        *narrow_plane[LENS_LAYER_SCALES], *narrow_depths[LENS_LAYER_SCALES], *layer_sample[VIRGA_LENS_LAYERS],
        *layer[LENS_LAYER_FORMS], *combine[VIRGA_LENS_COMBINE_FORMS * (VIRGA_LENS_LAYERS + 1)],
        *paper[2 * (VIRGA_LENS_LAYERS + 1)], *circle[VIRGA_LENS_LAYERS + 1];
    virga_lens_stats stats;
};

/* ---- lens_aperture.c */

/* Fills the areas of an aperture's image on a grid of pixels, for the radii of shaders/lens/spread.glsl. */
void lens_fill_areas(uint32_t blades, double roundness, double rotation_deg, float areas[VIRGA_LENS_SPREADS]);

/* ---- lens.c */

/* Which of the forms for 0 to VIRGA_LENS_LAYERS layers a pass has for so many: that one, but on GPUs from two layers on
 * the last one, see FOR_LAYERS in shaders/lens/layers.glsl. */
uint32_t lens_layer_form(const virga_lens *lens, uint32_t layers);

/* By which passes discs are gathered at half resolution, see shaders/lens/narrow.glsl. */
typedef enum lens_way {
    LENS_WAY_ANY,    /* of any width, from blocks of texels */
    LENS_WAY_NARROW, /* in one pass */
    LENS_WAY_WIDE,   /* (in place) the same for wider ones, from two scales */
} lens_way;

/* The one place that chooses, by the kind of device, its memory and the settings. */
lens_way lens_way_of(const virga_lens *lens, const virga_lens_settings *settings);

/* ---- lens_draw.c */
enum {
    LENS_DRAW_PICTURE,
    LENS_DRAW_PART,
    LENS_DRAW_TILES,
    LENS_DRAW_LAYERS,
    LENS_DRAW_SOFT,
    LENS_DRAW_BOTH,
    LENS_DRAW_WIDE,
    LENS_DRAWS,
};
extern const virga_effect_draw lens_draws[LENS_DRAWS];
virga_result lens_draw(virga_lens *lens, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                       const char *call);

#endif
