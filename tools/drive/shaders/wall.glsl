// wall.glsl - how wet driving rain makes a wall (virga/walls.h). The includer has Frame, Surface and in_relative.
//
// Virga says how wet a surface in the open is, by its material and the direction that it faces. What is sheltered is
// the host's to know: a map of depth along the line of the rain's mean slant has what the rain meets first. Drops of
// other sizes and gusts come along lines beside that one, so a few of them are looked up.
#define VIRGA_GLSL
#include "shared/wall_gpu.h"
#include "shared/wall_map.glsl" // installed as virga/shared/wall_map.glsl

layout(set = 0, binding = 8) uniform sampler2D shelter_map;

const int SHELTER_LOOKS = 6;
const vec2 SHELTER_AT[SHELTER_LOOKS] = // in standard deviations of the slant
    vec2[](vec2(-1.2, 0.2), vec2(-0.5, -1.0), vec2(-0.2, 0.9), vec2(0.2, -0.3), vec2(0.6, 0.5), vec2(1.3, -0.6));
const float OWN_M = 0.05; // what is nearer above is the surface itself

// How far above a height (relative to the camera) the first surface is, on the line that a place of the map stands for.
float first_above(vec2 at, float height_m)
{
    float depth = textureLod(shelter_map, at * frame.shelter_slant.w, 0.0).r;
    return depth < 1.0 ? frame.shelter_low.y - depth * frame.shelter_low.w - height_m : -1.0;
}

// [0; 1] share of the rain that reaches a point of a surface.
float open_to_rain(vec3 point, vec3 n)
{
    vec2 mean = frame.shelter_slant.xy;
    vec3 from = point + 0.08 * n; // some texels off the surface
    vec2 at = from.xz + mean * from.y + frame.shelter_low.xz;
    vec2 inside = min(at, 1.0 / frame.shelter_slant.w - at);
    float known = smoothstep(0.5, 4.0, min(inside.x, inside.y)), blocked = 0.0;
    for (int i = 0; i < SHELTER_LOOKS && known > 0.0; i++) {
        // On this line, what is h above the point is at `at` + h apart. First h is guessed, then it is looked up there.
        vec2 apart = mean - virga_wall_slant(mean, frame.shelter_slant.z, SHELTER_AT[i], n);
        float above = first_above(at + 2.0 * apart, from.y);
        if (above > OWN_M)
            above = first_above(at + above * apart, from.y);
        blocked += step(OWN_M, above);
    }
    return 1.0 - known * blocked / float(SHELTER_LOOKS);
}

// x: [0; 1] how full of water its pores are. y: [0; 1] how much of it a film covers.
vec2 wall_water(vec3 n)
{
    if (surface.traits.w >= 0.0 || frame.shelter_low.w <= 0.0)
        return vec2(0.0);
    int material = int(-surface.traits.w) - 1;
    virga_wall_look look = virga_wall_rows(n);
    vec4 row = look.weights.x * frame.walls[int(look.rows.x) * DRIVE_WALL_MATERIALS + material] +
               look.weights.y * frame.walls[int(look.rows.y) * DRIVE_WALL_MATERIALS + material] +
               look.weights.z * frame.walls[int(look.rows.z) * DRIVE_WALL_MATERIALS + material];
    if (row.x < 0.01)
        return vec2(0.0);
    float open = open_to_rain(in_relative, n);
    return vec2(smoothstep(0.0, 0.85, row.x), smoothstep(0.01, 0.07, row.y)) * smoothstep(0.05, 0.6, open);
}

// Water in pores throws light back into them, so that more of it is absorbed (Lekner and Dorf 1988: 0.066 of diffuse
// light on its way in, 0.47 on its way out). A film shines: over paint as itself, over plaster it follows its grain.
void wet_wall(vec2 water, float metallic, inout vec3 albedo, inout float roughness)
{
    float porous = clamp((roughness - 0.5) / 0.3, 0.0, 1.0);
    vec3 dark = 0.934 * 0.53 * albedo / (1.0 - 0.47 * albedo);
    albedo = mix(albedo, dark, water.x * porous * (1.0 - metallic));
    roughness = mix(roughness, min(roughness, mix(0.15, 0.6, porous)), water.y);
}
