// order_draws.glsl - the draws of streaks as they are before their order is known.
layout(scalar, set = 0, binding = 6) writeonly buffer Prepared { virga_prepared_gpu prepared; };

// The list is complete. `found`: selected slots, also those without room in it.
void begin_draws(uint found)
{
    prepared.wide_quads = virga_draw_gpu(6u * list.second_kind, 1u, 0u, 0, 0u);
    prepared.lines = virga_draw_gpu(0u, 1u, 0u, 0, 0u);
    prepared.thin_quads = virga_draw_gpu(0u, 1u, 0u, 0, 0u);
    prepared.streaks = list.count;
    prepared.dropped = found - list.count;
}
