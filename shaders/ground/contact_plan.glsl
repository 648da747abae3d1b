// contact_plan.glsl - what a contact does with the water of a cell. Include contacts.glsl before.
#include "shared/crown_sheet.h"

#define FILM_UM      50          // stays on the ground, as on that which water has left
#define REACH_M      0.1         // heights of ground and patch differ by less

// Water that the tread carries, as a depth: 0.1 mm on three quarters of it, grooves of 8 mm on the rest. The formula is
// that of Flintsch et al. 2014, Splash and spray assessment tool development program (Virginia Tech, for FHWA), with
// the values of a tire of a car.
#define STICKS_M  0.0001
#define GROOVES_M 0.008
#define LAND      0.75
#define TREAD_UM  2075.0 // 1e6 (LAND STICKS_M + (1 - LAND) GROOVES_M)

#define TENSION    0.0728 // N/m
#define DENSITY    998.2  // kg/m^3
#define VISCOSITY  1.0e-6 // m^2/s
#define DRAINS_RAD 0.44   // mean angle of the tread at which its water leaves

struct Plan {
    bool moves;
    vec2 at;       // m, see in_contact
    vec2 outward;  // unit length: to where water is pushed
    float push_m;  // way out of the patch, into the first or second cell beside it
    float deep_m;  // of the water that moves
    float out_m_s; // speed of the sheet
    uint tread_nl; // flies off the tread
    uint sheet_nl; // flies to the sides
    uint pushed_nl;
    uint droplets;
    uint hash;
};

// Share of a tread's water that flies off. Surface tension holds drops up to a size d against the centrifugal force:
// rho v^2 / r d^2 = sigma. Of a layer as deep as TREAD_UM, what is farther than d from the rubber leaves. It leaves at
// an angle with an exponential distribution; behind the edge of a mudguard it does not leave.
float tread_share(uint contact)
{
    const float v = max(tick.contacts[contact].tread, 1e-3);
    const float held_m = sqrt(TENSION * tick.contacts[contact].radius_m / (DENSITY * v * v));
    return max(1.0 - held_m / (1e-6 * TREAD_UM), 0.0) * (1.0 - exp(-tick.contacts[contact].open_rad / DRAINS_RAD));
}

// Share of a sheet that breaks off and flies. A drop on a wall splashes if K = sqrt(We) Re^(1/4) is above 57.7 (Mundo,
// Sommerfeld and Tropea 1995), here of a layer of water that is hit by a wall.
float sheet_share(float deep_m, float speed)
{
    const float we = DENSITY * speed * speed * deep_m / TENSION, re = speed * deep_m / VISCOSITY;
    return max(1.0 - 57.7 / max(sqrt(we) * sqrt(sqrt(re)), 1.0), 0.0);
}

// The profile of a sole is blocks on half of it, with grooves of 4 mm between them. Until the grooves are full, water
// below the blocks runs into them, and only that below the outer halves of the outermost blocks leaves the patch. (The
// half, the depth and the width of a block are our estimates, of boots.)
#define PROFILE_M 0.004
#define BLOCK_M   0.01

// Share of the water that is more than fits into the grooves: it is driven out by the sole as a whole.
float over_profile(float deep_m) { return max(1.0 - 0.5 * PROFILE_M / max(deep_m, 1e-5), 0.0); }

// A plate of width B that sinks at a speed u into a depth h drives out water at v = u B / (2 h). The pressure is
// rho / 2 (v^2 - v(x)^2), where v(x) grows from the middle to the edge, so its mean is rho v^2 / 3. While a foot comes
// down it carries a quarter of the body (our estimate), 200 N on 0.028 m^2 or 7.1 kPa: v is at most 4.6 m/s.
float driven_out(uint contact, float width_m, float deep_m)
{
    return min(0.5 * tick.contacts[contact].press * width_m / max(deep_m, 1e-5), 4.6);
}

// Share of the water that leaves from below the outermost blocks: they cover a half of a rim that is half a block wide.
// Where K is too small, as in less than 0.3 mm, tension holds it (sheet_share).
float from_edge(uint contact, float deep_m)
{
    const vec2 half_m = vec2(tick.contacts[contact].half_m[0], tick.contacts[contact].half_m[1]);
    const vec2 inside = max(1.0 - 0.5 * BLOCK_M / half_m, 0.0);
    const bool breaks = sheet_share(deep_m, driven_out(contact, BLOCK_M, deep_m)) > 0.0;
    return breaks ? 0.5 * (1.0 - inside.x * inside.y) * (1.0 - over_profile(deep_m)) : 0.0;
}

// Speed v at which water leaves the patch of a foot: the mean of both kinds of water. The sole as a whole has a gap
// below it that is larger by its profile. At 0.7 m/s in 1.5 mm of water, v is 2.3 m/s, all of it from the edge.
float foot_speed(uint contact, float deep_m)
{
    const float width_m = 2.0 * min(tick.contacts[contact].half_m[0], tick.contacts[contact].half_m[1]);
    const float over = over_profile(deep_m), edge = from_edge(contact, deep_m);
    const float pressed = mix(driven_out(contact, width_m, deep_m + PROFILE_M),
                              driven_out(contact, BLOCK_M, deep_m), edge / max(over + edge, 1e-6));
    return length(vec2(pressed, 0.5 * tick.contacts[contact].speed));
}

// Share of the water under a foot that rises as a sheet. The layer that runs out at v meets that beside it, at rest and
// as deep. Where they meet, the water has nowhere to go but up (the kinematic discontinuity of Yarin and Weiss 1995,
// Impact of drops on solid surfaces; quoted from memory, derived here). Seen from there both come at the same speed c,
// as they have the same pressure (Bernoulli): v - c = c, c = v / 2. Equal layers that meet leave at a right angle to
// both, with their speed: so the sheet rises at v / 2 and goes out at v / 2.
//
// Each half is a stream that runs against a wall. Water heaps up there to the depth behind a hydraulic jump, h2 / h =
// (sqrt(1 + 8 F^2) - 1) / 2 with F^2 = c^2 / (g h) (Belanger), and runs away with it as a wave. What is thrown up at c
// is in the air for 2 c / g, and above h2 for sqrt(c^2 - 2 g h2) / c of that time: sqrt(1 - 2 (h2 / h) / F^2) of it is
// the sheet. In 14 mm of water that is none below v = 1.8 m/s, and a half at 2.5 m/s.
float rising_share(uint contact, float deep_m, float speed)
{
    const float froude2 = 0.25 * speed * speed / (9.81 * max(deep_m, 1e-5));
    const float heap = 0.5 * (sqrt(1.0 + 8.0 * froude2) - 1.0);
    const float pressed = over_profile(deep_m) + from_edge(contact, deep_m);
    return pressed * sqrt(max(1.0 - 2.0 * heap / max(froude2, 1e-6), 0.0));
}

// To the nearer side of a wheel; away from the middle of a foot.
vec2 outward_of(uint contact, vec2 at, uint hash)
{
    const float side = abs(at.y) > 1e-4 ? sign(at.y) : (hash & 1u) == 0u ? 1.0 : -1.0;
    if (tick.contacts[contact].radius_m > 0.0)
        return vec2(0.0, side);
    const vec2 half_m = vec2(tick.contacts[contact].half_m[0], tick.contacts[contact].half_m[1]);
    const vec2 away = vec2(clamp(at.x / half_m.x, -1.0, 1.0), at.y / half_m.y);
    return dot(away, away) > 1e-6 ? normalize(away) : vec2(0.0, side);
}

float way_out(uint contact, vec2 at, vec2 outward, uint hash)
{
    const vec2 half_m = vec2(tick.contacts[contact].half_m[0], tick.contacts[contact].half_m[1]);
    const float along = abs(outward.x) > 1e-3 ? (half_m.x - at.x * sign(outward.x)) / abs(outward.x) : 1e3;
    const float across = abs(outward.y) > 1e-3 ? (half_m.y - at.y * sign(outward.y)) / abs(outward.y) : 1e3;
    return max(min(along, across), 0.0) + tick.cell_m * (0.55 + 0.9 * virga_unit(virga_hash1(hash)));
}

bool touches(uint contact, uint cell_index, uint free_nl)
{
    const float above =
        tick.contacts[contact].height_m - float(floor_of(cell_index).height_um) * 1e-6;
    const bool wheel = tick.contacts[contact].radius_m > 0.0;
    const float surface = wheel ? REACH_M : float(free_nl) * tick.m_per_nl + 0.002;
    return above < surface && above > -REACH_M;
}

// Shares of flying water as droplets: one for each half microlitre, at least one for each kind of spray. A foot throws
// once in a step, and large drops that are seen one by one: four times as many.
uint droplets_of(uint tread_nl, uint sheet_nl, bool wheel)
{
    const uint kinds = min(tread_nl, 1u) + min(sheet_nl, 1u), nl = tread_nl + sheet_nl;
    const uint most = wheel ? tick.contact_droplets : min(4u * tick.contact_droplets, 64u);
    return nl == 0u ? 0u : max(min(nl / 500u, most), kinds);
}

// The front of a wheel passes a cell once: then the tread takes its share. All later the wheel only pushes aside what
// flows under it, as the grooves are full.
void plan_wheel(uint contact, uint moved, inout Plan plan)
{
    const bool fresh = plan.at.x > tick.contacts[contact].half_m[0] - tick.contacts[contact].swept_m;
    const uint carried = min(moved, uint(TREAD_UM * float(tick.nl_per_um)));
    precise float tread = float(carried) * tread_share(contact);
    plan.tread_nl = fresh && tick.contact_droplets > 0u ? min(uint(tread), carried) : 0u;
    plan.pushed_nl = moved - carried;
    plan.out_m_s = tick.contacts[contact].speed;
}

// Water of several cells may go to one: from the middle of the patch to its edge.
uint most_moved(uint contact)
{
    const float half_m = max(tick.contacts[contact].half_m[0], tick.contacts[contact].half_m[1]);
    return 0x40000000u / (uint(half_m * tick.inv_cell_m) + 2u);
}

Plan plan_of(Near near)
{
    Plan plan;
    plan.moves = false;
    plan.tread_nl = plan.sheet_nl = plan.pushed_nl = plan.droplets = 0u;
    plan.at = in_contact(near.contact, middle_of(near.cell));
    if (near.cell_index == NO_CELL || !covers(near.contact, plan.at))
        return plan;
    for (uint before = 0u; before < near.contact; before++)
        if (covers(before, in_contact(before, middle_of(near.cell))))
            return plan;
    const uint free_nl = cells[near.cell_index].free_nl;
    const virga_soil_gpu soil = tick.soils[floor_of(near.cell_index).material];
    const uint stays = max(uint(FILM_UM * tick.nl_per_um), hidden_nl(soil));
    if (free_nl <= stays || !touches(near.contact, near.cell_index, free_nl))
        return plan;
    const uint moved = min(free_nl - stays, most_moved(near.contact));
    plan.hash = virga_hash4(tick.seed ^ tick.contacts[near.contact].id * 0x9e3779b9u, uint(near.cell.x),
                            uint(near.cell.y), tick.tick);
    plan.moves = true;
    plan.outward = outward_of(near.contact, plan.at, plan.hash);
    plan.push_m = way_out(near.contact, plan.at, plan.outward, plan.hash);
    plan.pushed_nl = moved;
    plan.deep_m = float(moved) * tick.m_per_nl;
    const bool wheel = tick.contacts[near.contact].radius_m > 0.0;
    if (wheel)
        plan_wheel(near.contact, moved, plan);
    else
        plan.out_m_s = foot_speed(near.contact, plan.deep_m);
    // Of a foot's sheet, the fingers come off as drops. The rest falls back and is counted as pushed.
    const float share = wheel ? sheet_share(float(plan.pushed_nl) * tick.m_per_nl, plan.out_m_s)
                              : VIRGA_CROWN_SHED * rising_share(near.contact, plan.deep_m, plan.out_m_s);
    precise float flies = float(plan.pushed_nl) * share;
    plan.sheet_nl = tick.contact_droplets > 0u ? min(uint(flies), plan.pushed_nl) : 0u;
    plan.pushed_nl -= plan.sheet_nl;
    plan.droplets = droplets_of(plan.tread_nl, plan.sheet_nl, wheel);
    return plan;
}
