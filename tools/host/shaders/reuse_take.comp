#version 460
// reuse_take.comp - where a block is not kept: which pixel of the sub-frame that was shaded everywhere sees the same
// surface as this pixel of a later one. Edges are where this one's depth has them, and only what the first one has not
// seen is shaded anew. One invocation for each pixel.
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"
#include "reuse_contrast.glsl"
#include "reuse_slope.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D depth_picture;
layout(set = 0, binding = 1, std430) readonly buffer Planes { vec4 planes[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Choices { uint choices[]; };
layout(set = 0, binding = 5) uniform sampler2D first_depth;
layout(set = 0, binding = 6) uniform sampler2D first_color;
layout(set = 0, binding = 10) uniform usampler2D first_id;
layout(set = 0, binding = 11, std430) readonly buffer Slopes { vec2 slopes[]; };
layout(set = 0, binding = 12) uniform usampler2D id_picture;

uint choose(ivec2 pixel)
{
    const float depth = texelFetch(depth_picture, pixel, 0).r, allowed = reuse_tolerance(depth);
    const vec2 slope = reuse_slope(depth_picture, pixel, depth), shift = vec2(reuse.shift_x, reuse.shift_y);
    const uint id = reuse_id(depth, texelFetch(id_picture, pixel, 0).r);
    uint best = HOST_REUSE_SHADED;
    float nearest = 4.0; // no pixel of the square is so far away
    vec3 low = vec3(1e30), high = vec3(0.0);
    for (int i = 0; i < 4; i++) { // those around the point that is seen
        const ivec2 place = ivec2(floor(shift)) + ivec2(i & 1, i >> 1), at = reuse_inside(pixel + place);
        const vec2 away = vec2(place) - shift, its_slope = slopes[at.y * int(reuse.width) + at.x];
        const vec3 color = texelFetch(first_color, at, 0).rgb;
        const float farther = texelFetch(first_depth, at, 0).r - depth, far = dot(away, away);
        // Each lies on the plane through the other.
        const float apart = max(reuse_apart(slope, farther, away), reuse_apart(its_slope, farther, away));
        if (apart > allowed || texelFetch(first_id, at, 0).r != id)
            continue;
        low = min(low, color);
        high = max(high, color);
        best = far < nearest ? uint(place.x + 1 + 3 * (place.y + 1)) : best;
        nearest = min(nearest, far);
    }
    return reuse_contrast(low, high) <= reuse.contrast ? best : HOST_REUSE_SHADED;
}

void main()
{
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(reuse.width) || pixel.y >= int(reuse.height))
        return;
    const vec4 plane = planes[reuse_block(uvec2(pixel))];
    // A loop, not a branch: software Vulkan skips a loop where no lane takes it.
    uint chosen = HOST_REUSE_SHADED;
    [[dont_unroll]] for (bool takes = reuse_takes_pixels(plane); takes; takes = false)
        chosen = choose(pixel);
    choices[pixel.y * int(reuse.width) + pixel.x] = chosen;
}
