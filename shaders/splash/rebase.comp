// rebase.comp - the anchor of positions has moved: all of them count from the new one.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "state.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

float[3] shifted(float position[3])
{
    return float[3](position[0] + tick.shift[0], position[1] + tick.shift[1], position[2] + tick.shift[2]);
}

void main()
{
    const uint place = gl_GlobalInvocationID.x;
    if (place < tick.max_splashes)
        splashes[place].position = shifted(splashes[place].position);
    if (place < tick.max_droplets) {
        droplets[place].position = shifted(droplets[place].position);
        droplets[place].base = shifted(droplets[place].base);
    }
}
