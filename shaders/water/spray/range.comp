// range.comp - where the surfels of the droplets are: after those of the surface, as far as there is room.
// One invocation. Reads and writes: state.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "water/list_groups.glsl"

layout(local_size_x = 1) in;

void main()
{
    const uint wanted = state.droplets * VIRGA_WATER_DROPLET_SURFELS;
    const uint count = min(wanted, frame.max_surfels - state.surfels);
    state.first_spray_surfel = state.surfels;
    state.spray_surfels = count;
    state.spray_surfel_groups = uint[3]((count + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, 1u, 1u);
    state.surfels_wanted += wanted;
    state.surfels += count;
    state.surfel_groups = uint[3]((state.surfels + VIRGA_WATER_LANES - 1u) / VIRGA_WATER_LANES, 1u, 1u);
}
