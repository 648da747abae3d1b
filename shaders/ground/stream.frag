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
layout(location = 5) flat in uint octaves;
layout(location = 0) out vec2 slope;

const float WAVES_M[VIRGA_STREAM_OCTAVES] = float[VIRGA_STREAM_OCTAVES](VIRGA_STREAM_WAVE_LIST);

// What stands still and the layers that move are unlike each other: each has the picture in another of these ways, as
// it is, mirrored, or turned by a right angle. Its waves have other phases along each axis.
const mat2 WAYS[1 + VIRGA_STREAM_LAYERS] =
    mat2[1 + VIRGA_STREAM_LAYERS](mat2(1.0, 0.0, 0.0, 1.0), mat2(-1.0, 0.0, 0.0, 1.0), mat2(0.0, 1.0, -1.0, 0.0));

// Choices instead of arrays with an index: software Vulkan reads those lane by lane.
vec2 of_octave(uint octave, vec2 a, vec2 b, vec2 c) { return octave == 0u ? a : octave == 1u ? b : c; }
vec2 corner_of(uint octave)
{
    return of_octave(octave, vec2(tick.stream_corner[0], tick.stream_corner[1]),
                     vec2(tick.stream_corner[2], tick.stream_corner[3]),
                     vec2(tick.stream_corner[4], tick.stream_corner[5]));
}
vec2 place_of(uint octave, uint layer)
{
    const uint at = 2u * layer * VIRGA_STREAM_OCTAVES;
    return of_octave(octave, vec2(tick.stream_place[at], tick.stream_place[at + 1u]),
                     vec2(tick.stream_place[at + 2u], tick.stream_place[at + 3u]),
                     vec2(tick.stream_place[at + 4u], tick.stream_place[at + 5u]));
}
// Each octave's picture is turned by another angle, so that they do not come again together.
vec2 turn_of(uint octave)
{
    return of_octave(octave, vec2(VIRGA_STREAM_TURN_0), vec2(VIRGA_STREAM_TURN_1), vec2(VIRGA_STREAM_TURN_2));
}

// The slopes of both surfaces of an octave's picture, in lengths of its side. A wave has 31 texels of the picture: the
// nearest one is half a texel off at most, which is a twentieth of the slope in the mean. Filtering cost more than all
// else here.
vec4 waves_at(mat2 way, vec2 at, vec2 place)
{
    const ivec2 texel = ivec2(fract(way * at + place) * float(VIRGA_STREAM_TILE)) & (VIRGA_STREAM_TILE - 1);
    const vec4 bytes = texelFetch(stream_tile, ivec3(texel, 0), 0) * 255.0;
    const vec4 both = bytes - 128.0;
    return vec4(both.xy * way, both.zw * way);
}

vec2 slope_of(uint octave)
{
    const float side_m = WAVES_M[0] * VIRGA_STREAM_TILE_WAVES * float(1u << octave);
    const vec2 t = turn_of(octave), corner = corner_of(octave);
    const mat2 turned = mat2(t.x, t.y, -t.y, t.x);
    const vec2 here = turned * at_m / side_m + corner;
    vec2 rise = standing_m[octave] * waves_at(WAYS[0], here, vec2(0.0)).xy;
    for (uint layer = 0u; layer < VIRGA_STREAM_LAYERS; layer++) {
        const vec2 began = here - turned * (layer == 0u ? moved_m.xy : moved_m.zw) / side_m;
        const float angle = turn_rad_s[octave] * tick.stream_age_s[layer];
        const vec4 both = waves_at(WAYS[1u + layer], began, place_of(octave, layer));
        rise += (both.xy * cos(angle) + both.zw * sin(angle)) * (tick.stream_weight[layer] * height_m[octave]);
    }
    return rise * turned * (VIRGA_STREAM_TILE_SLOPE / 127.0 / side_m);
}

// The block has one octave or more. The loop tests behind its body, as software Vulkan runs a body that no lane enters.
void main()
{
    slope = vec2(0.0);
    uint left = octaves;
    do {
        slope += slope_of(uint(max(findLSB(left), 0)));
        left &= left - 1u;
    } while (left != 0u);
    slope *= tick.stream_waves;
}
