// crown.vert - vertices of a sheet: crowns and low sheets that flare towards a rim with fingers, and flat disks.
// One invocation per vertex, one instance per sheet. Reads: the list of sheets, splashes. Writes: position, rim, size.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define STATE_ACCESS readonly
#define COMPACT_ACCESS readonly
#include "splash/state.glsl"
#include "view.glsl"
#include "compact.glsl"
#include "shared/crown_sheet.h"
#include "gpu/compact_buffers.glsl"

layout(location = 0) out vec3 position; // relative to the camera
layout(location = 1) out vec3 normal;
// x: up its height [0; 1]; y: fraction of the time that it is there; z: coverage; w: view depth
layout(location = 2) out vec4 sheet;
// x: angle; y: height there; z: height of the rim; w: radius there (m)
layout(location = 4) out vec4 place;
layout(location = 5) out vec3 upward; // along the sheet
// See crown_water.glsl: mean thickness of the wall and radius of the rim (m), fraction of its life, and life (s)
layout(location = 6) flat out vec4 water;
// x: fingers, < 0: a disk; y, z: sites of holes around and up; w: mean water of a finger (m^3)
layout(location = 7) flat out vec4 parts;
layout(location = 8) flat out uint random;

#ifdef MOTION
layout(location = 3) out vec3 before; // in the previous frame's clip coordinates: x, y, w
#endif

#define HOLE_SITES 0.9 // distance of places where holes may open, in drops

struct Shape {
    Crown crown;
    vec3 side, across;
    float height, min_height, phase; // m: height as drawn, and the lowest while the shutter is open
};

// The shape `ago_s` before the time that is drawn.
Shape shape_of(virga_splash_gpu splash, float ago_s)
{
    const Crown now = crown_at(splash, view.time_close_s - ago_s), open = crown_at(splash, view.time_open_s - ago_s);
    Shape s;
    s.crown = now;
    // A disk is drawn as it is at the end; a sheet is as high as at either end of the shutter.
    const bool disk = now.model == VIRGA_SPLASH_DISK;
    if (open.height > now.height && !disk)
        s.crown.radius = open.radius;
    s.height = disk ? now.height : max(now.height, open.height);
    s.min_height = min(now.height, open.height);
    s.side = normalize(abs(now.normal.y) > 0.7 ? vec3(now.normal.y, -now.normal.x, 0.0)
                                               : vec3(now.normal.z, 0.0, -now.normal.x));
    s.across = cross(s.side, now.normal);
    s.phase = 6.2831853 * virga_unit(virga_hash2(now.random, 5u));
    return s;
}

// An ellipse: longer along one direction, shorter across it, by the same length.
vec3 oval(Crown crown, vec3 outward)
{
    const vec3 along = vec3(crown.along.x, 0.0, crown.along.y) / max(crown.radius, 1e-6);
    const float more = length(along);
    return outward * (1.0 - more) + along * (2.0 * dot(outward, along) / max(more, 1e-6));
}

// The point of a sheet at an angle and a fraction of the height.
vec3 sheet_point(Shape s, float angle, float up)
{
    const vec3 outward = cos(angle) * s.side + sin(angle) * s.across;
    if (s.crown.model == VIRGA_SPLASH_DISK) {
        const float wobble = 1.0 + 0.06 * sin(3.0 * angle + s.phase) + 0.04 * sin(5.0 * angle + 2.3 * s.phase);
        return outward * (s.crown.radius * wobble * up) + s.crown.normal * (s.height * (1.0 - up * up));
    }
    // Everywhere as high as the highest finger: the fragment shader cuts the rim out of it.
    const float high = VIRGA_CROWN_REACH * up;
    const float radius = s.crown.radius * (VIRGA_CROWN_FOOT + VIRGA_CROWN_FLARE * high * high);
    const vec3 leaned = vec3(s.crown.lean.x, 0.0, s.crown.lean.y) * (0.004 * up * up);
    return oval(s.crown, outward) * radius + s.crown.normal * (s.height * high) + leaned;
}

// How its water is shared. A droplet that falls back is too slow to make fingers: the collar around it is low.
void write_water(Crown now, bool disk)
{
    const bool collar = now.model == VIRGA_SPLASH_DOT;
    const float all = virga_crown_water(now.diameter, now.flown), share = clamp(now.share, 0.0, 1.0);
    const float drops = VIRGA_CROWN_DROPS * 0.5235988 * now.diameter * now.diameter * now.diameter;
    const float around = 6.2831853 * max(now.radius, 1e-5);
    const float fingers = 2.0 * floor(0.5 * virga_crown_count(all, now.widest) + 0.5);
    water.x = virga_crown_thinnest(all, now.widest, now.highest) * virga_crown_thinning(share);
    water.y = virga_crown_rod(virga_crown_rim(all, share) / around);
    water.zw = vec2(share, now.life_s);
    parts.x = disk ? -1.0 : collar ? 0.0 : fingers;
    const vec2 wall = vec2(6.2831853 * VIRGA_CROWN_MEAN * now.widest, now.highest);
    parts.yz = max(floor(wall / (HOLE_SITES * now.diameter) + 0.5), vec2(5.0, 3.0));
    parts.w = virga_crown_fingers(all, share, drops * now.flown, virga_crown_left(share)) / fingers;
    random = now.random;
}

#include "gpu/own_view.glsl"

void main()
{
    const uint slot = splash_slot(listed[look.max_sprites + gl_InstanceIndex]);
    if (slot == NO_SLOT) {
        gl_Position = DRAWN_NOWHERE;
        return;
    }
    const virga_splash_gpu splash = splash_of(slot);
    const Shape s = shape_of(splash, 0.0);
    const Crown now = s.crown;
    const bool disk = now.model == VIRGA_SPLASH_DISK;
    // Columns alternate between left and right of the one farthest from the camera.
    const uint vertex = uint(gl_VertexIndex), column = vertex >> 5, j = column >> 1;
    const int from = (column & 1u) == 0u ? int(j) : -int(j) - 1;
    const float farthest = atan(dot(now.center, s.across), dot(now.center, s.side) + 1e-9);
    const float step_angle = 6.2831853 / float(VIRGA_CROWN_COLUMNS);
    const float angle = farthest + float(from + int((vertex >> 4) & 1u)) * step_angle;
    const float up = float(vertex & 15u) / float(VIRGA_CROWN_ROWS);
    const vec3 p = sheet_point(s, angle, up);
    const vec3 around = sheet_point(s, angle + 0.05, up) - sheet_point(s, angle - 0.05, up);
    const vec3 rise = sheet_point(s, angle, up + 0.05) - sheet_point(s, angle, up - 0.05);
    normal = cross(around, rise);
    upward = dot(rise, rise) > 0.0 ? normalize(rise) : now.normal;
    normal = dot(normal, normal) > 0.0 ? normalize(normal) : now.normal;
    position = now.center + p;
#ifdef MOTION
    const Shape then = shape_of(splash, view.frame_interval_s);
    before = project(to_mat(view.previous_clip_from_rel), then.crown.center + sheet_point(then, angle, up)).xyw;
#endif
    // The upper part is there for the fraction of the time in which the sheet is that high.
    const float min_height = s.min_height / max(s.height, 1e-6);
    const float visible = disk || min_height >= 1.0 ? 1.0 : clamp((1.0 - up) / (1.0 - min_height) + 0.25, 0.0, 1.0);
    const float high = VIRGA_CROWN_REACH * up;
    // Around an oval the radius is the way per angle.
    const bool round = now.along == vec2(0.0);
    const float wide = max(s.crown.radius, 1e-5) * (VIRGA_CROWN_FOOT + VIRGA_CROWN_FLARE * high * high);
    place = vec4(angle, s.height * high, max(s.height, 1e-6), round ? wide : max(10.0 * length(around), 1e-5));
    write_water(now, disk);
    const float fade = disk ? 1.0 - smoothstep(0.7, 1.0, now.share) : 1.0;
    gl_Position = project(to_mat(view.clip_from_rel), position);
    const bool seen = s.height > 0.0;
    sheet = vec4(up, visible, fade * near_fade(now.center) * min(now.weight, 1.0) * min(look.gain, 4.0), gl_Position.w);
    if (!seen)
        gl_Position = DRAWN_NOWHERE;
}
