// physical.frag - drops by Snell and Fresnel: the world through them, on its head, and what they reflect.
// Premultiplied.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "sky.glsl"
#include "gpu/light.glsl"
#include "surface.glsl"
#include "plate.glsl"
#include "path.glsl"
#include "temporal.glsl"

layout(location = 0) out vec4 radiance;

#define THROWN 0.3 // share of the light beside it that a ray shows which is thrown back at all
#define FILM_TURN 0.15 // rad: how much a film on what is not glass turns from place to place
#define LENS vec2(30.0, 100.0) // 1/m: water less curved than the one is no lens, more than the other is: a drop is
#define UNDER  0.5   // of the light under a drop, at the middle: what its focus takes away
#define BESIDE 0.7   // of that beside it, at the rim
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

// Where the light on what is not glass comes from along it, of the sky's mean direction and of lamps by their shares;
// 0: straight from above, 1: along the surface.
vec3 light_way(vec3 flat_normal)
{
    const vec3 to_sky = vec3(dot(sh_coefficient(3u), vec3(1.0)), dot(sh_coefficient(1u), vec3(1.0)),
                             dot(sh_coefficient(2u), vec3(1.0)));
    const float mean = dot(sh_coefficient(0u), vec3(1.0)), turned = length(to_sky); // 1 : 1 / sqrt(3) is from one side
    float sum = max(0.886227 * mean + 1.023327 * dot(to_sky, flat_normal), 0.0);
    vec3 way = to_sky * (sum / max(turned, 1e-6) * min(1.732051 * turned / max(mean, 1e-6), 1.0));
    for (uint i = 0u; HAS_LAMPS && i < view.light_count; i++) {
        const vec3 to_lamp = to_vec(view.lights[i].position) - position;
        const float distance2 = max(dot(to_lamp, to_lamp), 1e-4), above = dot(to_lamp, flat_normal);
        const float share = dot(to_vec(view.lights[i].intensity), vec3(1.0)) * max(above, 0.0) / distance2;
        sum += share * inversesqrt(distance2);
        way += to_lamp * (share / distance2);
    }
    way /= max(sum, 1e-6);
    return way - flat_normal * dot(way, flat_normal);
}

// A drop is a lens to what it lies on: light is gathered at its far side and missing at the near one. All over the base
// of a cap, whose normal leans the more the farther out, both are the same: means of x^4 over half a disc, and of 1 - x
// over all of it, are 1/16 and 1.
float focus_under(vec3 normal, vec3 flat_normal, vec3 way)
{
    const vec3 leans = normal - flat_normal * dot(normal, flat_normal);
    const float steep = min(look.cap_height, 1.0), at_rim = 2.0 * steep / (1.0 + steep * steep), strength = length(way);
    const float x = clamp(-dot(leans, way) / max(strength * at_rim, 1e-4), -1.0, 1.0), far_side = max(x, 0.0);
    return 1.0 + strength * (16.0 * UNDER * far_side * far_side * far_side * far_side - UNDER * (1.0 - x));
}

// The same beside it, less and less up to some 0.4 radii from its rim: a shadow towards the light, and what the focus
// has beyond the rim on the other side. Around it both are the same: means of cos^4 and cos over half a turn, each as
// part of a whole one, are 3/16 and 1/pi.
float focus_beside(vec2 slope, float density, vec3 way)
{
    const float steep = length(slope), near = smoothstep(0.4, 1.0, density / shown_by.x) * smoothstep(0.05, 0.3, steep);
    const float x = dot(slope.x * along_u + slope.y * along_v, way) / max(steep * length(way), 1e-4);
    const float far_side = max(x, 0.0);
    return 1.0 + BESIDE * near * length(way) *
                     (1.697653 * far_side * far_side * far_side * far_side + min(x, 0.0));
}

vec3 shown(Path path, vec3 d, Water water)
{
    const vec3 flat_normal = cross(along_u, along_v);
    const bool opaque = SIDE == VIRGA_GLASS_DRAW_OPAQUE;
    // On what is not glass a film follows the bumps beneath, which the map does not have: it mirrors a lamp as widely,
    // or its trails would be white wires. Drops and beads are round, whatever they lie on.
    const float film = opaque ? 1.0 - smoothstep(1.5e-5, 6e-5, water.height) : 0.0;
    const float width = max(0.5 * path.pixels * gain_angle.y, max(FILM_TURN * film, 0.02));
    const bool outside = opaque || SIDE == VIRGA_GLASS_DRAW_BEFORE ||
                         (SIDE != VIRGA_GLASS_DRAW_BEHIND && dot(d, flat_normal) < 0.0);
    vec3 through = seen(path.ahead, path.pixel, path.out_of, path.pixels) * mix(1.0, THROWN, path.lost);
    if (opaque)
        through *= mix(focus_under(path.normal, flat_normal, light_way(flat_normal)), 1.0, film);
    else if (HAS_LAMPS) // a sheet shows the lamp where and as the picture has it, and would glow all around it
        through += lamps_along(path.out_of, width) * ((1.0 - path.lost) * smoothstep(LENS.x, LENS.y, water.bend));
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
    // What is not glass is seen beside drops too, in their shadow and their focus.
    const bool opaque = SIDE == VIRGA_GLASS_DRAW_OPAQUE;
    const bool beside = opaque && water.cover + water.mist < 1.0 && water.density > 0.4 * shown_by.x;
    if ((water.cover + water.mist <= 0.0 && !beside) || behind_scene())
        discard;
    if (opaque && dot(d, cross(along_u, along_v)) > 0.0)
        discard; // the back of what is not glass
#ifdef TEMPORAL
    write_temporal(moves_inside(path, water) ? motion_in_water(change, scene_before(path.pixel), shown_before(path, d))
                                             : vec2(0.0), water.cover + water.mist);
#else
    const Path path = path_through(d, water, pixel_m, SIDE == VIRGA_GLASS_DRAW_OPAQUE);
#endif
    const vec3 light = shown(path, d, water);
    radiance = vec4(water.cover * light + water.mist * mist_light, water.cover + water.mist);
    if (opaque) {
        const float focus = focus_beside(water.slope, water.density, light_way(cross(along_u, along_v)));
        const vec3 more = tint_given.w == 0.0 ? vec3(0.0) : plate_at(gl_FragCoord.xy, 1.0) * max(focus - 1.0, 0.0);
        radiance += (1.0 - radiance.a) * vec4(more, max(1.0 - focus, 0.0));
    }
}
