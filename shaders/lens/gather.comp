// gather.comp - the scene out of focus. For each texel, all samples whose circle of confusion reaches it, see
// gather.glsl.
//
// Discs up to VIRGA_LENS_FINE texels are gathered from the samples one by one, wider ones from blocks, see levels.glsl.
// At half resolution it works on one list of tiles after the other.
// One invocation per texel. Reads: samples, spreads, blocks, aperture, reaches, lists, that layer. Writes: fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#include "blocks.glsl"
#include "lists.glsl"
#include "on_scene.glsl"

const bool NEAR = (OWN_FORM & VIRGA_LENS_NO_NEAR) == 0u;
const bool ON_SCENE = (OWN_FORM & VIRGA_LENS_ON_SCENE) != 0u; // a layer lies on the scene

layout(push_constant) uniform List { uint kind; }; // at half resolution
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8) uniform sampler2D samples;
layout(set = 0, binding = 25) uniform sampler2D spreads;
layout(std430, set = 0, binding = 10) readonly buffer Reaches { vec4 reaches[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

int row_of(ivec2 texel) { return 0; }
vec4 sample_in(int row, ivec2 texel) { return texelFetch(samples, inside(texel), 0); }
float spread_in(int row, ivec2 texel) { return texelFetch(spreads, inside(texel), 0).r; }

#define CORNERS_ARE_READ false
void write_field(ivec3 at, vec4 value) { imageStore(fields, at, value); }
#include "gather.glsl"

void main()
{
    const ivec2 first = HALVED ? listed_first(kind) : ivec2(gl_WorkGroupID.xy) * 8;
    const ivec2 texel = first + ivec2(gl_LocalInvocationID.xy);
    if (first.x < 0 || texel.x >= int(view.columns) || texel.y >= int(view.rows))
        return;
    const vec4 reach = reaches[tile_of(texel)];
    gather_texel(texel, reach.xy, uint(reach.a), vec4(0.0));
}
