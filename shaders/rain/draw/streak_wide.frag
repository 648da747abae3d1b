// streak_wide.frag - coverage and light of a wide streak at a pixel, premultiplied. A drop in focus shows its inside;
// one out of focus has the mean of its light.
// One invocation per pixel of a wide streak. Reads: the scene's depth. Writes: radiance, motion, reactive.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "streak_pixel.glsl"
#include "gpu/streak_profile.glsl"
#include "gpu/encode.glsl"
#include "lens_edge.glsl"

layout(location = 0) noperspective in vec4 streak_position;
layout(location = 1) flat in vec4 center_alpha;
layout(location = 2) flat in vec4 rim_wave;
layout(location = 3) flat in vec4 shape;
layout(location = 5) flat in vec4 depth_terms; // with HAS_DEPTH, see soft_edge
layout(location = 6) flat in vec3 lamp_light;
layout(location = 0) out vec4 radiance;

// What a drop shows at (u, v) of its disc: the ray is deflected by 2 (i - t), sin i = r, towards the other side, so the
// world appears upside down. At the rim, Schlick's Fresnel term reflects the surroundings. With sin t = r / 1.333 both
// cosines are square roots, and those of sums follow: no angle is needed.
vec3 through_drop(vec2 uv, vec3 d)
{
    const float r = min(length(uv), 0.999), sin_t = r / 1.333;
    const float cos_i = sqrt(1.0 - r * r), cos_t = sqrt(1.0 - sin_t * sin_t);
    const float cos_half = cos_i * cos_t + r * sin_t, sin_half = r * cos_t - cos_i * sin_t; // of i - t
    const vec3 side = normalize(to_vec(view.right)) * uv.x + normalize(to_vec(view.up)) * uv.y;
    const vec3 out_of = r > 1e-3 ? side / r : vec3(0.0);
    const float grazing = 1.0 - cos_i, grazing2 = grazing * grazing;
    const float fresnel = 0.0204 + 0.9796 * grazing2 * grazing2 * grazing;
    const vec3 refracted = d * (1.0 - 2.0 * sin_half * sin_half) - out_of * (2.0 * sin_half * cos_half);
    const vec3 reflected = d * (2.0 * r * r - 1.0) + out_of * (2.0 * r * cos_i); // by pi - 2 i
    return mix(environment(refracted, vec2(1.0)), environment(reflected, vec2(1.0)), fresnel);
}

// The light at a pixel is the mean over the height of the drop that passes it. Above and below the middle the
// deflections are opposite and equal, so the middle stands for the mean.
vec3 wide_light(float u, float along, vec2 direction, vec3 d)
{
    const vec2 side = vec2(-direction.y, direction.x);
    const vec2 screen = side * u + direction * (shape.z > shape.y ? 0.0 : along);
    return through_drop(vec2(screen.x, -screen.y), d); // screen y is down
}

void main()
{
    // Before any discard: derivatives are undefined after it.
    const vec2 across = vec2(dFdx(streak_position.x), dFdy(streak_position.x));
    const vec2 onward = vec2(dFdx(streak_position.y), dFdy(streak_position.y));
    const float half_width = shape.x, body_px = shape.y, path_px = shape.z, focus = shape.w;
    const float u = min(abs(streak_position.x) / half_width, 1.0);
    float alpha =
        center_alpha.a * streak_capsule(abs(streak_position.x), half_width, streak_position.y, path_px, body_px);
    const float depth_m = 1.0 / streak_position.w;
    if (HAS_LENS)
        alpha *= mix(lens_edge(streak_position.xy, half_width, path_px, mat2(across, onward), depth_m, depth_terms),
                     soft_edge(depth_m, depth_terms), focus);
    else if (HAS_DEPTH)
        alpha *= soft_edge(depth_m, depth_terms);
    if (alpha <= 0.0)
        discard;

    const float width_blend = clamp(half_width - 0.75, 0.0, 1.0);
    // All of a drop passes a pixel, along a chord: the mean of r^2 on it is u^2 + (1 - u^2) / 3. Weighted by chords its
    // mean over the drop is 1/2, which is what a streak has that is too narrow or too blurred to show more.
    const float rim = mix(0.5, (1.0 + 2.0 * u * u) / 3.0, focus * width_blend);
    vec3 light = mix(center_alpha.rgb, rim_wave.rgb, rim);
    const vec3 d = normalize(pixel_ray(gl_FragCoord.xy));
    const vec2 direction = normalize(vec2(across.y, -across.x) + vec2(0.0, 1e-6));
    const float along = body_px > 0.0 ? clamp((streak_position.y - 0.5 * path_px) / (0.5 * body_px), -1.0, 1.0) : 0.0;
    const float lens_blend = focus * clamp((half_width - 0.5 * WIDE_PX) / WIDE_PX, 0.0, 1.0);
    light = mix(light, wide_light(streak_position.x / half_width, along, direction, d) + lamp_light, lens_blend);
    radiance = for_target(vec4(light * streak_wave(streak_position.z, rim_wave.w) * alpha, alpha));
    WRITE_MOTION(motion, alpha);
    WRITE_REACTIVE(alpha, view.reactive_gain);
}
