// water.glsl - what draws know of the water at a pixel, and what their pipelines are specialised for.
#define SCENE_DEPTH_BINDING 15
#include "gpu/scene_depth.glsl"
#include "gpu/view.glsl"

#include "mode.glsl"
#define HAS_DEPTH ((DRAW_MODE & VIRGA_GLASS_DRAW_DEPTH) != 0u)
#ifndef HAS_LAMPS
#define HAS_LAMPS ((DRAW_MODE & VIRGA_GLASS_DRAW_LAMPS) != 0u)
#endif
#define SIDE (DRAW_MODE & VIRGA_GLASS_DRAW_SIDE)

struct Water {
    float cover;  // of the pixel by drops and film that have a shape
    float mist;   // by water too small for a shape
    float height; // m
    float density;
    vec2 slope; // of the height; (paper) of the density; per metre
    float bend; // largest change of the slope, 1/m
};
