// rebase.comp - the anchor of positions has moved: all of them count from the new one.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

uvec3 shifted(uvec3 position) { return floatBitsToUint(uintBitsToFloat(position) + to_vec(tick.shift)); }

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    if (place < tick.max_splashes)
        splashes[4u * place].xyz = shifted(splashes[4u * place].xyz);
    if (place < tick.max_droplets) {
        droplets[4u * place].xyz = shifted(droplets[4u * place].xyz);
        droplets[4u * place + 2u].xyz = shifted(droplets[4u * place + 2u].xyz); // its base
    }
}
