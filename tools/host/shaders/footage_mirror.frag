#version 460
// footage_mirror.frag - what level water mirrors of a picture that replaces the scene: each ray that leaves the water
// is followed until it is behind what the picture shows there. Without depth all of it is infinitely far away. What the
// picture does not show is the environment.
#extension GL_GOOGLE_include_directive : require
#include "frame_gpu.h"

layout(set = 0, binding = 0, std140) uniform Frame { host_frame_gpu frame; };
layout(set = 0, binding = 1) uniform sampler2D sky_texture;
layout(set = 1, binding = 0) uniform sampler2D picture;
layout(set = 1, binding = 1) uniform sampler2D picture_depth;

#include "mirror_jitter.glsl"

layout(location = 0) in vec2 in_clip;
layout(location = 0) out vec4 out_color;
layout(location = 1) out float out_near;

const float PI = 3.14159265;
const int STEPS = 56, HALVES = 5;
const float GROWTH = 1.09;   // of the way from step to step
const float BEYOND = 0.3;    // share of the picture's size over which its border goes on, and fades to the environment

// Where the picture has a point relative to the camera; it has no jitter.
vec2 at_picture(vec4 clip) { return clip.xy / clip.w * 0.5 + 0.5 - frame.screen.zw / frame.screen.xy; }

// How far beyond the picture's border a place is.
float outside(vec2 at)
{
    const vec2 off = max(-at, at - 1.0);
    return max(max(off.x, off.y), 0.0);
}

// Metres along the axis to what the picture shows at a place. Depth is a + b / metres.
float shown(vec2 at, vec2 ab) { return ab.y / (textureLod(picture_depth, at, 0.0).r - ab.x); }

vec4 clip_at(vec3 from, vec3 d, float way) { return frame.clip_from_relative * vec4(from + d * way, 1.0); }

float behind(vec4 clip, vec2 ab) { return clip.w - shown(at_picture(clip), ab); }

// The way to what a ray meets, and where the picture shows that; 0: nothing.
//
// Behind a thing that stands nearer to the camera than the ray nobody sees it: it is hidden, but has met nothing. If
// what the picture shows where it comes out lies between where the ray was seen last and where it is now, the ray has
// gone through that while it was hidden: a wall behind a person. Beside the person the wall is seen, and stands for it.
float meet(vec3 from, vec3 d, float start, out vec2 at)
{
    const vec4 one = frame.clip_from_relative * vec4(frame.ray_z.xyz, 1.0);
    const vec4 two = frame.clip_from_relative * vec4(2.0 * frame.ray_z.xyz, 1.0);
    const vec2 ab = vec2(two.z - one.z, 2.0 * one.z - two.z);
    float last = start, seen = start, seen_m = clip_at(from, d, start).w;
    at = vec2(0.0);
    for (int i = 0; i < STEPS; i++) {
        const float way = last * GROWTH + 0.01;
        const vec4 clip = clip_at(from, d, way);
        if (clip.w > 0.0 && outside(at_picture(clip)) == 0.0) {
            const float there = shown(at_picture(clip), ab), off = clip.w - there;
            if (off > 0.0 && off < max(0.3, 2.0 * (way - last))) {
                float low = last, high = way;
                for (int k = 0; k < HALVES; k++) {
                    const float middle = 0.5 * (low + high);
                    if (behind(clip_at(from, d, middle), ab) > 0.0)
                        high = middle;
                    else
                        low = middle;
                }
                at = at_picture(clip_at(from, d, high));
                return high;
            }
            if (off > 0.0 && there > seen_m) {
                at = at_picture(clip);
                return seen + (there - seen_m) / (clip.w - seen_m) * (way - seen);
            }
            if (off <= 0.0) {
                seen = way;
                seen_m = clip.w;
            }
        }
        last = way;
    }
    return 0.0;
}

void main()
{
    const vec2 clip = (in_clip - mirror_jitter()) / frame.mirror.y;
    vec3 d = normalize(frame.ray_z.xyz + clip.x * frame.ray_x.xyz + clip.y * frame.ray_y.xyz);
    d.y = -d.y;
    const float u = atan(d.x, -d.z) / (2.0 * PI) + 0.5 + frame.environment.x;
    const vec3 sky = textureLod(sky_texture, vec2(u, acos(clamp(d.y, -1.0, 1.0)) / PI), 0.0).rgb;
    const vec3 from = vec3(0.0, 2.0 * frame.mirror.x, 0.0); // the mirrored eye
    vec2 at = vec2(0.0);
    const float met = d.y > 1e-3 ? meet(from, d, -frame.mirror.x / d.y, at) : 0.0;
    const vec4 far = frame.clip_from_relative * vec4(d, 0.0);
    if (met == 0.0)
        at = at_picture(far);
    const float share = met > 0.0 || far.w > 0.0 ? 1.0 - smoothstep(0.0, BEYOND, outside(at)) : 0.0;
    const float way = met > 0.0 ? met : HOST_MIRROR_FAR;
    const vec3 point = from + d * way;
    const vec4 mirrored = frame.clip_from_relative * vec4(point.x, 2.0 * frame.mirror.x - point.y, point.z, 1.0);
    out_color = vec4(mix(sky, textureLod(picture, at, 0.0).rgb, share), 1.0);
    out_near = 1.0 / clamp(way, 0.05, HOST_MIRROR_FAR);
    gl_FragDepth = mirrored.w > 0.0 ? clamp(mirrored.z / mirrored.w, 0.0, 1.0) : 1.0;
}
