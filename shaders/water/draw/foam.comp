// foam.comp - light of each particle of foam, and where it is in the picture.
//
// Foam scatters light many times and swallows hardly any: it is taken as white paper that lies on the surface. Spray is
// taken as drops of rain are. Many particles that are half transparent make a soft cover: where n of them lie over each
// other, they cover 1 - (1 - a)^n.
//
// What is under the surface is seen through the water: less what the surface mirrors, and what the water swallows on
// both ways.
//
// One invocation per particle. Reads: the list, foam, the sums of splats. Writes: foam_splats.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "gpu/light.glsl"
#include "shared/compact.h"
#include "shared/foam.h"
#define STATE_ACCESS readonly
#include "water/state.glsl"
#define SCALED (look.scale < 1.0)
#include "surface.glsl"
#include "fresnel.glsl"
#include "foam_splats.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(scalar, set = 0, binding = 20) readonly buffer SlotList
{
    virga_list_gpu slot_list;
    uint slots[];
};
layout(scalar, set = 0, binding = 21) readonly buffer Foam { virga_foam_gpu foam[]; };
layout(std430, set = 0, binding = 22) writeonly buffer FoamSplats { uvec4 foam_splats[]; };

#define WHITE 0.9
#define MIN_PX 0.75   // smaller ones are drawn with this radius and less coverage
#define MAX_STREAK_PX 4096.0 // far from where a half float ends
#define APPEARS_S 0.08
#define DISSOLVES_S 0.5

// Of a white surface: its radiance is the irradiance over pi. The moments are those of a cosine.
vec3 lit(vec3 p, vec3 n)
{
    vec3 sum = environment(n, vec2(0.6666667, 0.25));
    for (uint i = 0u; i < view.light_count; i++) {
        const Lamp lamp = lamp_at(i, p);
        sum += view.light_gain / 3.14159265 * lamp.light * max(dot(lamp.towards, n), 0.0);
    }
    return sum;
}

// The water's surface at the particle's pixel, and what it lets through of what is `under` it by so much (m).
struct Cover {
    vec3 normal, through;
    float under;
};

Cover cover_at(vec3 p, vec4 clip)
{
    const vec2 pixel = vec2(view.viewport[0], view.viewport[1]) +
                       (0.5 * clip.xy / clip.w + 0.5) * vec2(view.viewport[2], view.viewport[3]);
    const vec4 sums = sums_at(clamp(image_pixel(pixel), vec2(0.5), vec2(look.width, look.height) - 0.5));
    Cover cover = Cover(vec3(0.0, 1.0, 0.0), vec3(1.0), 0.0);
    if (sums.w < 0.5)
        return cover;
    const vec3 normal = normalize(normal_of(sums.xy / sums.w));
    const float cosine = max(-dot(normal, normalize(p)), 0.05), depth = sums.z / sums.w;
    cover.under = (clip.w - depth) / clip.w * length(p);
    if (abs(cover.under) < 4.0 * look.spacing_m)
        cover.normal = normal;
    // Foam on the surface is half in it: that counts as above.
    const float wet = max(cover.under - 0.5 * look.spacing_m, 0.0);
    const float in_water = sqrt(1.0 - (1.0 - cosine * cosine) / (WATER * WATER));
    const vec3 lost = to_vec(look.absorption_1_m) + to_vec(look.scattering_1_m);
    const float mirrored = min(look.reflection * fresnel(cosine, in_water), 1.0);
    cover.through = mix(vec3(1.0), (1.0 - mirrored) * exp(-2.0 * lost * wet), min(wet / look.spacing_m, 1.0));
    return cover;
}

float coverage_of_kind(virga_foam_gpu own)
{
    const float there = clamp(own.age_s / APPEARS_S + 0.25, 0.0, 1.0) * clamp(own.life_s / DISSOLVES_S, 0.0, 1.0);
    return look.foam_coverage * there * (own.kind == VIRGA_FOAM_SURFACE ? 1.0 : 0.6);
}

// How far it has come in the picture since the shutter opened, in pixels of the target. Without this, a picture of a
// few sub-frames has rows of dots where foam is fast.
vec2 streak_of(vec3 p, vec3 velocity, vec4 clip)
{
    const vec4 opened = project(to_mat(view.open_clip_from_rel),
                                p - (view.time_close_s - view.time_open_s) * velocity);
    if (!(min(opened.w, clip.w) > NEAR_W))
        return vec2(0.0);
    const vec2 streak = 0.5 * (clip.xy / clip.w - opened.xy / opened.w) * vec2(view.viewport[2], view.viewport[3]);
    return clamp(streak, vec2(-MAX_STREAK_PX), vec2(MAX_STREAK_PX));
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= state.foam)
        return;
    const virga_foam_gpu own = foam[slots[index]];
    const vec3 p = to_vec(own.position) + to_vec(view.origin_offset) - look.foam_late_s * to_vec(own.moved);
    const vec4 clip = project(to_mat(view.clip_from_rel), p);
    const vec2 streak = streak_of(p, to_vec(own.moved), clip);
    foam_splats[FOAM_TEXELS * index] = uvec4(floatBitsToUint(clip.xyw), halves(streak.x, streak.y));
    float radius = own.radius / (view.pixel_angle * clip.w), covered = coverage_of_kind(own);
    if (radius < MIN_PX)
        covered *= radius * radius / (MIN_PX * MIN_PX);
    radius = max(radius, MIN_PX);
    covered *= kept_by_streak(length(streak) / radius);
    const vec2 edge = clip.w + 2.0 * (radius + abs(streak)) * clip.w / vec2(view.viewport[2], view.viewport[3]);
    if (!(clip.w > NEAR_W) || any(greaterThan(abs(clip.xy), edge)) || covered < 1e-3) {
        foam_splats[FOAM_TEXELS * index + 1u] = uvec4(0u);
        return;
    }
    const Cover cover = cover_at(p, clip);
    const vec3 flying = environment(normalize(p), vec2(view.phase_moment[1], view.phase_moment[2])) +
                        lamps(p, normalize(p));
    const vec3 light = own.kind == VIRGA_FOAM_SPRAY ? 0.5 * (flying + WHITE * lit(p, vec3(0.0, 1.0, 0.0)))
                                                    : WHITE * lit(p, cover.normal);
    // What the water swallows is lost from the cover, too: it lies over the water's own light.
    const vec3 seen = light * cover.through;
    const float left = max(cover.through.r, max(cover.through.g, cover.through.b));
    const vec4 before = project(to_mat(view.previous_clip_from_rel), p - to_vec(own.moved) * view.frame_interval_s);
    const vec2 motion = motion_px(clip, before);
    foam_splats[FOAM_TEXELS * index + 1u] =
        uvec4(floatBitsToUint(radius), halves(seen.r / max(left, 1e-4), seen.g / max(left, 1e-4)),
              halves(seen.b / max(left, 1e-4), covered * left), halves(motion.x, motion.y));
}
