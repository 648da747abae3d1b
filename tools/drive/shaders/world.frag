#version 460
// world.frag - the sample's only material: sky light, lamps, and the water that Virga's ground says is there.
#extension GL_GOOGLE_include_directive : require
#include "drive_gpu.h"
#include "shared/ground_map.glsl" // installed as virga/shared/ground_map.glsl

layout(set = 0, binding = 0, std140) uniform Frame { drive_frame_gpu frame; };
layout(set = 0, binding = 2) uniform sampler3D reflection; // panoramas by roughness
layout(set = 0, binding = 3) uniform sampler2D wet_map;
layout(set = 0, binding = 4) uniform usampler2D spot_map;
layout(set = 0, binding = 5) uniform sampler2D ripple_map;
layout(set = 0, binding = 6) uniform sampler2D last_picture; // of the frame before, dry; alpha: 1 / distance
layout(set = 0, binding = 7) uniform sampler2D far_map;
layout(set = 1, binding = 0) uniform sampler2D base_texture;
layout(set = 1, binding = 1) uniform sampler2D emissive_texture;
layout(push_constant) uniform Surface { drive_surface_gpu surface; };

layout(location = 0) in vec3 in_relative;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec2 in_uv;
layout(location = 0) out vec4 out_color;

#include "wall.glsl"

const float PI = 3.14159265;
const int STEPS = 14;

vec3 sky_on(vec3 n)
{
    vec3 sum = frame.irradiance[0].rgb + frame.irradiance[1].rgb * n.y + frame.irradiance[2].rgb * n.z +
               frame.irradiance[3].rgb * n.x + frame.irradiance[4].rgb * (n.x * n.y) +
               frame.irradiance[5].rgb * (n.y * n.z) + frame.irradiance[6].rgb * (3.0 * n.z * n.z - 1.0) +
               frame.irradiance[7].rgb * (n.x * n.z) + frame.irradiance[8].rgb * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0));
}

// What lies in a direction where the picture does not say: the panorama, and houses low above the horizon.
vec3 far_light(vec3 d, float roughness)
{
    float levels = float(textureSize(reflection, 0).z);
    vec3 at = vec3(atan(d.x, -d.z) / (2.0 * PI) + 0.5, acos(clamp(d.y, -1.0, 1.0)) / PI,
                   (roughness * (levels - 1.0) + 0.5) / levels);
    return textureLod(reflection, at, 0.0).rgb * mix(0.18, 1.0, smoothstep(0.05, 0.75, d.y));
}

// What a mirror shows: the ray is followed through the last frame's picture until it goes behind something there.
vec3 mirrored(vec3 from, vec3 d, float roughness)
{
    vec3 away = far_light(d, roughness);
    float before = 0.0, after = 0.0, way = 0.15;
    vec4 seen = vec4(0.0);
    bool hit = false;
    for (int i = 0; i < STEPS && !hit; i++, way *= 1.55) {
        vec3 point = from + d * way;
        vec4 clip = frame.last_from_relative * vec4(point, 1.0);
        vec2 at = clip.xy / clip.w * 0.5 + 0.5;
        if (clip.w <= 0.05 || any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0))))
            break;
        float gone = length(point + frame.moved.xyz), there = 1.0 / max(textureLod(last_picture, at, 0.0).a, 1e-4);
        hit = gone > there && gone - there < 0.5 + 0.5 * way;
        before = hit ? before : way;
        after = way;
    }
    if (!hit)
        return away;
    float edge = 1.0;
    for (int i = 0; i < 5; i++) { // nearer by halves
        float middle = 0.5 * (before + after);
        vec3 point = from + d * middle;
        vec4 clip = frame.last_from_relative * vec4(point, 1.0);
        vec2 at = clip.xy / clip.w * 0.5 + 0.5;
        vec4 texel = textureLod(last_picture, at, 0.0);
        bool behind = length(point + frame.moved.xyz) > 1.0 / max(texel.a, 1e-4);
        after = behind ? middle : after;
        before = behind ? before : middle;
        seen = texel;
        vec2 inside = min(at, 1.0 - at);
        edge = smoothstep(0.0, 0.08, min(inside.x, inside.y));
    }
    return mix(away, seen.rgb, edge);
}

// How much of the sky a car leaves to the ground under it and beside it.
float beside_car(vec3 point, float up)
{
    vec3 at = vec3(dot(frame.shade[0], vec4(point, 1.0)), dot(frame.shade[1], vec4(point, 1.0)),
                   dot(frame.shade[2], vec4(point, 1.0)));
    vec2 off = max(abs(at.xz) - vec2(0.55, 0.8), 0.0) * vec2(0.9, 2.1); // in metres or so
    float under = 1.0 - smoothstep(0.0, 0.9, length(off));
    return 1.0 - 0.88 * under * under * smoothstep(0.5, 0.8, up) * (1.0 - smoothstep(0.05, 0.16, abs(at.y)));
}

// Water in the window around the camera; beyond, where rain alone has said how wet it is; and on to the horizon.
virga_ground_wetness water_at(vec2 at, float pixel)
{
    float height_m = in_relative.y - frame.ground_low.y, reach = frame.ground_wrap.w;
    virga_ground_wetness near =
        virga_ground_at(wet_map, spot_map, ivec2(frame.ground_wrap.xy), max(int(frame.ground_wrap.z), 1), at, height_m,
                        pixel, 1.0 / max(frame.ground_low.w, 1e-6));
    float share = virga_ground_near_share(in_relative.xz * frame.ground_low.w, reach);
    if (share >= 1.0)
        return near;
    int cells = int(frame.ground_far.w);
    virga_ground_wetness open = virga_ground_wetness(0.0, 0.0, 0.0, 0.0);
    if (surface.traits.w > 0.0)
        open = virga_ground_open(far_map, cells, uint(surface.traits.w) - 1u);
    vec2 far_at = (in_relative.xz - frame.ground_far.xz) * frame.ground_far.y;
    return virga_ground_mix(virga_ground_far_at(far_map, cells, far_at, height_m, open,
                                                1.0 / max(frame.ground_far.y, 1e-6)),
                            near, share);
}

// Lamps: Lambert, and GGX with the visibility of Hammon 2017.
vec3 lamps(vec3 albedo, vec3 f0, float roughness, vec3 n, vec3 v)
{
    vec3 sum = vec3(0.0);
    float n_v = clamp(abs(dot(n, v)), 1e-3, 1.0), a = max(roughness * roughness, 0.004), a2 = a * a;
    for (int i = 0; i < int(frame.moved.w); i++) {
        drive_light_gpu light = frame.lights[i];
        vec3 to = light.position.xyz - in_relative;
        float distance2 = max(dot(to, to), 0.01);
        vec3 l = to * inversesqrt(distance2), h = normalize(l + v);
        float part = distance2 * light.position.w * light.position.w, window = max(1.0 - part * part, 0.0);
        float cone = clamp(-dot(l, light.direction.xyz) * light.cone.x + light.cone.y, 0.0, 1.0);
        float n_l = dot(n, l), n_h = clamp(dot(n, h), 0.0, 1.0), c = 1.0 - clamp(dot(v, h), 0.0, 1.0);
        float reach = window * window * cone * cone * n_l / distance2;
        if (reach <= 0.0)
            continue;
        float d = (n_h * a2 - n_h) * n_h + 1.0;
        vec3 fresnel = f0 + (1.0 - f0) * (c * c * c * c * c);
        vec3 shine = fresnel * (a2 / (PI * d * d) * 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, a));
        sum += light.intensity.rgb * (albedo / PI + shine) * reach;
    }
    return sum;
}

// What a rough environment mirror gives back: the fit of Karis 2014 to the split sum.
vec3 share_mirrored(vec3 f0, float roughness, float n_v)
{
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    return f0 * (-1.04 * a + r.z) + (1.04 * a + r.w);
}

void main()
{
    vec4 base = surface.base_color * texture(base_texture, in_uv);
    if (base.a < surface.traits.y)
        discard;
    vec3 v = normalize(-in_relative), flat_normal = cross(dFdx(in_relative), dFdy(in_relative));
    vec3 n = normalize(in_normal);
    n = dot(n, flat_normal) * dot(v, flat_normal) < 0.0 ? -n : n; // to the side that is seen
    float roughness = surface.emissive.w, metallic = surface.traits.x, sky = surface.traits.z;
    vec3 f0 = mix(vec3(0.04), base.rgb, metallic), albedo = base.rgb * (1.0 - metallic);

    // The water here. Pores darken what is rough (Lagarde 2013), a film shines, a puddle is a mirror of its own.
    vec2 at = (in_relative.xz - frame.ground_low.xz) * frame.ground_low.w;
    float pixel = max(length(dFdx(at)), length(dFdy(at)));
    virga_ground_wetness water = water_at(at, pixel);
    float level = smoothstep(0.3, 0.6, n.y);
    float damp = level * max(0.85 * water.spot, smoothstep(0.15, 0.8, water.wet));
    float film = level * smoothstep(0.01, 0.25, water.depth_mm);
    float puddle = level * smoothstep(0.5, 1.6, water.depth_mm);
    albedo *= mix(1.0, mix(1.0, 0.2, clamp((roughness - 0.5) / 0.4, 0.0, 1.0)), damp);
    roughness = mix(roughness, max(0.3 * roughness, 0.12), max(film, 0.35 * damp));
    if (sky > 0.5) // not in a cabin
        wet_wall(wall_water(n), metallic, albedo, roughness);

    sky *= beside_car(in_relative, n.y);
    float open = sky * mix(0.55, 1.0, 0.5 + 0.5 * n.y), n_v = clamp(abs(dot(n, v)), 1e-3, 1.0);
    // Light in a cabin comes from around more than from above.
    vec3 lit_from = surface.traits.z < 0.6 ? normalize(vec3(n.x, 0.35 + 0.35 * n.y, n.z)) : n;
    vec3 color = albedo * sky_on(lit_from) * open + surface.emissive.rgb * texture(emissive_texture, in_uv).rgb;
    color += lamps(albedo, f0, roughness, n, v) * min(2.0 * sky, 1.0);
    vec3 r = reflect(-v, n);
    bool mirror = film > 0.02 && sky > 0.5; // worth to be looked up
    vec3 around = mirror ? mirrored(in_relative, r, roughness) : far_light(r, roughness);
    color += share_mirrored(f0, roughness, n_v) * around * sky * (1.0 - puddle);
    if (puddle > 0.0) {
        vec2 point = (in_relative.xz - frame.ripples.xy) * frame.ripples.z;
        vec2 inside = min(point, 1.0 - point);
        float drawn = smoothstep(0.0, 0.12, min(inside.x, inside.y)) *
                      (1.0 - smoothstep(0.006, 0.03, pixel / max(frame.ground_low.w, 1e-6)));
        vec2 slope = textureLod(ripple_map, point, 0.0).xy * drawn;
        vec3 up = normalize(vec3(-slope.x, 1.0, -slope.y));
        float rough = clamp(sqrt(sqrt(2.0 * water.slope2 * (1.0 - 0.8 * drawn))), 0.03, 0.5);
        float c = 1.0 - clamp(dot(up, v), 0.0, 1.0), fresnel = 0.0204 + 0.9796 * c * c * c * c * c;
        vec3 d = reflect(-v, up);
        d.y = abs(d.y);
        vec3 surface_light = fresnel * sky * mirrored(in_relative, d, rough);
        surface_light += lamps(vec3(0.0), vec3(0.0204), max(rough, 0.1), up, v);
        color = mix(color, color * (1.0 - fresnel) + surface_light, puddle);
    }
    out_color = vec4(min(color, vec3(6e4)), 1.0 / max(length(in_relative), 0.05));
}
