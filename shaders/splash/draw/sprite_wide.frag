// sprite_wide.frag - a sprite that is at least WIDE_PX wide and shows the background through it: balls and necks of
// water, premultiplied.
// One invocation per pixel of such a sprite. Reads: the scene's picture and depth. Writes: radiance, motion, reactive.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/view_gpu.h"
#include "gpu/vectors.glsl"
layout(scalar, set = 0, binding = 1) uniform View
{
    virga_view_gpu view;
    virga_splash_look_gpu look;
};
#include "gpu/view.glsl"
#include "gpu/light.glsl"
#include "torn.glsl"
#include "sprite_pixel.glsl"
#include "through.glsl"
#include "gpu/encode.glsl"

#define WIDE_PX 3.0 // as in view.glsl

// A neck merges with the ball on its tip, which is wider by this factor (see pile_widths), and ends in the ball's lower
// half, so that its flat end does not show. The neck of a ball that has left ends as softly.
#define BALL_OF_NECK (1.0 / 0.7)

float outside_ball()
{
    const float radius = BALL_OF_NECK * shape.x;
    return 1.0 - smoothstep(shape.z - radius, shape.z - 0.25 * radius, sprite_position.y);
}

void main()
{
    const float alpha = sprite_cover() * (rim_kind.w > 0.5 ? outside_ball() : 1.0);
    if (alpha <= 0.0)
        discard;
    const bool pile = rim_kind.w > 0.5;
    const float half_width = pile ? pile_half_width() : shape.x;
    const float u = clamp(sprite_position.x / max(half_width, 0.25), -1.0, 1.0);
    // A droplet that moved by its own width or more while the shutter was open shows neither an image nor a rim: at
    // each pixel all of it passed.
    const float smeared = pile ? 0.0 : clamp(0.5 * shape.z / max(half_width, 0.25), 0.0, 1.0);
    const float beyond = pile                      ? 0.0
                         : sprite_position.y < 0.0 ? sprite_position.y
                                                   : max(sprite_position.y - shape.z, 0.0);
    const float v = clamp(beyond / max(half_width, 0.25), -1.0, 1.0) * (1.0 - smeared);
    const vec2 along = axis_chance.xy, side = vec2(-along.y, along.x), screen = side * u + along * v;
    const vec3 d = normalize(pixel_ray(gl_FragCoord.xy));
    const vec3 across = normalize(to_vec(view.right)) * screen.x - normalize(to_vec(view.up)) * -screen.y;
    const vec3 unlit = torn_light(environment(d, vec2(0.97, 0.90)), pile ? TORN_PILE : TORN_DROPLET);
    const vec3 lamps_in = max(center_alpha.rgb - unlit, vec3(0.0));
    const vec3 even = mix(center_alpha.rgb, around_of(d), 0.6);
    const vec3 mean = mix(mix(center_alpha.rgb, rim_kind.rgb, (1.0 + 2.0 * u * u) / 3.0), even, smeared);
    const float show = clamp((2.0 * half_width - WIDE_PX) / WIDE_PX, 0.0, 1.0) * (1.0 - 0.85 * smeared);
    const vec3 light = mix(mean, through_ball(d, across) + lamps_in, show);
    radiance = for_target(vec4(light * alpha, alpha));
    WRITE_MOTION(motion, alpha);
    WRITE_REACTIVE(alpha, view.reactive_gain);
}
