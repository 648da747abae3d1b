// sprite.glsl - what the slots of sprites stand for, and how much of the picture each would cover.
#include "view.glsl"

#define SLOT_NONE    0u
#define SLOT_DROPLET 1u
#define SLOT_PILE    2u
#define SLOT_SPLASH  3u

struct Slot {
    uint kind;
    uint item;
};

Slot slot_of(uint slot)
{
    const uint span = state.view_groups[0] * VIRGA_SPLASH_GROUP;
    Slot found = Slot(SLOT_NONE, NO_SLOT);
    if (slot < 3u * span) {
        found.kind = slot < 2u * span ? SLOT_DROPLET : SLOT_PILE;
        found.item = slot < span ? slot : slot < 2u * span ? slot - span : slot - 2u * span;
        if (found.item >= state.staying)
            found.item = NO_SLOT;
    } else {
        found.kind = SLOT_SPLASH;
        found.item = ring_slot(state.first_splash, state.end_splash, look.max_splashes, slot - 3u * span);
    }
    if (found.item == NO_SLOT)
        found.kind = SLOT_NONE;
    return found;
}

// A sprite before projection.
struct Sprite {
    uint kind;
    vec3 head, tail; // relative to the camera: at the end and at the start of the shutter
    vec3 normal;     // (puff) of the surface that it stands on, from tail to head
    bool moves;      // head and tail are at different times
    vec2 widths;     // m, at head and tail
    float body;      // m; 0: its whole length
    float gain, weight;
    float solid;
    float spread; // (puff) radius (m) in which the drops lie that it stands for
    uint id;
};

Sprite empty_sprite()
{
    Sprite sprite;
    sprite.kind = VIRGA_SPRITE_DROPLET;
    sprite.head = sprite.tail = sprite.normal = vec3(0.0);
    sprite.moves = false;
    sprite.widths = vec2(0.0);
    sprite.body = 0.0;
    sprite.gain = 1.0;
    sprite.weight = 0.0;
    sprite.solid = 1.0;
    sprite.spread = 0.0;
    sprite.id = 0u;
    return sprite;
}

#define CLEAR_S 0.15 // age of spray from which on it is as visible as other droplets

// Spray that stands for many droplets is a cloud of them, which widens as they part. Of several that are thrown at the
// same place one in CLOUDS is drawn so, for all of them, as clouds cover many pixels; the others show single drops.
//
// A cloud's coverage falls from its middle as (1 - r^2 / R^2)^2, whose integral is pi R^2 / 3. That is the area of its
// drops, pi / 4 d^2 each.
#define CLOUDS      2
#define CLOUD_DROPS 8.0  // fewer are no cloud
#define CLOUD_M     0.05 // radius when they leave a cell
#define CLOUD_M_S   0.45 // by which it widens
#define MAX_CLOUD_M 0.5

void make_cloud(virga_droplet_gpu droplet, float age_s, inout Sprite sprite)
{
    const float radius = min(CLOUD_M + CLOUD_M_S * age_s, MAX_CLOUD_M), d = droplet.diameter_m;
    sprite.kind = VIRGA_SPRITE_CLOUD;
    sprite.widths = vec2(2.0 * radius);
    sprite.body = 2.0 * radius;
    sprite.gain = 0.75 * float(CLOUDS) * d * d / (radius * radius);
}

// All of these `ago_s` before the time that is drawn, 0 for now.
Sprite droplet_sprite(virga_droplet_gpu droplet, float ago_s)
{
    Sprite sprite = empty_sprite();
    const bool rests = (droplet.kind & VIRGA_DROPLET_ALIVE) == 0u || droplet.age_s + view.time_close_s <= 0.0;
    sprite.head = droplet_at(droplet, view.time_close_s - ago_s);
    sprite.tail = is_film() ? droplet_at(droplet, view.time_open_s - ago_s) : sprite.head;
    sprite.moves = is_film();
    sprite.widths = vec2(droplet.diameter_m);
    sprite.body = droplet.diameter_m;
    sprite.weight = rests ? 0.0 : droplet_weight(droplet);
    // Water that has just left is clear; it takes a moment until it shows its surroundings as drops do. So spray does
    // not change at once when water hands it over.
    if ((droplet.kind & VIRGA_DROPLET_SPRAY) != 0u)
        sprite.gain = clamp((droplet.age_s + view.time_close_s - ago_s) / CLEAR_S, 0.1, 1.0);
    if ((droplet.kind & VIRGA_DROPLET_SPRAY) != 0u && sprite.weight > CLOUD_DROPS && is_film() &&
        VIRGA_DROPLET_INDEX(droplet.kind) % uint(CLOUDS) == 0u)
        make_cloud(droplet, max(droplet.age_s + view.time_close_s - ago_s, 0.0), sprite);
    sprite.id = droplet.id;
    return sprite;
}

// A pile narrows from its foot to a neck that is thinner than its droplet; a cone has a wider foot.
vec2 pile_widths(virga_droplet_gpu droplet, float left)
{
    const float foot = is_upright(droplet) ? 4.0 : 2.2, neck = is_upright(droplet) ? 0.95 : 0.7;
    return droplet.diameter_m * vec2(neck, foot) * (is_upright(droplet) ? 1.0 : sqrt(left));
}

Sprite pile_sprite(virga_droplet_gpu droplet, float ago_s)
{
    Sprite sprite = empty_sprite();
    const vec4 now = pile_tip(droplet, view.time_close_s - ago_s), before = pile_tip(droplet, view.time_open_s - ago_s);
    const vec3 base = base_of(droplet);
    const float now_m = distance(now.xyz, base) * step(1e-4, now.w),
                before_m = distance(before.xyz, base) * step(1e-4, before.w);
    const bool longer = now_m >= before_m;
    sprite.kind = VIRGA_SPRITE_PILE;
    sprite.head = longer ? now.xyz : before.xyz;
    sprite.tail = base;
    // It is there all of the time up to the height that it has at both ends of the shutter.
    sprite.solid = min(now_m, before_m) / max(max(now_m, before_m), 1e-6);
    sprite.widths = pile_widths(droplet, max(now.w, before.w));
    // A crown has fewer fingers than droplets: droplets between them were torn off the rim at once.
    const bool crown = VIRGA_DROPLET_MODEL(droplet.kind) == VIRGA_SPLASH_CROWN_CONE;
    const bool finger = is_upright(droplet) ||
                        (!crown && (!is_film() || look.physical == 0u || VIRGA_DROPLET_INDEX(droplet.kind) % 3u == 0u));
    const bool visible = (droplet.kind & VIRGA_DROPLET_ALIVE) != 0u && (droplet.kind & VIRGA_DROPLET_SPRAY) == 0u &&
                         finger && max(now_m, before_m) > 1e-5;
    sprite.weight = visible ? droplet_weight(droplet) : 0.0;
    sprite.id = droplet.id;
    return sprite;
}

// A splash that is too small for a sheet: a soft blob (puff) with the coverage of its sheet, and of its droplets where
// they are not simulated (a seventh of the drop's water in a dozen of them). One that stands for several shows them
// side by side.
Sprite puff_sprite(virga_splash_gpu splash, float ago_s)
{
    Sprite sprite = empty_sprite();
    const Crown crown = crown_at(splash, 0.5 * (view.time_close_s + view.time_open_s) - ago_s);
    const float age = max(splash_age(splash, view.time_close_s - ago_s), 0.0), t = age / splash.life_s;
    const bool of_foot = (splash.kind & VIRGA_SPLASH_OF_FOOT) != 0u;
    const bool alone =
        crown.droplets == 0u && !of_foot && crown.model != VIRGA_SPLASH_DOT && crown.model != VIRGA_SPLASH_DISK;
    const float spread = alone ? 0.04 * splash.speed_m_s * age : 0.0;
    const float across = 2.0 * (crown.radius + spread), up = max(crown.height + spread, 0.2 * across);
    float area = crown.model == VIRGA_SPLASH_DISK ? 0.3 * across * across : 2.0 * crown.radius * crown.height;
    if (alone && t < 1.0)
        area += 2.5 * crown.diameter * crown.diameter * (1.0 - t);
    sprite.kind = VIRGA_SPRITE_PUFF;
    sprite.tail = crown.center;
    sprite.head = crown.center + crown.normal * up;
    sprite.normal = crown.normal;
    sprite.widths = vec2(across);
    sprite.body = across;
    // Surfaces other than ground, such as a leaf or a railing, may end beside the drop.
    const bool ground = VIRGA_DROPLET_STATE(splash.kind) != VIRGA_GROUND_NONE;
    const float beside = SPACING * VIRGA_GROUND_DROP_M * sqrt(max(crown.weight - 1.0, 0.0));
    sprite.spread = ground ? min(beside, VIRGA_GROUND_CROWNS_M) : 0.0;
    sprite.weight = t <= 1.0 && area > 0.0 ? crown.weight : 0.0;
    sprite.gain = area / max(across * up, 1e-8);
    // Pieces of one impact have the same id, so it is a number of the splash's own.
    const float part = clamp(crown.radius / max(crown.radius + spread, 1e-6), 0.01, 1.0);
    const float ring = crown.model == VIRGA_SPLASH_DISK ? 0.0 : part;
    sprite.id = (splash.random & 1023u) | uint(1023.0 * min(t, 1.0)) << 10 | uint(255.0 * ring) << 20;
    return sprite;
}

Sprite sprite_of(Slot slot, float ago_s)
{
    if (slot.kind == SLOT_NONE)
        return empty_sprite();
    if (slot.kind == SLOT_SPLASH)
        return puff_sprite(splash_of(slot.item), ago_s);
    const virga_droplet_gpu droplet = droplet_of(slot.item);
    if (slot.kind == SLOT_PILE)
        return pile_sprite(droplet, ago_s);
    return droplet_sprite(droplet, ago_s);
}

// A sprite on the picture.
struct Projected {
    vec4 head, tail; // clip coordinates
    float width_px, way_px, body_px;
    float coverage;      // of its middle; 0: not visible
    float columns, rows; // (puff) how many puffs beside and behind each other
    float spread_px;     // by which they are wider than one
    float one_share;     // height of one of them, as a fraction of the sprite's
    float sine;          // sine of the elevation from which it is seen: depth over width of its rim on the picture
};

// Seen from the side, a disc is a line. The exact positions of an impact's drops are unknown, so the flatter the view,
// the more they are scattered in depth (m), and the less sideways.
vec2 scatter_m(float spread, float sine, float distance)
{
    const float longer = clamp(MIN_FLATNESS / max(sine, 1e-3), 1.0, MAX_STRETCH);
    return spread * vec2(inversesqrt(longer), min(sqrt(longer), max(MAX_REACH * distance / max(spread, 1e-3), 1.0)));
}

// Both ends get the depth of the ground at their position, or the ground in front would hide the foot; slightly nearer,
// since distances on the picture are those of a chord.
void set_ground_depth(Sprite sprite, float reach_m, inout Projected p)
{
    const mat4 m = to_mat(view.clip_from_rel);
    const vec3 level = sprite.tail - sprite.normal * dot(sprite.normal, sprite.tail);
    const vec3 away = level * inversesqrt(max(dot(level, level), 1e-12));
    const float middle = p.tail.w, reach = min(reach_m, 0.5 * middle);
    const float nearer = min(reach * reach / middle + distance(sprite.head, sprite.tail), 0.25 * middle);
    const vec4 before = project(m, sprite.tail - away * (nearer + reach)),
               behind = project(m, sprite.tail - away * (nearer - reach));
    p.tail = vec4(p.tail.xy / p.tail.w * before.w, before.zw);
    p.head = vec4(p.head.xy / p.head.w * behind.w, behind.zw);
}

// A puff spans from the near side of its rim to the far one. Several are spread over an ellipse, the projection of a
// disc on the ground; some are twice as high as the mean.
void project_puff(Sprite sprite, float nearest, float drawn, vec2 up, inout Projected p)
{
    p.sine = abs(dot(normalize(sprite.tail), sprite.normal));
    p.body_px = max(p.width_px, drawn);
    const vec2 scatter = scatter_m(sprite.spread, p.sine, p.tail.w);
    const float wide_px = pixels(2.0 * scatter.x, nearest), each_px = max(1.5 * p.width_px, MIN_SPACING * drawn);
    const float rim_px = 0.5 * p.sine * p.body_px, high_px = p.way_px;
    float below_px = rim_px, above_px = rim_px, reach_m = 0.5 * sprite.body;
    p.columns = clamp(floor(min(sprite.weight, wide_px / each_px + 1.0)), 1.0, float(MAX_COLUMNS));
    if (p.columns > 1.5) {
        const float deep_px = pixels(2.0 * scatter.y, nearest) * p.sine;
        below_px += 0.5 * deep_px;
        above_px += 0.5 * deep_px + high_px;
        p.rows = min(sprite.weight / p.columns, deep_px / (1.5 * (high_px + 2.0 * rim_px + 1.0)));
        p.rows = clamp(floor(p.rows), 1.0, float(MAX_ROWS));
        p.spread_px = wide_px;
        reach_m += scatter.y;
    }
    set_ground_depth(sprite, reach_m, p);
    const vec2 pixel = 2.0 * up / vec2(view.viewport[2], view.viewport[3]);
    p.head.xy += above_px * pixel * p.head.w;
    p.tail.xy -= below_px * pixel * p.tail.w;
    p.one_share = high_px / max(high_px + below_px + above_px, 1e-3);
}

Projected project_sprite(Sprite sprite)
{
    Projected p;
    p.head = project(to_mat(view.clip_from_rel), sprite.head);
    if (sprite.moves)
        p.tail = project(to_mat(view.open_clip_from_rel), sprite.tail);
    else
        p.tail = project(to_mat(view.clip_from_rel), sprite.tail);
    if (sprite.moves) {
        // Each sub-frame has a part of the path. With a jitter of its own it would not begin where the one before ends.
        p.head.xy -= vec2(view.jitter[0], view.jitter[1]) * p.head.w;
        p.tail.xy -= vec2(view.jitter[0], view.jitter[1]) * p.tail.w;
    }
    p.coverage = 0.0;
    p.width_px = p.way_px = p.body_px = p.spread_px = 0.0;
    p.columns = p.rows = p.one_share = 1.0;
    p.sine = 0.0;
    const float nearest = min(p.head.w, p.tail.w);
    if (sprite.weight <= 0.0 || nearest < NEAR_W)
        return p;
    const vec2 moved = (p.head.xy / p.head.w - p.tail.xy / p.tail.w) * 0.5 * vec2(view.viewport[2], view.viewport[3]);
    p.way_px = length(moved);
    p.width_px = pixels(max(sprite.widths.x, sprite.widths.y), nearest);
    const float drawn = max(view.min_width_px, 1e-3);
    p.body_px = pixels(sprite.body, nearest);
    if (sprite.kind == VIRGA_SPRITE_PUFF) {
        const vec2 up = p.way_px > 1e-3 ? moved / p.way_px : vec2(0.0, -1.0);
        project_puff(sprite, nearest, drawn, up, p);
    }
    const float beyond = (p.width_px + p.spread_px + 2.0) * max(p.head.w, p.tail.w);
    const vec2 margin = beyond / vec2(view.viewport[2], view.viewport[3]);
    const vec2 high = min(p.head.xy - p.head.w, p.tail.xy - p.tail.w),
               low = min(-p.head.xy - p.head.w, -p.tail.xy - p.tail.w);
    if (any(greaterThan(high, margin)) || any(greaterThan(low, margin)))
        return p;
    const float mean_px =
        sprite.kind == VIRGA_SPRITE_PILE ? pixels(0.5 * (sprite.widths.x + sprite.widths.y), nearest) : p.width_px;
    float one = sprite.gain * look.gain * min(mean_px / drawn, 1.0);
    // (puff) from above it covers its width instead of its height
    const float high_px = max(p.way_px, 0.2 * p.width_px);
    float shown = one;
    if (sprite.kind == VIRGA_SPRITE_DROPLET)
        shown *= min(p.body_px / max(p.way_px, 1.0), 1.0);
    else if (sprite.kind == VIRGA_SPRITE_PILE)
        shown = one *= min(max(p.way_px, 0.05), 1.0);
    else if (sprite.kind == VIRGA_SPRITE_PUFF) {
        // A blob is drawn one pixel higher and half a pixel wider than it is, see puff_cover.
        const float wide_px = max(p.width_px, drawn);
        shown = one *= high_px / (high_px + 1.0) * wide_px / (wide_px + 0.5);
    }
    const float many = sprite.weight / (p.columns * p.rows);
    const float all = min(shown * many, max(shown, MAX_COVERAGE)) / max(shown, 1e-9) * one;
    const float fade = clamp(shown * many / MIN_COVERAGE - 1.0, 0.0, 1.0);
    p.coverage = min(all, max(look.gain, 1.0)) * fade * near_fade(0.5 * (sprite.head + sprite.tail));
    if (sprite.kind == VIRGA_SPRITE_PUFF)
        p.coverage *= (high_px + 1.0) / (p.way_px + 1.0);
    return p;
}

// Whether a splash's sheet is large enough on the picture to be drawn as a sheet.
bool is_sheet(virga_splash_gpu splash, Crown crown)
{
    const float distance = project(to_mat(view.clip_from_rel), crown.center).w;
    const float size = crown.model == VIRGA_SPLASH_DISK  ? crown.radius
                       : crown.model == VIRGA_SPLASH_DOT ? 1.5 * crown.diameter
                       : (splash.kind & VIRGA_SPLASH_OF_FOOT) != 0u
                           ? crown.highest
                           : crown_height(splash.diameter_m, splash_weber(splash));
    return distance > NEAR_W && pixels(size, distance) >= MESH_PX;
}
