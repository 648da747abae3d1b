// surface.glsl - the water at a pixel of the pane: coverage, slopes and curvature.
#include "water.glsl"
#define FILTER_IN_SHADER ((DRAW_MODE & VIRGA_GLASS_DRAW_BY_HAND) != 0u)

// Red: density, or more where a sheet of film covers. Green, blue: slopes of the height, per metre. Alpha: if positive,
// the mist (the part covered by water that is too small for a shape); if negative, in drops, minus the largest change
// of the slope (1/m), or on a surface that is not glass minus the height (m).
layout(set = 0, binding = 12) uniform sampler2D relief_map;

layout(location = 0) in vec2 pane_position;
layout(location = 1) in vec3 position;
layout(location = 5) flat in vec4 map_grid; // these as in corner.glsl
layout(location = 6) flat in vec4 view_box;
layout(location = 7) flat in vec2 threshold_shift;
#ifdef PAPER
layout(location = 2) in vec4 pane_directions;
#else
layout(location = 2) in vec3 along_u;
layout(location = 3) in vec3 along_v;
layout(location = 4) in vec3 mist_light;
layout(location = 8) flat in vec4 tint_given; // these as in corner_light.glsl
layout(location = 9) flat in vec4 clip_xy[2];
layout(location = 11) flat in vec4 clip_w;
layout(location = 13) flat in vec2 gain_angle;
#endif

vec2 last_texel() { return map_grid.zw; }

// The pixel's position in texels, from the center of the first.
vec2 texels_here() { return clamp(pane_position / map_grid.xy - 0.5, vec2(0.0), last_texel()); }

// Not every device filters textures of four 32-bit floats.
vec4 relief_here()
{
    const vec2 texels = texels_here(), low = floor(texels), t = texels - low;
    if (!FILTER_IN_SHADER)
        return textureLod(relief_map, (texels + 0.5) / vec2(textureSize(relief_map, 0)), 0.0);
    const ivec2 at = ivec2(low), next_texel = min(at + 1, ivec2(last_texel()));
    return mix(mix(texelFetch(relief_map, at, 0), texelFetch(relief_map, ivec2(next_texel.x, at.y), 0), t.x),
               mix(texelFetch(relief_map, ivec2(at.x, next_texel.y), 0), texelFetch(relief_map, next_texel, 0), t.x),
               t.y);
}

bool is_behind_scene()
{
    if (!HAS_DEPTH)
        return false;
    const float stored = buffer_depth(gl_FragCoord.xy);
    return stored != view.far_depth && view_depth(stored) < 0.9999 / gl_FragCoord.w;
}

// The rim is one pixel wide: antialiased by the density's change per pixel.
float cover_of(float density)
{
    return clamp((density - threshold_shift.x) / max(fwidth(density), 1e-4) + 0.5, 0.0, 1.0);
}

Water water_here()
{
    const vec4 relief = relief_here();
    Water water;
    water.cover = cover_of(relief.x);
    water.mist = (1.0 - water.cover) * max(relief.w, 0.0);
    water.density = relief.x;
    water.slope = relief.yz;
    water.height = water.bend = max(-relief.w, 0.0);
    return water;
}
