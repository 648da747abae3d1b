// live_counts.glsl - what follows from the numbers of free slots (x) and of slots in use (y) in the live list. By one
// invocation.
uint[3] groups_of(uint invocations)
{
    return uint[3]((invocations + VIRGA_GLASS_GROUP - 1u) / VIRGA_GLASS_GROUP, 1u, 1u);
}

void write_live_counts(uvec2 found)
{
    state.alive = found.y;
    state.free = tick.pane.max_drops - found.y;
    state.free_listed = found.x;
    state.max_rounds = 0u;
    state.max_nl = 0u;
    state.alive_groups = groups_of(found.y);
}
