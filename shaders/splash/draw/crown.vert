// crown.vert - a point of a sheet: crowns and low sheets that flare towards a rim with fingers, and disks that lie
// flat.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#define COMPACT_ACCESS readonly
#include "splash/state.glsl"
#include "view.glsl"
#include "compact.glsl"
#include "crown_rim.glsl"
#include "gpu/compact_buffers.glsl"

layout(location = 0) out vec3 position; // relative to the camera
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 sheet;    // up its height [0; 1]; share of time that it is there; coverage; view depth
layout(location = 4) out vec4 rim_at;   // angles of the fingers' wave and of the slow one; fingers; height (m), disk: 0
layout(location = 5) out vec3 upward;   // along the sheet
layout(location = 6) out vec2 size;     // m: the rim's radius; how thick the rim is

#ifdef MOTION
layout(location = 3) out vec3 before; // in the previous frame's clip coordinates: x, y, w
#endif

struct Shape {
    Crown crown;
    vec3 side, across;
    float height, low, fingers, turn; // m: as it is drawn, and as it is at the least while the shutter is open
};

// As it was `ago_s` before the time drawn.
Shape shape_of(virga_splash_gpu splash, float ago_s)
{
    const Crown now = crown_at(splash, view.time_close_s - ago_s), open = crown_at(splash, view.time_open_s - ago_s);
    Shape s;
    s.crown = now;
    // A disk is as it is now; a sheet reaches as high as it did at either end of the shutter.
    const bool disk = now.model == VIRGA_SPLASH_DISK;
    if (open.height > now.height && !disk)
        s.crown.radius = open.radius;
    s.height = disk ? now.height : max(now.height, open.height);
    s.low = min(now.height, open.height);
    s.side = normalize(abs(now.normal.y) > 0.7 ? vec3(now.normal.y, -now.normal.x, 0.0)
                                               : vec3(now.normal.z, 0.0, -now.normal.x));
    s.across = cross(s.side, now.normal);
    // A droplet that falls back is too slow for fingers: what rises around it is a low collar.
    const bool collar = now.model == VIRGA_SPLASH_DOT;
    s.fingers = collar ? 0.0 : float(clamp(now.droplets, 7u, 11u));
    s.turn = 6.2831853 * virga_unit(virga_hash2(now.random, 5u));
    return s;
}

// A point at an angle and a share of the height.
vec3 sheet_point(Shape s, float angle, float up)
{
    const vec3 outward = cos(angle) * s.side + sin(angle) * s.across;
    if (s.crown.model == VIRGA_SPLASH_DISK) {
        const float wobble = 1.0 + 0.06 * sin(3.0 * angle + s.turn) + 0.04 * sin(5.0 * angle + 2.3 * s.turn);
        return outward * (s.crown.radius * wobble * up) + s.crown.normal * (s.height * (1.0 - up * up));
    }
    // As high everywhere as its highest finger: the rest is cut out of it where it is drawn.
    const float radius = s.crown.radius * (0.72 + 0.3 * up * up);
    const vec3 leaned = vec3(s.crown.lean.x, 0.0, s.crown.lean.y) * (0.004 * up * up);
    return outward * radius + s.crown.normal * (s.height * CROWN_REACH * up) + leaned;
}

void main()
{
    const uint slot = splash_place(listed[look.max_sprites + gl_InstanceIndex]);
    if (slot == NO_PLACE) {
        gl_Position = DRAWN_NOWHERE;
        return;
    }
    const virga_splash_gpu splash = splash_of(slot);
    const Shape s = shape_of(splash, 0.0);
    const Crown now = s.crown;
    const bool disk = now.model == VIRGA_SPLASH_DISK;
    // Columns in turns left and right of the farthest from the camera.
    const uint vertex = uint(gl_VertexIndex), column = vertex >> 5, j = column >> 1;
    const int from = (column & 1u) == 0u ? int(j) : -int(j) - 1;
    const float farthest = atan(dot(now.centre, s.across), dot(now.centre, s.side) + 1e-9);
    const float step_angle = 6.2831853 / float(VIRGA_CROWN_COLUMNS);
    const float angle = farthest + float(from + int((vertex >> 4) & 1u)) * step_angle;
    const float up = float(vertex & 15u) / float(VIRGA_CROWN_ROWS);
    const vec3 p = sheet_point(s, angle, up);
    const vec3 around = sheet_point(s, angle + 0.05, up) - sheet_point(s, angle - 0.05, up);
    const vec3 rise = sheet_point(s, angle, up + 0.05) - sheet_point(s, angle, up - 0.05);
    normal = cross(around, rise);
    upward = dot(rise, rise) > 0.0 ? normalize(rise) : now.normal;
    normal = dot(normal, normal) > 0.0 ? normalize(normal) : now.normal;
    position = now.centre + p;
#ifdef MOTION
    const Shape then = shape_of(splash, view.ago_s);
    before = project(to_mat(view.previous_clip_from_rel), then.crown.centre + sheet_point(then, angle, up)).xyw;
#endif
    // The upper part is there for the share of time that the sheet is as high.
    const float low = s.low / max(s.height, 1e-6);
    const float there = disk || low >= 1.0 ? 1.0 : clamp((1.0 - up) / (1.0 - low) + 0.25, 0.0, 1.0);
    rim_at = vec4(s.fingers * angle + s.turn, 2.0 * angle + 1.7 * s.turn, s.fingers, disk ? 0.0 : s.height);
    size = vec2(max(s.crown.radius, 1e-5), CROWN_BEAD * now.diameter);
    const float fade = disk ? 1.0 - smoothstep(0.7, 1.0, now.share) : 1.0;
    gl_Position = project(to_mat(view.clip_from_rel), position);
    const bool seen = s.height > 0.0;
    sheet = vec4(up, there, fade * near_fade(now.centre) * min(now.weight, 1.0) * min(look.gain, 4.0), gl_Position.w);
    if (!seen)
        gl_Position = DRAWN_NOWHERE;
}
