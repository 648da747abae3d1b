// sprite_corner.glsl - a sprite's record taken apart, and its four corners around its way on the picture, half a pixel
// wider than it is drawn.
//
// Vertices are pulled from the sprites by an ordinary index buffer: instances of four vertices cost software Vulkan
// half as much again.
layout(scalar, set = 0, binding = 13) readonly buffer Sprites { virga_sprite_gpu sprites[]; };

#ifdef MOTION
layout(scalar, set = 0, binding = 13) readonly buffer Motions { vec4 motions[]; }; // behind the sprites
layout(location = 5) noperspective out vec2 motion; // px
#endif

layout(location = 0) noperspective out vec4 place; // px from the middle line; px from the tail; view depth; -
layout(location = 1) flat out vec4 centre_alpha;
layout(location = 2) flat out vec4 rim_kind;
layout(location = 3) flat out vec4 shape;          // half widths at head and tail; way; length of the thing (px)
layout(location = 4) flat out vec4 turn;           // direction of its way on the picture; solid share; -

void set_corner(uint vertex)
{
    const virga_sprite_gpu sprite = sprites[vertex >> 2];
    const vec2 head = vec2(sprite.head[0], sprite.head[1]), tail = vec2(sprite.tail[0], sprite.tail[1]);
    const vec2 widths = unpackHalf2x16(sprite.widths), alpha_body = unpackHalf2x16(sprite.alpha_body);
    const vec2 light[3] = vec2[3](unpackHalf2x16(sprite.light[0]), unpackHalf2x16(sprite.light[1]),
                                  unpackHalf2x16(sprite.light[2]));
    const vec2 half_viewport = 0.5 * vec2(view.viewport[2], view.viewport[3]);
    const vec2 way = (head - tail) * half_viewport;
    const float way_px = length(way);
    const vec2 along = way_px > 1e-3 ? way / way_px : vec2(0.0, -1.0), side = vec2(-along.y, along.x);
    const bool at_head = (vertex & 2u) != 0u;
    // A droplet reaches half of itself beyond its way; what stands on the ground ends where it ends.
    const float widest = 0.5 * max(widths.x, widths.y) + 0.5;
    const float margin = sprite.kind == VIRGA_SPRITE_PILE ? 0.5 : sprite.kind == VIRGA_SPRITE_PUFF ? 0.5 : widest;
    const float own = sprite.kind == VIRGA_SPRITE_PILE ? 0.5 * (at_head ? widths.x : widths.y) + 0.5 : widest;
    const float across = (vertex & 1u) == 0u ? -own : own;
    const vec2 corner =
        (at_head ? head : tail) + (side * across + along * (at_head ? margin : -margin)) / half_viewport;
#ifdef MOTION
    const vec4 ends = motions[4u * look.max_sprites + (vertex >> 2)];
    motion = at_head ? ends.xy : ends.zw;
#endif
    place = vec4(across, at_head ? way_px + margin : -margin, sprite.distance[at_head ? 0 : 1], 0.0);
    centre_alpha = vec4(light[0], light[1].x, alpha_body.x);
    rim_kind = vec4(light[1].y, light[2], float(sprite.kind));
    shape = vec4(0.5 * widths, way_px, alpha_body.y);
    turn = vec4(along, unpackHalf2x16(sprite.solid).x, 0.0);
    // The same w at all corners, so that everything is interpolated without perspective.
    gl_Position = vec4(corner, sprite.depth[at_head ? 0 : 1], 1.0);
}
