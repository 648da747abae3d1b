// encode.glsl - what a draw writes into a target whose values are encoded, see virga_target_def.encoding.
#include "gpu/srgb.glsl"

layout(constant_id = 2) const bool ENCODED = false;
layout(constant_id = 3) const float BEHIND = 0.18; // virga_target_def.blend_background

// From premultiplied light to what blending adds to the light `behind`: the sum is encoded(light + (1 - a) behind). It
// is not negative, because the curve is concave and begins at 0.
vec4 for_target_over(vec4 light, vec3 behind)
{
    if (!ENCODED)
        return light;
    const float left = clamp(1.0 - light.a, 0.0, 1.0);
    const vec3 sum = srgb_encoded(max(light.rgb, vec3(0.0)) + left * behind);
    return vec4(max(sum - left * srgb_encoded(behind), vec3(0.0)), light.a);
}

// Where the light behind is not known: exact where it is BEHIND, or a is 1.
vec4 for_target(vec4 light) { return for_target_over(light, vec3(BEHIND)); }
