// table.glsl - the table of ids: open addressing with linear probing.

// Whether the last frame's states are there. A frame that the host has thrown away has not written its half.
bool goes_on()
{
    return frame.serial_before != 0u && state.splash_serials[1u - frame.splash_half] == frame.serial_before;
}

// Index among the last frame's splash particles, or max_splashes.
uint find_before(uint id)
{
    const uint first = (1u - frame.splash_half) * (frame.splash_mask + 1u);
    if (!goes_on())
        return frame.max_splashes;
    for (uint i = 0u, at = virga_hash1(id); i <= frame.splash_mask; i++, at++) {
        const uint entry = table[first + (at & frame.splash_mask)];
        if (entry == 0u)
            break;
        if (splashes[splash_before(entry - 1u)].id == id)
            return entry - 1u;
    }
    return frame.max_splashes;
}

// If several particles have the same id, the one that is first in the list is found, in any order of invocations.
void enter(uint splash, uint id)
{
    const uint first = frame.splash_half * (frame.splash_mask + 1u);
    for (uint i = 0u, at = virga_hash1(id); i <= frame.splash_mask; i++, at++) {
        const uint slot = first + (at & frame.splash_mask);
        const uint entry = atomicCompSwap(table[slot], 0u, splash + 1u);
        if (entry == 0u)
            return;
        if (particles[splash_particle(entry - 1u)].id == id) {
            atomicMin(table[slot], splash + 1u);
            return;
        }
    }
}
