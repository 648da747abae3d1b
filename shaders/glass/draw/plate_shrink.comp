// plate_shrink.comp - all smaller copies of the plate, each half as wide, in one pass. They lie to the right of the
// largest: 128 at the top, below it 64, 32, 16, 8 and 4.
// One workgroup per 64 x 64 texels of the largest copy. Reads: the largest copy. Writes: the smaller ones.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 13, rgba16f) uniform image2D copies_out;

shared vec3 smaller[16][16];

vec3 mean_of(ivec2 at)
{
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; i++)
        sum += imageLoad(copies_out, 2 * at + ivec2(i & 1, i >> 1)).rgb;
    return 0.25 * sum;
}

void main()
{
    const ivec2 lane = ivec2(gl_LocalInvocationID.xy), group = ivec2(gl_WorkGroupID.xy);
    ivec2 at = 2 * (group * 16 + lane), corner = ivec2(VIRGA_GLASS_COPY, 0);
    vec3 mean = vec3(0.0);
    for (int i = 0; i < 4; i++) {
        const vec3 quarter = mean_of(at + ivec2(i & 1, i >> 1));
        imageStore(copies_out, corner + at + ivec2(i & 1, i >> 1), vec4(quarter, 1.0));
        mean += 0.25 * quarter;
    }
    corner.y = VIRGA_GLASS_COPY / 2;
    for (int side = 16; side >= 1; side /= 2) {
        const bool mine = all(lessThan(lane, ivec2(side)));
        if (side < 16) {
            barrier();
            if (mine)
                mean = 0.25 * (smaller[2 * lane.y][2 * lane.x] + smaller[2 * lane.y][2 * lane.x + 1] +
                               smaller[2 * lane.y + 1][2 * lane.x] + smaller[2 * lane.y + 1][2 * lane.x + 1]);
            barrier();
        }
        if (mine) {
            smaller[lane.y][lane.x] = mean;
            imageStore(copies_out, corner + group * side + lane, vec4(mean, 1.0));
        }
        corner.x += side * (VIRGA_GLASS_COPY / 64);
    }
}
