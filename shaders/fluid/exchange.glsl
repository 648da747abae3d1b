// exchange.glsl - the lists of water that comes from the ground and goes back to it, see shared/exchange.h.
#define VIRGA_GLSL
#include "shared/exchange.h"
#include "shared/fluid_gpu.h"
#include "shared/particle.h"
#include "gpu/vectors.glsl"

layout(scalar, set = 0, binding = 0) uniform Step { virga_fluid_step_gpu frame; };
layout(scalar, set = 0, binding = 1) buffer Particles { virga_particle_gpu particles[]; };
// The same buffer in words.
layout(std430, set = 0, binding = 1) buffer ShareBits { uint share_bits[]; };
#define SHARE_STRIDE 8u
#define SHARE_AT     3u
layout(std430, set = 0, binding = 2) buffer SlotPressures { vec2 slot_pressures[]; };
layout(scalar, set = 0, binding = 3) buffer Exchange {
    virga_exchange_gpu exchange;
    virga_exchanged_gpu entries[]; // taken ones, then given ones
};

// For how long a particle has been at rest (s), see advance.comp.
float rest_of(uint slot) { return slot_pressures[frame.max_particles + slot].x; }
void begin_rest(uint slot) { slot_pressures[frame.max_particles + slot] = vec2(0.0); }

bool is_free(uint slot) { return !(particles[slot].share > 0.0); }

// Adds the water of some particles to a sum of 64 bits.
void add_water(inout uint sum[2], uint count)
{
    uint high, low, carry;
    umulExtended(count, frame.particle_nl, high, low);
    sum[0] = uaddCarry(sum[0], low, carry);
    sum[1] += high + carry;
}
