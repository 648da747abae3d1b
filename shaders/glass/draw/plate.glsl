// plate.glsl - the plate behind the pane, looked up sharp, or in smaller copies where a drop shows much of
// it in little.
#include "copies.glsl"

layout(set = 0, binding = 16) uniform sampler2D scene_color;

vec2 plate_size() { return vec2(textureSize(scene_color, 0)); }

// The mean over about so many pixels a side around a place of the picture.
vec3 plate_at(vec2 pixel, float pixels)
{
    const vec2 uv = pixel / plate_size();
    const float copied = max(max(plate_size().x, plate_size().y) / float(VIRGA_GLASS_COPY), 1.0);
    const float level = log2(max(pixels / copied, 1e-3));
    // One copy, the nearest: drops are too small to show where one gives way to the next.
    const float sharp = copied > 1.0 ? clamp(-level / log2(copied), 0.0, 1.0) : level < 0.0 ? 1.0 : 0.0;
    const int nearest = clamp(int(level + 0.5), 0, VIRGA_GLASS_COPY_LEVELS - 1);
    return mix(copy_at(uv, nearest), textureLod(scene_color, uv, 0.0).rgb, sharp);
}

#ifndef PAPER
#define MIRRORED 0.2 // of the picture, along its borders: what is shown beyond them

// Where a place relative to the camera (w = 1), or a direction (w = 0), is on the picture; false: not before the
// camera.
bool on_picture(vec4 where, out vec2 pixel)
{
    const vec4 low = clip_xy[0], high = clip_xy[1];
    const vec3 clip = mat4x3(low.xy, clip_w.x, low.zw, clip_w.y, high.xy, clip_w.z, high.zw, clip_w.w) * where;
    const vec2 ndc = clip.xy / max(clip.z, 1e-5);
    pixel = view_box.xy + (0.5 * ndc + 0.5) * view_box.zw;
    return clip.z > 1e-5;
}

// The place itself, or beyond the picture's borders one within them: mirrored, and drawn together towards the border.
vec2 nearest_in(vec2 pixel)
{
    const vec2 uv = (pixel - view_box.xy) / view_box.zw, within = clamp(uv, 0.0, 1.0), beyond = uv - within;
    return view_box.xy + (within - MIRRORED * beyond / (MIRRORED + abs(beyond))) * view_box.zw;
}

// What lies there: the picture; beyond its borders what is within them, the wider spread the farther out; and from half
// a picture beyond them on, more and more, the environment.
vec3 seen(bool ahead, vec2 pixel, vec3 direction, float pixels)
{
    const vec3 around = environment(direction, vec2(1.0));
    if (tint_given.w == 0.0 || !ahead)
        return around;
    const vec2 beyond = max(abs((pixel - view_box.xy) / view_box.zw - 0.5) - 0.5, vec2(0.0));
    const float wide = max(pixels, 0.5 * length(beyond * view_box.zw));
    return mix(plate_at(nearest_in(pixel), wide), around, smoothstep(0.5, 1.5, length(beyond)));
}
#endif
