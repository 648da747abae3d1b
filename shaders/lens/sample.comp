// sample.comp - the scene as samples: color and circle of confusion of each texel of the work image, see sample.glsl.
//
// At half resolution it works on the list of tiles whose samples are read. Those of them that nothing reaches are in
// focus, and lie beside others, which read their fields.
// One invocation per texel. Reads: color, depth, state, reaches, lists, that layer. Writes: samples, spreads, fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "pixels.glsl"
#define SCENE_LINEAR ((OWN_FORM & VIRGA_LENS_LINEAR) != 0u)
#include "scene_color.glsl"
#include "spread.glsl"
#include "texels.glsl"
#include "sample.glsl"
#include "lists.glsl"
#include "on_scene.glsl"

const bool ON_SCENE = (OWN_FORM & VIRGA_LENS_ON_SCENE) != 0u; // a layer lies on the scene

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D samples;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image2D spreads;
layout(std430, set = 0, binding = 10) readonly buffer Reaches { vec4 reaches[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

void store_sharp(ivec2 texel, vec3 color)
{
    imageStore(fields, ivec3(texel, VIRGA_LENS_FAR), vec4(color, 0.0));
    imageStore(fields, ivec3(texel, VIRGA_LENS_NEAR), vec4(0.0));
    if (ON_SCENE)
        imageStore(fields, ivec3(texel, VIRGA_LENS_FIRST_LAYER + view.on_scene - 1u), on_scene_mean(texel));
}

void main()
{
    const ivec2 first = HALVED ? listed_first(VIRGA_LENS_TILES_SAMPLED) : ivec2(gl_WorkGroupID.xy) * 8;
    const ivec2 texel = first + ivec2(gl_LocalInvocationID.xy);
    if (first.x < 0 || texel.x >= int(view.columns) || texel.y >= int(view.rows))
        return;
    const texel_sample own = sample_of(texel);
    imageStore(samples, texel, vec4(own.color, own.radius));
    imageStore(spreads, texel, vec4(own.share * spread(own.radius), own.radius, 0.0, 0.0));
    if (HALVED && is_sharp(reaches[tile_of(texel)].xy))
        store_sharp(texel, own.color);
}
