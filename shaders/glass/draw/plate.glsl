// plate.glsl - look-ups of the plate behind the pane: sharp, or in smaller copies where a drop shows much of it in few
// pixels.
#include "copies.glsl"
#include "gpu/host_color.glsl"

layout(set = 0, binding = 16) uniform sampler2D scene_color;

vec2 plate_size() { return vec2(textureSize(scene_color, 0)); }

#ifndef PAPER
// For includers that define FAR_APART: set where samples are far apart. Each is `pixels` from the next in both
// directions, and what it shows must meet what the next one shows. A copy has as many rows as columns, so its texels
// are as wide as the picture is and not square. One that is `pixels` wide across its narrow side leaves no gap; the
// copies above and below it are blended.
bool far_apart = false;

// The mean over about `pixels` x `pixels` pixels of the picture.
vec3 plate_at(vec2 pixel, float pixels)
{
    const vec2 uv = pixel / plate_size(), texel = plate_size() / float(VIRGA_GLASS_COPY);
    const float copied = max(max(texel.x, texel.y), 1.0), last = float(VIRGA_GLASS_COPY_LEVELS - 1);
#ifdef FAR_APART
    if (far_apart) {
        const float level = clamp(log2(pixels / min(texel.x, texel.y)), 0.0, last), finer = floor(level);
        return mix(copy_at(uv, int(finer)), copy_at(uv, int(min(finer + 1.0, last))), level - finer);
    }
#endif
    const float level = log2(max(pixels / copied, 1e-3));
    // Only the nearest copy: drops are too small to show the border between two levels. The largest copy of a small
    // picture has texels that are smaller than a pixel: looked up once a pixel, they do not add up to its light.
    const float sharp = copied > 1.0 ? clamp(-level / log2(copied), 0.0, 1.0) : level < 0.5 ? 1.0 : 0.0;
    const int nearest = int(clamp(floor(level + 0.5), 0.0, last));
    return mix(copy_at(uv, nearest), host_color(textureLod(scene_color, uv, 0.0).rgb, uint(tint_given.w)), sharp);
}

#define MIRRORED 0.2 // part of the picture along its borders that is shown beyond them

// Projects a point relative to the camera (w = 1) or a direction (w = 0) to a pixel. False: behind the camera.
bool on_picture(vec4 where, out vec2 pixel)
{
    const vec4 low = clip_xy[0], high = clip_xy[1];
    const vec3 clip = mat4x3(low.xy, clip_w.x, low.zw, clip_w.y, high.xy, clip_w.z, high.zw, clip_w.w) * where;
    const vec2 ndc = clip.xy / max(clip.z, 1e-5);
    pixel = view_box.xy + (0.5 * ndc + 0.5) * view_box.zw;
    return clip.z > 1e-5;
}

// The pixel itself, or for one beyond the picture's borders a pixel within: mirrored, and compressed towards the
// border.
vec2 nearest_in(vec2 pixel)
{
    const vec2 uv = (pixel - view_box.xy) / view_box.zw, within = clamp(uv, 0.0, 1.0), beyond = uv - within;
    return view_box.xy + (within - MIRRORED * beyond / (MIRRORED + abs(beyond))) * view_box.zw;
}

// The light there: the picture; beyond its borders the mirrored picture, more blurred the farther out; and from half a
// picture beyond the borders on, more and more the environment.
vec3 scene_light(bool ahead, vec2 pixel, vec3 direction, float pixels)
{
    const vec3 around = environment(direction, vec2(1.0));
    if (tint_given.w == 0.0 || !ahead)
        return around;
    const vec2 beyond = max(abs((pixel - view_box.xy) / view_box.zw - 0.5) - 0.5, vec2(0.0));
    const float blur_px = max(pixels, 0.5 * length(beyond * view_box.zw));
    return mix(plate_at(nearest_in(pixel), blur_px), around, smoothstep(0.5, 1.5, length(beyond)));
}
#endif
