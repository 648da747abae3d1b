// splat_mark.comp - the list of visible surfels, first pass: selects those that face the camera and are in the picture.
// One invocation per surfel. Reads: surfels. Writes: selection.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "view.glsl"
#include "surfels.glsl"
#define COMPACT_GROUP VIRGA_WATER_LANES
#define COMPACT_SELECTION_BINDING 4
#define COMPACT_LIST_BINDING 5
#include "gpu/compact_mark.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

bool is_visible(Surfel s)
{
    const vec4 clip = project(to_mat(view.clip_from_rel), s.position);
    const float reach = look.surfel_scale * s.radius, edge = 1.0 + 4.0 / float(min(look.width, look.height));
    // The factor of x and y: the ends of the axes of the camera's rays at the picture's borders.
    const vec2 wide = reach * vec2(inversesqrt(dot(to_vec(view.right), to_vec(view.right))),
                                   inversesqrt(dot(to_vec(view.up), to_vec(view.up))));
    // Also false for NaN.
    return s.radius > 0.0 && dot(s.normal, s.position) < 0.0 && clip.w > NEAR_W + 0.5 * reach &&
           all(lessThan(abs(clip.xy), edge * clip.w + wide + reach));
}

void main()
{
    const uint index = gl_GlobalInvocationID.x;
    bool selected = false;
    if (index < state.surfels)
        selected = is_visible(surfel_at(index));
    mark_selected(selected ? FIRST_KIND : NOT_SELECTED);
}
