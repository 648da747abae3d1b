// view_common.glsl - bindings of the viewer's shaders.
#extension GL_EXT_scalar_block_layout : require
#define VIRGA_GLSL
#include "view_gpu.h"
#include "shared/ground_cell.h"
#include "shared/glass_drop.h"

layout(set = 0, binding = 0) uniform View { view_gpu view; };
layout(set = 0, binding = 1) uniform sampler2D color_map;
layout(set = 0, binding = 2) uniform sampler2D splash_map;
layout(set = 0, binding = 3) uniform sampler2D rain_map;
layout(set = 0, binding = 4) uniform sampler2D glass_map;
layout(set = 0, binding = 5) uniform sampler2D refraction_map;
layout(set = 0, binding = 6) uniform sampler2D normal_map;
layout(set = 0, binding = 7) uniform sampler2D velocity_map;
layout(set = 0, binding = 8) uniform sampler2D water_map;
layout(set = 0, binding = 9) uniform usampler2D id_map;
layout(set = 0, binding = 10) uniform sampler2D depth_map;
layout(set = 0, binding = 11) uniform sampler2DArray occlusion_map;
layout(set = 0, binding = 12) uniform sampler2D height_map;
layout(scalar, set = 0, binding = 13) readonly buffer Floors { virga_floor_gpu floors[]; };
layout(scalar, set = 0, binding = 14) readonly buffer Cells { virga_cell_gpu cells[]; };
layout(scalar, set = 0, binding = 15) readonly buffer Surface { uint surface[]; };
layout(scalar, set = 0, binding = 16) readonly buffer Drops { virga_glass_drop_gpu drops[]; };

#define HAS_SPLASH  1u
#define HAS_GLASS   2u
#define HAS_GROUND  4u
#define HAS_MAPS    8u
#define HAS_HEIGHTS 16u
bool has(uint what) { return (view.mode.z & what) != 0u; }

// The rectangle of a flat map of that aspect inside the picture's area: low corner and size, pixels.
vec4 flat_area(float aspect)
{
    const vec2 size = min(view.area.zw, view.area.wz * vec2(aspect, 1.0 / aspect)) * 0.96;
    return vec4(view.area.xy + 0.5 * (view.area.zw - size), size);
}
