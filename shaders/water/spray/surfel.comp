// surfel.comp - the surface of the droplets, by rays from their centers (section 4.2 of Iwasaki et al. 2006: they are
// too small for the grid). On each ray the surface is where the sum of the densities of all droplets of the same
// particle falls to frame.spray_level. A droplet all alone has it at its radius; droplets that touch flow into one
// another. Rays that end inside another droplet have a surfel without area.
//
// Equation 4 with the radius h' = frame.spray_kernel R_s: W'' = frame.spray_factor (1 - (r / h')^2)^3.
// One invocation per surfel. Reads: droplets, splashes, particles. Writes: surfels.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "water/octahedron.glsl"
#include "water/packed_share.glsl"
#include "gpu/texels.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

layout(std430, set = 0, binding = 15) writeonly buffer Surfels { uvec4 surfels[]; };
TEXELS(droplet_texel, 16, 14)

// The splash particle of a droplet.
uint splash_of(uint droplet)
{
    uint first = 0u, end = state.splashes;
    while (first + 1u < end) {
        const uint middle = (first + end) >> 1;
        if (droplet_starts[middle] <= droplet)
            first = middle;
        else
            end = middle;
    }
    return first;
}

// The droplets of the same particle: their number is that of the particle's pieces, and they follow each other.
uvec2 family_of(uint splash)
{
    const uint start = droplet_starts[splash];
    return uvec2(start, min(start + splashes[splash_now(splash)].pieces, state.droplets));
}

// Density of a family at a position; w: density, xyz: its gradient.
vec4 density_at(vec3 position, uvec2 family)
{
    vec4 sum = vec4(0.0);
    for (uint i = family.x; i < family.y; i++) {
        const vec4 droplet = uintBitsToFloat(droplet_texel(2u * i));
        const float h = max(frame.spray_kernel * droplet.w, 1e-12), inv_h2 = 1.0 / (h * h);
        const vec3 apart = position - droplet.xyz;
        const float x = max(1.0 - dot(apart, apart) * inv_h2, 0.0);
        sum += frame.spray_factor * x * x * vec4(-6.0 * inv_h2 * apart, x);
    }
    return sum;
}

// Direction `i` of a droplet: points on a spiral over the sphere, with an angle of its own.
vec3 direction(uint i, uint id)
{
    const float z = 1.0 - (2.0 * float(i) + 1.0) / float(VIRGA_WATER_DROPLET_SURFELS);
    const float angle = 2.39996323 * float(i) + 6.28318531 * virga_unit(id);
    return vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z);
}

void main()
{
    const uint own = gl_GlobalInvocationID.x;
    if (own >= state.spray_surfels)
        return;
    const uint droplet = own / VIRGA_WATER_DROPLET_SURFELS, surfel = state.first_spray_surfel + own;
    const vec4 ball = uintBitsToFloat(droplet_texel(2u * droplet));
    const uvec4 motion = droplet_texel(2u * droplet + 1u);
    const uint splash = splash_of(droplet);
    const uvec2 family = family_of(splash);
    const float share = particles[splashes[splash_now(splash)].particle].share;
    const vec3 along = direction(own % VIRGA_WATER_DROPLET_SURFELS, motion.w);
    // The droplet's own density reaches the level at its radius and 0 at h'. What others add moves the surface
    // outwards.
    float low = ball.w, high = frame.spray_kernel * ball.w, radius = ball.w, size = VIRGA_WATER_DROPLET_SURFEL * ball.w;
    vec3 normal = along;
    if (family.y > family.x + 1u) {
        if (density_at(ball.xyz + high * along, family).w >= frame.spray_level)
            size = 0.0;
        for (uint i = 0u; i < 10u; i++) {
            const float middle = 0.5 * (low + high);
            if (density_at(ball.xyz + middle * along, family).w >= frame.spray_level)
                low = middle;
            else
                high = middle;
        }
        radius = low;
        const vec3 gradient = density_at(ball.xyz + radius * along, family).xyz;
        const float length2 = dot(gradient, gradient);
        normal = length2 > 1e-20 ? -gradient * inversesqrt(length2) : along;
    }
    surfels[2u * surfel] = uvec4(floatBitsToUint(ball.xyz + radius * along), pack_octahedron(normal));
    surfels[2u * surfel + 1u] = uvec4(motion.xyz, floatBitsToUint(with_share(size, share)));
}
