// view.frag - the picture, tone-mapped, or what it is made of.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "view_common.glsl"

layout(location = 0) out vec4 out_color;

const vec3 OUTSIDE = vec3(0.055, 0.06, 0.07); // around the picture

// As png_tone has it: identity up to 0.6, then a rational shoulder that meets 1 at 8.
float tone(float x)
{
    const float knee = 0.6, room = 1.0 - knee, white = (8.0 - knee) / room;
    const float u = (x - knee) / room;
    return x <= knee ? max(x, 0.0) : min(1.0, knee + room * u * (1.0 + u / (white * white)) / (1.0 + u));
}

vec3 to_display(vec3 linear)
{
    const vec3 low = linear * 12.92, high = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, vec3(lessThanEqual(linear, vec3(0.0031308))));
}

vec3 exposed(vec3 radiance)
{
    const vec3 x = radiance * view.picture.z;
    return to_display(vec3(tone(x.r), tone(x.g), tone(x.b)));
}

vec4 over(vec4 layer, vec4 below) { return layer + below * (1.0 - layer.a); }

vec4 beauty(vec2 at)
{
    vec4 sum = textureLod(color_map, at, 0.0);
    if (has(HAS_SPLASH))
        sum = over(textureLod(splash_map, at, 0.0), sum);
    sum = over(textureLod(rain_map, at, 0.0), sum);
    return has(HAS_GLASS) ? over(textureLod(glass_map, at, 0.0), sum) : sum;
}

// A premultiplied layer over squares, as image editors show what is transparent.
vec3 layer(vec4 texel)
{
    const vec2 square = floor(gl_FragCoord.xy / 12.0);
    const float grey = mod(square.x + square.y, 2.0) < 1.0 ? 0.06 : 0.09;
    return to_display(clamp(texel.rgb * view.picture.z + grey * (1.0 - texel.a), 0.0, 1.0));
}

// Blue over green and yellow to red, for amounts in [0; 1].
vec3 heat(float x)
{
    x = clamp(x, 0.0, 1.0);
    return clamp(vec3(1.5 - abs(4.0 * x - vec3(3.0, 2.0, 1.0))), 0.0, 1.0);
}

vec3 hue(float turn)
{
    return clamp(abs(fract(turn + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
}

float distance_at(ivec2 texel)
{
    const float depth = texelFetch(depth_map, texel, 0).r;
    return view.projection.w / (depth + view.projection.z);
}

vec3 depth_color(ivec2 texel)
{
    const float d = distance_at(texel);
    return texelFetch(depth_map, texel, 0).r >= 1.0 ? vec3(0.0) : vec3(1.0 - clamp(log2(1.0 + d) / 8.0, 0.0, 0.95));
}

vec3 velocity_color(vec2 pixels)
{
    const float speed = length(pixels);
    const vec3 direction = hue(atan(pixels.y, pixels.x) / 6.2831853);
    return mix(vec3(0.02), direction, clamp(speed / view.picture.w, 0.0, 1.0));
}

vec3 id_color(uint id)
{
    return id == 0u ? vec3(0.0)
                    : mix(vec3(0.85), hue(float(id) * 0.61803399), 0.55) * (0.55 + 0.45 * fract(float(id) * 0.37));
}

// ---- cells, where the picture shows them

// The cell of the world at a place relative to the camera, as an entry of the buffers; false outside of the window.
bool cell_of(vec3 relative, out uint place)
{
    const ivec2 cell = ivec2(floor((relative.xz - view.ground.xy) * view.ground.z));
    const int side = int(view.ground.w), tiles = view.cells.z;
    const ivec2 tile = (cell >> 6) + view.cells.xy, slot = tile & (tiles - 1), inside = cell & 63;
    place = (uint(slot.y * tiles + slot.x) << 12) | uint(inside.y << 6 | inside.x);
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
    const uint um = cell.free_nl / uint(view.cells.w);
    if (um >= 3000u)
        return um >= 10000u ? VIRGA_GROUND_PUDDLE_10 : um >= 5000u ? VIRGA_GROUND_PUDDLE_5 : VIRGA_GROUND_PUDDLE_3;
    const uint capacity = view.capacity[material >> 2][material & 3u];
    return cell.held_nl >= capacity && um >= 20u ? VIRGA_GROUND_WET : VIRGA_GROUND_DRY;
}

vec3 cell_color(ivec2 texel, vec2 at)
{
    const vec3 grey = vec3(0.35 * dot(exposed(textureLod(color_map, at, 0.0).rgb), vec3(0.3, 0.6, 0.1)));
    uint place;
    const vec3 relative = relative_at(texel);
    if (!has(HAS_GROUND) || texelFetch(depth_map, texel, 0).r >= 1.0 || !cell_of(relative, place))
        return grey;
    const virga_floor_gpu own = floors[place];
    const float above = relative.y + view.jitter.z - float(own.height_um) * 1e-6;
    if (own.material >= VIRGA_GROUND_MATERIALS || abs(above) > 0.25)
        return grey;
    const uint entry = view.mode.x == VIEW_MATERIAL ? own.material : state_of(cells[place], own.material);
    return view.palette[entry].rgb * (0.55 + 1.3 * grey.r);
}

// ---- flat maps

vec3 occlusion_color(vec2 pixel)
{
    const vec4 flat_map = flat_area(1.0);
    const vec2 at = (pixel - flat_map.xy) / flat_map.zw;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0))) || !has(HAS_MAPS))
        return OUTSIDE;
    const float depth = textureLod(occlusion_map, vec3(at, float(view.mode.y)), 0.0).r;
    const float height = view.heights.x - depth * view.heights.y; // in the world
    return depth >= 1.0 ? vec3(0.03, 0.03, 0.08) : heat(0.08 + (height - view.heights.z) / 16.0) * 0.9;
}

// The pane as seen from outside: u to the right, v up.
bool pane_place(vec2 pixel, out vec2 place)
{
    const vec4 flat_map = flat_area(view.pane.x / view.pane.y);
    const vec2 at = (pixel - flat_map.xy) / flat_map.zw;
    place = vec2(at.x, 1.0 - at.y) * view.pane.xy;
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0))) && has(HAS_GLASS);
}

float distance_to_blade(vec2 place, vec4 blade)
{
    const vec2 way = blade.zw - blade.xy, from = place - blade.xy;
    return length(from - way * clamp(dot(from, way) / max(dot(way, way), 1e-9), 0.0, 1.0));
}

// Affinity, with the particles' regions beside the blades; the drops are drawn over it.
vec3 pane_color(vec2 pixel)
{
    vec2 place;
    if (!pane_place(pixel, place))
        return OUTSIDE;
    const uvec2 cell = min(uvec2(place / view.pane.z), view.pane_cells.xy - 1u);
    const uint word = surface[cell.x + cell.y * view.pane_cells.x];
    if ((word & 0x1000000u) == 0u)
        return OUTSIDE;
    const float affinity = (float(word & 0xffu) - 128.0) / 32.0;
    vec3 color = vec3(0.25 + 0.09 * affinity);
    for (uint i = 0u; i < view.pane_cells.z; i++) {
        const float way = distance_to_blade(place, view.blades[i]);
        color = way < view.pane.w ? mix(color, vec3(0.55, 0.32, 0.1), 0.6) : color;
        color = way < 0.004 ? vec3(0.02) : color;
    }
    return color;
}

vec3 height_color(vec2 pixel)
{
    vec2 place;
    if (!pane_place(pixel, place) || !has(HAS_HEIGHTS))
        return OUTSIDE;
    const vec4 texel = texelFetch(height_map, ivec2(place / view.pane.xy * view.height_map.xy), 0);
    const float water = texel.r >= view.height_map.z ? texel.g : 0.0;
    return water > 0.0 ? heat(0.15 + 0.85 * water / 0.0015) : vec3(0.05, 0.06, 0.09) + 0.5 * vec3(texel.b);
}

void main()
{
    const vec2 pixel = gl_FragCoord.xy, at = (pixel - view.area.xy) / view.area.zw;
    const ivec2 texel = clamp(ivec2(at * view.picture.xy), ivec2(0), ivec2(view.picture.xy) - 1);
    const bool inside = all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
    vec3 color = OUTSIDE;
    switch (inside ? view.mode.x : VIEW_MODES) {
    case VIEW_PICTURE: color = exposed(beauty(at).rgb); break;
    case VIEW_PLATE: color = exposed(textureLod(color_map, at, 0.0).rgb); break;
    case VIEW_RAIN: color = layer(textureLod(rain_map, at, 0.0)); break;
    case VIEW_SPLASH: color = layer(has(HAS_SPLASH) ? textureLod(splash_map, at, 0.0) : vec4(0.0)); break;
    case VIEW_GLASS: color = layer(has(HAS_GLASS) ? textureLod(glass_map, at, 0.0) : vec4(0.0)); break;
    case VIEW_REFRACTION:
        if (has(HAS_GLASS)) {
            const vec4 bent = texelFetch(refraction_map, texel, 0);
            color = mix(vec3(0.05), vec3(0.5 + bent.xy / (2.0 * view.picture.xy), 0.5), bent.a);
        }
        break;
    case VIEW_DEPTH: color = depth_color(texel); break;
    case VIEW_NORMAL: color = 0.5 + 0.5 * texelFetch(normal_map, texel, 0).xyz; break;
    case VIEW_VELOCITY: color = velocity_color(texelFetch(velocity_map, texel, 0).xy); break;
    case VIEW_ID: color = id_color(texelFetch(id_map, texel, 0).r); break;
    case VIEW_WETNESS: color = heat(0.05 + 0.6 * texelFetch(water_map, texel, 0).x).bgr; break;
    case VIEW_WATER_DEPTH: color = heat(texelFetch(water_map, texel, 0).y / 0.01); break;
    case VIEW_CELL_STATE:
    case VIEW_MATERIAL: color = cell_color(texel, at); break;
    case VIEW_OCCLUSION: color = occlusion_color(pixel); break;
    case VIEW_PANE: color = pane_color(pixel); break;
    case VIEW_PANE_HEIGHT: color = height_color(pixel); break;
    }
    out_color = vec4(color, 1.0);
}
