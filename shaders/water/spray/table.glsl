// table.glsl - the table of ids: open addressing with linear probing.

// The step whose states go on; 0: there is none. It is older than the last one if the host has thrown frames away.
uint serial_before()
{
    const uint serial = state.splash_serials[1u - state.splash_half];
    return frame.serial_before != 0u && serial >= frame.serial_first ? serial : 0u;
}

// Time since that step (s).
float gap_s()
{
    const uint serial = serial_before();
    const float before_s = state.splash_times[1u - state.splash_half];
    return serial == 0u ? 0.0 : serial == frame.serial_before ? frame.gap_s : max(frame.time_s - before_s, 0.0);
}

// Index among the last frame's splash particles, or max_splashes.
uint find_before(uint id)
{
    const uint first = (1u - state.splash_half) * (frame.splash_mask + 1u);
    if (serial_before() == 0u)
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
