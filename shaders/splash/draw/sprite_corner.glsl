// sprite_corner.glsl - the vertices of a sprite: its record unpacked, and the four corners of a quad around its path on
// the picture, half a pixel wider than it is drawn; or the two ends of a line of that width, for a droplet (see
// rain/draw/streak.glsl).
//
// Vertices are read from the sprites by an ordinary index buffer: instances of four vertices cost software Vulkan half
// as much again.
#include "gpu/line.glsl"
#include "gpu/texels.glsl"
#include "gpu/light.glsl"
#include "directions.glsl"
#include "sprite_form.glsl"
#include "torn.glsl"
#include "shared/random.h"
#include "puff_ring.glsl"
#include "puff_crowns.glsl"
#define SMALL_WATER_OUT
#include "small_water.glsl"

TEXELS(sprite_texel, 20, 13) // four texels per sprite; behind all of them a texel per motion

#ifdef MOTION
layout(location = 5) noperspective out vec2 motion; // px
#endif

// x: px from the center line; y: px from the tail; z: 1 / view depth, which is linear on the picture
layout(location = 0) noperspective out vec4 sprite_position;
layout(location = 1) flat out vec4 center_alpha;
layout(location = 2) flat out vec4 rim_kind;
// x, y: half widths at head and tail ((puff) y: radius of the ring over the half width); z: length of the path; w:
// length of the body (px)
layout(location = 3) flat out vec4 shape;
// Direction of the path on the picture. A puff: x: rows, and as fraction the fraction of its life; y: sine of the
// elevation; z: share; w: columns, and a random fraction. A line: see line_equation.
layout(location = 4) flat out vec4 axis_chance;

// Vertices from VIRGA_SPLASH_CROWN_VERTEX on are those of crowns that are drawn one by one, an instance for each puff.
void set_corner(uint index)
{
    const bool is_crown = PUFFS && index >= uint(VIRGA_SPLASH_CROWN_VERTEX);
    const uint puff = (index - uint(VIRGA_SPLASH_CROWN_VERTEX)) / (4u * uint(VIRGA_SPLASH_MAX_CROWNS)) +
                      uint(gl_InstanceIndex);
    const uint vertex = is_crown ? 4u * puff + (index & 3u) : index;
    const uint texel = vertex & ~3u; // four corners and four texels per sprite
    const vec4 ends = uintBitsToFloat(sprite_texel(texel)), depths = uintBitsToFloat(sprite_texel(texel + 1u));
    const uvec4 shown = sprite_texel(texel + 2u), rest = sprite_texel(texel + 3u);
    const vec2 head = ends.xy, tail = ends.zw;
    const vec2 widths = unpackHalf2x16(shown.x), alpha_body = unpackHalf2x16(shown.y);
    const vec2 light[3] = vec2[3](unpackHalf2x16(shown.z), unpackHalf2x16(shown.w), unpackHalf2x16(rest.x));
    const uint kind = rest.y;
    const vec2 half_viewport = 0.5 * vec2(view.viewport[2], view.viewport[3]);
    const vec2 path = (head - tail) * half_viewport;
    const float path_px = length(path);
    const vec2 along = path_px > 1e-3 ? path / path_px : vec2(0.0, -1.0), side = vec2(-along.y, along.x);
    const bool at_head = (vertex & 2u) != 0u;
    // A droplet extends by half its length beyond its path; things on the ground end where they end.
    const float widest = 0.5 * max(widths.x, widths.y) + 0.5;
    const float margin = kind == VIRGA_SPRITE_PILE ? 0.5 : kind == VIRGA_SPRITE_PUFF ? 0.5 : widest;
    const float own = kind == VIRGA_SPRITE_PILE ? 0.5 * (at_head ? widths.x : widths.y) + 0.5 : widest;
    float across = LINES ? 0.0 : (vertex & 1u) == 0u ? -own : own, beyond = at_head ? margin : -margin;
    center_alpha = vec4(light[0], light[1].x, alpha_body.x);
    rim_kind = vec4(light[1].y, light[2], float(kind));
    shape = vec4(0.5 * widths, path_px, alpha_body.y);
    const vec2 shares = unpackHalf2x16(rest.z);
    const float random = float(rest.w & 1023u) / 1024.0, life = float(rest.w >> 10 & 1023u) / 1024.0;
    const float rows = floor(shares.y / 32.0);
    axis_chance = vec4(along, shares.x, shares.y - 32.0 * rows + random);
    if (kind == VIRGA_SPRITE_PUFF) {
        axis_chance.xy = vec2(rows + life, widths.y);
        shape.y = float(rest.w >> 20 & 255u) / 255.0;
    }
    float up = at_head ? 1.0 : 0.0; // of the way between both ends of the quad of all
    vec4 rect = vec4(0.0);
    if (is_crown) {
        rect = crown_rect(shape, axis_chance, (index >> 2) % uint(VIRGA_SPLASH_MAX_CROWNS), vec2(-own, -margin),
                          vec2(own, path_px + margin));
        across = (vertex & 1u) == 0u ? rect.x : rect.z;
        up = ((at_head ? rect.w : rect.y) + margin) / (path_px + 2.0 * margin);
        beyond = (at_head ? rect.w : rect.y) - (at_head ? path_px : 0.0);
    }
    const vec2 corner = (at_head ? head : tail) + (side * across + along * beyond) / half_viewport;
    sprite_position = vec4(across, (at_head ? path_px : 0.0) + beyond,
                           mix(1.0 / max(depths.w, 1e-6), 1.0 / max(depths.z, 1e-6), up), 0.0);
#ifdef MOTION
    const vec4 moved = uintBitsToFloat(sprite_texel(4u * look.max_sprites + (vertex >> 2)));
    motion = mix(moved.zw, moved.xy, up);
#endif
    if (LINES)
        axis_chance = vec4(line_equation(tail, side), 0.0);
    above_first = above_second = above_clear = above_hidden = lit_torn = vec4(0.0);
    const bool empty = is_crown && rect.x >= rect.z;
    // A loop, not a branch: software Vulkan skips a loop where no lane takes it.
    [[dont_unroll]] for (bool shows = view.color_given != 0u && !empty; shows; shows = false)
        set_small_water(0.5 * (head + tail), center_alpha.rgb, torn_of(kind));
    // w is 1 at all corners, so that everything is interpolated without perspective.
    gl_Position = vec4(corner, mix(depths.y, depths.x, up), 1.0);
}
