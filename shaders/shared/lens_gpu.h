/* lens_gpu.h - the lens effect's uniform block and state. Internal to Virga. */
#ifndef VIRGA_SHARED_LENS_GPU_H
#define VIRGA_SHARED_LENS_GPU_H

#include "types.h"

#ifndef VIRGA_GLSL
#define uint virga_uint
typedef struct virga_lens_gpu virga_lens_gpu;
typedef struct virga_lens_state_gpu virga_lens_state_gpu;
#endif

#define VIRGA_LENS_TILE       16  /* pixels of the work image along a tile's side */
#define VIRGA_LENS_MAX_RADIUS 63  /* px, of a circle of confusion in the work image */
#define VIRGA_LENS_APERTURE   127 /* texels of the aperture image along a side: 2 VIRGA_LENS_MAX_RADIUS + 1 */
#define VIRGA_LENS_COLUMN     8   /* (paper) pixels below each other that one invocation blurs */
#define VIRGA_LENS_SPREADS    512 /* entries of the table of areas */
#define VIRGA_LENS_LAYERS     5   /* layers over the scene at most */

/* The image of the aperture, and below it rows with the areas. */
#define VIRGA_LENS_AREA_ROWS 5 /* at least VIRGA_LENS_SPREADS / VIRGA_LENS_APERTURE */

/* What a pass is specialised for: bits of its specialisation constant; the low ones are of the pass itself. */
#define VIRGA_LENS_HALVED   256 /* half resolution */
#define VIRGA_LENS_SHAPED   1   /* gather, layer: an aperture that is no disc, or cat's eye */
#define VIRGA_LENS_ON_SCENE 2   /* gather: a layer lies on the scene */
#define VIRGA_LENS_DEPTHS   2   /* layer: it has a depth image */

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
    float max_radius;       /* texels */
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
    float layer_inv_m[5];   /* 1/m, 1 / depth of a layer without a depth image; 0: it has one */
    float areas[512];       /* texels, areas of the aperture's image, see shaders/lens/spread.glsl */
};

/* Kept from view to view; read back as statistics. */
struct virga_lens_state_gpu {
    float focus_inv_m; /* 1/m, focus of the newest view */
    uint focused;      /* there was a view */
};

#ifndef VIRGA_GLSL
VIRGA_ASSERT_SIZE(virga_lens_gpu, 156 + 4 * 512);
VIRGA_ASSERT_SIZE(virga_lens_state_gpu, 8);
#undef uint
#endif

#endif
