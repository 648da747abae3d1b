// picture_physical.frag - drops by Snell and Fresnel: the world through them, on its head, and what they reflect.
// Premultiplied.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "picture.glsl"
#include "picture_sky.glsl"
#include "gpu/light.glsl"
#include "picture_surface.glsl"
#include "picture_plate.glsl"
#include "picture_path.glsl"
#include "picture_temporal.glsl"

layout(location = 0) out vec4 radiance;

#define THROWN 0.3 // share of the light beside it that a ray shows which is thrown back at all
#define FILM_TURN 0.15 // rad: how much a film on what is not glass turns from place to place
#define BEHIND 0.25 // share of the environment that rays meet which are thrown back into the room that the pane closes

// Lamps that lie in a direction: a small disc each, as wide as a pixel of a drop shows of the world.
vec3 lamps_along(vec3 direction, float width)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < view.light_count; i++) {
        const vec3 way = to_vec(view.lights[i].position) - position;
        const float distance2 = max(dot(way, way), 1e-4);
        const vec3 towards = way * inversesqrt(distance2);
        const float x = distance2 * view.lights[i].inv_range * view.lights[i].inv_range;
        const float ends = clamp(1.0 - x * x, 0.0, 1.0);
        const float cone = clamp((dot(-towards, to_vec(view.lights[i].direction)) - view.lights[i].cos_outer) *
                                     view.lights[i].inv_cos_width, 0.0, 1.0);
        const vec3 apart = towards - direction;
        const float spot = exp(-0.5 * dot(apart, apart) / (width * width)) / (6.2831853 * width * width);
        sum += to_vec(view.lights[i].intensity) * (ends * ends * cone * cone / distance2 * spot);
    }
    return sum;
}

// Light gathered at a drop's far side: an opaque surface under it is brighter away from the lamp, and darker
// towards it.
vec3 caustic(vec3 normal, vec3 flat_normal)
{
    const vec3 tilt = normal - flat_normal * dot(normal, flat_normal);
    vec3 bright = vec3(1.0);
    const vec3 sky = vec3(dot(sh_coefficient(3u), vec3(1.0)), dot(sh_coefficient(1u), vec3(1.0)),
                          dot(sh_coefficient(2u), vec3(1.0)));
    const vec3 main_way = sky / max(length(sky), 1e-4);
    const float away = -dot(tilt, main_way - flat_normal * dot(main_way, flat_normal));
    bright *= 1.0 + 1.6 * max(away, 0.0) * max(away, 0.0) * 4.0 + 0.5 * min(away, 0.0);
    for (uint i = 0u; i < view.light_count; i++) {
        const vec3 way = normalize(to_vec(view.lights[i].position) - position);
        const float far_side = max(-dot(tilt, way - flat_normal * dot(way, flat_normal)), 0.0);
        bright += 4.0 * far_side * far_side;
    }
    return max(bright, vec3(0.2));
}

vec3 shown(Path path, vec3 d, float height)
{
    const vec3 flat_normal = cross(along_u, along_v);
    const bool opaque = SIDE == VIRGA_GLASS_DRAW_OPAQUE;
    // On what is not glass a film follows the bumps beneath, which the map does not have: it mirrors a lamp as widely,
    // or its trails would be white wires. Drops and beads are round, whatever they lie on.
    const float level = opaque ? FILM_TURN * (1.0 - smoothstep(1.5e-5, 6e-5, height)) : 0.0;
    const float width = max(0.5 * path.pixels * gain_angle.y, max(level, 0.02));
    const bool outside = opaque || SIDE == VIRGA_GLASS_DRAW_BEFORE ||
                         (SIDE != VIRGA_GLASS_DRAW_BEHIND && dot(d, flat_normal) < 0.0);
    vec3 through = seen(path.ahead, path.pixel, path.out_of, path.pixels) * mix(1.0, THROWN, path.lost);
    if (opaque)
        through *= caustic(path.normal, flat_normal);
    else if (HAS_LAMPS)
        through += lamps_along(path.out_of, width) * (1.0 - path.lost);
    // The room is dim and its reflection faint: without the finer part of its light.
    vec3 mirrored = environment(path.mirrored, outside ? vec2(1.0) : vec2(1.0, 0.0)) * (outside ? 1.0 : BEHIND);
    if (HAS_LAMPS && outside)
        mirrored += lamps_along(path.mirrored, width);
    return mix(through * tint_given.rgb, mirrored * gain_angle.x, path.reflects);
}

void main()
{
    const Water water = water_here();
    const float pixel_m = max(length(dFdx(place)), length(dFdy(place)));
    const vec3 d = normalize(position);
#ifdef TEMPORAL
    const Path path = path_through(d, water, pixel_m, SIDE == VIRGA_GLASS_DRAW_OPAQUE);
    const mat2 change = mat2(dFdx(path.pixel), dFdy(path.pixel)); // while all pixels of a quad are there
#endif
    if (water.cover + water.mist <= 0.0 || behind_scene())
        discard;
    if (SIDE == VIRGA_GLASS_DRAW_OPAQUE && dot(d, cross(along_u, along_v)) > 0.0)
        discard; // the back of what is not glass
#ifdef TEMPORAL
    write_temporal(moves_inside(path, water) ? motion_in_water(change, scene_before(path.pixel), shown_before(path, d))
                                             : vec2(0.0), water.cover + water.mist);
#else
    const Path path = path_through(d, water, pixel_m, SIDE == VIRGA_GLASS_DRAW_OPAQUE);
#endif
    const vec3 light = shown(path, d, water.height);
    radiance = vec4(water.cover * light + water.mist * mist_light, water.cover + water.mist);
}
