// order_indices.comp - the indices of each streak's two triangles, or of its line, where it is drawn, and how many are.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "rain/tick.glsl"
#include "view.glsl"
#include "rain/compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "order.glsl"

layout(local_size_x = VIRGA_RAIN_GROUP) in;
layout(scalar, set = 0, binding = 6) writeonly buffer Prepared { virga_prepared_gpu prepared; };
layout(scalar, set = 0, binding = 7) readonly buffer Streaks { virga_streak_gpu streaks[]; };
layout(scalar, set = 0, binding = 21) buffer Indices { uvec2 indices[]; }; // the same, two at a time

void write_quad(uint at, uint corner)
{
    indices[at] = corner + uvec2(0u, 1u);
    indices[at + 1u] = corner + uvec2(2u, 2u);
    indices[at + 2u] = corner + uvec2(1u, 3u);
}

// Thin streaks begin behind all wide ones, and those that are lines are the first of them.
void write_draws(uint lines)
{
    const uint last = BUCKETS - 1u, thin = order[count_at(last, 0u)] + order[total_at(last)];
    const uint first = 6u * list.second_kind;
    prepared.lines = virga_draw_gpu(2u * lines, 1u, first, 0, 0u);
    prepared.thin = virga_draw_gpu(6u * (thin - lines), 1u, first + 2u * lines, 0, 0u);
}

void main()
{
    const uint index = gl_GlobalInvocationID.x, wide = list.second_kind;
    if (index >= list.count)
        return;
    const uint lines = order[count_at(first_bucket_of_quads(), 0u)];
    if (index == 0u)
        write_draws(lines);
    const uint corner = 4u * index, mark = streaks[index].order;
    if (index < wide) {
        write_quad(3u * index, corner);
        return;
    }
    if (mark == NOT_DRAWN)
        return;
    const uint bucket = mark / VIRGA_RAIN_GROUP, rank = mark % VIRGA_RAIN_GROUP;
    const uint place = order[count_at(bucket, gl_WorkGroupID.x)] + rank;
    if (bucket < first_bucket_of_quads())
        indices[3u * wide + place] = corner + uvec2(0u, 2u); // tail and head
    else
        write_quad(3u * wide + lines + 3u * (place - lines), corner);
}
