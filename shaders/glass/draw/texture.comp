// texture.comp - textures of drops: a drop's picture at each point of a mesh over the pane.
// One invocation per texel of the textures that are made anew. Reads: nodes, the plate, its copies, the scene's depth.
// Writes: textures.
// Paper: Sato, Dobashi and Yamamoto 2002, sections 3.2 and 3.3.
//
// The drop is so small that the eye's rays to all of it are parallel, and its size does not matter. A texture covers
// the square around the drop's base, -1 to 1 radii along u and v. Each level has half the texels of the one before, a
// side, and shows the plate as blurred as a drop of so many pixels does. Texels beyond the rim repeat it, so that a
// filter never mixes in what is no water.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define PIXEL_HERE here_px
#define HAS_LAMPS true // a loop over no lamps costs nothing, and a pipeline less is built
vec2 here_px;
#include "view.glsl"
#include "gpu/light.glsl"
#include "drop_inputs.glsl"
#include "plate.glsl"
#include "path.glsl"
#include "drop_path.glsl"
#include "water_light.glsl"

layout(local_size_x = VIRGA_GLASS_TEXTURE_GROUP) in;
layout(set = 0, binding = 29, rgba16f) uniform writeonly image2D textures_out;

#define FOOTPRINT 0.7 // of a texel: the filter of the draw blurs, too
#define RIM 0.97       // radius of the outermost ray
#define MAX_HALF 6.0e4 // in a half float

// The paper shows the plate alone, without reflections (section 3.3).
vec3 drop_light(Path path, vec3 d)
{
    if (look.hemispheres != 0u)
        return to_vec(look.tint) * mix(1.0, TOTAL_SHARE, path.lost) *
               scene_light(path.ahead, path.pixel, path.out_of, path.pixels);
    return water_light(path, d, Water(1.0, 0.0, 0.0, 1.0, vec2(0.0), LENS.y));
}

void main()
{
    const uint side = look.texture_texels, each = side * side * 85u / 64u; // 1 + 1/4 + 1/16 + 1/64
    const uint i = gl_GlobalInvocationID.x, nth = i / each;
    if (nth >= look.textures)
        return;
    const uint number = (look.first_texture + nth) % (look.texture_columns * look.texture_rows);
    const uvec2 point = uvec2(number % look.texture_columns, number / look.texture_columns);
    uint rest = i % each, texels = side;
    for (uint level = 1u; level < VIRGA_GLASS_TEXTURE_LEVELS && rest >= texels * texels; level++) {
        rest -= texels * texels;
        texels /= 2u;
    }
    const uvec2 texel = uvec2(rest % texels, rest / texels);
    stand_at(vec2(point) / (vec2(look.texture_columns, look.texture_rows) - 1.0));
    const bool before_eye = on_picture(vec4(position, 1.0), here_px);
    here_px = clamp(before_eye ? here_px : view_box.xy, view_box.xy, view_box.xy + view_box.zw - 1.0);
    const vec2 offset = (vec2(texel) + 0.5) * 2.0 / float(texels) - 1.0;
    const vec2 at = offset * min(1.0, RIM / max(length(offset), 1e-6));
    const vec3 d = normalize(position);
    const vec3 light = drop_light(path_through_drop(at, d, FOOTPRINT * 2.0 / float(texels)), d);
    const uvec2 corner = point * uvec2(2u * side, side) + uvec2(2u * (side - texels), 0u);
    imageStore(textures_out, ivec2(corner + texel), vec4(min(light, MAX_HALF), 1.0));
}
