// view.frag - the picture, tone-mapped, or what it is made of.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "view_modes.h"
#include "view_common.glsl"

layout(set = 0, binding = VIEW_AT_LAYERS + 0) uniform sampler2D layer_map_0;
layout(set = 0, binding = VIEW_AT_LAYERS + 1) uniform sampler2D layer_map_1;
layout(set = 0, binding = VIEW_AT_LAYERS + 2) uniform sampler2D layer_map_2;
layout(set = 0, binding = VIEW_AT_LAYERS + 3) uniform sampler2D layer_map_3;
layout(set = 0, binding = VIEW_AT_LAYERS + 4) uniform sampler2D layer_map_4;
layout(set = 0, binding = VIEW_AT_LAYERS + 5) uniform sampler2D layer_map_5;
layout(set = 0, binding = VIEW_AT_LAYERS + 6) uniform sampler2D layer_map_6;
layout(set = 0, binding = VIEW_AT_LAYERS + 7) uniform sampler2D layer_map_7;
layout(location = 0) out vec4 out_color;

vec4 layer_at(uint layer, vec2 at)
{
    switch (layer) {
    case 0u: return textureLod(layer_map_0, at, 0.0);
    case 1u: return textureLod(layer_map_1, at, 0.0);
    case 2u: return textureLod(layer_map_2, at, 0.0);
    case 3u: return textureLod(layer_map_3, at, 0.0);
    case 4u: return textureLod(layer_map_4, at, 0.0);
    case 5u: return textureLod(layer_map_5, at, 0.0);
    case 6u: return textureLod(layer_map_6, at, 0.0);
    default: return textureLod(layer_map_7, at, 0.0);
    }
}

// The same of a texel, unfiltered.
vec4 layer_texel(uint layer, ivec2 texel)
{
    switch (layer) {
    case 0u: return texelFetch(layer_map_0, texel, 0);
    case 1u: return texelFetch(layer_map_1, texel, 0);
    case 2u: return texelFetch(layer_map_2, texel, 0);
    case 3u: return texelFetch(layer_map_3, texel, 0);
    case 4u: return texelFetch(layer_map_4, texel, 0);
    case 5u: return texelFetch(layer_map_5, texel, 0);
    case 6u: return texelFetch(layer_map_6, texel, 0);
    default: return texelFetch(layer_map_7, texel, 0);
    }
}

vec4 over(vec4 layer, vec4 below) { return layer + below * (1.0 - layer.a); }

vec4 beauty(vec2 at)
{
    vec4 sum = textureLod(color_map, at, 0.0);
    for (uint i = 0u; i < view.mode.z; i++)
        sum = over(layer_at(view.over[i >> 2][i & 3u], at), sum);
    return sum;
}

// A premultiplied layer over squares, as image editors show what is transparent.
vec3 layer_color(vec4 texel)
{
    const vec2 square = floor(gl_FragCoord.xy / 12.0);
    const float grey = mod(square.x + square.y, 2.0) < 1.0 ? 0.06 : 0.09;
    return to_display(clamp(texel.rgb * view.picture.z + grey * (1.0 - texel.a), 0.0, 1.0));
}

vec3 offset_color(vec4 offset)
{
    return mix(vec3(0.05), vec3(0.5 + offset.xy / (2.0 * view.picture.xy), 0.5), offset.a);
}

vec3 depth_color(ivec2 texel)
{
    const float d = distance_at(texel);
    return texelFetch(depth_map, texel, 0).r >= 1.0 ? vec3(0.0) : vec3(1.0 - clamp(log2(1.0 + d) / 8.0, 0.0, 0.95));
}

vec3 velocity_color(vec2 pixels)
{
    const float speed = length(pixels);
    const vec3 direction = hue(atan(pixels.y, pixels.x) / 6.2831853);
    return mix(vec3(0.02), direction, clamp(speed / view.picture.w, 0.0, 1.0));
}

vec3 id_color(uint id)
{
    return id == 0u ? vec3(0.0)
                    : mix(vec3(0.85), hue(float(id) * 0.61803399), 0.55) * (0.55 + 0.45 * fract(float(id) * 0.37));
}

void main()
{
    vec2 at;
    ivec2 texel;
    vec3 color = OUTSIDE;
    const bool inside = in_picture(gl_FragCoord.xy, at, texel);
    switch (inside ? view.mode.x : VIEW_MODE_COUNT) {
    case VIEW_PICTURE: color = exposed(beauty(at).rgb); break;
    case VIEW_PLATE: color = exposed(textureLod(color_map, at, 0.0).rgb); break;
    case VIEW_LAYER: color = layer_color(layer_at(view.mode.y, at)); break;
    case VIEW_OFFSETS: color = offset_color(layer_texel(view.mode.y, texel)); break;
    case VIEW_DEPTH: color = depth_color(texel); break;
    case VIEW_NORMAL: color = 0.5 + 0.5 * texelFetch(normal_map, texel, 0).xyz; break;
    case VIEW_VELOCITY: color = velocity_color(texelFetch(velocity_map, texel, 0).xy); break;
    case VIEW_ID: color = id_color(texelFetch(id_map, texel, 0).r); break;
    }
    out_color = vec4(color, 1.0);
}
