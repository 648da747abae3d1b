// adopt.comp - takes droplets that water hands over: they follow behind those that are in the air.
//
// The list says where they are at a time that may be a part of a tick later than the end of the newest tick, which
// positions of droplets are for. So each of them begins where it would have been then, such that a draw at that time
// shows it where the list says (droplet_at in splash/draw/view.glsl).
// One invocation per droplet. Reads: the list. Writes: droplets, counts.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "counters.glsl"
#include "handed.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

#define SPRAY_KIND (VIRGA_DROPLET_SPRAY | VIRGA_DROPLET_FREE | VIRGA_DROPLET_ALIVE)
#define OLDEST_S 1.0 // older ones count as that old, so that they have time to fall

bool is_finite(vec3 v) { return all(lessThan(abs(v), vec3(1e6))); }

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    if (index >= handed_count())
        return;
    const virga_handed_droplet_gpu from = handed[index];
    const float late_s = tick.handed_late_s;
    vec3 velocity = is_finite(to_vec(from.velocity)) ? to_vec(from.velocity) : vec3(0.0);
    vec3 position = is_finite(to_vec(from.position)) ? to_vec(from.position) : vec3(0.0);
    velocity.y += GRAVITY * late_s;
    position += to_vec(tick.handed_offset) - velocity * late_s + vec3(0.0, 0.5 * GRAVITY * late_s * late_s, 0.0);
    virga_droplet_gpu droplet;
    droplet.position = float[3](position.x, position.y, position.z);
    droplet.age_s = clamp(from.age_s, 0.0, OLDEST_S); // NaN becomes one of the two
    droplet.velocity = float[3](velocity.x, velocity.y, velocity.z);
    droplet.diameter_m = clamp(from.diameter_m, 1e-6, 1.0);
    droplet.base = droplet.position;
    droplet.slopes = 0u;
    droplet.kind = SPRAY_KIND | (from.number & 255u) << 16;
    droplet.id = from.id;
    droplet.water_nl = from.water_nl;
    droplet.weight_free = halves(from.drops > 1.0 ? min(from.drops, 6e4) : 1.0, 0.0);
    const uvec4 texels[4] = texels_of(droplet);
    for (uint i = 0u; i < 4u; i++)
        droplets[4u * (state.staying + index) + i] = texels[i];
    count(VIRGA_SPLASH_SPRAY_IN, from.water_nl);
}
