#version 460
// reuse_check.comp - once the depth of a sub-frame is drawn that shares shading: where it sees something else, from
// here on a block is not kept as a whole. One invocation for each block.
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D depth_picture;
layout(set = 0, binding = 1, std430) buffer Planes { vec4 planes[]; };
layout(set = 0, binding = 4, r32ui) uniform writeonly uimage2D kinds;
layout(set = 0, binding = 10) uniform usampler2D first_id;
layout(set = 0, binding = 12) uniform usampler2D id_picture;

void main()
{
    const uvec2 first = gl_GlobalInvocationID.xy * HOST_REUSE_SIDE;
    if (first.x >= reuse.width || first.y >= reuse.height)
        return;
    const ivec2 last = ivec2(reuse.width, reuse.height) - 1;
    const uint block = reuse_block(first);
    const vec4 plane = planes[block];
    const vec2 from = 1.0 + vec2(reuse.shift_x, reuse.shift_y);
    float apart = 0.0;
    bool same = true;
    for (int i = 0; i < HOST_REUSE_SIDE * HOST_REUSE_SIDE; i++) {
        const ivec2 inside = ivec2(i % HOST_REUSE_SIDE, i / HOST_REUSE_SIDE), at = ivec2(first) + inside;
        const float depth = texelFetch(depth_picture, min(at, last), 0).r;
        const uint id = texelFetch(id_picture, min(at, last), 0).r;
        same = same && id == texelFetch(first_id, min(at, last), 0).r;
        if (at == min(at, last))
            apart = max(apart, abs(plane.x + dot(plane.yz, vec2(inside) + from) - depth));
    }
    const bool keeps = same && apart <= plane.w;
    const bool shades = reuse_moves(first) || plane.w == REUSE_NOTHING.w;
    planes[block] = shades ? REUSE_NOTHING : keeps ? plane : REUSE_PIXELS;
    const uint kind = shades ? HOST_REUSE_SHADED : keeps ? HOST_REUSE_KEPT : HOST_REUSE_PIXELS;
    imageStore(kinds, ivec2(gl_GlobalInvocationID.xy), uvec4(kind));
}
