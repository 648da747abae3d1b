// contact_throw.glsl - the droplets of a plan: where they are at the end of the tick, how fast and how large. Include
// contact_plan.glsl before.
#include "shared/handed_droplet.h"

layout(scalar, set = 0, binding = 27) buffer Handed
{
    virga_handed_droplets_gpu handed_head;
    virga_handed_droplet_gpu handed[];
};

#define GRAVITY 9.81
#define SHOWN_S 0.12 // droplets of a wheel are seen at once: see CLEAR_S in splash/draw/sprite.glsl

// Diameters. Behind a groove the mean is 0.8 mm at We = 2700, and falls as We^(-1/2); We is of the tread's speed and
// the groove's width, here 1 cm (Radovich and Plocher 2009, Experiments on spray from a rolling tire, and the thesis at
// the University of Southern California that followed). They spread from a tenth of the mean to ten times, so ln d gets
// a standard deviation of 0.6. Half of the water is then in drops above 2.46 times the mean: exp(2.5 0.6^2). For sheets
// the width of the groove is replaced by the depth of the water.
#define MEAN_M   0.0008
#define MEAN_WE  2700.0
#define GROOVE_M 0.01
#define SPREAD   0.6
#define BY_WATER 2.46

// Each of mean 0 and variance 1, nearly normal: the sum of four uniform numbers.
float normal_of(uint hash)
{
    const vec4 four = unpackUnorm4x8(hash) + (0.5 / 256.0);
    return 1.7320508 * (dot(four, vec4(1.0)) - 2.0);
}

// Of a drop that has all of it: (6 volume / pi)^(1/3).
float diameter_of_water(uint water_nl) { return pow(1.909859317e-12 * float(water_nl), 1.0 / 3.0); }

float diameter_of(float width_m, float speed, uint hash, uint water_nl)
{
    const float we = max(DENSITY * speed * speed * width_m / TENSION, 1.0);
    const float d = BY_WATER * MEAN_M * sqrt(MEAN_WE / we) * exp(SPREAD * normal_of(hash));
    return min(clamp(d, 0.0001, 0.005), diameter_of_water(water_nl));
}

// Drops of a foot's sheet. Its rim is as thick as b = sqrt(sigma / (rho a)), where a is its deceleration, here that of
// gravity: 2.7 mm (Wang, Dandekar, Bustos, Poulain and Bourouiba 2018, Universal rim thickness in unsteady sheet
// fragmentation). The fingers that grow from it are 0.6 as thick (crown_sheet.h), and break into drops 1.89 times as
// wide as they, of the volume of one wavelength (Rayleigh). Their sizes have the gamma law of fourth order (Villermaux,
// Marmottant and Duplat 2004, Ligament-mediated spray formation), whose mean volume is that of a drop
// (5 x 6 / 4^2)^(1/3) = 1.233 times as wide as the mean: so this is 2.5 mm. A sum of four exponential numbers has that
// law. Both papers are quoted from memory.
#define FOOT_MEAN_M 0.0025
float foot_diameter(uint hash)
{
    const vec4 four = unpackUnorm4x8(hash) * (255.0 / 256.0) + (0.5 / 256.0);
    return clamp(-0.25 * FOOT_MEAN_M * log(four.x * four.y * four.z * four.w), 0.0005, 0.006);
}

// What begins at a place of the contact: along, across, up; and moves.
struct Start {
    vec3 at, velocity;
};

// A point of the tread that is at an angle behind the patch moves ahead with v - w cos and up with w sin, where v is
// the speed of the axle and w that of the tread.
Start start_on_tread(uint contact, uint hash)
{
    const float covered = exp(-tick.contacts[contact].open_rad / DRAINS_RAD);
    const float angle = -DRAINS_RAD * log(1.0 - virga_unit(hash) * (1.0 - covered));
    const float r = tick.contacts[contact].radius_m, w = tick.contacts[contact].tread;
    const float across = tick.contacts[contact].half_m[1] * (2.0 * virga_unit(virga_hash2(hash, 1u)) - 1.0);
    const float aside = 0.1 * w * normal_of(virga_hash2(hash, 2u));
    Start start;
    start.at = vec3(-tick.contacts[contact].half_m[0] - r * sin(angle), across, 0.005 + r * (1.0 - cos(angle)));
    start.velocity = vec3(tick.contacts[contact].speed - w * cos(angle), aside, w * sin(angle));
    return start;
}

// Water before a wheel is hit by a wedge with half the angle a, narrow at its edges and blunt in its middle. The wall
// moves at v sin(a) in the direction of its normal, (sin a, cos a). Water that sticks to it gets that speed, and a free
// sheet, which keeps its energy (Bernoulli), twice as much: 1.4 times is between the two. The sheet rises at 5 to 40
// degrees.
#define WEDGE 1.4
Start start_at_wheel(uint contact, Plan plan, uint hash)
{
    const float half_m = tick.contacts[contact].half_m[1];
    const float a = mix(1.2, 0.6, min(abs(plan.at.y) / half_m, 1.0)) + 0.12 * normal_of(virga_hash2(hash, 1u));
    const float speed = WEDGE * plan.out_m_s * sin(a), rises = mix(0.09, 0.7, virga_unit(virga_hash2(hash, 2u)));
    Start start;
    start.at = vec3(tick.contacts[contact].half_m[0] * (2.0 * virga_unit(hash) - 1.0), half_m * plan.outward.y, 0.01);
    start.velocity =
        speed * vec3(sin(a), cos(a) * plan.outward.y * cos(rises), max(cos(a), 0.5) * sin(rises));
    return start;
}

// Drops from the edge of a foot's sheet: they go out and up at half the speed each as it does (rising_share), some of
// them a little faster, so that they fly ahead of it.
Start start_at_foot(uint contact, Plan plan, uint hash)
{
    const float turn = 0.2 * normal_of(virga_hash2(hash, 1u));
    const vec2 o = plan.outward, out_now = vec2(o.x * cos(turn) - o.y * sin(turn), o.x * sin(turn) + o.y * cos(turn));
    const vec2 faster = 1.0 + vec2(0.35, 0.25) * vec2(virga_unit(hash), virga_unit(virga_hash2(hash, 2u)));
    Start start;
    start.at = vec3(plan.at + o * max(plan.push_m - tick.cell_m, 0.0), 0.005);
    start.velocity = 0.5 * plan.out_m_s * vec3(faster.x * out_now, faster.y);
    start.velocity.x += 0.3 * tick.contacts[contact].speed;
    return start;
}

// From along and across to the world.
vec3 to_world(uint contact, vec3 v)
{
    const vec2 ahead = ahead_of(contact), level = v.x * ahead + v.y * vec2(-ahead.y, ahead.x);
    return vec3(level.x, v.z, level.y);
}

// `ago_s`: time from the start to the end of the tick, in which the contact went on.
void write_droplet(Near near, Start start, float ago_s, virga_handed_droplet_gpu droplet, uint at)
{
    const vec2 from = out_of_contact(near.contact, start.at.xy - vec2(tick.contacts[near.contact].speed * ago_s, 0.0));
    const float floor_m = float(floor_of(near.cell_index).height_um) * 1e-6, late_s = ago_s + tick.handed_late_s;
    vec3 velocity = to_world(near.contact, start.velocity);
    vec3 position = vec3(from.x, max(floor_m, tick.contacts[near.contact].height_m) + start.at.z, from.y);
    position += velocity * late_s - vec3(0.0, 0.5 * GRAVITY * late_s * late_s, 0.0) -
                vec3(tick.handed_offset[0], tick.handed_offset[1], tick.handed_offset[2]);
    velocity.y -= GRAVITY * late_s;
    droplet.position = float[3](position.x, position.y, position.z);
    droplet.velocity = float[3](velocity.x, velocity.y, velocity.z);
    // Those of a foot appear when they leave the sheet, which is drawn as one.
    droplet.age_s = (tick.contacts[near.contact].radius_m > 0.0 ? SHOWN_S : 0.001) + late_s;
    handed[at] = droplet;
}

// Up to a factor.
float volume_of(uint hash)
{
    const float d = foot_diameter(virga_hash2(hash, 7u));
    return d * d * d;
}

// Each stands for as many of its size, so the water is shared by their volumes.
void throw_from_foot(Near near, Plan plan, uint first)
{
    float all = 0.0;
    for (uint i = 0u; i < plan.droplets; i++)
        all += volume_of(virga_hash2(plan.hash, i));
    uint left_nl = plan.sheet_nl;
    for (uint i = 0u; i < plan.droplets; i++) {
        const uint hash = virga_hash2(plan.hash, i), later = plan.droplets - 1u - i;
        const float volume = volume_of(hash);
        const uint share_nl = clamp(uint(float(plan.sheet_nl) * (volume / all)), 1u, left_nl - later);
        virga_handed_droplet_gpu droplet;
        droplet.id = plan.hash;
        droplet.number = i;
        droplet.water_nl = later == 0u ? left_nl : share_nl;
        left_nl -= droplet.water_nl;
        droplet.diameter_m = min(foot_diameter(virga_hash2(hash, 7u)), diameter_of_water(droplet.water_nl));
        const float d = droplet.diameter_m;
        droplet.drops = float(droplet.water_nl) * 1.909859317e-12 / (d * d * d);
        const float ago = virga_unit(virga_hash2(hash, 5u));
        write_droplet(near, start_at_foot(near.contact, plan, hash), ago * tick.tick_s, droplet, first + i);
    }
}

void throw_from_wheel(Near near, Plan plan, uint first)
{
    const uint contact = near.contact, all_nl = plan.tread_nl + plan.sheet_nl;
    const uint by_water = uint(float(plan.droplets) * (float(plan.tread_nl) / float(all_nl)) + 0.5);
    const uint most = plan.sheet_nl > 0u ? plan.droplets - 1u : plan.droplets;
    const uint treads = plan.tread_nl > 0u ? clamp(by_water, 1u, most) : 0u;
    const float swept = tick.contacts[contact].swept_m, half_m = tick.contacts[contact].half_m[0];
    const float passed = swept > 0.0 ? clamp((half_m - plan.at.x) / swept, 0.0, 1.0) : 0.0;
    for (uint i = 0u; i < plan.droplets; i++) {
        const bool tread = i < treads;
        const uint of_kind = tread ? treads : plan.droplets - treads, number = tread ? i : i - treads;
        const uint kind_nl = tread ? plan.tread_nl : plan.sheet_nl;
        const uint hash = virga_hash2(plan.hash, i);
        const float cell_s = swept > 0.0 ? min(tick.cell_m / swept, 1.0) : 0.0;
        const float ago = clamp(passed + cell_s * (virga_unit(virga_hash2(hash, 6u)) - 0.5), 0.0, 1.0);
        virga_handed_droplet_gpu droplet;
        droplet.id = plan.hash;
        droplet.number = i;
        droplet.water_nl = kind_nl / of_kind + (number == 0u ? kind_nl % of_kind : 0u);
        const float width_m = tread ? GROOVE_M : plan.deep_m;
        const float speed = tread ? tick.contacts[contact].tread : plan.out_m_s;
        droplet.diameter_m = diameter_of(width_m, speed, virga_hash2(hash, 7u), droplet.water_nl);
        const float d = droplet.diameter_m;
        droplet.drops = float(droplet.water_nl) * 1.909859317e-12 / (d * d * d);
        const Start start = tread ? start_on_tread(contact, hash) : start_at_wheel(contact, plan, hash);
        write_droplet(near, start, ago * tick.tick_s, droplet, first + i);
    }
}

void throw_droplets(Near near, Plan plan, uint first)
{
    if (tick.contacts[near.contact].radius_m > 0.0)
        throw_from_wheel(near, plan, first);
    else
        throw_from_foot(near, plan, first);
}
