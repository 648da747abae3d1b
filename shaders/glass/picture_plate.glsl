// picture_plate.glsl - the plate behind the pane, looked up sharp, or in smaller copies where a drop shows much of
// it in little.
layout(set = 0, binding = 14) uniform sampler2D copies;
layout(set = 0, binding = 16) uniform sampler2D scene_color;

vec2 plate_size() { return vec2(textureSize(scene_color, 0)); }

// A copy by its level: 0 is 512 texels wide, each further one half as many.
vec3 copy_at(vec2 uv, int level)
{
    const float side = float(VIRGA_GLASS_COPY >> level);
    // 512 at the left, 256 beside it, the others below that in a row.
    const vec2 corner = level == 0 ? vec2(0.0) : level == 1 ? vec2(512.0, 0.0) : vec2(768.0 - 2.0 * side, 256.0);
    const vec2 at = corner + clamp(uv * side, vec2(0.5), vec2(side - 0.5));
    return textureLod(copies, at / vec2(VIRGA_GLASS_COPY_WIDTH, VIRGA_GLASS_COPY), 0.0).rgb;
}

// The mean over about so many pixels a side around a place of the picture.
vec3 plate_at(vec2 pixel, float pixels)
{
    const vec2 uv = pixel / plate_size();
    const float copied = max(max(plate_size().x, plate_size().y) / float(VIRGA_GLASS_COPY), 1.0);
    const float level = log2(max(pixels / copied, 1e-3));
    if (level < 0.0) {
        const float sharp = copied > 1.0 ? clamp(-level / log2(copied), 0.0, 1.0) : 1.0;
        const vec3 own = textureLod(scene_color, uv, 0.0).rgb;
        return sharp < 1.0 ? mix(copy_at(uv, 0), own, sharp) : own;
    }
    const int low = min(int(level), VIRGA_GLASS_COPY_LEVELS - 2);
    return mix(copy_at(uv, low), copy_at(uv, low + 1), clamp(level - float(low), 0.0, 1.0));
}

// Where a place relative to the camera (w = 1), or a direction (w = 0), is on the picture; false: not before the
// camera.
bool on_picture(vec4 where, out vec2 pixel)
{
    const vec4 clip = to_mat(view.clip_from_rel) * where;
    const vec2 ndc = clip.xy / max(clip.w, 1e-5);
    pixel = vec2(view.viewport[0], view.viewport[1]) + (0.5 * ndc + 0.5) * vec2(view.viewport[2], view.viewport[3]);
    return clip.w > 1e-5;
}

// What lies there: the picture, and smoothly around its edges the environment.
vec3 seen(bool ahead, vec2 pixel, vec3 direction, float pixels)
{
    const vec3 around = environment(direction, vec2(1.0));
    if (view.color_given == 0u || !ahead)
        return around;
    const vec2 size = vec2(view.viewport[2], view.viewport[3]), way = abs(pixel - gl_FragCoord.xy) / size;
    const vec2 ndc = (pixel - vec2(view.viewport[0], view.viewport[1])) / size * 2.0 - 1.0;
    // The wider a ray is bent the wider the band: one that is not bent shows the picture up to its edge.
    const float band = clamp(max(way.x, way.y), 1e-3, 0.15);
    const float inside = smoothstep(0.0, 1.0, (1.0 - max(abs(ndc.x), abs(ndc.y))) / band);
    return inside > 0.0 ? mix(around, plate_at(pixel, pixels), inside) : around;
}
