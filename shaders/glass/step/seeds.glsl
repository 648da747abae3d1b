// seeds.glsl - what wants a place at the end of a tick, in this order: drops that land (of the rate, then the host's),
// what each awake place left behind, what blades' bins give away.
#include "particles.glsl"

uint seed_count() { return landing_count() + state.awake + tick.blade_count * VIRGA_GLASS_BINS; }

#define NO_RANK 0x7fffffffu
#define JOINS   0x80000000u // with the place of the drop that the water joins
