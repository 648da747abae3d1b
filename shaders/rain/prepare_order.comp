// prepare_order.comp - the indices of each streak's two triangles, where it is drawn.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "tick.glsl"
#include "view.glsl"
#include "compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "order.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 7) readonly buffer Streaks { virga_streak_gpu streaks[]; };
layout(scalar, set = 0, binding = 21) buffer Indices { uvec2 indices[]; }; // the same, two at a time

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= list.count)
        return;
    const uint mark = streaks[index].order, area = mark / VIRGA_RAIN_GROUP, rank = mark % VIRGA_RAIN_GROUP;
    const uint place =
        index < list.second_kind ? index : list.second_kind + order[count_at(area, gl_WorkGroupID.x)] + rank;
    const uint corner = 4u * index;
    indices[3u * place] = corner + uvec2(0u, 1u);
    indices[3u * place + 1u] = corner + uvec2(2u, 2u);
    indices[3u * place + 2u] = corner + uvec2(1u, 3u);
}
