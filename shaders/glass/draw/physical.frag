// physical.frag - drops by Snell and Fresnel: the world through them, upside down, and what they reflect.
// Premultiplied.
// One invocation per pixel of a tile with water. Reads: the relief map, the plate, the scene's depth. Writes: radiance,
// motion, reactive.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "sky.glsl"
#include "gpu/light.glsl"
#include "surface.glsl"
#include "plate.glsl"
#include "path.glsl"
#include "water_light.glsl"
#include "temporal.glsl"
#include "gpu/encode.glsl"

layout(location = 0) out vec4 radiance;

#define BESIDE 0.7 // as UNDER in water_light.glsl, beside the drop at its rim

// As focus_under beside the drop, fading out some 0.4 radii from its rim: a shadow towards the light, and the part of
// the focus beyond the rim on the other side. Over the circle gain and loss are equal: the means of cos^4 and cos over
// half a turn, relative to a whole turn, are 3/16 and 1/pi.
float focus_beside(vec2 slope, float density, vec3 light_along)
{
    const float steep = length(slope),
                near = smoothstep(0.4, 1.0, density / threshold_shift.x) * smoothstep(0.05, 0.3, steep);
    const float x = dot(slope.x * along_u + slope.y * along_v, light_along) / max(steep * length(light_along), 1e-4);
    const float far_side = max(x, 0.0);
    return 1.0 +
           BESIDE * near * length(light_along) * (1.697653 * far_side * far_side * far_side * far_side + min(x, 0.0));
}

void main()
{
    const Water water = water_here();
    const float pixel_m = max(length(dFdx(pane_position)), length(dFdy(pane_position)));
    const vec3 d = normalize(position);
#ifdef TEMPORAL
    const Path path = path_through(d, water, pixel_m, SIDE == VIRGA_GLASS_DRAW_OPAQUE);
    // before the discard: derivatives need all pixels of a quad
    const mat2 change = mat2(dFdx(path.pixel), dFdy(path.pixel));
#endif
    // A surface that is not glass also shows the shadow and the focus beside drops.
    const bool opaque = SIDE == VIRGA_GLASS_DRAW_OPAQUE;
    const bool in_shadow = opaque && water.cover + water.mist < 1.0 && water.density > 0.4 * threshold_shift.x;
    if ((water.cover + water.mist <= 0.0 && !in_shadow) || is_behind_scene())
        discard;
    if (opaque && dot(d, cross(along_u, along_v)) > 0.0)
        discard; // the back of a surface that is not glass
#ifdef TEMPORAL
    write_temporal(shows_scene(path, water) ? motion_in_water(change, scene_before(path.pixel), shown_before(path, d))
                                            : vec2(0.0),
                   water.cover + water.mist);
#else
    const Path path = path_through(d, water, pixel_m, SIDE == VIRGA_GLASS_DRAW_OPAQUE);
#endif
    const vec3 light = water_light(path, d, water);
    vec4 shown = vec4(water.cover * light + water.mist * mist_light, water.cover + water.mist);
    if (opaque) {
        const float focus = focus_beside(water.slope, water.density, light_direction(cross(along_u, along_v)));
        const vec3 more = tint_given.w == 0.0 ? vec3(0.0) : plate_at(gl_FragCoord.xy, 1.0) * max(focus - 1.0, 0.0);
        shown += (1.0 - shown.a) * vec4(more, max(1.0 - focus, 0.0));
    }
    radiance = for_target(shown);
}
