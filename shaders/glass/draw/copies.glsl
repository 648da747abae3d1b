// copies.glsl - smaller copies of the plate behind the pane.
layout(set = 0, binding = 14) uniform sampler2D copies;

// A look-up in the copy of a level: 0 is the largest, each further one half as wide.
vec3 copy_at(vec2 uv, int level)
{
    const float one = float(VIRGA_GLASS_COPY), side = float(VIRGA_GLASS_COPY >> level);
    // In one image: the largest at the left, the next to its right, all others in a row below that.
    const vec2 corner = level == 0 ? vec2(0.0) : level == 1 ? vec2(one, 0.0) : vec2(1.5 * one - 2.0 * side, 0.5 * one);
    const vec2 at = corner + clamp(uv * side, vec2(0.5), vec2(side - 0.5));
    return textureLod(copies, at / vec2(VIRGA_GLASS_COPY_WIDTH, VIRGA_GLASS_COPY), 0.0).rgb;
}
