// stream.frag - the slope of the waves of running water, added to that of rings.
// One invocation per texel of the ripple map on such water. Reads: the picture of waves. Writes: slope (additive).
//
// The picture has two surfaces A and B of waves of one length, in all directions. A stands still;
// A cos(w t) + B sin(w t) are such waves under way, which pass through each other (stream_table.h).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "tick.glsl"

layout(set = 0, binding = 29) uniform sampler2DArray stream_tile;
layout(location = 0) noperspective in vec2 at_m;
layout(location = 1) noperspective in vec4 moved_m;
layout(location = 2) noperspective in vec3 height_m;
layout(location = 3) noperspective in vec3 turn_rad_s;
layout(location = 4) noperspective in vec3 standing_m;
layout(location = 0) out vec2 slope;

const float WAVES_M[VIRGA_STREAM_OCTAVES] = float[VIRGA_STREAM_OCTAVES](VIRGA_STREAM_WAVE_LIST);
// Each octave's picture is turned by another angle, so that they do not come again together.
const vec2 TURNED[VIRGA_STREAM_OCTAVES] =
    vec2[VIRGA_STREAM_OCTAVES](vec2(VIRGA_STREAM_TURN_0), vec2(VIRGA_STREAM_TURN_1), vec2(VIRGA_STREAM_TURN_2));

// What stands still and the layers that move are unlike each other: each has the picture in another of these ways, as
// it is, mirrored, or turned by a right angle. Its waves have other phases along each axis.
const mat2 WAYS[1 + VIRGA_STREAM_LAYERS] =
    mat2[1 + VIRGA_STREAM_LAYERS](mat2(1.0, 0.0, 0.0, 1.0), mat2(-1.0, 0.0, 0.0, 1.0), mat2(0.0, 1.0, -1.0, 0.0));

// The slopes of both surfaces of an octave's picture, at a place from the window's low corner.
vec4 waves_at(uint octave, mat2 way, vec2 at_m, vec2 place)
{
    const float side_m = WAVES_M[octave] * VIRGA_STREAM_TILE_WAVES;
    const vec2 t = TURNED[octave], corner = vec2(tick.stream_corner[2u * octave], tick.stream_corner[2u * octave + 1u]);
    const vec2 turned_m = vec2(t.x * at_m.x - t.y * at_m.y, t.y * at_m.x + t.x * at_m.y);
    const vec2 at = fract(way * (turned_m / side_m + corner) + place);
    // Its last texels are its first ones again: it is filtered without a seam.
    const vec2 texel = (at * float(VIRGA_STREAM_TILE) + 0.5) / float(VIRGA_STREAM_TILE + 1);
    const vec4 bytes = textureLod(stream_tile, vec3(texel, 0.0), 0.0) * 255.0;
    const vec4 both = (bytes - 128.0) * (VIRGA_STREAM_TILE_SLOPE / 127.0 / side_m);
    return vec4(both.xy * way, both.zw * way);
}

void main()
{
    slope = vec2(0.0);
    for (uint i = 0u; i < VIRGA_STREAM_OCTAVES; i++) {
        vec2 rise = standing_m[i] * waves_at(i, WAYS[0], at_m, vec2(0.0)).xy;
        for (uint layer = 0u; layer < VIRGA_STREAM_LAYERS; layer++) {
            const vec2 began_m = at_m - (layer == 0u ? moved_m.xy : moved_m.zw);
            const float angle = turn_rad_s[i] * tick.stream_age_s[layer];
            const uint at = 2u * (layer * VIRGA_STREAM_OCTAVES + i);
            const vec2 place = vec2(tick.stream_place[at], tick.stream_place[at + 1u]);
            const vec4 both = waves_at(i, WAYS[1u + layer], began_m, place);
            rise += (both.xy * cos(angle) + both.zw * sin(angle)) * (tick.stream_weight[layer] * height_m[i]);
        }
        const vec2 t = TURNED[i];
        slope += vec2(t.x * rise.x + t.y * rise.y, t.x * rise.y - t.y * rise.x);
    }
    slope *= tick.stream_waves;
}
