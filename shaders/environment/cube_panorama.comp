// cube_panorama.comp - a panorama of the surroundings from a cube map.
// One invocation per texel. Reads: the cube map. Writes: the panorama.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define CUBE
#include "environment.glsl"
#include "panorama.glsl"

vec3 around(vec3 d, float spread)
{
    const float level = log2(spread * float(info.width) / (0.5 * PI)); // a face spans a quarter of a turn
    return light_of(textureLod(image, d * world_from_image(), max(level, 0.0)).rgb);
}
