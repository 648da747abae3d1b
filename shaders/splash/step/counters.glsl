// counters.glsl - counters of 64 bits that only grow.

void count(uint index, uint amount)
{
    if (amount == 0u)
        return;
    const uint old = atomicAdd(state.counts[index].low, amount);
    if (old + amount < old)
        atomicAdd(state.counts[index].high, 1u);
}
