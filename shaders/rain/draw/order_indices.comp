// order_indices.comp - writes the indices of each streak's two triangles, or of its line, in drawing order; and the
// draws' arguments.
// One invocation per streak. Reads: streaks, counts. Writes: index buffer, draw arguments.
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
layout(scalar, set = 0, binding = 21) buffer Indices { uvec2 indices[]; }; // the same buffer, two indices at a time

void write_quad(uint at, uint corner)
{
    indices[at] = corner + uvec2(0u, 1u);
    indices[at + 1u] = corner + uvec2(2u, 2u);
    indices[at + 2u] = corner + uvec2(1u, 3u);
}

// Thin streaks come after all wide ones; those drawn as lines are the first of them.
void write_draws(uint lines)
{
    const uint last = BUCKETS - 1u, thin = order[count_index(last, 0u)] + order[total_index(last)];
    const uint first = 6u * list.second_kind;
    prepared.lines = virga_draw_gpu(2u * lines, 1u, first, 0, 0u);
    prepared.thin_quads = virga_draw_gpu(6u * (thin - lines), 1u, first + 2u * lines, 0, 0u);
}

void main()
{
    const uint index = gl_GlobalInvocationID.x, wide = list.second_kind;
    if (index >= list.count)
        return;
    const uint lines = order[count_index(first_bucket_of_quads(), 0u)];
    if (index == 0u)
        write_draws(lines);
    const uint corner = 4u * index, sort_key = streaks[index].order;
    if (index < wide) {
        write_quad(3u * index, corner);
        return;
    }
    if (sort_key == NOT_DRAWN)
        return;
    const uint bucket = sort_key / VIRGA_RAIN_GROUP, rank = sort_key % VIRGA_RAIN_GROUP;
    const uint thin_index = order[count_index(bucket, gl_WorkGroupID.x)] + rank;
    if (bucket < first_bucket_of_quads())
        indices[3u * wide + thin_index] = corner + uvec2(0u, 2u); // tail and head
    else
        write_quad(3u * wide + lines + 3u * (thin_index - lines), corner);
}
