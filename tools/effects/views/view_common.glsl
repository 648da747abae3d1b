// view_common.glsl - bindings of the viewer's shaders, and colors. A shader that has uniforms of its own defines
// VIEW_OWN, their struct, before it includes this.
#extension GL_EXT_scalar_block_layout : require
#include "view_gpu.h"

#ifdef VIEW_OWN
layout(set = 0, binding = VIEW_AT_UNIFORMS) uniform View
{
    view_gpu view;
    VIEW_OWN own;
};
#else
layout(set = 0, binding = VIEW_AT_UNIFORMS) uniform View { view_gpu view; };
#endif
layout(set = 0, binding = VIEW_AT_COLOR) uniform sampler2D color_map;
layout(set = 0, binding = VIEW_AT_NORMAL) uniform sampler2D normal_map;
layout(set = 0, binding = VIEW_AT_VELOCITY) uniform sampler2D velocity_map;
layout(set = 0, binding = VIEW_AT_WATER) uniform sampler2D water_map;
layout(set = 0, binding = VIEW_AT_ID) uniform usampler2D id_map;
layout(set = 0, binding = VIEW_AT_DEPTH) uniform sampler2D depth_map;

const vec3 OUTSIDE = vec3(0.055, 0.06, 0.07); // around the picture

// The curves of png_tone, by png_curve.
float tone(float x)
{
    if (view.mode.w == 1u) {
        const float film = 0.6 * clamp(x, 0.0, 1e6);
        return min(1.0, film * (2.51 * film + 0.03) / (film * (2.43 * film + 0.59) + 0.14));
    }
    if (view.mode.w == 2u)
        return clamp(x, 0.0, 1.0);
    const float knee = 0.6, room = 1.0 - knee, white = (8.0 - knee) / room;
    const float u = (x - knee) / room;
    return x <= knee ? max(x, 0.0) : min(1.0, knee + room * u * (1.0 + u / (white * white)) / (1.0 + u));
}

vec3 to_display(vec3 linear)
{
    const vec3 low = linear * 12.92, high = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(high, low, vec3(lessThanEqual(linear, vec3(0.0031308))));
}

vec3 exposed(vec3 radiance)
{
    const vec3 x = radiance * view.picture.z;
    return to_display(vec3(tone(x.r), tone(x.g), tone(x.b)));
}

// Blue over green and yellow to red, for amounts in [0; 1].
vec3 heat(float x)
{
    x = clamp(x, 0.0, 1.0);
    return clamp(vec3(1.5 - abs(4.0 * x - vec3(3.0, 2.0, 1.0))), 0.0, 1.0);
}

vec3 hue(float turn)
{
    return clamp(abs(fract(turn + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.0, 1.0);
}

float distance_at(ivec2 texel)
{
    const float depth = texelFetch(depth_map, texel, 0).r;
    return view.projection.w / (depth + view.projection.z);
}

// The rectangle of a flat map of that aspect inside the picture's area: low corner and size, pixels.
vec4 flat_area(float aspect)
{
    const vec2 size = min(view.area.zw, view.area.wz * vec2(aspect, 1.0 / aspect)) * 0.96;
    return vec4(view.area.xy + 0.5 * (view.area.zw - size), size);
}

// A pixel of the window in the picture, from 0 to 1, and its texel; false outside of it.
bool in_picture(vec2 pixel, out vec2 at, out ivec2 texel)
{
    at = (pixel - view.area.xy) / view.area.zw;
    texel = clamp(ivec2(at * view.picture.xy), ivec2(0), ivec2(view.picture.xy) - 1);
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
}
