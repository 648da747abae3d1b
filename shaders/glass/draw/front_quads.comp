// front_quads.comp - drops on the camera's front element: a quad for each, around the disc that it becomes out of focus
// (front_overlap.glsl). The drop faces the camera and is flat: the middle of its base says where it is.
// One invocation per live slot. Reads: the live list, drops, nodes. Writes: quads, index buffer, draw arguments.
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

#define WHOLE     1e4   // radius of an opening that is all behind a drop, in radii of the drop
#define NEAREST_M 0.001 // from the opening; what is nearer is not drawn

// k R of front_overlap.glsl. At least half a pixel, so that a drop before a pinhole has a rim of a pixel.
float opening_m(float away_m)
{
    const float opening = 0.5 * view.lens_px * view.pixel_angle * abs(1.0 - away_m * view.inv_focus);
    return max(opening, 0.5 * away_m * view.pixel_angle);
}

// In clip space at a view depth of 1, in the middle of the depth range: so near a drop is before everything, also
// where the near plane is behind it.
void write_quad(uint i, vec2 at, vec2 scale, vec2 middle, float radius_m, float size, float opening, float veil)
{
    const uint first = look.quads_offset + 3u * (look.pane.max_drops + 2u) + VIRGA_GLASS_QUAD_WORDS * i;
    const float words[VIRGA_GLASS_QUAD_WORDS] =
        float[](at.x, at.y, 0.5, 1.0, scale.x, 0.0, 0.0, 0.0, 0.0, scale.y, 0.0, 0.0, middle.x, middle.y, radius_m,
                size, opening, veil, 0.0, 0.0);
    for (uint word = 0u; word < VIRGA_GLASS_QUAD_WORDS; word++)
        corners[first + word] = floatBitsToUint(words[word]);
}

void write_drop(uint i, vec2 middle, float radius_m, vec4 clip)
{
    const float opening = opening_m(clip.w) / radius_m;
    const vec2 scale = radius_m / clip.w / vec2(length(to_vec(view.right)), length(to_vec(view.up)));
    write_quad(i, clip.xy / clip.w, scale, middle, radius_m, 1.0 + opening, opening, 0.0);
}

void write_indices(uint i, bool shown)
{
    for (uint corner = 0u; corner < 3u; corner++)
        corners[look.quads_offset + 3u * i + corner] = shown ? 3u * i + corner : 0u;
}

// After all drops: over the whole picture, as if a drop at the pane's middle were before all of the opening. The
// triangle around a circle of radius 1.5 holds the square from -1 to 1. `share`: of the veil; less than 0: of the
// streaks.
void write_whole(uint i, float share)
{
    const vec2 middle = 0.5 * vec2(look.pane.width_m, look.pane.height_m);
    write_indices(i, true);
    write_quad(i, vec2(0.0), vec2(1.0), middle, 1.0, 1.5, WHOLE, share);
}

void write_counts()
{
    const uint veils = look.veil > 0.0 ? 1u : 0u, streaks = look.starburst > 0.0 ? 1u : 0u;
    work.quads = virga_glass_corners_gpu(3u * (state.shown + veils + streaks), 1u, look.quads_offset, 0, 0u);
    if (veils > 0u)
        write_whole(state.shown, look.veil);
    if (streaks > 0u)
        write_whole(state.shown + veils, -look.starburst);
}

void main()
{
    const uint i = gl_GlobalInvocationID.x, slot = listed[min(i, look.pane.max_drops - 1u)];
    if (i == 0u)
        write_counts();
    if (i >= state.shown)
        return;
    const virga_glass_drop_gpu drop = drops[slot];
    const uint kind = drop.kind & VIRGA_GLASS_KIND;
    const float radius_m = kind == VIRGA_GLASS_PARTICLE ? look.particle_m : cap_radius(float(drop.water_nl));
    const vec2 middle = mix(vec2(drop.previous_position[0], drop.previous_position[1]),
                            vec2(drop.position[0], drop.position[1]), look.share);
    const vec4 clip = clip_of_pane(frame_on(middle).position, 1.0);
    const bool shown = kind != VIRGA_GLASS_FREE && radius_m > 0.0 && clip.w > NEAREST_M;
    write_indices(i, shown);
    if (shown)
        write_drop(i, middle, radius_m, clip);
}
