#version 460
// reuse_choose.frag - where a block is not kept: which pixel of the sub-frame that was shaded everywhere a pixel takes.
// It is one that sees the same surface. So edges are where this one's depth has them, and only what the first one has
// not seen is shaded anew: there the depth is this one's own. Elsewhere it is one that nothing is equal to.
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"
#include "reuse_contrast.glsl"
#include "reuse_slope.glsl"

layout(set = 0, binding = 0) uniform sampler2D depth_picture;
layout(set = 0, binding = 6) uniform sampler2D first_color;
layout(set = 0, binding = 11) uniform sampler2D first_seen; // see reuse_slope.frag
layout(set = 0, binding = 12) uniform usampler2D id_picture;
layout(set = 0, binding = 13) uniform usampler2D kinds;

layout(location = 0) out uint out_place; // of the pixel to take, see reuse_place

// The place of the pixel to take, and whether there is one.
uint choose(ivec2 pixel, float depth, out bool is_taken)
{
    const float allowed = reuse_tolerance(depth);
    const vec2 slope = reuse_slope(depth_picture, pixel, depth), shift = vec2(reuse.shift_x, reuse.shift_y);
    const float id = float(texelFetch(id_picture, pixel, 0).r);
    uint best = 0u;
    float nearest = 4.0; // no pixel of the square is so far away
    vec3 low = vec3(1e30), high = vec3(0.0);
    for (uint i = 0u; i < 4u; i++) {
        const ivec2 place = reuse_place(i), at = reuse_inside(pixel + place);
        const vec2 away = vec2(place) - shift;
        const vec3 color = texelFetch(first_color, at, 0).rgb;
        const vec4 seen = texelFetch(first_seen, at, 0);
        const float farther = seen.z - depth, far = dot(away, away);
        // Each lies on the plane through the other.
        const float apart = max(reuse_apart(slope, farther, away), reuse_apart(seen.xy, farther, away));
        if (apart > allowed || seen.w != id)
            continue;
        low = min(low, color);
        high = max(high, color);
        best = far < nearest ? i : best;
        nearest = min(nearest, far);
    }
    is_taken = nearest < 4.0 && reuse_contrast(low, high) <= reuse.contrast;
    return best;
}

void main()
{
    const ivec2 pixel = ivec2(gl_FragCoord.xy);
    const uint kind = texelFetch(kinds, pixel / HOST_REUSE_SIDE, 0).r;
    float depth = texelFetch(depth_picture, pixel, 0).r;
    out_place = 0u;
    // A loop, not a branch: software Vulkan skips a loop where no lane takes it.
    [[dont_unroll]] for (bool looks = kind == HOST_REUSE_PIXELS; looks; looks = false) {
        bool is_taken;
        out_place = choose(pixel, depth, is_taken);
        depth = is_taken ? HOST_REUSE_AT_TAKEN : depth;
    }
    gl_FragDepth = kind == HOST_REUSE_KEPT ? HOST_REUSE_AT_KEPT : depth;
}
