/* glass_picture_gpu.h - what the passes that make and draw the height map share with the C code that feeds them.
 * Internal to Virga. */
#ifndef VIRGA_SHARED_GLASS_PICTURE_GPU_H
#define VIRGA_SHARED_GLASS_PICTURE_GPU_H

#include "glass_gpu.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_glass_picture_gpu virga_glass_picture_gpu;
typedef struct virga_glass_tile_gpu virga_glass_tile_gpu;
typedef struct virga_glass_written_gpu virga_glass_written_gpu;
typedef struct virga_glass_work_gpu virga_glass_work_gpu;
typedef struct virga_glass_corners_gpu virga_glass_corners_gpu;
typedef struct virga_glass_quad_gpu virga_glass_quad_gpu;
#endif

#define VIRGA_GLASS_TILE       8     /* texels a side; one workgroup of the gathering pass per tile */
#define VIRGA_GLASS_TILE_ROW   32768 /* max workgroups along x of a dispatch over tiles */
#define VIRGA_GLASS_MIST_BLOCK 16    /* texels a side of a block of the mist map: one workgroup, one quad */
/* max radius of a bead in cells: it reaches no farther than the next cell */
#define VIRGA_GLASS_BEAD_CELLS      0.45f
#define VIRGA_GLASS_BEAD_SEEN       0.75f /* min radius in texels of a bead with a shape */
#define VIRGA_GLASS_MAX_MIST_TEXELS 8192  /* max texels a side of the mist map */
/* compression steps; the gathering pass has a variant for at most this many, the usual number */
#define VIRGA_GLASS_USUAL_STEPS 5
#define VIRGA_GLASS_DROP_BALLS  4  /* max balls of one slot */
#define VIRGA_GLASS_FILL_GROUP  64 /* balls per workgroup of the pass that fills the lists */
/* texels a side of the background picture's largest copy; smaller ones are to its right */
#define VIRGA_GLASS_COPY        256
#define VIRGA_GLASS_COPY_WIDTH  392 /* 256 + 128 + 8 */
#define VIRGA_GLASS_COPY_LEVELS 7   /* down to 4 x 4 */
#define VIRGA_GLASS_COPY_PAPER  2   /* level of 64 x 64 */

/* A view of the pane: its pose, the resolution of its map, and the settings of its picture. */
struct virga_glass_picture_gpu {
    virga_glass_pane_gpu pane;
    float world_from_pane[9]; /* rotation, 3 x 3 matrix */
    float origin[3];          /* m, origin of the pane's frame, relative to the camera */
    uint map_columns;         /* texels in use, along u */
    uint map_rows;            /* and along v */
    uint tile_columns;
    uint tile_rows;
    float texel_m[2]; /* m */
    float share;      /* elapsed fraction of the newest tick at the drawn time */
    float late_s;     /* s, <= 0: drawn time minus the time of the newest tick */
    uint tick;
    float tick_s;            /* s, length of a tick */
    float gravity[3];        /* m/s^2, in the pane's frame */
    float drop_nl_of_m3;     /* spherical cap, see virga_glass_tick_gpu */
    float cap_height;        /* of a spherical cap, in radii of its base */
    float particle_m;        /* m, radius */
    uint particles_as_given; /* 1: particles are shown with that radius, as in the paper */
    float impact_s;          /* s, time in which a landed drop contracts to its final shape */
    float film_break_s;      /* s, time after which a film has broken into beads */
    uint density;            /* virga_glass_density */
    uint weighted;           /* virga_glass_blend */
    uint compress_steps;
    float compress_from; /* V0 */
    float compress_step; /* fraction of V0 */
    float compress_k;    /* [0; 1], k */
    float threshold;     /* density at the outline of a drop */
    float pinning;       /* [0; 1] how uneven outlines are */
    float paper_shift;   /* (paper) displacement of the background by the normal's x and y, in heights of the picture */
    float thickness_m;   /* m, of the glass */
    float tint[3];
    uint opaque;
    float gain;           /* factor of the reflections */
    uint max_tiles;       /* max tiles in a list */
    uint max_entries;     /* max entries of the lists of all tiles together */
    uint written_columns; /* tiles per row of the array that records which tiles of the images hold something */
    uint max_blocks;      /* max blocks of the mist map in the list of those with film */
    uint mist_columns;    /* size of the mist map in texels; a texel covers mist_cells x mist_cells cells */
    uint mist_rows;
    uint mist_cells;
    uint mist_pitch;     /* texels from one row to the next: a multiple of the block size */
    float mist_scale[2]; /* texture coordinates of the mist map per metre */
    uint sheets;         /* 1: sheets of film are shown */
    uint whole_map;      /* 1: the host reads the map, so all of it is written */
    uint masked;         /* 1: the pane has a mask */
    uint bead_seed;      /* hash of the pane's seed, for beads of film */
    uint map_seed[2];    /* hashes of the settings that the maps depend on */
    /* from positions relative to the camera to the previous frame's clip space, for points that are fixed on the
     * pane */
    float previous_from_here[16];
    float previous_eye[3]; /* position of the previous frame's camera, in the same terms */
    uint view_texel;       /* first texel of the view in the buffer of all views */
    float beside;          /* reach in texels: water is visible up to this distance from its texel */
    uint bounds_offset;    /* (even) start of the tiles' bounds, two words each, after all vertex indices */
    /* Drops as textures. Smaller ones than this are drawn so: diameter in pixels; 0: none */
    float textured_px;
    uint texture_columns; /* points of the mesh that have a texture, along u */
    uint texture_rows;    /* and along v */
    uint texture_texels;  /* a side of a texture's first level */
    uint hemispheres;     /* 1: drops are hemispheres (Sato et al.); 0: caps, as the height map has them */
    uint first_texture;   /* made anew for this view: the first of them */
    uint textures;        /* and their number, in turn */
    /* start of the quads' vertex indices, three for each drop and six more; the quads follow */
    uint quads_offset;
    float veil;           /* (front) share of the opening that mist covers */
    float starburst;      /* (front) share of it that streaks of film cover */
    float starburst_rad;  /* angle at which a fresh streak meets the glass: the steepest of them */
    float starburst_turn; /* rad, from u towards v: direction of the first ray */
    uint starburst_rays;  /* directions; a ray on both sides for each */
    uint opening_blades;  /* (front) of the opening; 0: it is a disc */
    float opening_round;  /* 0: straight blades; 1: a disc */
    float opening_turn;   /* rad, of the blades */
    float opening_area;   /* of the opening whose corners are 1 from its middle */
    /* Condensation. */
    float fog_m_of_pl;    /* m, mean thickness of a picolitre on a cell */
    float fog_dense;      /* 1/m^2, droplets that begin on glass of mean affinity */
    float fog_uneven;     /* of the logarithm of that, per standard deviation of a cell's affinity */
    uint fog_offset;      /* start of its quads' vertex indices, after all else: without and with single droplets */
    uint fog_indices;     /* max number of either */
    float fog_cap_height; /* of a droplet, in radii of its base: droplets grow, so their rims are not drawn back */
    float fog_single_m;   /* m, radius from which droplets are seen */
};

/* A drop drawn as one quad. Vectors are in clip space: at (x, y) from its middle the quad is at clip + x along_u + y
 * along_v. */
struct virga_glass_quad_gpu {
    float clip[4];
    float along_u[4]; /* of a step of 1 in x: a radius of the base; (point) a pixel */
    float along_v[4]; /* the same in y */
    float middle[2];  /* m, on the pane */
    float radius_m;   /* m, of the base */
    float size;       /* x and y end at -size and size */
    float alpha;      /* [0; 1] */
    float level;      /* of the textures; between two whole numbers both are mixed */
    uint point;       /* 1: no larger than a pixel, and spread over two by two */
    uint pad;
};

#define VIRGA_GLASS_BLADE_PARTS 4 /* straight parts that stand for a blade of the opening */

#define VIRGA_GLASS_TEXTURE_GROUP  64 /* texels per workgroup of the pass that makes textures */
#define VIRGA_GLASS_TEXTURE_LEVELS 4  /* of a texture: each half as wide as the one before */
#define VIRGA_GLASS_QUAD_WORDS     20 /* size of a quad */

/* Flags of a draw pipeline. The pane's side: BEHIND or BEFORE if all of it is seen from that side, OPAQUE if it is not
 * glass; without a flag the side may vary. */
#define VIRGA_GLASS_DRAW_DEPTH   1u /* the scene's depth can be read */
#define VIRGA_GLASS_DRAW_LAMPS   2u /* there are lights */
#define VIRGA_GLASS_DRAW_BEHIND  4u
#define VIRGA_GLASS_DRAW_BEFORE  8u
#define VIRGA_GLASS_DRAW_OPAQUE  12u
#define VIRGA_GLASS_DRAW_SIDE    12u /* mask of the three */
#define VIRGA_GLASS_DRAW_BY_HAND 16u /* the shader filters the map, because the device does not */
/* the host's background picture can be read. Without PLATE and ALONE: virga_view_gpu.color_given decides */
#define VIRGA_GLASS_DRAW_PLATE 32u
#define VIRGA_GLASS_DRAW_ALONE 64u  /* there is no background picture */
#define VIRGA_GLASS_DRAW_PAPER 128u /* (refraction vectors) the paper's style */

#define VIRGA_GLASS_DRAW_DROPLETS 256u /* (fog) some droplets are seen as drops */

/* Flags of virga_glass_tile_gpu.film. */
#define VIRGA_GLASS_LISTED     2u /* the tile is in the list for the pass that computes slopes */
#define VIRGA_GLASS_SHOWN      4u /* the tile has something to draw */
#define VIRGA_GLASS_HAS_SLOPES 8u /* the relief map holds something there since an earlier view */
#define VIRGA_GLASS_SPANS_BIT  8  /* first bit of the columns with water; the rows follow */
#define VIRGA_GLASS_SEEN       (0xffffu << VIRGA_GLASS_SPANS_BIT | VIRGA_GLASS_SHOWN)

/* What the images hold of a tile since they were last written. It must be cleared if the tile becomes empty. */
#define VIRGA_GLASS_HOLDS_WATER  1u /* the height map */
#define VIRGA_GLASS_HOLDS_RELIEF 2u /* the image that draws with Snell refraction read */

/* The water that a tile of the images shows, of the newest view that changed it. A tile with the same water is not
 * written again. */
struct virga_glass_written_gpu {
    uint holds;      /* VIRGA_GLASS_HOLDS_..., and VIRGA_GLASS_SEEN of virga_glass_tile_gpu.film */
    uint content[2]; /* as in virga_glass_tile_gpu */
};

/* Arguments of an indexed indirect draw, in Vulkan's layout. */
struct virga_glass_corners_gpu {
    uint index_count;
    uint instance_count;
    uint first_index;
    int vertex_offset;
    uint first_instance;
};

/* Work lists: arguments of indirect dispatches and draws, then counts. The lists follow: tiles without film; from
 * look.max_tiles on, tiles with film; from 2 look.max_tiles on, blocks of the mist map with film that has a shape;
 * look.max_blocks further, tiles with something to show; look.max_tiles further, blocks of the mist map that may have
 * any film. The order in a list does not matter, because entries are independent. All zero when a view's passes
 * begin. */
struct virga_glass_work_gpu {
    uint tile_groups[3];           /* of the gathering pass over tiles without film */
    uint film_groups[3];           /* of the gathering pass over tiles with film */
    uint ball_groups[3];           /* of the pass that fills the lists */
    uint block_groups[3];          /* of the pass over blocks with film that has a shape */
    uint relief_groups[3];         /* of the pass over tiles that have, or had, something to show */
    virga_glass_corners_gpu drops; /* draw of tiles */
    virga_glass_corners_gpu mist;  /* draw of blocks */
    uint tiles;                    /* entries of the list of tiles without film */
    uint film_tiles;               /* entries of the list of tiles with film */
    uint relief_tiles;
    uint shaped; /* number of balls with a shape, for the statistics */
    uint cut;    /* list entries of tiles that were dropped because the buffer was full */
    uint balls;
    uint entries;                   /* list entries that all tiles need, without a limit */
    uint used;                      /* list entries that they got */
    uint highest;                   /* max radius of a ball (m), the bits of a float */
    uint mist_groups[3];            /* of the pass over blocks of the mist map that may have any film */
    virga_glass_corners_gpu quads;  /* draw of drops as textures */
    virga_glass_corners_gpu fog[2]; /* draws of blocks with fog: of droplets that are not seen, and that are */
};

/* The water on a tile of the map. */
struct virga_glass_tile_gpu {
    uint count;  /* balls that touch it */
    uint first;  /* first entry of its list */
    uint filled; /* entries written so far */
    uint film;   /* bit 0: film with a shape, or a sheet of film; then the flags above, and spans */
    /* Sums of hashes of all that its texels depend on: two, so that no two contents are taken for the same */
    uint content[2];
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_glass_tile_gpu, 24);
VIRGA_ASSERT_SIZE(virga_glass_written_gpu, 12);
VIRGA_ASSERT_SIZE(virga_glass_corners_gpu, 20);
VIRGA_ASSERT_SIZE(virga_glass_quad_gpu, 4 * VIRGA_GLASS_QUAD_WORDS);
VIRGA_ASSERT_SIZE(virga_glass_work_gpu, 208);
VIRGA_ASSERT_OFFSET(virga_glass_work_gpu, drops, 60);
VIRGA_ASSERT_OFFSET(virga_glass_work_gpu, mist, 80);
VIRGA_ASSERT_OFFSET(virga_glass_work_gpu, shaped, 112);
VIRGA_ASSERT_OFFSET(virga_glass_picture_gpu, map_columns, 80);
#undef uint
#endif

#endif
