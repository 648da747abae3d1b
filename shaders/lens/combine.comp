// combine.comp - the picture: the scene and the layers over each other.
//
// At half resolution it works on one list of tiles after the other, and an invocation on the four pixels of a texel:
// with up to one layer they read between the same nine texels of the fields, each of which is fetched once.
// One invocation per pixel, or per texel of a list. Reads: color, depth, layers, fields, lists. Writes: the picture.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "lens.glsl"
#include "pixels.glsl"
#include "layers.glsl"

const uint LAYERS = OWN_FORM % (VIRGA_LENS_LAYERS + 1u);
const uint KIND = OWN_FORM / (VIRGA_LENS_LAYERS + 1u) % VIRGA_LENS_COMBINE_KINDS;
const bool ALL_SHARP = KIND == VIRGA_LENS_ALL_SHARP;
const bool NO_FAR = KIND == VIRGA_LENS_TILES_SHARP;
const bool NO_NEAR = KIND == VIRGA_LENS_TILES_FAR || NO_FAR;
const bool SOFT = false;
const bool LISTED = HALVED && !ALL_SHARP;

#define SCENE_LINEAR (OWN_FORM >= VIRGA_LENS_COMBINE_KINDS * (VIRGA_LENS_LAYERS + 1u))
#include "compose.glsl"
#include "stack.glsl"
#include "lists.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D picture;

void store_pixel(uvec2 at, composed sum)
{
    if (at.x < view.width && at.y < view.height)
        imageStore(picture, ivec2(at), end_pixel(sum));
}

void put_pixel(uvec2 at, vec4 behind, vec4 before)
{
    composed sum = begin_pixel(at, behind, before);
#define PUT(layer) put(layer, sum)
    FOR_LAYERS(PUT)
    store_pixel(at, sum);
}

// With up to one layer. There are four of these in the code, and compilers take as long as there is code.
void put_one_layer(uvec2 at, vec4 behind, vec4 before)
{
    composed sum = begin_pixel(at, behind, before);
    if (LAYERS == 1u)
        put(0u, sum);
    store_pixel(at, sum);
}

// A field at the four pixels of a texel. Their centres are a quarter of a texel from its own.
struct quad {
    vec4 pixels[4];
};

vec4 field_texel(ivec2 texel, uint which) { return texelFetch(fields, ivec3(inside(texel), which), 0); }

// To the left of a texel's centre, and to the right.
void read_row(ivec2 texel, uint which, out vec4 left, out vec4 right)
{
    const vec4 middle = field_texel(texel, which);
    left = mix(middle, field_texel(texel - ivec2(1, 0), which), 0.25);
    right = mix(middle, field_texel(texel + ivec2(1, 0), which), 0.25);
}

quad field_quad(ivec2 texel, uint which)
{
    vec4 left[3], right[3];
    read_row(texel - ivec2(0, 1), which, left[0], right[0]);
    read_row(texel, which, left[1], right[1]);
    read_row(texel + ivec2(0, 1), which, left[2], right[2]);
    return quad(vec4[4](mix(left[1], left[0], 0.25), mix(right[1], right[0], 0.25), mix(left[1], left[2], 0.25),
                        mix(right[1], right[2], 0.25)));
}

// The same without sharing: with more layers, four times all images are more than a card has scalar registers for.
void put_pixels(uvec2 at)
{
    [[dont_unroll]] for (uint i = 0u; i < 4u; i++) {
        const uvec2 pixel_at = at + uvec2(i & 1u, i >> 1u);
        look_at(min(pixel_at, uvec2(view.width, view.height) - 1u));
        vec4 behind = vec4(0.0), before = vec4(0.0);
        if (!NO_FAR)
            behind = field(VIRGA_LENS_FAR);
        if (!NO_NEAR)
            before = field(VIRGA_LENS_NEAR);
        put_pixel(pixel_at, behind, before);
    }
}

void put_texel(ivec2 texel)
{
    const uvec2 at = 2u * uvec2(texel);
    if (LAYERS > 1u) {
        put_pixels(at);
        return;
    }
    const quad none = quad(vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0)));
    quad behind = none, before = none;
    if (!NO_FAR)
        behind = field_quad(texel, VIRGA_LENS_FAR);
    if (!NO_NEAR)
        before = field_quad(texel, VIRGA_LENS_NEAR);
    put_one_layer(at, behind.pixels[0], before.pixels[0]);
    put_one_layer(at + uvec2(1u, 0u), behind.pixels[1], before.pixels[1]);
    put_one_layer(at + uvec2(0u, 1u), behind.pixels[2], before.pixels[2]);
    put_one_layer(at + uvec2(1u, 1u), behind.pixels[3], before.pixels[3]);
}

void main()
{
    if (LISTED) {
        const ivec2 first = listed_first(KIND);
        const ivec2 texel = first + ivec2(gl_LocalInvocationID.xy);
        if (first.x >= 0 && texel.x < int(view.columns) && texel.y < int(view.rows))
            put_texel(texel);
        return;
    }
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= view.width || at.y >= view.height)
        return;
    vec4 behind = vec4(0.0), before = vec4(0.0);
    if (!ALL_SHARP) {
        behind = texelFetch(fields, ivec3(at, VIRGA_LENS_FAR), 0);
        before = texelFetch(fields, ivec3(at, VIRGA_LENS_NEAR), 0);
    }
    put_pixel(at, behind, before);
}
