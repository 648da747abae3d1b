// gather.comp - the scene out of focus. For each texel, all samples whose circle of confusion reaches it.
//
// In front of the focus, a sample covers every texel in its circle: the near field has a coverage of its own, and lies
// over the rest. Behind the focus, a sample is cut by what is nearer: it spreads no farther than the circle of the
// texel that it would cover, so nothing bleeds over a sharp edge in front of it. The far field is divided by the sum
// of its weights. Its fourth component is the near field's mean circle of confusion, which says what layers are in
// front of it. Where the near field hides the far field, the samples around fill in what the near blur uncovers.
//
// At half resolution a texel in focus has no far field of its own to show, as its pixels are shown as they are. Pixels
// behind it, at its edge, read between it and its neighbours. So it gets the far field that is behind it there, and
// neither is a dark edge of it around what is in focus, nor a hole.
//
// A layer that lies on the scene, as haze does, is spread by the same weights.
// At half resolution it works on one list of tiles after the other.
// One invocation per texel. Reads: samples, spreads, aperture, reaches, lists, that layer. Writes: fields.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "lens.glsl"
#include "aperture.glsl"
#include "pixels.glsl"
#include "lists.glsl"

const bool NEAR = (OWN_FORM & VIRGA_LENS_NO_NEAR) == 0u;
const bool ON_SCENE = (OWN_FORM & VIRGA_LENS_ON_SCENE) != 0u; // a layer lies on the scene

layout(push_constant) uniform List { uint kind; }; // at half resolution
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 8) uniform sampler2D samples;
layout(set = 0, binding = 25) uniform sampler2D spreads;
layout(set = 0, binding = 26) uniform sampler2D on_scene;
layout(std430, set = 0, binding = 10) readonly buffer Reaches { vec4 reaches[]; };
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2DArray fields;

// The sum of the coverage of a disc on the grid, about: exact enough for weights that are divided by their sum.
float disc_area(float radius) { return 3.14159265 * (radius * radius + 1.0 / 12.0) + 0.1; }

// Behind what is out of focus in front, the scene is not known: it is filled in from around, mostly from the nearest
// samples. Those that would reach this far by themselves count in full.
float nearness(ivec2 apart, float radius, float own)
{
    const float share = dot(vec2(apart), vec2(apart)) / max(radius * radius, 1.0);
    return own < -POINT ? 1.0 / max(share * share * share, 1.0) : 1.0;
}

// The nearest texel of the work image.
ivec2 inside(ivec2 texel) { return clamp(texel, ivec2(0), ivec2(view.columns, view.rows) - 1); }

// The mean of the pixels in a texel of the layer that lies on the scene.
vec4 on_scene_mean(ivec2 texel)
{
    vec4 sum = vec4(0.0);
    for (uint i = 0u; i < STEP * STEP; i++)
        sum += finite(texelFetch(on_scene, pixel_of(texel, i), 0));
    return sum / float(STEP * STEP);
}

// What is gathered of a field: the scene's color and weight, and the layer on it.
struct field_sum {
    vec4 scene, on;
};

// Each field has a loop of its own, because few tiles have both.
field_sum gather_near(ivec2 texel, float reach, barrel cut, out float circle_sum)
{
    field_sum sum = field_sum(vec4(0.0), vec4(0.0));
    const int rows = reach > POINT ? int(ceil(reach)) : -1;
    circle_sum = 0.0;
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(reach, y);
        for (int x = -columns; x <= columns; x++) {
            const ivec2 apart = ivec2(x, y), from = inside(texel + apart);
            const vec4 source = texelFetch(samples, from, 0);
            // Seen from the source, this texel is at -apart, and the image is upside down.
            const float weight =
                source.a < -POINT ? covers(apart, -source.a, cut) * texelFetch(spreads, from, 0).r : 0.0;
            sum.scene += weight * vec4(source.rgb, 1.0);
            circle_sum += weight * source.a;
            if (ON_SCENE)
                sum.on += weight * on_scene_mean(from);
        }
    }
    return sum;
}

field_sum gather_far(ivec2 texel, float own, float reach, barrel cut)
{
    field_sum sum = field_sum(vec4(0.0), vec4(0.0));
    const int rows = int(ceil(reach));
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(reach, y);
        for (int x = -columns; x <= columns; x++) {
            const ivec2 apart = ivec2(x, y), from = inside(texel + apart);
            const vec4 source = texelFetch(samples, from, 0);
            float radius = NEAR && own < -POINT ? max(source.a, -own) : min(source.a, max(own, POINT));
            float least = -POINT;
            if (HALVED && abs(own) <= POINT)
                radius = source.a, least = POINT;
            float weight = source.a >= least ? covers(-apart, radius, cut) / disc_area(max(radius, POINT)) : 0.0;
            if (NEAR)
                weight *= nearness(apart, source.a, own);
            sum.scene += weight * vec4(source.rgb, 1.0);
            if (ON_SCENE)
                sum.on += weight * on_scene_mean(from);
        }
    }
    return sum;
}

// The far field of a texel, with weights.
field_sum scene_behind(ivec2 texel, vec4 own, float reach, barrel cut)
{
    const bool in_focus = HALVED && abs(own.a) <= POINT;
    // A texel behind the focus is covered by nothing wider than its own circle; behind a near one it may be any.
    const float far_reach = own.a < -POINT ? max(reach, -own.a) : in_focus ? reach : max(own.a, POINT);
    field_sum sum = gather_far(texel, own.a, far_reach, cut);
    if (!in_focus)
        return sum;
    // From half a pixel on, its pixels are mixed with its own field, see compose.glsl.
    const float share = sum.scene.a > 0.0 ? smoothstep(0.5 * POINT, POINT, abs(own.a)) : 1.0;
    const float per_weight = sum.scene.a > 0.0 ? 1.0 / sum.scene.a : 0.0;
    sum.scene = mix(sum.scene * per_weight, vec4(own.rgb, 1.0), share);
    if (ON_SCENE)
        sum.on = mix(sum.on * per_weight, on_scene_mean(texel), share);
    return sum;
}

void store(ivec2 texel, vec4 far, vec4 near, vec4 on)
{
    imageStore(fields, ivec3(texel, VIRGA_LENS_FAR), far);
    imageStore(fields, ivec3(texel, VIRGA_LENS_NEAR), near);
    if (ON_SCENE)
        imageStore(fields, ivec3(texel, VIRGA_LENS_FIRST_LAYER + view.on_scene - 1u), on);
}

void main()
{
    const ivec2 first = HALVED ? listed_first(kind, TILE_GROUPS) : ivec2(gl_WorkGroupID.xy) * 8;
    const ivec2 texel = first + ivec2(gl_LocalInvocationID.xy);
    if (first.x < 0 || texel.x >= int(view.columns) || texel.y >= int(view.rows))
        return;
    const ivec2 tile = texel / VIRGA_LENS_TILE;
    const vec4 reach = reaches[tile.y * int(view.tile_columns) + tile.x];
    const vec4 own = texelFetch(samples, texel, 0);
    if (max(reach.x, reach.y) <= POINT) {
        store(texel, vec4(own.rgb, 0.0), vec4(0.0), ON_SCENE ? on_scene_mean(texel) : vec4(0.0));
        return;
    }
    const barrel cut = barrel_at(texel);
    float circle_sum = 0.0;
    field_sum near = field_sum(vec4(0.0), vec4(0.0));
    if (NEAR)
        near = gather_near(texel, reach.x, cut, circle_sum);
    const field_sum far = scene_behind(texel, own, reach.y, cut);
    const float near_circle = near.scene.a > 0.0 ? circle_sum / near.scene.a : 0.0;
    // Where there is nothing behind, or more than one near sample a texel, the near field is all.
    if (near.scene.a > 1.0 || far.scene.a == 0.0) {
        near.on /= near.scene.a;
        near.scene /= near.scene.a;
    }
    const float per_weight = far.scene.a > 0.0 ? 1.0 / far.scene.a : 0.0;
    store(texel, vec4(far.scene.rgb * per_weight, near_circle), near.scene,
          near.on + (1.0 - near.scene.a) * far.on * per_weight);
}
