// rebase.comp - the anchor of positions has moved: all positions become relative to the new one.
// One invocation per slot. Reads: tick. Writes: droplets, splashes.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

uvec3 shifted(uvec3 position) { return floatBitsToUint(uintBitsToFloat(position) + to_vec(tick.shift)); }

void main()
{
    const uint slot = gl_GlobalInvocationID.x;
    if (slot < tick.max_splashes)
        splashes[4u * slot].xyz = shifted(splashes[4u * slot].xyz);
    if (slot < tick.max_droplets) {
        droplets[4u * slot].xyz = shifted(droplets[4u * slot].xyz);
        droplets[4u * slot + 2u].xyz = shifted(droplets[4u * slot + 2u].xyz); // its base
    }
}
