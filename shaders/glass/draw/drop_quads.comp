// drop_quads.comp - drops that are drawn as textures: a quad for each, in the order of the list of live slots.
// One invocation per live slot. Reads: the live list, drops, nodes. Writes: quads, index buffer, draw arguments.
// Paper: Sato, Dobashi and Yamamoto 2002, section 3.4.
//
// A drop is a disc on the picture, or an ellipse where the pane leans: the pane is flat over so short a way. With the
// Jacobian J of the projection, in pixels per radius, its area is pi |det J|. The quad is half a pixel wider on each
// side, for the soft rim. A drop with a radius of less than half a pixel has no rim: its area is spread over two by two
// pixels, by the distance from its middle, so that it neither flickers nor gains or loses water to the eye.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "drop_size.glsl"

layout(local_size_x = VIRGA_GLASS_GROUP) in;
layout(scalar, set = 0, binding = 1) readonly buffer Drops { virga_glass_drop_gpu drops[]; };
layout(scalar, set = 0, binding = 10) readonly buffer List
{
    virga_list_gpu list;
    uint listed[];
};
layout(scalar, set = 0, binding = 18) buffer Work { virga_glass_work_gpu work; };
layout(scalar, set = 0, binding = 19) writeonly buffer Corners { uint corners[]; };
layout(scalar, set = 0, binding = 22) readonly buffer State { virga_glass_state_gpu state; };

#define POINT_PX 0.5         // radius of a drop without a rim
#define MIXED vec2(0.6, 1.0) // part of the way from a level to the next in which both are mixed

// Pixels per unit along a direction from a point, both in clip space.
vec2 pixels_along(vec4 clip, vec4 direction)
{
    return 0.5 * (direction.xy - clip.xy / clip.w * direction.w) / clip.w * vec2(view.viewport[2], view.viewport[3]);
}

// The coarsest level that has a texel for each pixel of a drop with this radius; towards the next one both are mixed.
float level_of(float radius_px)
{
    const float level = clamp(log2(float(look.texture_texels) / (2.0 * max(radius_px, 1e-6))), 0.0,
                              float(VIRGA_GLASS_TEXTURE_LEVELS - 1));
    return floor(level) + smoothstep(MIXED.x, MIXED.y, fract(level));
}

virga_glass_quad_gpu quad_at(vec2 middle, float radius_m, vec4 clip, vec4 along_u, vec4 along_v, float alpha)
{
    const vec2 u_px = pixels_along(clip, along_u), v_px = pixels_along(clip, along_v);
    const float area = abs(u_px.x * v_px.y - u_px.y * v_px.x), radius_px = sqrt(area);
    const float longest = max(max(length(u_px), length(v_px)), 1e-6);
    const bool point = radius_px < POINT_PX;
    float size = 1.0 + 0.5 * longest / max(area, 1e-6); // half the ellipse is at least area / longest wide
    if (point) {
        along_u = vec4(2.0 / view.viewport[2] * clip.w, 0.0, 0.0, 0.0);
        along_v = vec4(0.0, 2.0 / view.viewport[3] * clip.w, 0.0, 0.0);
        size = 1.0;
        alpha *= 3.14159265 * area;
    } else // a rim that is linear over a pixel covers pi (r^2 + 1/12)
        alpha *= area / (area + 1.0 / 12.0);
    return virga_glass_quad_gpu(float[4](clip.x, clip.y, clip.z, clip.w),
                                float[4](along_u.x, along_u.y, along_u.z, along_u.w),
                                float[4](along_v.x, along_v.y, along_v.z, along_v.w), float[2](middle.x, middle.y),
                                radius_m, min(size, 64.0), alpha, level_of(radius_px), point ? 1u : 0u, 0u);
}

void write_quad(uint at, virga_glass_quad_gpu quad)
{
    const uint words[VIRGA_GLASS_QUAD_WORDS] = uint[](
        floatBitsToUint(quad.clip[0]), floatBitsToUint(quad.clip[1]), floatBitsToUint(quad.clip[2]),
        floatBitsToUint(quad.clip[3]), floatBitsToUint(quad.along_u[0]), floatBitsToUint(quad.along_u[1]),
        floatBitsToUint(quad.along_u[2]), floatBitsToUint(quad.along_u[3]), floatBitsToUint(quad.along_v[0]),
        floatBitsToUint(quad.along_v[1]), floatBitsToUint(quad.along_v[2]), floatBitsToUint(quad.along_v[3]),
        floatBitsToUint(quad.middle[0]), floatBitsToUint(quad.middle[1]), floatBitsToUint(quad.radius_m),
        floatBitsToUint(quad.size), floatBitsToUint(quad.alpha), floatBitsToUint(quad.level), quad.point, 0u);
    for (uint i = 0u; i < VIRGA_GLASS_QUAD_WORDS; i++)
        corners[at + i] = words[i];
}

// The triangle around the drop; with nothing to draw, one that is a point.
void write_indices(uint i, bool shown)
{
    for (uint corner = 0u; corner < 3u; corner++)
        corners[look.quads_offset + 3u * i + corner] = shown ? 3u * i + corner : 0u;
}

void main()
{
    const uint i = gl_GlobalInvocationID.x, slot = listed[min(i, look.pane.max_drops - 1u)];
    if (i == 0u)
        work.quads = virga_glass_corners_gpu(3u * state.shown, 1u, look.quads_offset, 0, 0u);
    const virga_glass_drop_gpu drop = drops[slot];
    const uint kind = drop.kind & VIRGA_GLASS_KIND;
    const float radius_m = kind == VIRGA_GLASS_PARTICLE ? look.particle_m : cap_radius(float(drop.water_nl));
    const vec2 middle = mix(vec2(drop.previous_position[0], drop.previous_position[1]),
                            vec2(drop.position[0], drop.position[1]), look.share);
    const Frame pane = frame_on(middle);
    const vec4 clip = clip_of_pane(pane.position, 1.0);
    const float alpha = clip.w > 0.0 ? texture_alpha(relative_size(radius_m, clip.w)) : 0.0;
    if (i >= state.shown)
        return;
    const bool shown = kind != VIRGA_GLASS_FREE && alpha > 0.0;
    write_indices(i, shown);
    if (shown)
        write_quad(look.quads_offset + 3u * (look.pane.max_drops + 2u) + VIRGA_GLASS_QUAD_WORDS * i,
                   quad_at(middle, radius_m, clip, clip_of_pane(pane.along_u, 0.0) * radius_m,
                           clip_of_pane(pane.along_v, 0.0) * radius_m, alpha));
}
