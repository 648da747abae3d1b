// picture_surface.glsl - what a pixel of the pane shows of the height map: coverage, slopes and curvature of the
// water there.
#define SCENE_DEPTH_BINDING 15
#include "gpu/scene_depth.glsl"
#include "gpu/view.glsl"

layout(constant_id = 0) const bool HAS_DEPTH = true;
layout(scalar, set = 0, binding = 4) readonly buffer Surface { uint surface[]; };
layout(set = 0, binding = 12) uniform sampler2D map;

layout(location = 0) in vec2 place;
layout(location = 1) in vec3 position;
layout(location = 2) in vec3 along_u;
layout(location = 3) in vec3 along_v;

struct Water {
    float cover;  // of the pixel by drops and film that have a shape
    float mist;   // and by water too small for one
    float height; // m
    vec2 slope;   // of the height, or (paper) of the density, per metre
    float bend;   // largest change of the slope, 1/m
};

// ---- one channel of the 4 x 4 texels around a place, and what they give there. Weights are whole floats: those of
// a sampler
// have eight bits, whose steps slopes would show.

vec4 gather_map(vec2 texel, int channel)
{
    const vec2 at = (texel + 1.0) / vec2(textureSize(map, 0));
    const vec4 g = channel == 0 ? textureGather(map, at, 0) : textureGather(map, at, 1);
    return g.wzxy; // (0, 0), (1, 0), (0, 1), (1, 1)
}

vec2 map_place(out vec2 t)
{
    const vec2 last = vec2(look.map_columns, look.map_rows) - 3.0;
    const vec2 at = clamp(place / texel_m() - 0.5, vec2(1.0), last + 0.999);
    const vec2 low = min(floor(at), last);
    t = at - low;
    return low;
}

// Value, slopes per texel by central differences between which it is blended, and the largest change of a slope.
void relief(int channel, out vec2 slope, out float bend)
{
    vec2 t;
    const vec2 low = map_place(t);
    const vec4 a = gather_map(low - 1.0, channel), b = gather_map(low + vec2(1, -1), channel);
    const vec4 c = gather_map(low + vec2(-1, 1), channel), d = gather_map(low + vec2(1, 1), channel);
    // Rows from below: a.x a.y b.x b.y; a.z a.w b.z b.w; c.x c.y d.x d.y; c.z c.w d.z d.w.
    const vec4 across = 0.5 * vec4(b.z - a.z, b.w - a.w, d.x - c.x, d.y - c.y);
    const vec4 up = 0.5 * vec4(c.y - a.y, d.x - b.x, c.w - a.w, d.z - b.z);
    slope = vec2(mix(mix(across.x, across.y, t.x), mix(across.z, across.w, t.x), t.y),
                 mix(mix(up.x, up.y, t.x), mix(up.z, up.w, t.x), t.y));
    const vec2 along = vec2(max(abs(across.y - across.x), abs(across.w - across.z)),
                            max(abs(up.z - up.x), abs(up.w - up.y)));
    bend = max(along.x, along.y);
}

float between(vec4 corners, vec2 t)
{
    return mix(mix(corners.x, corners.y, t.x), mix(corners.z, corners.w, t.x), t.y);
}

// ---- coverage

bool is_glass()
{
    const uvec2 cell = uvec2(clamp(place / look.pane.cell_m, vec2(0.0), vec2(look.pane.columns, look.pane.rows) - 1.0));
    return (surface[cell.x + cell.y * look.pane.columns] & 0x1000000u) != 0u;
}

bool behind_scene()
{
    const float stored = HAS_DEPTH ? buffer_depth(gl_FragCoord.xy) : view.far_depth;
    return stored != view.far_depth && view_depth(stored) < 0.9999 / gl_FragCoord.w;
}

Water water_here()
{
    vec2 t;
    const vec2 low = map_place(t);
    const float density = between(gather_map(low, 0), t);
    // Over one pixel the rim goes from nothing to all.
    const float width = max(fwidth(density), 1e-4);
    const vec2 texels = vec2(look.map_columns, look.map_rows);
    const vec4 all = textureLod(map, clamp(place / texel_m(), vec2(0.5), texels - 0.5) /
                                         vec2(textureSize(map, 0)), 0.0);
    const float film_cover = look.style != 0u ? smoothstep(1e-6, 4e-6, all.a) : 0.0; // the paper has no film
    Water water = Water(0.0, 0.0, 0.0, vec2(0.0), 0.0);
    water.cover = max(clamp((density - look.threshold) / width + 0.5, 0.0, 1.0), film_cover);
    water.mist = (1.0 - water.cover) * all.b;
    return water;
}

// Slopes where there is water to show them.
void add_relief(inout Water water)
{
    vec2 t;
    const vec2 low = map_place(t);
    const vec4 heights = gather_map(low, 1);
    water.height = max(between(heights, t), 0.0);
    float bend;
    relief(look.style == 0u ? 0 : 1, water.slope, bend);
    water.slope /= texel_m();
    water.bend = bend / (look.texel_m[0] * look.texel_m[1]);
}
