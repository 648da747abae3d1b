// streams.glsl - where running water is kept: one entry for each cell around the middle of the ripple map, behind the
// rings in their buffer. Include rings.glsl before.

// Cells are numbered modulo the side of the area, so that an entry stays where it is while the area moves.
uint stream_index(ivec2 cell)
{
    const uint side = tick.stream_blocks * VIRGA_STREAM_BLOCK;
    const uvec2 at = (uvec2(cell) + 0x80000000u) % side; // negative numbers below the others
    return at.y * side + at.x;
}

bool stream_is_of(virga_stream_gpu stream, ivec2 cell) { return stream.cell[0] == cell.x && stream.cell[1] == cell.y; }

// Ticks since a layer of waves began, see ground_streams.c.
uint stream_age(uint layer)
{
    return (tick.last_tick + layer * (tick.stream_period / 2u)) % tick.stream_period;
}
