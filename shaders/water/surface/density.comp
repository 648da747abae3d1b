// density.comp - the density of the water at each particle (equations 1 and 2 of Iwasaki et al. 2006): the sum of the
// density functions of all particles around it, its own included. 1 is inside the water. Particles with a low density
// are near the surface; they mark the cells that the surface may run through.
// One invocation per sorted particle. Reads: sorted, cell_starts. Writes: densities, cell_marks.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/marks.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 15) writeonly buffer Densities { float densities[]; };

vec3 here;
float sum, inv_h2;

void visit(vec4 particle)
{
    const vec3 apart = particle.xyz - here;
    const float x = max(1.0 - dot(apart, apart) * inv_h2, 0.0);
    sum += particle.w * (x * x * x);
}
#include "water/gather.glsl"

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    if (own >= grid.sorted)
        return;
    here = uintBitsToFloat(sorted_texel(own)).xyz;
    sum = 0.0;
    inv_h2 = frame.inv_h2;
    const uint cell = cell_at(here);
    gather(cell);
    const float density = frame.kernel * sum;
    densities[sorted_indices[own]] = density;
    if (density < frame.full)
        atomicOr(cell_marks[cell], reached_cells(here * frame.inv_cell_m));
}
