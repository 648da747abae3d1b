// enter.glsl - enters a splash particle of this step into the table of ids.

// Of two that want the same word the first of the list gets it, and the other one goes on to the next: so each word is
// the same in any order of invocations (Shun and Blelloch 2014, "Phase-concurrent hash tables for determinism"). If
// several particles have the same id, the one that is first in the list is found.
void enter(uint splash, uint id)
{
    const uint first = state.splash_half * (frame.splash_mask + 1u);
    uint own = splash + 1u;
    for (uint i = 0u, at = virga_hash1(id); i <= frame.splash_mask; i++, at++) {
        const uint slot = first + (at & frame.splash_mask);
        if (atomicCompSwap(table[slot], 0u, own) == 0u)
            return;
        const uint other = atomicMin(table[slot], own), other_id = particles[splash_particle(other - 1u)].id;
        if (other_id == id)
            return;
        if (other > own) {
            own = other;
            id = other_id;
        }
    }
}
