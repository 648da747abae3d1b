/* lens_gpu.h - the lens effect's uniform block and state. Internal to Virga. */
#ifndef VIRGA_SHARED_LENS_GPU_H
#define VIRGA_SHARED_LENS_GPU_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_lens_gpu virga_lens_gpu;
typedef struct virga_lens_state_gpu virga_lens_state_gpu;
typedef struct virga_lens_list_gpu virga_lens_list_gpu;
typedef struct virga_lens_tile_gpu virga_lens_tile_gpu;
#endif

#define VIRGA_LENS_TILE       16  /* pixels of the work image along a tile's side */
#define VIRGA_LENS_MAX_RADIUS 63  /* px, of a circle of confusion in the work image */
#define VIRGA_LENS_APERTURE   127 /* texels of the aperture image along a side: 2 VIRGA_LENS_MAX_RADIUS + 1 */
#define VIRGA_LENS_COLUMN     8   /* (paper) pixels below each other that one invocation blurs */
#define VIRGA_LENS_SPREADS    512 /* entries of the table of areas */
#define VIRGA_LENS_LAYERS     5   /* layers over the scene at most */

/* Wide discs come from blocks of 2, 4 and 8 texels along a side, see shaders/lens/levels.glsl. */
#define VIRGA_LENS_FINE          8      /* texels, discs up to this radius come from single texels */
#define VIRGA_LENS_LEVELS        3      /* of blocks */
#define VIRGA_LENS_EDGE_VARIANCE 0.1022 /* of the soft edge of such discs, see shaders/lens/blocks.glsl */

/* Kinds of blocks, and what is kept of each. */
#define VIRGA_LENS_BLOCKS_FAR  0 /* behind the focus, of the level's radii */
#define VIRGA_LENS_BLOCKS_NEAR 1 /* in front of the focus, of the level's radii */
#define VIRGA_LENS_BLOCKS_ALL  2 /* all that is not in front of the focus, or little of that */
#define VIRGA_LENS_BLOCK_KINDS 3

#define VIRGA_LENS_BLOCK_LIGHT    0 /* light and where it is, see shaders/lens/levels.glsl */
#define VIRGA_LENS_BLOCK_ON_SCENE 1 /* light of the layer that lies on the scene */
#define VIRGA_LENS_BLOCK_PARTS    2

/* The image of the aperture, and below it rows with the areas. */
#define VIRGA_LENS_AREA_ROWS 5 /* at least VIRGA_LENS_SPREADS / VIRGA_LENS_APERTURE */

/* What the blocks pass is specialised for. */
#define VIRGA_LENS_BLOCKS_SCENE    0
#define VIRGA_LENS_BLOCKS_ON_SCENE 1 /* a layer lies on it */
#define VIRGA_LENS_BLOCKS_LAYER    2 /* a layer in place of the scene */
#define VIRGA_LENS_BLOCK_FORMS     3

/* What a pass is specialised for: bits of its specialisation constant; the low ones are of the pass itself. */
#define VIRGA_LENS_HALVED        256 /* half resolution */
#define VIRGA_LENS_IN_PLACE      512 /* draws blend over the target, see shaders/lens/overlay.frag */
#define VIRGA_LENS_SHAPED        1   /* gather, layer: an aperture that is no disc, or cat's eye */
#define VIRGA_LENS_ON_SCENE      2   /* sample, gather: a layer lies on the scene */
#define VIRGA_LENS_DEPTHS        2   /* layer: it has a depth image */
#define VIRGA_LENS_NO_NEAR       4   /* gather: nothing in front of the focus is out of focus */
#define VIRGA_LENS_LINEAR        1   /* sample: the host's picture is linear light */
#define VIRGA_LENS_NARROW_LINEAR 2   /* narrow, wide: likewise */
#define VIRGA_LENS_ALONE         4   /* narrow, wide: no pass finds tiles, see shaders/lens/narrow.glsl */
#define VIRGA_LENS_QUARTER       2   /* narrow_plane, narrow_depths: wide discs, at a quarter of the resolution */

/* (half resolution) Tiles by what reaches them. There is a list of each kind, and one of the tiles whose samples are
 * read. */
#define VIRGA_LENS_TILES_BLURRED 0 /* circles of confusion from in front of the focus, and perhaps from behind it */
#define VIRGA_LENS_TILES_FAR     1 /* only from behind it */
#define VIRGA_LENS_TILES_SHARP   2 /* none */
#define VIRGA_LENS_TILE_KINDS    3
#define VIRGA_LENS_TILES_SAMPLED 3
#define VIRGA_LENS_TILE_LISTS    4

/* Heads of lists: the last one has the workgroups of blocks, and no tiles. */
#define VIRGA_LENS_LIST_OF_BLOCKS 4
#define VIRGA_LENS_LISTS          5
#define VIRGA_LENS_LIST_ROW       32768 /* tiles in a row of workgroups; a device has 65535 in one */
#define VIRGA_LENS_TILE_VERTICES  6     /* (in place) of a tile that is drawn: two triangles */

/* A bit beside those of levels, in what tiles tell each other: samples of this tile are read. */
#define VIRGA_LENS_SAMPLED 65536u

/* What the combine pass is specialised for besides the number of layers: times VIRGA_LENS_LAYERS + 1. The first three
 * are kinds of tiles. */
#define VIRGA_LENS_ALL_SHARP     3 /* no layer is out of focus either, and there are no fields */
#define VIRGA_LENS_COMBINE_KINDS 4
#define VIRGA_LENS_COMBINE_FORMS 8 /* from the fifth on the host's picture is linear light */

/* (in place, narrow) Tiles of which every pixel comes from the fields: they are drawn without what is beneath. */
#define VIRGA_LENS_TILES_SOFT 4

/* (narrow) Discs of some radii come from a quarter of the resolution, wider ones than VIRGA_LENS_COARSE_FROM px, and
 * from VIRGA_LENS_COARSE_TO px on nothing else does: see shaders/lens/narrow.glsl. */
#define VIRGA_LENS_COARSE_FROM (1.5 * VIRGA_LENS_FINE)
#define VIRGA_LENS_COARSE_TO   (2.0 * VIRGA_LENS_FINE)
#define VIRGA_LENS_COARSE_MOST (4.0 * VIRGA_LENS_FINE) /* px, the largest radius */
#define VIRGA_LENS_TILES_WIDE  5 /* every pixel comes from the coarse fields: drawn without what is beneath */
#define VIRGA_LENS_TILES_BOTH  6 /* (draw) blended, from both fields */

/* (narrow) An entry for every tile in place of lists: its kind, and bits beside it. */
#define VIRGA_LENS_KIND_MASK       255u
#define VIRGA_LENS_HAS_NEAR        256u  /* circles of confusion from in front of the focus reach it */
#define VIRGA_LENS_HAS_FINE        512u  /* it has fields of the work image */
#define VIRGA_LENS_HAS_COARSE      1024u /* it has coarse fields */
#define VIRGA_LENS_HAS_COARSE_NEAR 2048u /* and wide circles from in front of the focus reach it */
/* What is known of a tile from a quarter of the resolution, before it is done at half: the last two, and */
#define VIRGA_LENS_NEEDS_FINE 1u /* something is out of focus around it whose disc is not wide */
#define VIRGA_LENS_HAS_OTHERS 2u /* not every pixel comes from the coarse fields */

/* In what a draw has pushed, beside the kind: there are such entries, and no lists. */
#define VIRGA_LENS_EVERY 256u

/* (narrow) After those entries, a word for each tile, of each layer from half resolution and then of each layer from a
 * quarter of it: bits. */
#define VIRGA_LENS_TILE_WORDS   (1 + 2 * VIRGA_LENS_LAYERS)
#define VIRGA_LENS_LAYER_FINE   1u /* something of the layer reaches the tile, at half resolution */
#define VIRGA_LENS_LAYER_COARSE 2u /* and at a quarter of it */
#define VIRGA_LENS_LAYER_SEEN   4u /* the layer's own pixels are seen there, not its field alone */
#define VIRGA_LENS_LAYER_BITS   3  /* so many for each layer, in what a draw is told of a tile */

/* Layers of the image of fields. */
#define VIRGA_LENS_FAR         0
#define VIRGA_LENS_NEAR        1
#define VIRGA_LENS_FIRST_LAYER 2

/* One view. Pixels are pixels of the picture, unless they are called texels: those are of the work image. */
struct virga_lens_gpu {
    float depth_a;          /* 1 / view depth = (depth_a + depth buffer value) / depth_b */
    float depth_b;          /* m */
    float far_depth;        /* depth buffer value of the background */
    uint depth_given;       /* 0: everything is at focus */
    uint left;              /* px, first column of the viewport */
    uint top;               /* px */
    uint width;             /* px, of the viewport */
    uint height;            /* px */
    uint columns;           /* texels of the work image that are used */
    uint rows;              /* texels */
    uint tile_columns;      /* tiles that are used */
    uint tile_rows;         /* tiles */
    uint step;              /* px along a texel's side: 1, or 2 at half resolution */
    float circle_px_m;      /* px m, radius of the circle of confusion at 1/m away from the focus */
    float circle_per_depth; /* px, the same for one in the depth buffer: circle_px_m / depth_b */
    float max_radius;       /* texels */
    uint levels;            /* of blocks that radii up to it need */
    float edge_area;        /* what the soft edge of a block's disc adds to its area, see shaders/lens/levels.glsl */
    uint follow;            /* focus on what is at the focus point */
    uint focus_x;           /* px, focus point */
    uint focus_y;           /* px */
    float focus_inv_m;      /* 1/m, set focus */
    float ease;             /* share of the way to the new focus */
    float cats_eye;         /* shift of the second aperture in a corner, in radii */
    float blades;           /* of the aperture; 0: a disc */
    float roundness;        /* 0: straight blades; 1: a disc */
    float rotation;         /* rad, of the blades */
    float threshold_m[2];   /* (paper) m, differences of depth where blur begins and where it becomes stronger */
    float filter_weight[2]; /* (paper) weight of a filter's centre */
    uint layers;            /* layers over the scene */
    uint on_scene;          /* 1 + the layer that lies on the scene; 0: none does */
    uint multiview_index;   /* see virga_view.multiview_index */
    uint all_sharp;         /* nothing is out of focus: there are no fields and no tiles */
    uint sharp_layers;      /* bits of layers that are known to be in focus: they have no field */
    uint color_given;       /* VIRGA_COLOR_..., see view_gpu.h */
    uint fine_layers;       /* (narrow) bits of layers that have a field at half resolution */
    uint coarse_layers;     /* (narrow) and at a quarter of it */
    float layer_inv_m[5];   /* 1/m, 1 / depth of a layer without a depth image; 0: it has one */
    float areas[512];       /* texels, areas of the aperture's image, see shaders/lens/spread.glsl */
};

/* Kept from view to view; read back as statistics. */
struct virga_lens_state_gpu {
    float focus_inv_m; /* 1/m, focus of the newest view */
    uint focused;      /* there was a view */
};

/* A tile, and what the tiles around it tell it in this view: see shaders/lens/tile.comp. All but the first word is 0
 * between views. */
struct virga_lens_tile_gpu {
    uint levels; /* of blocks that have light of its own */
    uint near;   /* bits of a float (texels), the largest radius in front of the focus that reaches it */
    uint far;    /* the same behind the focus */
    uint layers; /* and of layers with depths */
    uint told;   /* levels of blocks that reach it, and VIRGA_LENS_SAMPLED */
};

/* A list of tiles: its head. The tiles of all lists come after the heads, as many for each list as there are tiles. */
struct virga_lens_list_gpu {
    uint groups_x; /* workgroups: in a tile */
    uint groups_y; /* tiles in a row */
    uint groups_z; /* rows */
    uint count;    /* tiles */
    uint levels;   /* (of the first list) levels of blocks that any tile has */
    /* A draw of the tiles: VkDrawIndirectCommand. */
    uint vertices;
    uint instances;
    uint first_vertex;
    uint first_instance;
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_lens_tile_gpu, 20);
VIRGA_ASSERT_SIZE(virga_lens_list_gpu, 36);
VIRGA_ASSERT_OFFSET(virga_lens_list_gpu, vertices, 20);
VIRGA_ASSERT_SIZE(virga_lens_gpu, 176 + 4 * 512);
VIRGA_ASSERT_SIZE(virga_lens_state_gpu, 8);
#undef uint
#endif

#endif
