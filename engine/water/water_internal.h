/* water/water_internal.h - defines the struct of virga_water and the functions its files share. Internal.
 *
 *   water.c          create, destroy, settings, queries
 *   water_surface.c  a step: particles become surfels
 *   water_spray.c    the spray of a step
 *   spray_kernel.c   the kernel of its droplets
 *   water_foam.c     the foam of a step
 *   water_images.c   the images that surfels are drawn into
 *   water_state.c    checks a saved state
 *   water_draw.c     prepare and draw
 */
#ifndef VIRGA_WATER_WATER_INTERNAL_H
#define VIRGA_WATER_WATER_INTERNAL_H

#include "gpu/context.h"
#include "gpu/effect.h"
#include "gpu/offscreen.h"
#include "gpu/state.h"
#include "particles/particle_grid.h"
#include "water/water.h"

#include <math.h>

#include <virga/shared/view_gpu.h>
#include <virga/shared/water_draw_gpu.h>
#include <virga/shared/water_gpu.h>

/* The data that is read back for one frame. */
typedef struct water_readback {
    virga_particle_grid_gpu grid;
    virga_water_state_gpu state;
} water_readback;

enum {
    WATER_LAYOUT_GRID,
    WATER_LAYOUT_KERNELS,
    WATER_LAYOUT_SURFACE,
    WATER_LAYOUT_SPRAY,
    WATER_LAYOUT_FOAM,
    WATER_LAYOUT_DRAW
};

/* Bindings of the kernels' and the surface's passes that the effect binds itself. */
enum { WATER_BIND_PARTICLES = 2, WATER_BIND_HANDED = 17, WATER_BIND_BODIES = 18 };

#define WATER_KERNELS       2 /* virga_water_kernel */
#define WATER_MAX_VIEWS     8 /* prepares in a frame */
#define WATER_DRAW_BINDINGS 33
#define WATER_DRAWS         4

/* The uniforms of a view. */
typedef struct water_view_block {
    virga_view_gpu view;
    virga_water_look_gpu look;
} water_view_block;

/* What a view is drawn from. Without max_width all of it is empty. */
typedef struct water_picture {
    virga_buffer *selection, *list, *splats, *prepared, *pyramid;
    VIRGA_PER_VIEW(virga_offscreen, sums); /* sums of splats, sums of their motion, depth */
    virga_buffer *divisions, *parts; /* these and `colors` are of light by surfels; without max_parts there are none */
    VIRGA_PER_VIEW(virga_offscreen, colors); /* sums of colors, depth */
    VIRGA_PER_VIEW(virga_image_2d, thickness);
    VIRGA_PER_VIEW(virga_buffer, foam_splats);
    VIRGA_PER_VIEW(virga_image_2d, gaps);      /* what the nearest water leaves open, see splat_gaps.comp */
    virga_buffer *open_blocks;                 /* see gap_blocks.glsl */
    VIRGA_PER_VIEW(virga_buffer, tiles);       /* see contact_tiles.comp */
    virga_image_2d *blank_depth, *blank_color; /* bound where a view has none */
    virga_ring view_ring;
    uint32_t view_offset; /* of the newest block */
    virga_bindings *bindings;
    virga_pipeline *splat_mark, *splat_scan, *splat_compact, *splat_write, *splat_gaps, *splat_close, *volume,
        *volume_merge, *foam;
    virga_pipeline *divide_mark, *divide_scan, *divide_write, *contact_tiles;
    virga_pipeline *splat_depth, *splat_sum, *splat_behind, *part_depth, *part_sum, *part_behind;
    virga_image panorama;
    uint32_t volume_first[VIRGA_WATER_VOLUME_LEVELS];
    uint32_t look[VIRGA_MAX_VIEWS]; /* VIRGA_WATER_LOOK_... bits, by index of the view */
    bool tiled[VIRGA_MAX_VIEWS];    /* it is drawn in tiles */
} water_picture;

/* The spray. */
typedef struct water_spray {
    virga_buffer *selection, *list, *splashes, *pieces, *table, *starts, *droplets;
    virga_bindings *bindings;
    virga_pipeline *begin, *mark, *scan, *compact, *break_up, *fly, *starts_scan;
    virga_pipeline *write, *write_pieces, *range, *surfel;
} water_spray;

/* The foam: a pool of particles. Without max_foam all of it is empty. */
typedef struct water_foam {
    virga_buffer *selection, *slots, *particles, *normals, *emissions, *sources;
    virga_bindings *bindings;
    virga_pipeline *move, *scan, *list_slots, *normal, *potential, *source_scan, *source_list, *starts, *make;
} water_foam;

struct virga_water {
    virga_effect base; /* first */
    virga_water_def def;
    virga_water_settings settings;
    double origin_m[3]; /* of the newest step */

    particle_grid grid;
    water_picture picture;
    virga_buffer *state, *cell_marks, *selection, *block_insides, *blocks, *block_of, *fields, *block_starts,
        *densities, *shifts, *shapes, *centers, *surfels;
    water_spray spray;
    /* Of the newest step that was no sub-frame. */
    bool spray_goes_on;        /* it had spray */
    uint32_t spray_serial;     /* number of the step */
    double spray_time_s;       /* its time */
    bool spray_hands_over;     /* states that go on may be of particles whose droplets were handed over */
    uint32_t spray_first;      /* the first step whose states go on */
    double spray_first_time_s; /* its time */
    virga_water_style spray_style;
    water_foam foam;
    double foam_time_s; /* of the newest step that was no sub-frame */
    float foam_late_s;  /* from the newest step to it */
    virga_ring step_ring;
    uint32_t step_particles[VIRGA_MAX_FRAMES_IN_FLIGHT]; /* of the steps in flight, for statistics */
    virga_bindings *kernel_bindings, *bindings;
    virga_pipeline *density[WATER_KERNELS], *kernel[WATER_KERNELS], *field[WATER_KERNELS], *surfel_write[WATER_KERNELS];
    virga_pipeline *cover, *relative, *block_mark, *block_scan, *block_compact, *surfel_count, *surfel_scan,
        *edge_write;
    virga_water_stats stats;
};

/* ---- water_state.c */

struct virga_state_check;
void water_check_state(const void *water, struct virga_state_check *check);

/* ---- water_surface.c */
void water_read_statistics(void *water, uint64_t frame, uint32_t ring_slot, uint32_t parts, const void *data);

/* ---- water_spray.c */

uint32_t water_table_entries(const virga_water_def *def); /* of one half */
bool water_has_spray(const virga_water *water);
void water_spray_fill(virga_water *water, const virga_water_step_info *info, virga_water_step_gpu *out);
void water_spray_clear(const virga_water *water, VkCommandBuffer cmd);
void water_spray_record(virga_water *water, VkCommandBuffer cmd);
void water_spray_record_surfels(virga_water *water, VkCommandBuffer cmd);
/* Volume of a particle (m^3). */
static inline double water_particle_m3(const virga_water_settings *settings)
{
    return settings->volume_m3 > 0 ? (double)settings->volume_m3 : pow((double)settings->spacing_m, 3);
}
/* Radius of surfels (m). */
double water_surfel_m(const virga_water_settings *settings);

/* ---- water_foam.c */
bool water_has_foam(const virga_water *water);
void water_foam_fill(virga_water *water, const virga_water_step_info *info, virga_water_step_gpu *out);
void water_foam_clear(const virga_water *water,
                      VkCommandBuffer cmd); /* before the barrier at the start of its passes */
void water_foam_record(virga_water *water, VkCommandBuffer cmd);

/* ---- water_images.c */
virga_result water_images_create(virga_water *water);
void water_images_retire(virga_water *water);
VkDeviceSize water_images_bytes(const virga_water_def *def);

/* Size of the finest level of the pyramid of thickness. */
VkExtent2D water_pyramid_extent(const virga_water_def *def);

/* Texels of all levels of the pyramid of thickness; `first` (may be NULL) gets the index of each level's first. */
uint32_t water_pyramid_texels(const virga_water_def *def, uint32_t first[VIRGA_WATER_VOLUME_LEVELS]);

/* ---- water_draw.c */
extern const virga_effect_draw water_draws[WATER_DRAWS];
virga_result water_draw(virga_water *water, VkCommandBuffer cmd, const virga_target *target, virga_prepared prepared,
                        const char *call);
extern const virga_binding_kind water_draw_bindings[WATER_DRAW_BINDINGS];

#endif
