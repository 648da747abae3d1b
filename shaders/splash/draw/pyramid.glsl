// pyramid.glsl - piles and crowns as the paper draws them (Mizukami et al., figures 4 and 5): pyramids with four sides.
#include "splash/state.glsl"
#include "sprite.glsl"
#include "compact.glsl"
#include "gpu/compact_buffers.glsl"

layout(location = 0) out vec3 position;   // relative to the camera
layout(location = 1) flat out vec2 shade; // coverage; -
#ifdef MOTION
layout(location = 2) out vec3 before; // in the previous frame's clip coordinates: x, y, w
#endif

// A corner of a pyramid: 0 to 3 its foot, 4 its tip.
vec3 corner_of(vec3 base, vec3 tip, float half_foot, uint corner)
{
    const vec3 axis = distance(tip, base) > 1e-7 ? normalize(tip - base) : vec3(0.0, 1.0, 0.0);
    const vec3 side = normalize(abs(axis.y) > 0.7 ? vec3(axis.y, -axis.x, 0.0) : vec3(axis.z, 0.0, -axis.x));
    const vec3 across = look.handed * cross(axis, side); // so that faces are counter-clockwise from outside
    if (corner == 4u)
        return tip;
    return base + half_foot * (((corner + 1u) & 2u) == 0u ? side : -side) +
           half_foot * ((corner & 2u) == 0u ? across : -across);
}

// Both `ago_s` before the time that is drawn.
vec3 crown_corner(uint pyramid, uint corner, float ago_s)
{
    const uint slot = splash_slot(listed[look.max_sprites + pyramid / VIRGA_CROWN_PYRAMIDS]);
    if (slot == NO_SLOT)
        return vec3(0.0);
    const virga_splash_gpu splash = splash_of(slot);
    const Crown crown = crown_at(splash, view.time_close_s - ago_s);
    const uint spoke = pyramid % VIRGA_CROWN_PYRAMIDS;
    const float angle =
        6.2831853 * (float(spoke) + virga_unit(virga_hash2(crown.random, 5u))) / float(VIRGA_CROWN_PYRAMIDS);
    const vec3 side = normalize(abs(crown.normal.y) > 0.7 ? vec3(crown.normal.y, -crown.normal.x, 0.0)
                                                          : vec3(crown.normal.z, 0.0, -crown.normal.x));
    const vec3 outward = cos(angle) * side + sin(angle) * cross(side, crown.normal);
    // The paper's crown stays on its initial circle; in the physical mode it widens.
    const uint row = VIRGA_DROPLET_MATERIAL(splash.kind) * VIRGA_GROUND_STATES + VIRGA_DROPLET_STATE(splash.kind);
    const float radius = look.physical != 0u ? crown.radius : rules.rules[row].circle_radius * crown.diameter;
    const float height = crown.height * (0.8 + 0.4 * virga_unit(virga_hash2(crown.random, 32u + spoke)));
    const vec3 base = crown.center + radius * outward, tip = base + height * crown.normal + 0.35 * height * outward;
    return corner_of(base, tip, height > 0.0 ? 0.28 * crown.diameter : 0.0, corner);
}

vec3 pile_corner(uint pyramid, uint corner, float ago_s)
{
    const uint slot = slot_of(listed[pyramid]).item;
    if (slot == NO_SLOT)
        return vec3(0.0);
    const virga_droplet_gpu droplet = droplet_of(slot);
    const vec4 tip = pile_tip(droplet, view.time_close_s - ago_s);
    const float half_foot = droplet.diameter_m * (is_upright(droplet) ? 1.5 : 0.7);
    return corner_of(base_of(droplet), tip.xyz, half_foot * tip.w, corner);
}

vec3 pyramid_corner(uint pyramid, uint corner, float ago_s)
{
#ifdef CROWNS
    return crown_corner(pyramid, corner, ago_s);
#else
    return pile_corner(pyramid, corner, ago_s);
#endif
}

#include "gpu/own_view.glsl"

void main()
{
    const uint vertex = uint(gl_VertexIndex);
    position = pyramid_corner(vertex >> 3, vertex & 7u, 0.0);
#ifdef MOTION
    before =
        project(to_mat(view.previous_clip_from_rel), pyramid_corner(vertex >> 3, vertex & 7u, view.frame_interval_s))
            .xyw;
#endif
    shade = vec2(0.6 * min(look.gain, 1.6) * near_fade(position), 0.0);
    gl_Position = project(to_mat(view.clip_from_rel), position);
}
