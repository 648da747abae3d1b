// soak.glsl - what came to a cell fills its pores first; the rest stays on it. Include cells.glsl before.
layout(scalar, set = 0, binding = 6) buffer Arrivals { virga_arrivals_gpu arrivals[]; };

void soak(uint cell_index)
{
    // Nothing is added in this pass: of all invocations that look at this cell, one finds the sum and the others 0.
    const uint given = atomicExchange(arrivals[cell_index].given_nl, 0u);
    if (given == 0u)
        return;
    const uvec2 words = cell_words[cell_index];
    const virga_cell_gpu cell = virga_cell_gpu(words.x, words.y);
    const uint capacity = tick.soils[floor_of(cell_index).material].capacity_nl;
    const uint absorbed = min(given, capacity - min(cell.held_nl, capacity));
    cell_words[cell_index] = uvec2(cell.free_nl + (given - absorbed), cell.held_nl + absorbed);
}
