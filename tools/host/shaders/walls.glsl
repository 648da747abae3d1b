// walls.glsl - what driving rain makes of walls, posts, cars and all else that is no ground: how wet a surface of its
// material is that faces this way, in the open (virga/walls.h), and how much of that rain arrives here, past awnings
// and sills. A map of depth along the line on which the rain came says that.
//
// Pores full of water darken (Lekner and Dorf 1988: light that has come out of the surface is thrown back by the water,
// and has another chance to be absorbed). A film on paint and metal is a smooth surface of its own.
#define VIRGA_GLSL
#include "shared/ground_map.glsl"
#include "shared/wall_gpu.h"
#include "shared/wall_map.glsl"

layout(set = 0, binding = 4) uniform sampler2D wet_map;
layout(set = 0, binding = 10) uniform sampler2D shelter_map;

struct Wall {
    float damp; // [0; 1] of the pores
    float film; // [0; 1] share of the surface that is a film
};

const int SHELTER_LOOKS = 8;
const float SHELTER_GUESS_M = 2.0; // above a point, where what shelters it is looked for
const float SHELTER_CLEAR_M = 0.05; // what is nearer above is the surface itself
const float RUN_FULL_MM_H = 2.0;   // at this flow all streaks below a ledge are there
const float FOOT_M = 0.16;         // splashes wet the foot of a wall up to about this height
const float FOOT_FALL_MM_H = 10.0; // in such rain; by the square root of the rain

// Two normally distributed numbers for each look: one in each eighth of the distribution along either axis.
const vec2 SHELTER_AT[SHELTER_LOOKS] =
    vec2[](vec2(-1.53, 0.16), vec2(-0.89, -1.53), vec2(-0.49, 0.89), vec2(-0.16, -0.49), vec2(0.16, 1.53),
           vec2(0.49, -0.16), vec2(0.89, 0.49), vec2(1.53, -0.89));

float wall_hash(ivec2 at)
{
    uint x = uint(at.x) * 0x9e3779b1u + uint(at.y) * 0x85ebca77u;
    x = (x ^ (x >> 15)) * 0xed5ad4bbu;
    x = (x ^ (x >> 13)) * 0xac4c1b51u;
    return float((x ^ (x >> 16)) & 0xffffu) / 65535.0;
}

// [0; 1], smooth.
float wall_noise(vec2 at)
{
    const ivec2 low = ivec2(floor(at));
    const vec2 t = at - vec2(low), f = t * t * (3.0 - 2.0 * t);
    return mix(mix(wall_hash(low), wall_hash(low + ivec2(1, 0)), f.x),
               mix(wall_hash(low + ivec2(0, 1)), wall_hash(low + ivec2(1, 1)), f.x), f.y);
}

// How far above a height the first surface is on the line of the map that passes a point; it may be below.
float shelter_above(vec2 at, float height_m)
{
    const float depth = textureLod(shelter_map, at * frame.shelter_slant.w, 0.0).r;
    return depth < 1.0 ? frame.shelter_low.y - depth * frame.shelter_low.w - height_m : -1e9;
}

// Whether rain that comes so far apart from the mean's slant meets something, that is looked for at a height above a
// point: what is far nearer is another thing, or the surface itself.
bool shelter_met(vec2 at, float height_m, vec2 apart, float above_m)
{
    return shelter_above(at + above_m * apart, height_m) > max(SHELTER_CLEAR_M, 0.3 * above_m);
}

// Share of the rain that reaches a surface; 1 where it is not `asked` for. `near_m`: how far above it is the nearest
// thing that shelters it. Software Vulkan runs what stands under a condition for all pixels, but goes on in a loop only
// while one is in it: where nothing is looked for it begins with the last look.
float shelter_open(vec3 relative, vec3 n, bool asked, out float near_m)
{
    const vec2 mean = frame.shelter_slant.xy;
    const float spread = frame.shelter_slant.z, side_m = 1.0 / frame.shelter_slant.w;
    const float texel_m = side_m / float(textureSize(shelter_map, 0).x);
    const vec3 point = relative + n * (2.5 * texel_m);
    const vec2 at = point.xz + mean * point.y + frame.shelter_low.xz, inside = min(at, side_m - at);
    const float known = smoothstep(0.5, 4.0, min(inside.x, inside.y));
    near_m = 1e9;
    const bool looked = asked && known > 0.0;
    // On the line of the mean, and on four around it, where these are at the height that is guessed. Two things may
    // shelter a place: the sill above it, and the eaves.
    float found = 0.0, sum_m = 0.0;
    int i = looked ? 0 : 4;
    do {
        const vec2 off = i == 0 ? vec2(0.0) : vec2(i < 3 ? 1.2 : -1.2, (i & 1) == 0 ? 1.2 : -1.2);
        const vec2 apart = mean - virga_wall_slant(mean, spread, off, n);
        const float above = shelter_above(at + SHELTER_GUESS_M * apart, point.y);
        const bool is = above > (i == 0 ? SHELTER_CLEAR_M : 0.3 * SHELTER_GUESS_M);
        near_m = is ? min(near_m, above) : near_m;
        found += float(is);
        sum_m += is ? above : 0.0;
    } while (++i < 5);
    const bool sheltered = looked && found > 0.0;
    const float far_m = sum_m / max(found, 1.0);
    float blocked = 0.0;
    i = sheltered ? 0 : SHELTER_LOOKS - 1;
    do {
        const vec2 apart = mean - virga_wall_slant(mean, spread, SHELTER_AT[i], n);
        bool met = shelter_met(at, point.y, apart, near_m);
        if (far_m > 1.5 * near_m && !met)
            met = shelter_met(at, point.y, apart, far_m);
        blocked += float(met);
    } while (++i < SHELTER_LOOKS);
    near_m = looked ? near_m : 1e9;
    return sheltered ? 1.0 - known * blocked / float(SHELTER_LOOKS) : 1.0;
}

// Water that gathers on a ledge comes down in streaks: share of a place, `u` along the wall and so far below the ledge,
// that is in one. `flow`: [0; 1] of the streaks are there.
float ledge_streaks(float u, float y, float below_m, float flow, float pixel_m)
{
    const float side_m = 0.09;
    const float at = u / side_m + 0.35 * (wall_noise(vec2(u * 3.0, y * 2.0)) - 0.5), cell = floor(at);
    const ivec2 key = ivec2(int(cell), 0);
    const float chance = wall_hash(key), middle = 0.2 + 0.6 * wall_hash(key + ivec2(0, 7919));
    const float length_m = 0.03 + 0.9 * pow(1.0 - chance, 4.0);
    const float narrow = 1.0 - 0.5 * clamp(below_m / length_m, 0.0, 1.0); // it soaks in on its way
    const float width_m = (0.06 + 0.2 * wall_hash(key + ivec2(0, 104729))) * side_m * narrow;
    const float across_m = abs(at - cell - middle) * side_m;
    const float in_streak = clamp((width_m - across_m) / max(0.5 * width_m, pixel_m) + 0.5, 0.0, 1.0) *
                            min(2.0 * width_m / max(pixel_m, 1e-4), 1.0);
    return in_streak * step(chance, 0.7 * flow) * (1.0 - smoothstep(0.7, 1.0, below_m / length_m));
}

// Irregularities of edges between wet and dry, at a place along a wall and its height.
float wall_grain(vec2 at) { return 0.6 * wall_noise(14.0 * at) + 0.4 * wall_noise(45.0 * at); }

// Splashes from wet ground.
float wall_foot(vec3 relative, vec3 n, vec2 place, float fall_mm_h)
{
    const float inv_cell = frame.ground_low.w, reach_m = FOOT_M * sqrt(fall_mm_h / FOOT_FALL_MM_H);
    const vec2 at = (relative.xz + 0.1 * n.xz - frame.ground_low.xz) * inv_cell;
    const int cells = int(frame.ground_wrap.z);
    const ivec2 cell = ivec2(floor(at));
    if (inv_cell <= 0.0 || min(cell.x, cell.y) < 0 || max(cell.x, cell.y) >= cells)
        return 0.0;
    const vec4 ground = virga_ground_texel(wet_map, ivec2(frame.ground_wrap.xy), cells, cell);
    const float height_m = relative.y - frame.ground_low.y - ground.a;
    if (height_m < -0.3 || height_m > 2.0 * reach_m)
        return 0.0;
    const float high = reach_m * (0.55 + 0.9 * wall_grain(place));
    return ground.r * (1.0 - smoothstep(0.35 * high, 1.3 * high, height_m));
}

// Share of a film that is left where it runs: it is thicker in rivulets, which keep to their paths.
float wall_rivulets(vec2 place)
{
    const float path = 22.0 * place.x + 0.6 * wall_noise(3.0 * place);
    return mix(0.3, 1.0, smoothstep(0.4, 0.8, wall_noise(vec2(path, 1.1 * place.y))));
}

vec4 wall_row(uint row, int material) { return frame.walls[int(row) * HOST_WALL_MATERIALS + material]; }

// `material`: -1 for what is left dry; `ground`: what is level of it is in the maps of the ground.
Wall wall_at(vec3 relative, vec3 n, int material, bool ground)
{
    Wall wall = Wall(0.0, 0.0);
    const float pixel_m = max(length(dFdx(relative)), length(dFdy(relative)));
    if (frame.shelter_low.w <= 0.0 || material < 0)
        return wall;
    const virga_wall_look look = virga_wall_rows(n);
    const vec4 level = wall_row(look.rows.z, material);
    const vec4 sides[2] = vec4[](wall_row(look.rows.x, material), wall_row(look.rows.y, material));
    const vec4 row = look.weights.x * sides[0] + look.weights.y * sides[1] + look.weights.z * level;
    const float share = ground ? 1.0 - smoothstep(HOST_LEVEL_Y, 0.6, n.y) : 1.0;
    if (share <= 0.0)
        return wall;
    const vec3 world = relative + frame.camera.xyz;
    const vec2 place = vec2(n.z * world.x - n.x * world.z + 17.0 * n.x, world.y);
    if (row.x > 0.01) {
        float near_m;
        const float open = shelter_open(relative, n, row.x > 0.01 && share > 0.0, near_m);
        // What is soaked in the open has had enough where a part of the rain arrives.
        const float enough = mix(0.9, 0.45, smoothstep(0.0, 0.06, row.y)), part = open * (1.0 - open);
        const float uneven = part > 0.0 ? 1.8 * (wall_grain(place) - 0.5) * part : 0.0;
        const float wet = smoothstep(0.05, enough, open + uneven);
        const float run = clamp(row.z / RUN_FULL_MM_H, 0.0, 1.0) * (1.0 - smoothstep(0.2, 0.6, abs(n.y)));
        const float flow = clamp(level.z / RUN_FULL_MM_H, 0.0, 1.0);
        float streak = 0.0, thick = 1.0;
        if (open < 0.95 && near_m < 1.0 && abs(n.y) < 0.4)
            streak = ledge_streaks(place.x, place.y, near_m, flow, pixel_m);
        if (run > 0.0)
            thick = mix(1.0, wall_rivulets(place), run);
        wall.damp = max(smoothstep(0.0, 0.85, row.x) * wet, 0.9 * streak);
        wall.film = max(smoothstep(0.01, 0.07, row.y) * wet * thick, 0.8 * streak);
    }
    const float foot = abs(n.y) < HOST_STEEP_Y ? wall_foot(relative, n, place, level.w) : 0.0;
    wall.damp = share * max(wall.damp, foot);
    wall.film = share * max(wall.film, 0.7 * foot);
    return wall;
}

void wet_wall(Wall wall, float metallic, inout vec3 albedo, inout float roughness, inout vec3 f0)
{
    // 0.066 of diffuse light is thrown back when it enters water, 0.47 when it leaves it.
    const float porous = clamp((roughness - 0.5) / 0.3, 0.0, 1.0);
    const vec3 dark = 0.934 * 0.53 * albedo / (1.0 - 0.47 * albedo);
    albedo = mix(albedo, dark, wall.damp * porous * (1.0 - metallic));
    const float smooth_film = mix(0.15, 0.62, porous); // a film over what is rough follows it in part
    const float under = mix(roughness, 0.75 * roughness, wall.damp * porous);
    roughness = mix(under, min(under, smooth_film), wall.film * (1.0 - 0.6 * metallic));
    f0 = mix(f0, max(f0 - 0.02, vec3(0.0204)), wall.film * (1.0 - metallic));
}
