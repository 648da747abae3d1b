// crown.frag - a sheet of water, premultiplied. A thin film mirrors with its two faces and hides nothing of the
// background. Rim, fingers and what holes leave are lenses. A disk is a flat drop.
// One invocation per pixel of a sheet. Reads: the scene's picture and depth. Writes: radiance, motion, reactive.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#define VIRGA_GLSL
#include "shared/splash_gpu.h"
#include "shared/view_gpu.h"
#include "gpu/vectors.glsl"
layout(scalar, set = 0, binding = 1) uniform View
{
    virga_view_gpu view;
    virga_splash_look_gpu look;
};
#include "gpu/light.glsl"
#define SCENE_DEPTH_BINDING 16
#include "gpu/scene_depth.glsl"
#include "through.glsl"
#include "shared/random.h"
#include "shared/crown_sheet.h"
#include "crown_water.glsl"
#include "gpu/temporal.glsl"
#include "gpu/encode.glsl"
#ifdef MOTION
layout(location = 3) in vec3 before; // in the previous frame's clip coordinates: x, y, w
#endif

layout(constant_id = 0) const bool HAS_DEPTH = true;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 sheet;
layout(location = 4) in vec4 place;
layout(location = 5) in vec3 upward;
layout(location = 6) flat in vec4 water;
layout(location = 7) flat in vec4 parts;
layout(location = 8) flat in uint random;
layout(location = 0) out vec4 radiance;

#define MAX_ASLANT 0.93 // sine; what is seen along the sheet is not stretched further

Sheet sheet_here(vec2 away)
{
    const vec2 aslant = away * min(1.0, MAX_ASLANT / max(length(away), 1e-6));
    return Sheet(place.z, place.w, water.z, water.w, water.x, water.y, parts.w, parts.x, parts.yz, aslant, random);
}

// The slope of the film's face (m/m). Water streams up into the fingers, so the film is thicker below each by up to a
// half: over half of their distance that is a slope of pi / 2 of thickness over distance for each face. It is thick at
// the foot, where it merges with the water that it rises from. Waves shorter than pixels are left out.
vec2 film_slope(Sheet s)
{
    if (s.fingers <= 0.0)
        return vec2(0.0);
    const float up = clamp(place.y / s.height, 0.0, 1.0), from_foot = 1.0 - up, wave = s.fingers * place.x;
    const vec2 waves = vec2(wave, 0.38 * wave + 2.0 * sin(3.0 * up + 0.21 * wave));
    const vec2 shown = 1.0 - smoothstep(0.6, 1.8, fwidth(wave) * vec2(1.0, 0.4));
    const float spacing = 6.2831853 / s.fingers * s.radius, thick = virga_crown_profile(up) * s.thick;
    const float slope = min(1.5707963 * thick / spacing, 0.35), wedge = VIRGA_CROWN_WEDGE * thick / s.height;
    return vec2(slope * dot(sin(waves) * shown, vec2(0.4 + 1.2 * up, 0.8)),
                -min(wedge, 0.3) - 0.6 * from_foot * from_foot * from_foot);
}

// The background, refracted by the angle between the film's faces, as by a prism of water: towards its thick side. The
// scene's depth gives the distance behind the film. `lean`: how the normal turns away from the thick side.
vec3 through_film(vec3 d, vec3 lean)
{
    if (view.color_given == 0u)
        return around_of(d);
    const float stored = HAS_DEPTH ? buffer_depth(gl_FragCoord.xy) : view.far_depth;
    const float beyond = stored == view.far_depth ? 1.0 : clamp(1.0 - sheet.w / view_depth(stored), 0.0, 1.0);
    const vec2 bent = -0.333 * beyond / view.pixel_angle *
                      vec2(dot(lean, normalize(to_vec(view.right))), dot(lean, normalize(to_vec(view.up))));
    const vec2 low = vec2(view.viewport[0], view.viewport[1]) + 0.5;
    const vec2 pixel = clamp(gl_FragCoord.xy + bent, low, low + vec2(view.viewport[2], view.viewport[3]) - 1.0);
    return scene_at(pixel);
}

// Light and coverage of a face with that normal.
struct Shade {
    vec3 light;
    float body, moving;
};

Shade film_shade(vec3 d, vec3 n, vec3 lean)
{
    const float cosine = -dot(n, d), face = fresnel(cosine);
    // A film has two faces: 2 F / (1 + F) with the light that is mirrored between them. Its faces are parallel but for
    // small slopes, so it shows what is behind it nearly in place. Without the host's picture, the target keeps that.
    const float mirror = 2.0 * face / (1.0 + face), hides = view.color_given != 0u ? 1.0 : 0.05;
    // What bends more is bent away from what is close behind.
    const vec3 far = seen(normalize(d - 0.333 * (lean - d * dot(lean, d))));
    const vec3 behind = mix(through_film(d, lean), far, smoothstep(0.1, 0.6, length(lean)));
    return Shade(mirror * around_of(reflect(d, n)) + (1.0 - mirror) * hides * behind,
                 mirror + (1.0 - mirror) * hides, mirror + (1.0 - mirror) * 0.05);
}

Shade lens_shade(vec3 d, vec3 n)
{
    return Shade(through_ball(d, n - d * dot(n, d)) + lamps(position, d), 1.0, 1.0);
}

// A flat drop: clear, and round at its edge.
Shade disk_shade(vec3 d, vec3 n)
{
    const float cosine = -dot(n, d), face = fresnel(cosine), mirror = 2.0 * face / (1.0 + face);
    const float rim = smoothstep(0.7, 1.0, sheet.x), edge = (1.0 - cosine) * (1.0 - cosine) * (1.0 - cosine);
    const float thick = clamp(0.05 + 0.12 * sheet.x * sheet.x + 0.6 * rim + 0.8 * edge, 0.0, 1.0);
    const vec3 behind = mix(through_film(d, vec3(0.0)), through_ball(d, (n + d * cosine) * (0.35 + 0.6 * rim)),
                            max(rim, edge));
    const float body = mirror + (1.0 - mirror) * thick;
    return Shade(mirror * around_of(reflect(d, n)) + (1.0 - mirror) * thick * behind + lamps(position, d) * thick, body,
                 body);
}

vec3 facing(vec3 n, vec3 d) { return normalize(n - 1.01 * d * max(dot(n, d), 0.0)); }

Shade crown_shade(vec3 d, vec3 n)
{
    const vec3 u = normalize(upward), right = normalize(cross(u, normalize(normal)));
    const Sheet s = sheet_here(vec2(dot(d, right), dot(d, u)));
    const float pixel_m = length(position) * view.pixel_angle;
    const Line line = rim_line(s, place.x);
    const Film film = torn_film(s, line, place.x, place.y, look.hole_m);
    Bead bead = edge_bead(s, line, place.x, place.y, look.hole_m);
    bead = join(bead, film.bead, 0.4 * min(bead.radius, film.bead.radius));
    // What is narrower than a pixel is drawn a pixel wide, and covers less.
    const float wider = max(0.5 * pixel_m - bead.radius, 0.0), covers = bead.radius / (bead.radius + wider);
    const float out_m = bead.out_m - wider, in_bead = covers * clamp(0.5 - out_m / pixel_m, 0.0, 1.0);
    const float in_film = clamp(0.5 + min(film.below_rim, film.beside_hole) / pixel_m, 0.0, 1.0) * (1.0 - in_bead);
    // A bead is round as seen from here. The film runs into it with a fillet.
    const float across = clamp(1.0 + out_m / (bead.radius + wider), 0.0, 0.98);
    const float fillet = clamp(1.0 - max(out_m, 0.0) / (1.5 * bead.radius), 0.0, 1.0);
    const vec3 outward = normalize(bead.outward.x * right + bead.outward.y * u + 1e-6 * u);
    const vec3 beside = normalize(outward - d * dot(outward, d) + 1e-6 * u);
    const vec3 round = facing(beside * across - d * sqrt(1.0 - across * across), d);
    const vec2 slope = film_slope(s);
    const vec3 lean = slope.x * right + slope.y * u + 0.7 * fillet * fillet * outward;
    const Shade lens = lens_shade(d, round), thin = film_shade(d, facing(n + lean, d), lean);
    return Shade(lens.light * in_bead + thin.light * in_film, lens.body * in_bead + thin.body * in_film,
                 lens.moving * in_bead + thin.moving * in_film);
}

void main()
{
    const vec3 d = normalize(position);
    vec3 n = normalize(normal);
    n = dot(n, d) > 0.0 ? -n : n;
    const Shade shade = parts.x < 0.0 ? disk_shade(d, facing(n, d)) : crown_shade(d, n);
    const float visible = clamp(sheet.y * sheet.z, 0.0, 1.0) * (HAS_DEPTH ? soft_edge(sheet.w) : 1.0);
    radiance = for_target(vec4(shade.light * visible, shade.body * visible));
    WRITE_MOTION(motion_from(before), shade.moving * visible);
    WRITE_REACTIVE(shade.moving * visible, view.reactive_gain);
}
