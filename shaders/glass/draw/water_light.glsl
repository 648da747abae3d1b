// water_light.glsl - the light of a drop by Snell and Fresnel: what is seen through it, and what it reflects. Include
// it after path.glsl.
#define TOTAL_SHARE 0.3        // part of the light that a totally reflected ray shows
#define FILM_TURN 0.15         // rad: how much the normal of film on a surface that is not glass varies
#define LENS vec2(30.0, 100.0) // 1/m: water that is less curved than x is no lens; from y on, as in a drop, it is one
#define UNDER 0.5              // how much light the focus takes away at the middle under a drop
#define COAT 1.5               // index of what covers a surface that is not glass
#define LEAST_COLOR 0.4        // part of the light of a dry surface that is its color, at least
#define INSIDE_SHARE 0.25 // part of the environment's light in the room behind the pane, for rays reflected into it

// Lamps in a direction: each a small disc, as wide as what a pixel of the drop shows of the world.
vec3 lamps_along(vec3 direction, float width)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < view.light_count; i++) {
        const vec3 to_light = to_vec(view.lights[i].position) - position;
        const float distance2 = max(dot(to_light, to_light), 1e-4);
        const vec3 towards = to_light * inversesqrt(distance2);
        const float x = distance2 * view.lights[i].inv_range * view.lights[i].inv_range;
        const float ends = clamp(1.0 - x * x, 0.0, 1.0);
        const float cone = clamp((dot(-towards, to_vec(view.lights[i].direction)) - view.lights[i].cos_outer) *
                                     view.lights[i].inv_cos_width,
                                 0.0, 1.0);
        const vec3 apart = towards - direction;
        const float spot = exp(-0.5 * dot(apart, apart) / (width * width)) / (6.2831853 * width * width);
        sum += to_vec(view.lights[i].intensity) * (ends * ends * cone * cone / distance2 * spot);
    }
    return sum;
}

// The direction along the surface that light on a surface that is not glass comes from: the mean of the sky and the
// lamps, weighted by their light. Length 0: straight from above, 1: along the surface.
vec3 light_direction(vec3 flat_normal)
{
    const vec3 to_sky = vec3(dot(sh_coefficient(3u), vec3(1.0)), dot(sh_coefficient(1u), vec3(1.0)),
                             dot(sh_coefficient(2u), vec3(1.0)));
    // a ratio of 1 : 1 / sqrt(3) means light from one side
    const float mean = dot(sh_coefficient(0u), vec3(1.0)), turned = length(to_sky);
    float sum = max(0.886227 * mean + 1.023327 * dot(to_sky, flat_normal), 0.0);
    vec3 light_along = to_sky * (sum / max(turned, 1e-6) * min(1.732051 * turned / max(mean, 1e-6), 1.0));
    for (uint i = 0u; HAS_LAMPS && i < view.light_count; i++) {
        const vec3 to_lamp = to_vec(view.lights[i].position) - position;
        const float distance2 = max(dot(to_lamp, to_lamp), 1e-4), above = dot(to_lamp, flat_normal);
        const float share = dot(to_vec(view.lights[i].intensity), vec3(1.0)) * max(above, 0.0) / distance2;
        sum += share * inversesqrt(distance2);
        light_along += to_lamp * (share / distance2);
    }
    light_along /= max(sum, 1e-6);
    return light_along - flat_normal * dot(light_along, flat_normal);
}

// A drop is a lens for the surface under it: light is gathered on its far side and missing on the near one. Over the
// base of a cap, whose normal leans more the farther out, gain and loss are equal: the means of x^4 over half a disc
// and of 1 - x over all of it are 1/16 and 1.
float focus_under(vec3 normal, vec3 flat_normal, vec3 light_along)
{
    const vec3 leans = normal - flat_normal * dot(normal, flat_normal);
    const float steep = min(look.cap_height, 1.0), at_rim = 2.0 * steep / (1.0 + steep * steep),
                strength = length(light_along);
    const float x = clamp(-dot(leans, light_along) / max(strength * at_rim, 1e-4), -1.0, 1.0), far_side = max(x, 0.0);
    return 1.0 + strength * (16.0 * UNDER * far_side * far_side * far_side * far_side - UNDER * (1.0 - x));
}

// On a surface that is not glass: what it reflects when dry and not when wet, per light of the surroundings.
// Paint, wax and most coats have an index near 1.5: under air they reflect 4 % at right angles, under water 0.35 %. So
// colors under water are deeper.
float dry_gloss(float cos_air)
{
    const float cos_coat = sqrt(1.0 - (1.0 - cos_air * cos_air) / (COAT * COAT));
    const float cos_water = sqrt(1.0 - (1.0 - cos_air * cos_air) / (WATER * WATER));
    return fresnel(cos_air, cos_coat, 1.0, COAT) - fresnel(cos_water, cos_coat, WATER, COAT);
}

// The surface under water, without that reflection. The picture does not tell how much of its light is that: `around`
// is what its surroundings would give to an even coat in the open, and at least LEAST_COLOR of the light is kept.
vec3 without_gloss(vec3 seen, vec3 d, vec3 flat_normal)
{
    const vec3 around = environment(reflect(d, flat_normal), vec2(1.0));
    return max(seen - dry_gloss(clamp(-dot(d, flat_normal), 0.05, 1.0)) * around, LEAST_COLOR * seen);
}

// The share of the light along a reflected ray that comes from the surroundings: a steep drop sends rays down to the
// surface that it sits on. Lobes of the surroundings are wide, so the change is gradual.
float above_surface(vec3 mirrored, vec3 flat_normal) { return smoothstep(-0.15, 0.15, dot(mirrored, flat_normal)); }

// What a ray shows that is reflected down to the surface from this height.
vec3 surface_beside(vec3 mirrored, vec3 flat_normal, float height)
{
    const float down = max(-dot(mirrored, flat_normal), 0.1);
    vec2 pixel;
    const bool ahead = on_picture(vec4(position + mirrored * (height / down), 1.0), pixel);
    return scene_light(ahead, pixel, mirrored, 1.0);
}

vec3 water_light(Path path, vec3 d, Water water)
{
    const vec3 flat_normal = cross(along_u, along_v);
    const bool opaque = SIDE == VIRGA_GLASS_DRAW_OPAQUE;
    // On a surface that is not glass, film follows the bumps below it, which the map does not contain, so it reflects a
    // lamp as a wide highlight; otherwise its trails would look like white wires. Drops and beads are round on any
    // surface.
    const float film = opaque ? 1.0 - smoothstep(1.5e-5, 6e-5, water.height) : 0.0;
    const float width = max(0.5 * path.pixels * gain_angle.y, max(FILM_TURN * film, 0.02));
    const bool outside =
        opaque || SIDE == VIRGA_GLASS_DRAW_BEFORE || (SIDE != VIRGA_GLASS_DRAW_BEHIND && dot(d, flat_normal) < 0.0);
    vec3 through = scene_light(path.ahead, path.pixel, path.out_of, path.pixels) * mix(1.0, TOTAL_SHARE, path.lost);
    if (opaque)
        through = without_gloss(through, d, flat_normal) *
                  mix(focus_under(path.normal, flat_normal, light_direction(flat_normal)), 1.0, film);
    else if (HAS_LAMPS) // a flat sheet shows the lamp as the picture does, and would glow all around it
        through += lamps_along(path.out_of, width) * ((1.0 - path.lost) * smoothstep(LENS.x, LENS.y, water.bend));
    // The room is dim and its reflection faint, so the finer part of its light is left out.
    vec3 mirrored = environment(path.mirrored, outside ? vec2(1.0) : vec2(1.0, 0.0)) * (outside ? 1.0 : INSIDE_SHARE);
    if (HAS_LAMPS && outside)
        mirrored += lamps_along(path.mirrored, width);
    if (opaque)
        mirrored = mix(surface_beside(path.mirrored, flat_normal, water.height), mirrored,
                       above_surface(path.mirrored, flat_normal));
    return mix(through * tint_given.rgb, mirrored * gain_angle.x, path.reflects);
}
