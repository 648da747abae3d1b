// glow.frag - a lamp's glow along one ray, see glow.glsl.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "gpu/scene_depth.glsl"
#include "glow.glsl"

layout(location = 0) noperspective in vec3 ray; // these: see glow.vert
layout(location = 1) flat in vec4 lamp;
layout(location = 2) flat in vec4 strength;
layout(location = 3) flat in vec4 spot;
layout(location = 4) flat in vec4 look_at;
layout(location = 5) flat in vec4 depth_terms;
layout(location = 6) flat in float pixel_angle;
layout(location = 7) noperspective in float begins;
layout(location = 0) out vec4 radiance;

#define PI 3.14159265
#define LOOKS 6
#define PARTS 16          // of a cone, or of what a range ends, that light is taken from one by one
#define HIDDEN_FROM_M 0.3 // nearer by that than the lamp is what may hide it: its own lantern does not
#define HIDDEN_M 0.9

float stored_view_depth(float stored)
{
    return stored == depth_terms.z ? 1e6 : depth_terms.y / (depth_terms.x + stored);
}

// Share of the lamp that the camera sees. A lamp behind a wall lights none of the haze before the wall.
float shows()
{
    float seen = 0.0;
    for (int i = 0; i < LOOKS; i++) {
        const float turn = 2.0 * PI / float(LOOKS - 1) * float(i);
        const vec2 pixel = look_at.xy + (i > 0 ? look_at.z * vec2(cos(turn), sin(turn)) : vec2(0.0));
        const float nearer = look_at.w - stored_view_depth(buffer_depth(pixel));
        seen += 1.0 - smoothstep(HIDDEN_FROM_M, HIDDEN_M, nearer);
    }
    return seen / float(LOOKS);
}

// F over the angles from a to b as far as light goes out into them: the cone of a spot, the end of a range. What is
// bent by an angle x leaves the lamp along -d cos x + n sin x, n from the lamp to where the ray is nearest, so its
// cosine with the spot's axis is A cos(x - p); and it has gone h / sin x when it is bent. Parts grow: most light is
// bent by little.
float lit(Pass pass, vec3 direction, float from, float to)
{
    const float u = -dot(direction, spot.xyz), v = dot(pass.aside, spot.xyz) / pass.nearest;
    const float most = sqrt(u * u + v * v);
    float middle = atan(v, u + 1e-9);
    middle += middle < -0.5 * PI ? 2.0 * PI : 0.0;
    const float wide = spot.w >= 0.0 ? acos(min(spot.w / max(most, 1e-6), 1.0)) : 2.0 * PI;
    const float least = asin(min(pass.nearest * strength.w, 1.0));
    const float low = max(max(from, least), middle - wide), high = min(min(to, PI - least), middle + wide);
    float sum = 0.0, begin = low, before = bent_up_to(low);
    for (int i = 1; i <= PARTS; i++) {
        const float share = float(i) / float(PARTS), end = mix(low, high, share * sqrt(share)), after = bent_up_to(end);
        const float angle = 0.5 * (begin + end), x = pass.nearest * strength.w / max(sin(angle), 1e-6);
        const float cone = clamp((most * cos(angle - middle) - spot.w) * depth_terms.w, 0.0, 1.0);
        const float ends = clamp(1.0 - x * x * x * x, 0.0, 1.0);
        sum += (after - before) * cone * cone * ends * ends;
        begin = end;
        before = after;
    }
    return high > low ? sum : 0.0;
}

void main()
{
    const vec3 direction = normalize(ray);
    const Pass pass = pass_of(lamp.xyz, direction, pixel_angle);
    const float out_there = pass.nearest * lamp.w, x2 = out_there * out_there, fade = clamp(1.0 - x2 * x2, 0.0, 1.0);
    if (fade <= 0.0)
        discard;
    const float start = length(ray) / max(begins, 1e-9);
    const float ends = max(stored_view_depth(buffer_depth(gl_FragCoord.xy)) * length(ray), start);
    const float from = atan(pass.nearest, pass.along - start), to = atan(pass.nearest, pass.along - ends);
    const bool all_around = spot.w < -1.0 && strength.w == 0.0;
    // Not below nothing: where the ray ends near the camera both are nearly one, and a GPU's arc tangent is rough.
    const float bent = all_around ? max(bent_up_to(to) - bent_up_to(from), 0.0) : lit(pass, direction, from, to);
    radiance = vec4(strength.rgb * (bent * fade * fade * shows() / pass.nearest), 0.0);
}
