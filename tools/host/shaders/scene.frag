#version 460
// scene.frag - Lambert and GGX under the environment and up to 16 lights. With MIRROR it is seen from under the
// mirror's plane, and dry; with DRY it is what no water lies on, and as it would be without. With FOOT, or
// DRY_FOOT, water may climb it. With GROUND it is level ground, at which no rain is driven. With FOOTAGE it is what
// water changes of ground that is on a picture: its base texture is a mask over the picture. With CLOTH, which is dry
// in that sense, light of the other side comes through; its pores hold water, and none climbs it. With DATA it has no
// color. With SWEPT, which is dry, it moves while the shutter is open.
//
// Software Vulkan runs what stands under a condition for all pixels. So what is told from a triangle is left out by
// variants. But for cloth they come to the same bits.
#extension GL_GOOGLE_include_directive : require
#if defined(CLOTH) || defined(DRY_FOOT) || defined(SWEPT)
#define DRY
#endif
#if defined(FOOT) || defined(DRY_FOOT)
#define CLIMBS
#endif
#if defined(CLOTH) || defined(MIRROR)
#define THIN
#include "cloth.glsl"
#endif
#ifdef SWEPT
#include "swept.glsl"
#endif
#include "frame_gpu.h"

layout(set = 0, binding = 0, std140) uniform Frame { host_frame_gpu frame; };
layout(set = 0, binding = 2) uniform sampler3D reflection_texture;
layout(set = 0, binding = 3) uniform sampler3D skylight_texture;
layout(set = 1, binding = 0) uniform sampler2D base_texture;
layout(set = 1, binding = 1) uniform sampler2D emissive_texture;
layout(push_constant) uniform Surface { host_surface_gpu surface; };

layout(location = 0) in vec3 in_relative;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec2 in_uv;

#if !defined(FOOTAGE) && !defined(DATA) && !defined(GROUND)
#define WALLS
#include "walls.glsl"
#endif
#ifdef MIRROR
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_near;
#else
#include "outputs.glsl"
#ifndef DRY
#define WET
#include "water.glsl"
#ifndef DATA
#include "mirror.glsl"
#endif
#endif
#endif

const float PI = 3.14159265;

vec3 diffuse_light(vec3 n)
{
    vec3 sum = frame.irradiance[0].rgb + frame.irradiance[1].rgb * n.y + frame.irradiance[2].rgb * n.z +
               frame.irradiance[3].rgb * n.x + frame.irradiance[4].rgb * (n.x * n.y) +
               frame.irradiance[5].rgb * (n.y * n.z) + frame.irradiance[6].rgb * (3.0 * n.z * n.z - 1.0) +
               frame.irradiance[7].rgb * (n.x * n.z) + frame.irradiance[8].rgb * (n.x * n.x - n.y * n.y);
    return max(sum, vec3(0.0));
}

vec3 reflected_light(vec3 d, float roughness)
{
    float u = atan(d.x, -d.z) / (2.0 * PI) + 0.5 + frame.environment.x;
    float v = acos(clamp(d.y, -1.0, 1.0)) / PI;
    float levels = float(textureSize(reflection_texture, 0).z);
    return textureLod(reflection_texture, vec3(u, v, (roughness * (levels - 1.0) + 0.5) / levels), 0.0).rgb;
}

// Moments of the sky's visibility: mean direction (1 up where all is open) and share.
vec4 sky_moments(vec3 n)
{
    vec3 point = in_relative + n * frame.skylight_low.w; // a voxel off the surface, clear of what lies behind it
    vec3 t = (point - frame.skylight_low.xyz) * frame.skylight_scale.xyz;
    vec4 moments = textureLod(skylight_texture, t, 0.0);
    float off = max(abs(in_relative.x), abs(in_relative.z)) - frame.skylight_fade.x;
    float above = (t.y - 1.0) * 8.0;
    float open = clamp(max(off * frame.skylight_scale.w, above), 0.0, 1.0);
    moments = mix(moments, vec4(0.0, 1.0, 0.0, 1.0), open);
    return vec4(moments.xyz, max(moments.w, 0.04)); // even deep inside some light arrives by bounces
}

// How much of the environment's light is left for a normal: the sky it sees; the ground, as lit as it is here; and
// what stands in the way, which gives back a quarter. 1 where all is open.
float sky_share(vec4 moments, vec3 n)
{
    float sky = clamp(0.5 * (moments.w + dot(moments.xyz, n)), 0.0, 1.0);
    float open = 0.5 + 0.5 * n.y;
    return sky + moments.w * ((1.0 - open) + 0.25 * max(open - sky, 0.0));
}

// What the specular lobe reflects of a white environment: analytic fit of Karis 2014 to the split sum.
vec3 environment_brdf(vec3 f0, float roughness, float n_v)
{
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a + r.zw;
    return f0 * ab.x + ab.y;
}

// GGX with the height-correlated visibility of Smith, as approximated by Hammon 2017; Schlick's Fresnel. `within2` is
// added to the square of its alpha.
vec3 specular_lobe(vec3 f0, float roughness, float within2, float n_l, float n_v, vec3 n, vec3 v, vec3 l)
{
    vec3 h = normalize(v + l);
    float n_h = clamp(dot(n, h), 0.0, 1.0), v_h = clamp(dot(v, h), 0.0, 1.0);
    float a = max(roughness * roughness, 0.002);
#ifdef MIRROR
    a = min(sqrt(a * a + within2), 1.0);
#endif
    float a2 = a * a;
    float d = (n_h * a2 - n_h) * n_h + 1.0;
    float distribution = a2 / (PI * d * d);
    float visibility = 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, a);
    float c = 1.0 - v_h, c2 = c * c;
    return (f0 + (1.0 - f0) * (c2 * c2 * c)) * (distribution * visibility);
}

#if defined(WET) || defined(CLIMBS)
layout(set = 0, binding = 11) uniform sampler2D contact_map;
#endif

// Irradiance of a lamp at right angles, `to` which that way leads.
vec3 lamp_light(int i, vec3 to)
{
    const float distance2 = max(dot(to, to), 1e-4);
    const vec3 l = to * inversesqrt(distance2);
    const float part = distance2 * frame.lights[i].position.w * frame.lights[i].position.w;
    const float window = max(1.0 - part * part, 0.0);
    const vec4 cone = frame.lights[i].cone;
    const float spot = clamp(-dot(l, frame.lights[i].direction.xyz) * cone.x + cone.y, 0.0, 1.0);
    return frame.lights[i].intensity.rgb * (window * window * spot * spot / distance2);
}

#ifdef CLIMBS
#include "climb.glsl"
#endif

#ifdef WET
// Distances towards a lamp at which something may stand in its light. What is farther casts no shadow. Of pictures that
// are averaged each looks a little nearer or farther.
const int CONTACT_LOOKS = 8;
const float CONTACT_M[CONTACT_LOOKS] = float[](0.03, 0.07, 0.13, 0.22, 0.36, 0.56, 0.84, 1.2);
const float CONTACT_SOFT_M = 0.02, CONTACT_SOFT = 0.12; // edges of shadows: of lamps of 12 cm a metre away

const float CONTACT_LEAST = 0.002; // light that is less is left as it is
const float CONTACT_OPEN = 0.93;   // where more of the sky is left, shadows of lamps are not looked for

float near_things = 0.0; // of this pixel: how far they keep lamps off it

// What is left of a lamp's light, in direction l, on ground; 1 where it is not `looked` for. Software Vulkan runs what
// stands under a condition for all pixels, but goes on in a loop only while one is in it: where nothing is looked for
// it begins with the last look.
float lamp_left(vec3 l, bool looked)
{
    const float flat_l = length(l.xz), rise = l.y / max(flat_l, 1e-4);
    const vec2 along = l.xz / max(flat_l, 1e-4), at = in_relative.xz - frame.contact.xz;
    const float side = float(textureSize(contact_map, 0).x) * frame.contact.w, apart = 1.0 + 0.35 * frame.screen.z;
    float left = 1.0, before = 0.0; // height of the ray at the look before: it is between both
    int i = looked ? 0 : CONTACT_LOOKS - 1;
    do {
        const float away = CONTACT_M[i] * apart, high = away * rise, soft = CONTACT_SOFT_M + CONTACT_SOFT * away;
        const vec2 things = texelFetch(contact_map, ivec2((at + along * away) * side), 0).zw;
        const vec2 inside = clamp(vec2(high - things.x, things.y - before) / soft + 0.5, 0.0, 1.0);
        left = min(left, 1.0 - inside.x * inside.y * (1.0 - smoothstep(0.8, 1.5, away)));
        before = high;
    } while (++i < CONTACT_LOOKS);
    return looked ? left : 1.0;
}
#endif

// What light of lamps meets: a surface, and the water over it.
struct Lobe {
    vec3 n;
    float n_v;
    vec3 f0;
    float roughness;
};

// What a surface, without its albedo, reflects of light from l on it.
vec3 lobe_of(Lobe lobe, float within2, float n_l, vec3 v, vec3 l)
{
    return specular_lobe(lobe.f0, lobe.roughness, within2, n_l, lobe.n_v, lobe.n, v, l);
}

// How much the half vector turns against the normal within a texel of the mirror's picture, as what it adds to alpha^2.
// A lamp in a pane is narrower than the texels: of the pictures that are averaged one would hit it with all its light,
// and water makes a pillar of that, which flashes. With the texel as a normal distribution whose deviation is half of
// its side (as in water.glsl) the slope's variance is a quarter of the squares that it differs by from texel to texel,
// right and down, and alpha^2 is twice the variance. Both are taken for one axis, so a highlight gets wider rather than
// narrower. Sampled at each texel, a normal distribution adds up to the same within 2 exp(-2 pi^2 / 4) = 1.4 %,
// wherever the texels lie; the lobe has longer tails.
float within_texel(vec3 n, vec3 v, vec3 l)
{
#ifdef MIRROR
    const vec3 turned = normalize(v + l) - n, right = dFdx(turned), down = dFdy(turned);
    return 0.5 * (dot(right, right) + dot(down, down));
#else
    return 0.0;
#endif
}

// Light of lamps that comes back from a surface, or through it, and from the water over it, whose shadows are the same.
// The loop ends at its end: software Vulkan runs a body once more for a condition at its beginning.
vec3 lit(vec3 albedo, vec3 through, Lobe ground, Lobe water, vec3 v, out vec3 on_water)
{
    vec3 sum = vec3(0.0);
    int lamps = int(surface.lamps.x);
    on_water = vec3(0.0);
    if (lamps == 0)
        return sum;
    do {
        const int i = findLSB(lamps);
        lamps &= lamps - 1;
        const vec3 to = frame.lights[i].position.xyz - in_relative;
        const vec3 l = to * inversesqrt(max(dot(to, to), 1e-4));
        const float n_l = max(dot(ground.n, l), 0.0), within2 = within_texel(ground.n, v, l);
        vec3 light = lamp_light(i, to);
#ifdef WET
        const float water_l = max(dot(water.n, l), 0.0), most = max(max(light.r, light.g), light.b);
        const bool looked = near_things > 0.0 && max(n_l, water_l) * most > CONTACT_LEAST;
        light *= mix(1.0, lamp_left(l, looked), near_things);
        if (water_l > 0.0)
            on_water += light * lobe_of(water, 0.0, water_l, v, l) * water_l;
#endif
        if (n_l > 0.0)
            sum += light * (albedo / PI + lobe_of(ground, within2, n_l, v, l)) * n_l;
#ifdef THIN
        sum += light * through * (max(-dot(ground.n, l), 0.0) / PI);
#endif
    } while (lamps != 0);
    return sum;
}

#if defined(WET) && !defined(DATA)
// What near things leave of what is seen of the sky.
float contact_shade(vec3 n)
{
    const vec2 at = (in_relative.xz - frame.contact.xz) * frame.contact.w, inside = min(at, 1.0 - at);
    const float known = smoothstep(0.0, 0.05, min(inside.x, inside.y)) * smoothstep(HOST_LEVEL_Y, 0.6, n.y);
    if (frame.contact.w <= 0.0 || known <= 0.0)
        return 1.0;
    const vec2 found = textureLod(contact_map, at, 0.0).xy;
    const float same = abs(in_relative.y - frame.contact.y - found.y) < 0.3 ? known : 0.0;
    near_things = same * (1.0 - smoothstep(CONTACT_OPEN - 0.1, CONTACT_OPEN, found.x));
    return mix(1.0, found.x, same);
}

Lobe lobe_of_water(Water water, vec3 v)
{
    return Lobe(water.normal, clamp(dot(water.normal, v), 1e-3, 1.0), vec3(0.0204), max(water.roughness, 0.08));
}

// A level mirror of water over a colour: of the scene where that is known, else of the sky that is left. `lamps`: light
// of lamps that it mirrors.
vec3 under_water(vec3 color, vec3 v, vec4 moments, Water water, vec3 lamps)
{
    const vec3 up = water.normal;
    vec3 r = reflect(-v, up);
    r.y = abs(r.y);
    float fresnel;
    vec4 scene = mirror_light(in_relative, v, up, water.roughness, moments.w, fresnel);
    vec3 sky = reflected_light(r, water.roughness) * sky_share(moments, r);
    vec3 mirror = scene.rgb + (fresnel - scene.a) * sky;
    return color * (1.0 - fresnel) + mirror + lamps;
}
#endif

// `eye`: where the mirror is seen from; `wetness` and depth of water (m).
void write(vec3 color, float alpha, vec3 n, vec3 eye, vec2 wetness)
{
#ifdef MIRROR
    out_color = vec4(min(color, vec3(6e4)), alpha);
    out_near = 1.0 / clamp(distance(eye, in_relative), 0.05, HOST_MIRROR_FAR); // glass keeps that of what is behind it
#else
#ifdef SWEPT
    out_color = vec4(color, 1.0) * swept_share(in_uv);
#else
    out_color = vec4(color, alpha);
#endif
    out_normal = vec4(n, 1.0);
    out_velocity = velocity_of(vec4(in_relative, 1.0), vec4(in_relative + frame.moved.xyz, 1.0));
    out_water = wetness;
    out_id = uint(surface.traits.z);
#endif
}

#ifdef FOOTAGE
// How the ground looks dry is on the picture. Water lets less of it through, and adds what it mirrors.
void main()
{
    const float road = texture(base_texture, gl_FragCoord.xy / frame.screen.xy).r;
    const vec3 v = normalize(-in_relative), n = normalize(in_normal);
    const Water water = water_at(in_relative, n, 1.0);
    const float dry = 0.2; // whatever is grey darkens alike
    vec3 albedo = vec3(dry), f0 = vec3(0.04);
    float roughness = surface.emissive.w;
    wet_material(water, 0.0, albedo, roughness, f0);
    const vec4 moments = sky_moments(n);
    const Lobe lobe = lobe_of_water(water, v);
    vec3 lamps;
    lit(vec3(0.0), vec3(0.0), lobe, lobe, v, lamps);
    const vec3 mirrored = under_water(vec3(0.0), v, moments, water, lamps);
    const vec3 seen = under_water(vec3(1.0), v, moments, water, lamps) - mirrored;
    const float through = albedo.g / dry * mix(1.0, seen.g, water.puddle);
    write(road * water.puddle * mirrored, road * (1.0 - through), n, vec3(0.0),
          vec2(max(water.damp, water.film), water.depth_mm * 1e-3));
    if (road < 0.5 / 255.0)
        discard;
}
#else
vec4 base_color(int bits)
{
    return surface.base_color * ((bits & HOST_HAS_BASE_TEXTURE) != 0 ? texture(base_texture, in_uv) : vec4(1.0));
}

vec3 emitted_light(int bits)
{
    return surface.emissive.rgb *
           ((bits & HOST_HAS_EMISSIVE_TEXTURE) != 0 ? texture(emissive_texture, in_uv).rgb : vec3(1.0));
}

// The triangle's own normal turns the smooth one to the side that is seen, whichever way a file winds it.
vec3 seen_normal(vec3 v)
{
#ifdef SWEPT
    return normalize(in_normal); // of the sides that are seen
#endif
    const vec3 flat_normal = cross(dFdx(in_relative), dFdy(in_relative)), n = normalize(in_normal);
    return dot(n, flat_normal) * dot(v, flat_normal) < 0.0 ? -n : n;
}

#ifdef DATA
void main()
{
    const vec3 n = seen_normal(normalize(-in_relative));
    const Water water = water_at(in_relative, n, 1.0);
    const bool cloth = surface.lamps.z > 0.0; // no water lies on it
    write(vec3(0.0), 1.0, n, vec3(0.0), cloth ? vec2(0.0) : vec2(max(water.damp, water.film), water.depth_mm * 1e-3));
}
#else
#ifdef WALLS
Wall wall_of(vec3 n, int bits)
{
#ifdef THIN
    const bool below = surface.lamps.z > 0.0 && n.y < 0.0; // rain soaks through to the lower side of cloth
    Wall wall = wall_at(in_relative, below ? -n : n, int(surface.lamps.y), bits >= HOST_GROUND);
    wall.film *= below ? 0.0 : 1.0;
    return wall;
#else
    return wall_at(in_relative, n, int(surface.lamps.y), bits >= HOST_GROUND);
#endif
}
#endif

#ifdef THIN
// What of the environment's light on the other side comes through; the shares of cloth, where it is one.
vec3 through_cloth(vec3 base, float damp, vec3 n, inout vec3 albedo, out vec3 through)
{
    through = vec3(0.0);
    if (surface.lamps.z <= 0.0)
        return vec3(0.0);
    const Cloth cloth = cloth_of(base, surface.lamps.z, damp);
    albedo = cloth.back;
    through = cloth.through;
    return through * diffuse_light(-n) * sky_share(sky_moments(-n), -n);
}
#endif

void main()
{
    int bits = int(surface.traits.w);
    vec4 base = base_color(bits);
    vec3 eye = vec3(0.0);
#ifdef MIRROR
    eye.y = 2.0 * frame.mirror.x;
#endif
    vec3 v = normalize(eye - in_relative), n = seen_normal(v);
    float roughness = surface.emissive.w, metallic = surface.traits.x;
    float n_v = clamp(abs(dot(n, v)), 1e-3, 1.0);
    vec3 f0 = mix(vec3(0.04), base.rgb, metallic);
    vec3 albedo = base.rgb * (1.0 - metallic);
#ifdef WET
    Water water = water_at(in_relative, n, (bits & HOST_HAS_JOINTS) != 0 ? base.a : 1.0);
    wet_material(water, metallic, albedo, roughness, f0);
    vec2 wetness = vec2(max(water.damp, water.film), water.depth_mm * 1e-3);
#else
    vec2 wetness = vec2(0.0);
#endif
#ifdef WALLS
    Wall wall = wall_of(n, bits);
    wet_wall(wall, metallic, albedo, roughness, f0);
#endif
    vec4 moments = sky_moments(n);
#ifdef WET
    moments *= bits >= HOST_GROUND ? contact_shade(n) : 1.0;
#endif
    vec3 r = reflect(-v, n);
    vec3 reflected = environment_brdf(f0, roughness, n_v) * reflected_light(r, roughness) * sky_share(moments, r);
#ifdef WET
    // Under water, whose index is near its own, hardly anything shines: the water does.
    reflected *= 1.0 - water.puddle;
    f0 *= 1.0 - water.puddle;
    roughness = mix(roughness, 1.0, water.puddle);
#endif
    vec3 through = vec3(0.0), behind = vec3(0.0);
#ifdef THIN
    behind = through_cloth(base.rgb, wall.damp, n, albedo, through);
#endif
    vec3 diffuse = albedo * diffuse_light(n) * sky_share(moments, n) + behind;
    const Lobe ground = Lobe(n, n_v, f0, roughness);
    vec3 on_water;
#ifdef WET
    const Lobe over = lobe_of_water(water, v);
#else
    const Lobe over = ground;
#endif
    vec3 color = diffuse + reflected + lit(albedo, through, ground, over, v, on_water) + emitted_light(bits);
#ifdef WET
    if (water.puddle > 0.0)
        color = mix(color, under_water(color, v, moments, water, on_water), water.puddle);
#endif
#ifdef CLIMBS
    color = under_climb(color, reflected, climb_at(in_relative, n, v), v, moments, int(surface.lamps.x));
#endif
    const float alpha = (bits & HOST_IS_GLASS) != 0 ? base.a : 1.0;
    color = color * alpha + reflected * (1.0 - alpha); // tint covers what is behind, reflections add to it
    write(color, alpha, n, eye, wetness);
}
#endif
#endif
