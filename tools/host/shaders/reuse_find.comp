#version 460
// reuse_find.comp - after a sub-frame that was shaded everywhere: where the next ones can do with its shading. One
// invocation for each block, which also looks at the pixels around it, since jitter moves what lies there into it.
#extension GL_GOOGLE_include_directive : require
#include "reuse.glsl"
#include "reuse_contrast.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D depth_picture;
layout(set = 0, binding = 1, std430) writeonly buffer Planes { vec4 planes[]; };
layout(set = 0, binding = 2) uniform sampler2D color_picture;
layout(set = 0, binding = 3) uniform sampler2D velocity_picture;

const int SIDE = HOST_REUSE_SIDE + 2;

ivec2 pixel_at(ivec2 from, int x, int y)
{
    return clamp(from + ivec2(x, y), ivec2(0), ivec2(reuse.width, reuse.height) - 1);
}

float depth_at(ivec2 from, int x, int y) { return texelFetch(depth_picture, pixel_at(from, x, y), 0).r; }

void main()
{
    const uvec2 first = gl_GlobalInvocationID.xy * HOST_REUSE_SIDE;
    if (first.x >= reuse.width || first.y >= reuse.height)
        return;
    const ivec2 from = ivec2(first) - 1;
    float most = 0.0;
    vec3 above[SIDE];
    for (int y = 0; y < SIDE; y++) {
        vec3 left = vec3(0.0);
        for (int x = 0; x < SIDE; x++) {
            const vec3 color = texelFetch(color_picture, pixel_at(from, x, y), 0).rgb;
            if (x > 0)
                most = max(most, reuse_contrast(left, color));
            if (y > 0)
                most = max(most, reuse_contrast(above[x], color));
            above[x] = left = color;
        }
    }
    const float corner = depth_at(from, 0, 0);
    const vec2 slope = (vec2(depth_at(from, SIDE - 1, 0), depth_at(from, 0, SIDE - 1)) - corner) / float(SIDE - 1);
    float apart = 0.0;
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            apart = max(apart, abs(corner + dot(slope, vec2(x, y)) - depth_at(from, x, y)));
    float moved2 = 0.0;
    for (int i = 0; i < 4; i++) {
        const ivec2 corner = ivec2(i & 1, i >> 1) * (SIDE - 1);
        const vec2 moved = texelFetch(velocity_picture, pixel_at(from, corner.x, corner.y), 0).xy;
        moved2 = max(moved2, dot(moved, moved));
    }
    const float wide = reuse_tolerance(corner), allowed = apart < wide ? reuse.contrast : reuse.edge;
    const bool stands = moved2 <= reuse.moved2 && !reuse_moves(first);
    apart += wide + REUSE_MOVED_PX * (abs(slope.x) + abs(slope.y));
    planes[reuse_block(first)] = !stands          ? REUSE_NOTHING
                                 : most > allowed ? REUSE_PIXELS
                                                  : vec4(corner, slope, apart);
}
