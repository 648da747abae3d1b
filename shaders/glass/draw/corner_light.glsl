// corner_light.glsl - outputs of a vertex for pixels that show water by Snell, or mist: directions and light. Include
// it after gpu/light.glsl and corner.glsl.
#include "copies.glsl"
#include "mode.glsl"

layout(location = 2) out vec3 along_u;
layout(location = 3) out vec3 along_v;
layout(location = 4) out vec3 mist_light;

// Constants of the view, see corner.glsl.
layout(location = 8) flat out vec4 tint_given; // a: color_given of the view
layout(location = 9) flat out vec4 clip_xy[2]; // view.clip_from_rel, column by column
layout(location = 11) flat out vec4 clip_w;
layout(location = 12) flat out uint view_texel;
layout(location = 13) flat out vec2 gain_angle; // x: look.gain, y: angle of a pixel

// Light of mist: each drop is a lens that shows all of the world in front of the pane.
vec3 shown_by_mist()
{
    if (!HAS_PLATE)
        return 0.85 * to_vec(look.tint) * environment(normalize(position), vec2(1.0));
    const vec2 uv = clamp(0.5 * gl_Position.xy / max(gl_Position.w, 1e-5) + 0.5, vec2(0.0), vec2(1.0));
    return 0.85 * to_vec(look.tint) * copy_at(uv, VIRGA_GLASS_COPY_LEVELS - 2);
}

void light_corner(Corner corner)
{
    along_u = corner.along_u;
    along_v = corner.along_v;
    mist_light = shown_by_mist();
    const mat4 clip = to_mat(view.clip_from_rel);
    view_texel = look.view_texel;
    gain_angle = vec2(look.gain, view.pixel_angle);
    tint_given = vec4(to_vec(look.tint), view.color_given);
    clip_xy = vec4[2](vec4(clip[0].xy, clip[1].xy), vec4(clip[2].xy, clip[3].xy));
    clip_w = vec4(clip[0].w, clip[1].w, clip[2].w, clip[3].w);
}
