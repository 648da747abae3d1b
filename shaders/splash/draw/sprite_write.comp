// sprite_write.comp - writes a sprite for each entry of the list: its position on the picture, and its light.
// One invocation per entry. Reads: the list, droplets, splashes, the view. Writes: sprites, motions.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#define IN_FORMS
#include "sprite.glsl"
#include "gpu/light.glsl"
#include "torn.glsl"
#include "compact.glsl"
#include "gpu/compact_buffers.glsl"
#include "view_lists.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;
const bool FULL = (FORM & uint(VIRGA_SPLASH_FORM_FULL)) != 0u;
// Four texels for each of `max_sprites` virga_sprite_gpu, behind them a texel for each one's motion.
layout(scalar, set = 0, binding = 13) writeonly buffer Sprites { uvec4 sprites[]; };

// A droplet is a lens: near its middle rays are deflected by up to 16 degrees, at its rim by 50 and more (Legendre
// moments: their cosines).
uvec3 light_of(vec3 middle, float torn)
{
    const vec3 d = normalize(middle);
    const vec2 at_rim = vec2(view.phase_moment[1], view.phase_moment[2]) * vec2(0.75, 0.3);
    const vec3 glitter = FULL ? lamps(middle, d) : vec3(0.0);
    const vec3 center = torn_light(environment(d, vec2(0.97, 0.90)), torn) + glitter;
    const vec3 rim = torn_light(environment(d, at_rim), torn) + 0.6 * glitter;
    return uvec3(halves(center.r, center.g), halves(center.b, rim.r), halves(rim.g, rim.b));
}

// Light has met many droplets before it leaves a cloud, and comes from nearly everywhere.
uvec3 light_of_cloud(vec3 middle)
{
    const vec3 d = normalize(middle);
    const vec3 light = environment(d, vec2(0.5, 0.2)) + (FULL ? lamps(middle, d) : vec3(0.0));
    return uvec3(halves(light.r, light.g), halves(light.b, light.r), halves(light.g, light.b));
}

// Motion of both ends since the previous frame. Something that did not exist then comes from where it began.
void write_motion(uint index, Slot slot, Sprite sprite)
{
    const mat4 now = to_mat(view.clip_from_rel), previous = to_mat(view.previous_clip_from_rel);
    const Sprite before = sprite_of(slot, view.frame_interval_s);
    sprites[4u * look.max_sprites + index] =
        floatBitsToUint(vec4(motion_px(project(now, sprite.head), project(previous, before.head)),
                             motion_px(project(now, sprite.tail), project(previous, before.tail))));
}

void main()
{
    const uint index = unwritten(lists[SPRITES]) + gl_GlobalInvocationID.x;
    if (index >= lists[SPRITES].count)
        return;
    const Slot slot = slot_of(listed[index]);
    const Sprite sprite = sprite_of(slot, 0.0);
    const Projected p = project_sprite(sprite);
    const vec3 head = p.head.xyz / p.head.w, tail = p.tail.xyz / p.tail.w;
    const bool puff = sprite.kind == VIRGA_SPRITE_PUFF;
    const float tail_px = max(pixels(sprite.widths.y, p.tail.w), view.min_width_px);
    const float head_px = puff ? p.body_px : max(pixels(sprite.widths.x, p.head.w), view.min_width_px);
    const uint widths = halves(head_px + p.spread_px, puff ? p.sine : tail_px);
    const uint shares = puff ? halves(p.one_share, p.columns + 32.0 * p.rows) : halves(sprite.solid, 1.0);
    const vec3 middle = 0.5 * (sprite.head + sprite.tail);
    const uvec3 light =
        sprite.kind == VIRGA_SPRITE_CLOUD ? light_of_cloud(middle) : light_of(middle, torn_of(sprite.kind));
    sprites[4u * index] = floatBitsToUint(vec4(head.xy, tail.xy));
    sprites[4u * index + 1u] = floatBitsToUint(vec4(head.z, tail.z, p.head.w, p.tail.w));
    sprites[4u * index + 2u] = uvec4(widths, halves(p.coverage, p.body_px), light.xy);
    sprites[4u * index + 3u] = uvec4(light.z, sprite.kind, shares, sprite.id);
    if (FULL && look.motion != 0u)
        write_motion(index, slot, sprite);
}
