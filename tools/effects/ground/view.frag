// view.frag - the ground: wetness and depth of water, and its cells where the picture shows them.
#version 460
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "view_gpu.h"
#define VIEW_OWN ground_view_gpu
#include "../views/view_common.glsl"
#include "shared/ground_cell.h"

layout(scalar, set = 0, binding = VIEW_AT_BUFFERS) readonly buffer Floors { virga_floor_gpu floors[]; };
layout(scalar, set = 0, binding = VIEW_AT_BUFFERS + 1) readonly buffer Cells { virga_cell_gpu cells[]; };
layout(location = 0) out vec4 out_color;

// The cell at a position relative to the camera, as an entry of the buffers; false outside of the window.
bool cell_of(vec3 relative, out uint entry)
{
    const ivec2 cell = ivec2(floor((relative.xz - own.ground.xy) * own.ground.z));
    const int side = int(own.ground.w), tiles = own.cells.z;
    const ivec2 tile = (cell >> 6) + own.cells.xy, slot = tile & (tiles - 1), inside = cell & 63;
    entry = (uint(slot.y * tiles + slot.x) << 12) | uint(inside.y << 6 | inside.x);
    return all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, ivec2(side)));
}

vec3 relative_at(ivec2 texel)
{
    const float d = distance_at(texel);
    const vec2 clip = (vec2(texel) + 0.5) / view.picture.xy * 2.0 - 1.0;
    const vec2 xy = (clip + view.jitter.xy) * d / view.projection.xy;
    return xy.x * view.right.xyz + xy.y * view.up.xyz - d * view.back.xyz;
}

// As the ground's own passes have it.
uint state_of(virga_cell_gpu cell, uint material)
{
    const uint um = cell.free_nl / uint(own.cells.w);
    if (um >= 3000u)
        return um >= 10000u ? VIRGA_GROUND_PUDDLE_10 : um >= 5000u ? VIRGA_GROUND_PUDDLE_5 : VIRGA_GROUND_PUDDLE_3;
    const uint capacity = own.capacity[material >> 2][material & 3u];
    return cell.held_nl >= capacity && um >= 20u ? VIRGA_GROUND_WET : VIRGA_GROUND_DRY;
}

vec3 cell_color(ivec2 texel, vec2 at)
{
    const vec3 grey = vec3(0.35 * dot(exposed(textureLod(color_map, at, 0.0).rgb), vec3(0.3, 0.6, 0.1)));
    uint entry;
    const vec3 relative = relative_at(texel);
    if (own.ground.w == 0.0 || texelFetch(depth_map, texel, 0).r >= 1.0 || !cell_of(relative, entry))
        return grey;
    const virga_floor_gpu ground = floors[entry];
    const float above = relative.y + own.heights.x - float(ground.height_um) * 1e-6;
    if (ground.material >= VIRGA_GROUND_MATERIALS || abs(above) > 0.25)
        return grey;
    const uint color =
        view.mode.x == GROUND_VIEW_MATERIAL ? ground.material : state_of(cells[entry], ground.material);
    return own.palette[color].rgb * (0.55 + 1.3 * grey.r);
}

void main()
{
    vec2 at;
    ivec2 texel;
    vec3 color = OUTSIDE;
    if (in_picture(gl_FragCoord.xy, at, texel)) {
        const vec2 water = texelFetch(water_map, texel, 0).xy;
        color = view.mode.x == GROUND_VIEW_WETNESS ? heat(0.05 + 0.6 * water.x).bgr
                : view.mode.x == GROUND_VIEW_DEPTH ? heat(water.y / 0.01)
                                                   : cell_color(texel, at);
    }
    out_color = vec4(color, 1.0);
}
