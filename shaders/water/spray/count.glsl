// count.glsl - counts of water with 64 bits, which only grow.
void count_handed(uint nl)
{
    const uint old = atomicAdd(state.handed_nl[0], nl);
    if (old + nl < old)
        atomicAdd(state.handed_nl[1], 1u);
}

void count_taken(uint nl)
{
    const uint old = atomicAdd(state.taken_nl[0], nl);
    if (old + nl < old)
        atomicAdd(state.taken_nl[1], 1u);
}
