#version 460
// reuse_check.comp - once the depth of a sub-frame is drawn that shares shading: where it sees something else, from
// here on nothing is shared. One invocation for each block.
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D depth_picture;
layout(set = 0, binding = 1, std430) buffer Planes { vec4 planes[]; };

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
    for (int i = 0; i < HOST_REUSE_SIDE * HOST_REUSE_SIDE; i++) {
        const ivec2 inside = ivec2(i % HOST_REUSE_SIDE, i / HOST_REUSE_SIDE), at = ivec2(first) + inside;
        const float depth = texelFetch(depth_picture, min(at, last), 0).r;
        if (at == min(at, last))
            apart = max(apart, abs(plane.x + dot(plane.yz, vec2(inside) + from) - depth));
    }
    planes[block] = apart <= plane.w && !reuse_moves(first) ? plane : REUSE_NOTHING;
}
