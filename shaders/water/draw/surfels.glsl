// surfels.glsl - the surfels of the newest step.
#include "water/octahedron.glsl"
#include "water/packed_share.glsl"
#include "gpu/texels.glsl"
TEXELS(surfel_texel, 3, 2)
#define STATE_ACCESS readonly
#include "water/state.glsl"

struct Surfel {
    vec3 position; // relative to the camera
    vec3 normal;
    vec3 velocity;
    float radius;
    float area; // of the surface that it stands for
    float droplet; // radius of its droplet; 0: it is of the surface
    float turn;    // of those of a droplet: which ones become specks first, see splats.glsl
    float share; // how much of its droplet or of the water around it is there, see virga_particle_gpu
};

// Surfels are made where the surface crosses edges of a grid, so there are |x| + |y| + |z| of them for each square of
// the grid's step on a surface with the normal (x, y, z).
float share_of_surface(float radius, vec3 normal)
{
    const float step_m = radius / VIRGA_WATER_SURFEL_STEPS;
    return step_m * step_m / (abs(normal.x) + abs(normal.y) + abs(normal.z));
}

// A droplet has the same number of surfels, whatever its radius. See spray/surfel.comp.
float share_of_droplet(float radius)
{
    const float droplet = radius / VIRGA_WATER_DROPLET_SURFEL;
    return 4.0 * 3.14159265 * droplet * droplet / float(VIRGA_WATER_DROPLET_SURFELS);
}

// A particle that appears or vanishes has a share of its volume, and so have its droplets. Drawn with that volume, half
// of the diameter would be there with an eighth of the share: the pixels in the middle would change all at once. So a
// droplet is drawn as large as it is when all is there, and covers as much as its share; see splats.glsl.
#define MIN_SHARE 1e-3

void grow_to_whole(inout Surfel s)
{
    const float growth = pow(clamp(s.share, MIN_SHARE, 1.0), -1.0 / 3.0);
    s.position += s.normal * (s.droplet * (growth - 1.0));
    s.droplet *= growth;
    s.radius *= growth;
    s.area *= growth * growth;
}

Surfel surfel_at(uint index)
{
    const uvec4 one = surfel_texel(2u * index), two = surfel_texel(2u * index + 1u);
    Surfel s;
    s.velocity = uintBitsToFloat(two.xyz);
    s.position = uintBitsToFloat(one.xyz) + to_vec(view.origin_offset);
    s.normal = unpack_octahedron(one.w);
    s.radius = uintBitsToFloat(two.w);
    const bool of_surface = index < state.first_spray_surfel;
    s.area = of_surface ? share_of_surface(s.radius, s.normal) : share_of_droplet(s.radius);
    s.droplet = of_surface ? 0.0 : s.radius / VIRGA_WATER_DROPLET_SURFEL;
    const uint of_spray = max(index, state.first_spray_surfel) - state.first_spray_surfel;
    s.turn = (float(of_spray % VIRGA_WATER_DROPLET_SURFELS) + 0.5) / float(VIRGA_WATER_DROPLET_SURFELS);
    s.share = share_in(two.w);
    if (s.share < 1.0 && !of_surface)
        grow_to_whole(s);
    return s;
}
