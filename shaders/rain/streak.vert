// streak.vert - four corners of a streak around its way on the screen, half a pixel wider than it is drawn.
//
// Vertices are pulled from the streak buffer by an ordinary index buffer (0 1 2 2 1 3 and so on): instances of four
// vertices cost software Vulkan half as much again.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "field.glsl"
#include "view.glsl"

layout(scalar, set = 0, binding = 7) readonly buffer Streaks { virga_streak_gpu streaks[]; };

layout(location = 0) out vec4 across_along; // px from the middle line; px from the tail; half width; way in px
layout(location = 1) out float depth;
layout(location = 2) flat out vec4 centre_alpha;
layout(location = 3) flat out vec4 rim_body;
layout(location = 4) flat out vec3 wave;    // turns along the streak, phase, size

void main()
{
    const virga_streak_gpu streak = streaks[gl_VertexIndex >> 2];
    const vec4 head = vec4(streak.head[0], streak.head[1], streak.head[2], streak.head[3]);
    const vec4 tail = vec4(streak.tail[0], streak.tail[1], streak.tail[2], streak.tail[3]);
    const vec2 half_viewport = 0.5 * vec2(view.viewport[2], view.viewport[3]);
    const vec2 way = (head.xy / head.w - tail.xy / tail.w) * half_viewport;
    const float way_px = length(way);
    const vec2 along = way_px > 1e-3 ? way / way_px : vec2(0.0, 1.0);
    const vec2 side = vec2(-along.y, along.x);

    const float half_width = 0.5 * streak.width_px, margin = 0.5 * streak.body_px + 0.5;
    const float across = ((gl_VertexIndex & 1) == 0 ? -1.0 : 1.0) * (half_width + 0.5);
    const bool at_head = (gl_VertexIndex & 2) != 0;
    vec4 clip = at_head ? head : tail;
    clip.xy += (side * across + along * (at_head ? margin : -margin)) / half_viewport * clip.w;
    gl_Position = streak.alpha > 0.0 ? clip : vec4(2.0, 2.0, 2.0, 1.0);

    // Interpolated without perspective: divided by w here and multiplied by its interpolation in the fragment shader
    // would be the long way; all corners get the same w instead.
    gl_Position = vec4(gl_Position.xyz / gl_Position.w, 1.0);
    depth = clip.w;
    across_along = vec4(across, at_head ? way_px + margin : -margin, half_width, way_px);
    centre_alpha = vec4(streak.centre[0], streak.centre[1], streak.centre[2], streak.alpha);
    rim_body = vec4(streak.rim[0], streak.rim[1], streak.rim[2], streak.body_px);
    wave = vec3(streak.wave, streak.wave_phase, streak.wave_size);
}
