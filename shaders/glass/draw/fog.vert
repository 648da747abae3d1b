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
#define THROUGH 0.95 // as in fog.frag
#define TAPS 16
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

// What droplets show: the mean of a disc around the vertex, see fog.frag. It is so wide that it changes little from one
// vertex to the next, and a fragment shader would need as many look-ups for each pixel.
vec3 light_behind()
{
    if (!HAS_PLATE)
        return environment(normalize(position), vec2(1.0));
    const vec2 uv = 0.5 * gl_Position.xy / max(gl_Position.w, 1e-5) + 0.5;
    const float contact = 2.0 * atan(look.fog_cap_height);
    const float reach_px = (WATER - 1.0) * contact / max(view.pixel_angle, 1e-6);
    const vec2 reach = reach_px / vec2(view.viewport[2], view.viewport[3]);
    // the copy whose texels are about as wide as one sample's part of the disc
    const float texels = 0.5 * max(reach.x, reach.y) * float(VIRGA_GLASS_COPY);
    const int level = clamp(int(log2(max(texels, 1.0)) + 0.5), 0, VIRGA_GLASS_COPY_LEVELS - 1);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < TAPS; i++) {
        const float angle = 2.39996323 * float(i); // the golden angle
        const vec2 offset = sqrt((float(i) + 0.5) / float(TAPS)) * vec2(cos(angle), sin(angle));
        sum += copy_at(clamp(uv + reach * offset, vec2(0.0), vec2(1.0)), level);
    }
    return sum / float(TAPS);
}

void main()
{
    mist_grid = vec4(look.mist_columns, look.mist_rows, look.mist_scale[0], look.mist_scale[1]);
    const uint columns = look.mist_pitch / VIRGA_GLASS_MIST_BLOCK + 1u, number = uint(gl_VertexIndex);
    const float block_m = float(VIRGA_GLASS_MIST_BLOCK * look.mist_cells) * look.pane.cell_m;
    const vec2 at = vec2(number % columns, number / columns) * block_m;
    light_corner(emit_corner(min(at / vec2(look.pane.width_m, look.pane.height_m), vec2(1.0))));
    const vec3 outward = normalize(cross(along_u, along_v));
    // Of what is not glass a fragment adds the light: it shows what is right under the droplets.
    if ((DRAW_MODE & VIRGA_GLASS_DRAW_SIDE) == VIRGA_GLASS_DRAW_OPAQUE)
        mist_light = irradiance(outward) * (REFLECTED / 3.14159265);
    else
        mist_light = THROUGH * to_vec(look.tint) * light_behind() + light_around(outward);
}
