// returns.glsl - water that falls back, as impacts for the ground.
#include "shared/impact.h"

layout(scalar, set = 0, binding = 9) writeonly buffer Returns
{
    virga_impacts_gpu returns_head;
    uvec4 returns[]; // four a virga_impact_gpu
};

void write_return(uint place, vec3 position, vec3 velocity, float diameter_m, uint id, uint material, uint water_nl)
{
    returns[4u * place] = uvec4(floatBitsToUint(position), 0u); // its time
    returns[4u * place + 1u] = floatBitsToUint(vec4(velocity, diameter_m));
    returns[4u * place + 2u] = floatBitsToUint(vec4(0.0, 1.0, 0.0, 1.0)); // normal, weight
    returns[4u * place + 3u] = uvec4(id, material, water_nl, tick.tick);
}
