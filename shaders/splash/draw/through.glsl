// through.glsl - what is seen through water and reflected on it: the scene where the host gives its picture, else the
// environment.
#include "gpu/host_color.glsl"
#include "directions.glsl"
layout(set = 0, binding = 17) uniform sampler2D scene_color;

vec3 scene_at(vec2 pixel)
{
    return host_color(textureLod(scene_color, pixel / vec2(textureSize(scene_color, 0)), 0.0).rgb, view.color_given);
}

// A pixel as the host has stored it.
vec3 stored_at(vec2 pixel) { return texelFetch(scene_color, ivec2(pixel), 0).rgb; }

// The environment. The surroundings hide it below, at, and somewhat above the horizon: there the picture just behind
// the pixel stands for them.
vec3 around_of(vec3 direction)
{
    const vec3 open = environment(direction, vec2(1.0));
    if (view.color_given == 0u)
        return open;
    return mix(min(host_color(stored_at(gl_FragCoord.xy), view.color_given), open), open, open_share(direction));
}

// The light from a direction. The scene is taken as far away: it is looked up where the ray from the camera in that
// direction meets the picture, and fades into the environment towards the picture's edges.
vec3 seen(vec3 direction)
{
    const vec3 around = around_of(direction);
    if (view.color_given == 0u)
        return around;
    const vec3 place = place_of(direction);
    if (place.z <= 0.0)
        return around; // independent of the picture
    return mix(around, scene_at(place.xy), place.z);
}

float fresnel(float cosine)
{
    return 0.0204 + 0.9796 * pow(1.0 - clamp(cosine, 0.0, 1.0), 5.0);
}

// What a ball of water shows at `side`, the part of the surface's normal across the line of sight, with the length r =
// sin i. The ray is deflected by 2 (i - t) towards the other side, so the world appears upside down; the rim reflects.
vec3 through_ball(vec3 d, vec3 side)
{
    const float r = min(length(side), 0.999);
    const float bend = 2.0 * (asin(r) - asin(r / 1.333)), reflected = 3.14159265 - 2.0 * asin(r);
    const vec3 out_of = r > 1e-3 ? side / r : vec3(0.0);
    return mix(seen(d * cos(bend) - out_of * sin(bend)), around_of(d * cos(reflected) + out_of * sin(reflected)),
               fresnel(sqrt(1.0 - r * r)));
}
