// returns.glsl - returns: water that falls back to the ground, as impacts.
#include "shared/impact.h"

layout(scalar, set = 0, binding = 9) writeonly buffer Returns
{
    virga_impacts_gpu returns_head;
    uvec4 returns[]; // four texels per virga_impact_gpu
};

// `material`: of the impact, with VIRGA_IMPACT_SPRAY and the pane.
void write_return(uint index, vec3 position, vec3 velocity, float diameter_m, uint id, uint material, uint water_nl)
{
    returns[4u * index] = uvec4(floatBitsToUint(position), 0u); // its time
    returns[4u * index + 1u] = floatBitsToUint(vec4(velocity, diameter_m));
    returns[4u * index + 2u] = floatBitsToUint(vec4(0.0, 1.0, 0.0, 1.0)); // normal, weight
    returns[4u * index + 3u] = uvec4(id, material, water_nl, tick.tick);
}
