// water.glsl - a material that is damp, wet or under water.
//
// Pores full of water darken what is rough (Lagarde 2013: albedo falls to a fifth where porosity is one); a film makes
// it glossier; from a tenth of a millimetre on water has a level surface of its own over it, with the reflectance of
// water (0.0204 at right angles), still rough where it is thin, and a mirror where it is a puddle. One surface for
// both, that mirrors the scene: were film to mirror the sky alone, every puddle would have a bright rim. So does what
// is merely soaked: a street between houses has little of the sky, and wet asphalt is darker than dry.
//
// What water does not cover are stones (grain.glsl): their film follows them, and mirrors by their slopes. Around each
// the water climbs a little, and what is shallower than a third of a millimetre does as they do.
#ifndef WALLS
#include "shared/ground_map.glsl"
#endif

#include "grain.glsl"

#ifndef WALLS // which has it already
layout(set = 0, binding = 4) uniform sampler2D wet_map;
#endif
layout(set = 0, binding = 5) uniform usampler2D spot_map;
layout(set = 0, binding = 6) uniform sampler2D ripple_map;
layout(set = 0, binding = 8) uniform sampler2D far_map;

struct Water {
    float damp;     // [0; 1] of the pores
    float joint;    // [0; 1] the same for water of joints, which darkens, but lies too deep to shine
    float film;     // [0; 1] share of the surface that is a film
    float puddle;   // [0; 1] share that has a surface of its own
    float depth_mm;
    float roughness; // of that surface
    vec3 normal;     // of that surface
};

const float THIN_SLOPE2 = 0.0067;   // variance of the slopes of a film that follows the grains below, along an axis
const float CLIMB_MM = 0.35;        // water that is shallower is no level
const float CLIMB_BLUR_MM = 0.15;

// Slope of the rings around the camera, faded out towards the end of their map, where only their variance is left.
vec3 water_normal(vec3 relative, float pixel_m, out float drawn)
{
    const vec2 at = (relative.xz - frame.ripples.xy) * frame.ripples.z;
    const vec2 inside = min(at, 1.0 - at);
    drawn = frame.ripples.w > 0.0 ? smoothstep(0.0, HOST_RIPPLES_FADE, min(inside.x, inside.y)) : 0.0;
    // Waves of about 2 cm can not be seen where a sample is as wide.
    drawn *= 1.0 - smoothstep(0.006, 0.03, pixel_m * sqrt(frame.sampling.x));
    const vec2 slope = textureLod(ripple_map, at, 0.0).xy * drawn;
    return normalize(vec3(-slope.x, 1.0, -slope.y));
}

// Of the surface; -1 if it is no ground.
int ground_material() { return (int(surface.traits.w) / HOST_GROUND) - 1; }

// What lies beyond the window, and on ground even beyond the map of that.
virga_ground_wetness far_water(vec3 relative, float height_m)
{
    const int cells = int(frame.ground_far.w), material = ground_material();
    virga_ground_wetness open = virga_ground_wetness(0.0, 0.0, 0.0, 0.0);
    if (material >= 0)
        open = virga_ground_open(far_map, cells, uint(material));
    const vec2 at = (relative.xz - frame.ground_far.xz) * frame.ground_far.y;
    return virga_ground_far_at(far_map, cells, at, height_m, open, 1.0 / max(frame.ground_far.y, 1e-6));
}

// glTF's occlusion is 0 in the middle of a joint, and 1 where its water does not come. It is taken as a distance.
const float JOINT_WIDTH_M = 0.010, JOINT_TO_OPEN_M = 0.017;

// Darkness by the water of joints. Where a pixel is as wide as a joint it fades.
float joints_at(float occlusion, float wet, float pixel_m)
{
    const float away_m = occlusion * JOINT_TO_OPEN_M - 0.5 * JOINT_WIDTH_M;
    const float most_m = JOINT_TO_OPEN_M - 0.5 * JOINT_WIDTH_M;
    return virga_ground_joint(wet, away_m, JOINT_WIDTH_M, most_m, pixel_m) * (1.0 - smoothstep(0.006, 0.02, pixel_m));
}

// `occlusion`: 1 without joints.
Water water_at(vec3 relative, vec3 n, float occlusion)
{
    const float inv_cell = frame.ground_low.w;
    const vec2 at = (relative.xz - frame.ground_low.xz) * inv_cell;
    const float pixel = max(length(dFdx(at)), length(dFdy(at)));
    const float height_m = relative.y - frame.ground_low.y;
    virga_ground_wetness wet = virga_ground_at(wet_map, spot_map, ivec2(frame.ground_wrap.xy),
                                               max(int(frame.ground_wrap.z), 1), at, height_m, pixel,
                                               1.0 / max(inv_cell, 1e-6));
    const float near = virga_ground_near_share(relative.xz * inv_cell, frame.ground_wrap.w);
    if (frame.ground_far.y > 0.0 && near < 1.0)
        wet = virga_ground_mix(far_water(relative, height_m), wet, near);
    const float level = inv_cell > 0.0 ? smoothstep(HOST_LEVEL_Y, 0.6, n.y) : 0.0;
    const float cell_m = 1.0 / max(inv_cell, 1e-6), pixel_m = pixel * cell_m;
    Water water;
    water.damp = level * max(0.85 * wet.spot, smoothstep(0.15, 0.8, wet.wet));
    water.joint = level * 0.85 * joints_at(occlusion, wet.wet, pixel_m);
    water.film = level * smoothstep(0.01, 0.25, wet.depth_mm);
    // Full pores close over: the most that they shine is three quarters of what a film does.
    water.puddle = level * max(smoothstep(0.05, 0.4, wet.depth_mm), 0.75 * smoothstep(0.3, 0.9, wet.wet));
    water.depth_mm = level * wet.depth_mm;
    float drawn;
    water.normal = water_normal(relative, pixel_m, drawn);
    // Beckmann's alpha^2 is twice the variance of a slope: that of waves which are not drawn, and that within a pixel
    // of those which are, where they turn from one to the next (a pixel as a normal distribution of half of its side:
    // Kaplanyan et al. 2016, Filtering distributions of normals for shading antialiasing). Of pictures that
    // are averaged each has to make up for a part of the pixel only.
    const vec2 slope = water.normal.xz / water.normal.y, right = dFdx(slope), down = dFdy(slope);
    const float within = 0.25 * frame.sampling.x * (dot(right, right) + dot(down, down));
    const Grain grain =
        grain_at(at, frame.ground_wrap.xy, int(frame.ground_wrap.z), cell_m, pixel_m * sqrt(frame.sampling.x),
                 water.puddle > 0.0 ? ground_material() : -1, wet.depth_mm);
    // The map shows all but the smallest drops' waves, which are shorter than its texels: a fifth of the variance.
    const float waves2 = wet.slope2 * (1.0 - 0.8 * drawn) + within + grain.stirred2;
    // Where stones or thin water give the slope, and where the waves do.
    const float level_mm = virga_ground_level_mm(wet.depth_mm, grain.spread_mm) - CLIMB_MM;
    const float still =
        virga_ground_under_water(level_mm, grain.height_mm, length(vec2(grain.lost_mm, CLIMB_BLUR_MM)));
    const vec2 mixed = mix(grain.slope, grain.stirred - slope, still);
    water.normal = normalize(vec3(-mixed.x, 1.0, -mixed.y));
    const float stones2 = THIN_SLOPE2 - min(grain.drawn_slope2, 0.9 * THIN_SLOPE2);
    water.roughness = clamp(sqrt(sqrt(2.0 * mix(stones2, waves2, still))), 0.03, 0.5);
    return water;
}

float porosity(float roughness) { return clamp((roughness - 0.5) / 0.4, 0.0, 1.0); }

// What of the light that falls on water comes back from a surface of some albedo below it, but for Fresnel's share on
// the way out, which depends on where it is seen from. Of diffuse light 0.934 enters. Below the surface it is spread
// evenly; what leaves has n^2 times less radiance than below; and 1 - 0.934 / n^2 = 0.474 of what comes up is thrown
// back, for another chance to be absorbed (Angstrom 1925, Lekner and Dorf 1988; n 1.333). Absorption on the way is left
// out: a centimetre of water takes 0.3 % of red light (0.34 / m at 650 nm, Pope and Fry 1997).
vec3 albedo_under_water(vec3 albedo) { return 0.934 * 0.563 * albedo / (1.0 - 0.474 * albedo); }

// What lies under the water, wet: darker where it is porous, glossier under a film. What pores are measured to darken
// by is with that water on it; what has none, as paint, is darker where the water has a surface of its own.
void wet_material(Water water, float metallic, inout vec3 albedo, inout float roughness, inout vec3 f0)
{
    const float damp = max(water.damp, water.joint);
    const float dark = mix(1.0, mix(1.0, 0.2, porosity(roughness)), damp * (1.0 - metallic));
    const vec3 covered = mix(albedo, albedo_under_water(albedo), water.puddle);
    // Saturated colours darken more: light bounces in the pores more often before it comes out.
    albedo = mix(albedo * dark, albedo * albedo * dark / max(dot(albedo, vec3(1.0 / 3.0)), 1e-3), 0.35 * damp);
    albedo = min(albedo, covered);
    roughness = mix(roughness, max(0.3 * roughness, 0.12), max(water.film, 0.35 * water.damp));
    f0 = mix(f0, max(f0, vec3(0.02)), water.film);
}
