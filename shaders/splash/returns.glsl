// returns.glsl - water that falls back, as impacts for the ground.
#include "shared/impact.h"

layout(scalar, set = 0, binding = 9) writeonly buffer Returns
{
    virga_impacts_gpu returns_head;
    virga_impact_gpu returns[];
};

virga_impact_gpu make_return(vec3 position, vec3 velocity, float diameter_m, uint id, uint material, uint water_nl)
{
    virga_impact_gpu impact;
    impact.position = float[3](position.x, position.y, position.z);
    impact.time_s = 0.0;
    impact.velocity = float[3](velocity.x, velocity.y, velocity.z);
    impact.diameter_m = diameter_m;
    impact.normal = float[3](0.0, 1.0, 0.0);
    impact.weight = 1.0;
    impact.id = id;
    impact.material = material;
    impact.water_nl = water_nl;
    impact.tick = tick.tick;
    return impact;
}
