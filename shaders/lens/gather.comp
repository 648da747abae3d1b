// gather.comp - the scene out of focus. For each texel, all samples whose circle of confusion reaches it.
//
// In front of the focus, a sample covers every texel in its circle: the near field has a coverage of its own, and lies
// over the rest. Behind the focus, a sample is cut by what is nearer: it spreads no farther than the circle of the
// texel that it would cover, so nothing bleeds over a sharp edge in front of it. The far field is divided by the sum
// of its weights. Its fourth component is the near field's mean circle of confusion, which says what layers are in
// front of it. Where the near field hides the far field, the samples around fill in what the near blur uncovers.
//
// A layer that lies on the scene, as haze does, is spread by the same weights.
// One invocation per texel. Reads: samples, spreads, aperture, reaches, that layer. Writes: fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "aperture.glsl"
#include "pixels.glsl"
#include "layers.glsl"

layout(constant_id = 0) const uint ON_SCENE = 0u; // 1: a layer lies on the scene

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8) uniform sampler2D samples;
layout(std430, set = 0, binding = 7) readonly buffer Spreads { float spreads[]; };
layout(std430, set = 0, binding = 10) readonly buffer Reaches { float reaches[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

#define POINT 0.5 // texels: a smaller circle of confusion is sharp

// The sum of the coverage of a disc on the grid, about: exact enough for weights that are divided by their sum.
float disc_area(float radius) { return 3.14159265 * (radius * radius + 1.0 / 12.0) + 0.1; }

// Behind what is out of focus in front, the scene is not known: it is filled in from around, mostly from the nearest
// samples. Those that would reach this far by themselves count in full.
float nearness(ivec2 apart, float radius, float own)
{
    const float share = dot(vec2(apart), vec2(apart)) / max(radius * radius, 1.0);
    return own < -POINT ? 1.0 / max(share * share * share, 1.0) : 1.0;
}

// Where the blur of the layer that lies on the scene goes.
ivec3 on_scene(ivec2 texel) { return ivec3(texel, VIRGA_LENS_FIRST_LAYER - 1u + view.on_scene); }

void main()
{
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy), last = ivec2(view.columns, view.rows) - 1;
    if (texel.x > last.x || texel.y > last.y)
        return;
    const ivec2 tile = texel / VIRGA_LENS_TILE;
    const float farthest = reaches[tile.y * int(view.tile_columns) + tile.x];
    const int reach = int(ceil(farthest));
    const vec4 own = texelFetch(samples, texel, 0);
    if (farthest <= POINT) {
        imageStore(fields, ivec3(texel, VIRGA_LENS_FAR), vec4(own.rgb, 0.0));
        imageStore(fields, ivec3(texel, VIRGA_LENS_NEAR), vec4(0.0));
        if (ON_SCENE != 0u)
            imageStore(fields, on_scene(texel), layer_mean(view.on_scene - 1u, texel));
        return;
    }
    vec4 far = vec4(0.0), near = vec4(0.0), far_on = vec4(0.0), near_on = vec4(0.0);
    float near_circle = 0.0;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            const ivec2 apart = ivec2(x, y), from = clamp(texel + apart, ivec2(0), last);
            const vec4 source = texelFetch(samples, from, 0);
            if (source.a < -POINT) {
                // Seen from the source, this texel is at -apart, and the image is upside down.
                const float covered = covers(apart, -source.a, texel);
                if (covered > 0.0) {
                    const float weight = covered * spreads[from.y * int(view.columns) + from.x];
                    near += weight * vec4(source.rgb, 1.0);
                    near_circle += weight * source.a;
                    if (ON_SCENE != 0u)
                        near_on += weight * layer_mean(view.on_scene - 1u, from);
                }
            } else {
                const float radius = own.a < -POINT ? max(source.a, -own.a) : min(source.a, max(own.a, POINT));
                const float covered = covers(-apart, radius, texel);
                if (covered > 0.0) {
                    const float weight = covered / disc_area(max(radius, POINT)) * nearness(apart, source.a, own.a);
                    far += weight * vec4(source.rgb, 1.0);
                    if (ON_SCENE != 0u)
                        far_on += weight * layer_mean(view.on_scene - 1u, from);
                }
            }
        }
    near_circle = near.a > 0.0 ? near_circle / near.a : 0.0;
    // Where there is nothing behind, or more than one near sample a texel, the near field is all.
    if (near.a > 1.0 || far.a == 0.0) {
        near_on /= near.a;
        near /= near.a;
    }
    const float per_weight = far.a > 0.0 ? 1.0 / far.a : 0.0;
    imageStore(fields, ivec3(texel, VIRGA_LENS_FAR), vec4(far.rgb * per_weight, near_circle));
    imageStore(fields, ivec3(texel, VIRGA_LENS_NEAR), near);
    if (ON_SCENE != 0u)
        imageStore(fields, on_scene(texel), near_on + (1.0 - near.a) * far_on * per_weight);
}
