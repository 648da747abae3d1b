// seeds.glsl - seeds: everything that needs a slot at the end of a tick. In this order: drops that land (of the rain
// rate, then of the host's list), tails that active drops left behind, particles out of the blades' bins, drops of film
// that breaks up, drops of fog.
#include "particles.glsl"

uint seed_count()
{
    return landing_count() + state.active_count + tick.blade_count * VIRGA_GLASS_BINS + tick.sites + tick.fog_sites;
}

#define NO_RANK 0x7fffffffu
#define JOINS 0x80000000u // with the slot of the drop that the water joins
