// bounds.comp - the box of cells that all particles are in.
// Each invocation takes BOUNDS_EACH particles. Reads: particles. Writes: the grid's state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define GRID_ACCESS
#include "particles/grid.glsl"

layout(local_size_x = VIRGA_GRID_LANES) in;

shared int group_low[3], group_high[3];
shared uint group_valid;

void main()
{
    const uint lane = gl_LocalInvocationIndex;
    if (lane < 3u) {
        group_low[lane] = VIRGA_GRID_COORDINATE;
        group_high[lane] = -VIRGA_GRID_COORDINATE;
    }
    if (lane == 3u)
        group_valid = 0u;
    barrier();
    ivec3 low = ivec3(VIRGA_GRID_COORDINATE), high = ivec3(-VIRGA_GRID_COORDINATE);
    uint valid = 0u;
    for (uint i = 0u; i < VIRGA_GRID_BOUNDS_EACH; i++) {
        const uint particle =
            (gl_WorkGroupID.x * VIRGA_GRID_BOUNDS_EACH + i) * VIRGA_GRID_LANES + lane;
        if (particle >= frame.particles)
            break;
        const vec3 p = to_vec(particles[particle].position);
        if (!is_valid(p))
            continue;
        const ivec3 cell = cell_of(p);
        low = min(low, cell);
        high = max(high, cell);
        valid++;
    }
    if (valid > 0u) {
        for (uint axis = 0u; axis < 3u; axis++) {
            atomicMin(group_low[axis], low[axis]);
            atomicMax(group_high[axis], high[axis]);
        }
        atomicAdd(group_valid, valid);
    }
    barrier();
    if (lane < 3u && group_valid > 0u) {
        atomicMin(grid.low[lane], group_low[lane]);
        atomicMax(grid.high[lane], group_high[lane]);
    }
    if (lane == 3u)
        atomicAdd(grid.valid, group_valid);
}
