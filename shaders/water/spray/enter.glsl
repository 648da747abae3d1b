// enter.glsl - enters a splash particle of this step into the table of ids.

// If several particles have the same id, the one that is first in the list is found, in any order of invocations.
void enter(uint splash, uint id)
{
    const uint first = state.splash_half * (frame.splash_mask + 1u);
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
