// picture_corner_light.glsl - what a corner tells the pixels that show water by Snell, or its mist: directions and
// light.
// After gpu/light.glsl and picture_corner.glsl.
#include "picture_copies.glsl"
#include "picture_mode.glsl"

layout(location = 2) out vec3 along_u;
layout(location = 3) out vec3 along_v;
layout(location = 4) out vec3 mist_light;

// Water too small to show a shape: each drop is a lens that shows all of the world before the pane.
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
}
