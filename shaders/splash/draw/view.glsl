// view.glsl - a view of splashes: its parameters, and where droplets, piles and crowns are at a time.
#include "shared/view_gpu.h"

layout(scalar, set = 0, binding = 1) uniform View
{
    virga_view_gpu view;
    virga_splash_look_gpu look;
};

#include "gpu/view.glsl"
#include "splash/shape.glsl"

// Coverage below this is invisible to the eye and in 8 bits.
#define MIN_COVERAGE (1.0 / 400.0)
#define MAX_COVERAGE 0.3 // of a sprite that stands for many
#define WIDE_PX 3.0      // from this width on a sprite shows what is behind it
#define MAX_COLUMNS 16   // max puffs beside each other in one sprite,
#define MAX_ROWS 4       // and behind each other; VIRGA_SPLASH_MAX_CROWNS is the product
#define SPACING 1.4      // distance between puffs, relative to their water: clusters merge
#define MIN_SPACING 3.0  // min distance between puffs, of the min width that is drawn
#define MIN_FLATNESS 0.3 // min height over width of the ellipse on which they are scattered
#define MAX_STRETCH 6.0  // max ratio of their distance in depth to that sideways,
#define MAX_REACH 0.2    // and within this fraction of their distance from the camera
#define MESH_PX 4.0      // crowns at least this high on the picture are drawn as sheets

#ifdef IN_FORMS
layout(constant_id = 0) const uint FORM = 0u; // VIRGA_SPLASH_FORM_...
bool is_film() { return (FORM & uint(VIRGA_SPLASH_FORM_FILM)) != 0u; }
#else
bool is_film() { return look.style == 1u; }
#endif

bool is_upright(virga_droplet_gpu droplet)
{
    return VIRGA_DROPLET_MODEL(droplet.kind) == VIRGA_SPLASH_CROWN_CONE && VIRGA_DROPLET_INDEX(droplet.kind) == 0u;
}

// Relative to the camera. Within a tick only velocity and gravity matter.
vec3 droplet_at(virga_droplet_gpu droplet, float time_s)
{
    const float since = max(time_s, -droplet.age_s);
    return to_vec(droplet.position) + to_vec(view.origin_offset) + to_vec(droplet.velocity) * since -
           vec3(0.0, 0.5 * GRAVITY * since * since, 0.0);
}

vec3 base_of(virga_droplet_gpu droplet) { return to_vec(droplet.base) + to_vec(view.origin_offset); }

// The tip of a droplet's pile at a time, and how much of the pile is left; 0: nothing. A pile whose droplet has left
// sinks in for as long as it rose.
vec4 pile_tip(virga_droplet_gpu droplet, float time_s)
{
    const float age = droplet.age_s + time_s, free_s = unpackHalf2x16(droplet.weight_free).y;
    const bool free = (droplet.kind & VIRGA_DROPLET_FREE) != 0u && age > free_s;
    if (!free)
        return vec4(droplet_at(droplet, time_s), age > 0.0 ? 1.0 : 0.0);
    const float since = age - free_s;
    // Where it left: back along its path, a parabola for such a short time.
    const vec3 tip = droplet_at(droplet, time_s - since), base = base_of(droplet);
    const float rise_s = is_upright(droplet) ? sqrt(max(2.0 * (tip.y - base.y), 0.0) / GRAVITY) : max(free_s, 0.004);
    const float t = since / max(rise_s, 1e-4), left = max(1.0 - t * t, 0.0);
    return vec4(mix(base, tip, left), left);
}

float droplet_weight(virga_droplet_gpu droplet) { return unpackHalf2x16(droplet.weight_free).x; }

float near_fade(vec3 p) { return view.near_fade_m > 0.0 ? clamp(length(p) / view.near_fade_m - 1.0, 0.0, 1.0) : 1.0; }

// ---- crowns and sheets

// Sheets are listed by their index behind the oldest splash.
uint splash_slot(uint entry) { return ring_slot(state.first_splash, state.end_splash, look.max_splashes, entry); }

struct Crown {
    vec3 center; // relative to the camera
    vec3 normal;
    vec2 lean;
    float radius, height;  // at that time
    float widest, highest; // m
    vec2 along;            // (of a foot) x and z of its long axis, times by how much that is longer on each side, at
                           // that time (m)
    float share, life_s;   // fraction of its life
    float flown;           // share of its water that flies away as droplets
    uint model, droplets, random;
    float diameter, weight;
};

float splash_age(virga_splash_gpu splash, float time_s)
{
    return (float(look.tick - splash.tick) + 1.0 - splash.share) * look.tick_s + time_s;
}

float splash_weber(virga_splash_gpu splash)
{
    return 998.2 * splash.speed_m_s * splash.speed_m_s * splash.diameter_m / 0.0728;
}

// The low sheet of a scattering splash is as high as the water depth allows.
float sheet_share(uint state)
{
    return state == VIRGA_GROUND_PUDDLE_5 ? MAX_SHEET : state == VIRGA_GROUND_PUDDLE_3 ? 0.6 : 0.4;
}

Crown crown_at(virga_splash_gpu splash, float time_s)
{
    Crown crown;
    const float age = splash_age(splash, time_s), weber = splash_weber(splash);
    crown.center = to_vec(splash.position) + to_vec(view.origin_offset);
    crown.normal = to_vec(splash.normal);
    crown.lean = unpackHalf2x16(splash.lean);
    crown.along = vec2(0.0);
    crown.model = VIRGA_DROPLET_MODEL(splash.kind);
    crown.droplets = splash.kind >> 16 & 255u;
    crown.flown = float(splash.kind >> 24) / 256.0;
    crown.random = splash.random;
    crown.diameter = splash.diameter_m;
    crown.weight = unpackHalf2x16(splash.depth_weight).y;
    float highest = crown_height(splash.diameter_m, weber), widest = crown_radius(splash.diameter_m, weber);
    if (crown.model == VIRGA_SPLASH_SCATTERING) {
        highest *= sheet_share(VIRGA_DROPLET_STATE(splash.kind));
        widest *= 0.8;
    }
    if (crown.model == VIRGA_SPLASH_DOT) { // a collar; slow droplets hardly make one
        highest = min(highest, 1.5 * splash.diameter_m);
        widest = min(widest, 1.5 * splash.diameter_m);
    }
    const bool of_foot = (splash.kind & VIRGA_SPLASH_OF_FOOT) != 0u;
    if (of_foot) {
        // It rises at its speed until gravity has stopped it. Its width is the mean of those along and across.
        highest = 0.5 * splash.speed_m_s * splash.speed_m_s / GRAVITY;
        widest = 0.5 * (crown.lean.x + crown.lean.y);
        crown.along = crown.normal.xz * (0.5 * (crown.lean.x - crown.lean.y));
        crown.normal = vec3(0.0, 1.0, 0.0);
        crown.lean = vec2(0.0);
    }
    const float life = max(crown.model == VIRGA_SPLASH_DOT ? DOT_S : crown_time(highest), 1e-3);
    crown.share = age / life;
    crown.widest = widest;
    crown.highest = highest;
    crown.life_s = life;
    crown.height = age < 0.0 || age > life ? 0.0 : highest * crown_rise(crown.share);
    crown.radius = widest * crown_spread(crown.share);
    crown.along *= crown_spread(crown.share);
    if (crown.model == VIRGA_SPLASH_DISK) {
        // It spreads at once, shrinks to two thirds, and dries in the end.
        const float spread = smoothstep(0.0, 0.004, age), back = smoothstep(0.006, 0.05, age);
        crown.share = age / splash.life_s;
        crown.radius = disk_radius(splash.diameter_m, weber) * spread * (1.0 - 0.35 * back);
        const float volume = 0.5235988 * splash.diameter_m * splash.diameter_m * splash.diameter_m;
        const float thick = 2.0 * volume / (3.14159265 * max(crown.radius * crown.radius, 1e-9));
        crown.height = age < 0.0 || crown.share > 1.0 ? 0.0 : min(thick, splash.diameter_m);
    }
    return crown;
}

// Length in pixels at a view depth.
float pixels(float length_m, float distance) { return length_m / (max(distance, NEAR_W) * view.pixel_angle); }
