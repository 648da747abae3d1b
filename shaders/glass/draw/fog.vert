// fog.vert - vertices of the blocks with fog: as mist.vert, but for the light.
// One invocation per vertex of the grid of blocks. Reads: nodes, the view. Writes: position, light of the fog.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/light.glsl"
#include "corner.glsl"
#include "corner_light.glsl"

layout(location = 14) flat out vec4 mist_grid; // as in mist.vert

#include "gpu/own_view.glsl"

// Estimates: what droplets show of all the world behind them, by rays that leave at their rims, and what they reflect
// to the eye of the light on its side; a room behind a pane has so much of the light outside.
#define AROUND 0.12
#define REFLECTED 0.05
#define INSIDE_SHARE 0.25

// Irradiance of a plane with this normal, by the first two bands of the environment, and by lamps.
vec3 irradiance(vec3 n)
{
    vec3 sum = 0.886227 * sh_coefficient(0u) + 1.023327 * (sh_coefficient(1u) * n.y + sh_coefficient(2u) * n.z +
                                                           sh_coefficient(3u) * n.x);
    sum = max(sum, vec3(0.0));
    for (uint i = 0u; i < view.light_count; i++) {
        const Lamp lamp = lamp_at(i, position);
        sum += lamp.light * max(dot(lamp.towards, n), 0.0);
    }
    return sum;
}

vec3 light_around(vec3 outward)
{
    const bool from_inside = dot(position, outward) > 0.0;
    const vec3 inside = INSIDE_SHARE * irradiance(-outward), outside = irradiance(outward);
    return (from_inside ? AROUND * outside + REFLECTED * inside : AROUND * inside + REFLECTED * outside) / 3.14159265;
}

void main()
{
    mist_grid = vec4(look.mist_columns, look.mist_rows, look.mist_scale[0], look.mist_scale[1]);
    const uint columns = look.mist_pitch / VIRGA_GLASS_MIST_BLOCK + 1u, number = uint(gl_VertexIndex);
    const float block_m = float(VIRGA_GLASS_MIST_BLOCK * look.mist_cells) * look.pane.cell_m;
    const vec2 at = vec2(number % columns, number / columns) * block_m;
    light_corner(emit_corner(min(at / vec2(look.pane.width_m, look.pane.height_m), vec2(1.0))));
    mist_light = light_around(normalize(cross(along_u, along_v)));
}
