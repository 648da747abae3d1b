// density.comp - the density of the water at each particle (equations 1 and 2 of Iwasaki et al. 2006): the sum of the
// density functions of all particles around it, its own included. 1 is inside the water. Particles with a low density
// are near the surface, and so are those beside an empty cell, also in water that is compressed. They mark the cells
// that the surface may run through.
//
// For anisotropic kernels the same loop sums up how the neighbours lie around the particle: the mean of their offsets,
// and their covariance (equations 9 and 10 of Yu and Turk 2013), with the weights 1 - (r / h)^3 of equation 11.
// One invocation per sorted particle. Reads: sorted, cell_starts. Writes: densities, cell_marks; with anisotropic
// kernels also shifts and shapes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "water/grid.glsl"
#include "water/marks.glsl"
#include "water/kernels.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 8) writeonly buffer Densities { float densities[]; };

vec3 here;
float sum, inv_h2;
float weight_sum;
vec3 mean, squares, products; // sums of weighted offsets; of x^2, y^2, z^2; of x y, x z, y z

void visit(vec4 particle)
{
    const vec3 apart = particle.xyz - here;
    const float q2 = dot(apart, apart) * inv_h2, x = max(1.0 - q2, 0.0);
    sum += particle.w * (x * x * x);
    if (KERNEL == VIRGA_WATER_ANISOTROPIC) {
        const float weight = particle.w * max(1.0 - q2 * sqrt(q2), 0.0);
        const vec3 weighted = weight * apart;
        weight_sum += weight;
        mean += weighted;
        squares += weighted * apart;
        products += weighted.xxy * apart.yzz;
    }
}
#include "water/gather.glsl"

// Whether one of the 27 cells around a cell has no particles.
bool beside_empty_cell(uint cell)
{
    const uvec3 dims = grid_dims();
    bool empty = false;
    for (uint row = 0u; row < 9u; row++) {
        const uint middle = row_middle(cell, row, dims);
        uint start = cell_starts[middle - 1u];
        for (uint next = middle; next <= middle + 2u; next++) {
            const uint end = cell_starts[next];
            empty = empty || start == end;
            start = end;
        }
    }
    return empty;
}

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    if (own >= grid.sorted)
        return;
    here = uintBitsToFloat(sorted_texel(own)).xyz;
    sum = weight_sum = 0.0;
    mean = squares = products = vec3(0.0);
    inv_h2 = frame.inv_h2;
    const uint cell = cell_at(here);
    gather(cell);
    const float density = frame.kernel * sum;
    densities[sorted_indices[own]] = density;
    // A splash particle all alone has no part in the surface, and there is none around it.
    const bool alone = density < frame.spray_low && sum <= 1.01 * uintBitsToFloat(sorted_texel(own)).w;
    if ((density < frame.full || beside_empty_cell(cell)) && !alone)
        atomicOr(cell_marks[cell], reached_cells(here * frame.inv_cell_m));
    if (KERNEL == VIRGA_WATER_ANISOTROPIC) {
        const float share = 1.0 / max(weight_sum, 1e-20);
        mean *= share;
        squares = squares * share - mean * mean;
        products = products * share - mean.xxy * mean.yzz;
        shifts[own] = vec4(mean, weight_sum);
        shapes[2u * own] = vec4(squares, products.x);
        shapes[2u * own + 1u] = vec4(products.yz, 0.0, 0.0);
    }
}
