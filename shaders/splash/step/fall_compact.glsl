// fall_compact.glsl - moves a droplet of this tick: one that fell becomes a return (its water goes to the ground); one
// that is alive moves to its index in the other buffer, in order. The buffer that it leaves keeps no living droplet.
layout(scalar, set = 0, binding = 12) writeonly buffer Staying { uvec4 staying[]; };

// There is `room` for that many returns, from `first` on; other fallen droplets wait in the air.
void compact_droplet(uint slot, virga_droplet_gpu droplet, uint first, uint room)
{
    const uvec4 word = marks[slot / 32u];
    const uint bit = 1u << (slot & 31u);
    if ((word.y & bit) == 0u)
        return;
    const uint fallen = word.z + bitCount(word.x & (bit - 1u)), alive = word.w + bitCount(word.y & (bit - 1u));
    const uvec4 texels[4] = texels_of(droplet);
    droplets[4u * slot + 3u] = uvec4(0u, texels[3].yzw);
    if ((word.x & bit) == 0u || fallen >= room) {
        const uint texel = 4u * (alive - min(fallen, room));
        for (uint i = 0u; i < 4u; i++)
            staying[texel + i] = texels[i];
        return;
    }
    const bool spray = (droplet.kind & VIRGA_DROPLET_SPRAY) != 0u;
    const uint pane = VIRGA_DROPLET_PANE(droplet.kind);
    const float diameter = droplet.water_nl > 0u ? droplet.diameter_m : 0.0; // without water it leaves no trace
    write_return(first + fallen, to_vec(droplet.position), to_vec(droplet.velocity), diameter, droplet.id,
                 VIRGA_DROPLET_MATERIAL(droplet.kind) | (spray ? VIRGA_IMPACT_SPRAY | pane << 16 : 0u),
                 droplet.water_nl);
    count(pane > 0u ? VIRGA_SPLASH_SPRAY_PANES : spray ? VIRGA_SPLASH_SPRAY_RETURNED : VIRGA_SPLASH_RETURNED,
          droplet.water_nl);
}
