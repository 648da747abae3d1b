// wakes.glsl - the waves that wheels and feet make on puddles: where a contact has moved water in a tick, a crater of
// that volume begins a ring wave. Include contacts.glsl and rings.glsl before.
//
// The rings of one tick and those of the ticks before it add up to the wake (Huygens). Where a wheel is faster than the
// waves, v > c = sqrt(g h) in shallow water, the fronts of its rings lie on two lines at an angle of asin(c / v) to its
// path (Mach); a slower one, and a foot that treads down, has rings around it. So no angle is computed anywhere.
//
// Depth d of a crater, from the volume V that a contact of width w has moved: the hole of the table's crater, d (1 - x)
// exp(-x) with x = r^2 / a^2, has a volume inside r = a of
//     int_0^a d (1 - x) exp(-x) 2 pi r dr = pi a^2 d int_0^1 (1 - x) exp(-x) dx = pi a^2 d / e
// A wide contact would leave holes deeper than the water, as all craters of a row have the same width. The volume of a
// stretch as long as a crater is wide is at most w a h, and there the crater is half as deep as the water, as those of
// drops are at most: d = V / (2 w a). The smaller of the two holds:
//     d = V / max(pi a^2 / e, 2 w a)
// That is the mean of a way: cells do not end where places do, so that single craters are up to 0.7 h deep.
// Both are linear in V, so it does not matter into how many craters a way is cut.
//
// Energy: a crater has (pi / 8 rho g a^2 + 3 pi / 4 sigma) d^2 (see rings.glsl), 0.1 mJ for d = 2.5 mm. The step that
// makes four of them in 5 mm of water moves 0.14 kg at up to 7.7 m/s, 4 J: waves get a ten thousandth of what the
// contact gives. They move no water from cell to cell, contact.comp has done so.

#define WAKE_BINS  8u    // places of a contact, along its way in a tick, where waves may begin
#define WAKE_M     0.07  // between two of them: a crater's width (the last of VIRGA_RING_WIDTH_LIST)
#define WAKE_HOLE  1.156 // pi / e
#define WAKE_WIDTH uint(VIRGA_RING_WIDTHS - 1)
#define PER_NL     1024u // water is added up in units of so many nl, so that sums fit into 32 bits
#define PER_M      1e4   // places are added up in tenths of millimetres

// Of each place: water that left its cells, the depth that it had (um), cells, and the sum of where they are. Sums of
// integers, so that the order of invocations does not matter.
shared uint wake_water[VIRGA_GROUND_CONTACTS * WAKE_BINS], wake_um[VIRGA_GROUND_CONTACTS * WAKE_BINS],
    wake_cells[VIRGA_GROUND_CONTACTS * WAKE_BINS];
shared int wake_along[VIRGA_GROUND_CONTACTS * WAKE_BINS], wake_across[VIRGA_GROUND_CONTACTS * WAKE_BINS];
shared uint wake_count[VIRGA_GROUND_CONTACTS];

void clear_wakes()
{
    for (uint i = gl_LocalInvocationIndex; i < VIRGA_GROUND_CONTACTS * WAKE_BINS; i += uint(VIRGA_GROUND_LANES)) {
        wake_water[i] = wake_um[i] = wake_cells[i] = 0u;
        wake_along[i] = wake_across[i] = 0;
    }
}

// A contact took water from a cell.
void stir(uint contact, vec2 at, uint gone_nl, uint free_nl)
{
    const float half_m = tick.contacts[contact].half_m[0], from_m = at.x + half_m + tick.contacts[contact].swept_m;
    const float length_m = 2.0 * half_m + tick.contacts[contact].swept_m;
    const float bins = clamp(floor(length_m / WAKE_M), 1.0, float(WAKE_BINS));
    const uint bin = contact * WAKE_BINS + uint(clamp(bins * from_m / length_m, 0.0, bins - 1.0));
    atomicAdd(wake_water[bin], gone_nl / PER_NL);
    atomicAdd(wake_um[bin], free_nl / uint(tick.nl_per_um));
    atomicAdd(wake_cells[bin], 1u);
    atomicAdd(wake_along[bin], int(floor(at.x * PER_M)));
    atomicAdd(wake_across[bin], int(floor(at.y * PER_M)));
}

float wake_depth_m(uint bin) { return 1e-6 * float(wake_um[bin]) / float(max(wake_cells[bin], 1u)); }

// From the middle of the contact.
vec2 wake_at(uint bin)
{
    return vec2(wake_along[bin], wake_across[bin]) / (PER_M * float(max(wake_cells[bin], 1u)));
}

// Whether waves begin at a place: on water as deep as drops need, where its waves may reach the ripple map.
bool begins_wake(uint contact, uint bin)
{
    const float reach_m = sqrt(9.81 * wake_depth_m(bin)) * VIRGA_WAKE_LIFE_S;
    const vec2 on_map =
        out_of_contact(contact, wake_at(bin)) - vec2(tick.ripple_low_m[0], tick.ripple_low_m[1]) + reach_m;
    return wake_water[bin] > 0u && wake_depth_m(bin) >= MIN_WATER_M &&
           min(on_map.x, on_map.y) > 0.0 && max(on_map.x, on_map.y) < tick.ripple_side_m + 2.0 * reach_m;
}

void start_wake(uint contact, uint bin, uint number)
{
    const vec2 at = wake_at(bin), cells_of = out_of_contact(contact, at) * tick.inv_cell_m, low = floor(cells_of);
    const float swept = tick.contacts[contact].swept_m, half_m = tick.contacts[contact].half_m[0];
    const float width_m = 2.0 * tick.contacts[contact].half_m[1];
    const float volume_m3 = 1e-12 * float(PER_NL) * float(wake_water[bin]);
    virga_ring_gpu ring;
    ring.cell = int[2](int(low.x) + tick.low_tile[0] * VIRGA_GROUND_TILE,
                       int(low.y) + tick.low_tile[1] * VIRGA_GROUND_TILE);
    ring.in_cell = float[2](cells_of.x - low.x, cells_of.y - low.y);
    ring.tick = tick.tick;
    // When its front came there. What treads down moves little: in the middle of the tick.
    ring.share = swept > tick.cell_m * 0.1 ? clamp(1.0 - (half_m - at.x) / swept, 0.0, 1.0) : 0.5;
    ring.crater_m = volume_m3 / max(WAKE_HOLE * WAKE_M * WAKE_M, 2.0 * width_m * WAKE_M);
    ring.depth_m = wake_depth_m(bin);
    ring.width = WAKE_WIDTH;
    ring.id = tick.contacts[contact].id;
    ring.drift = float[2](0.0, 0.0);
    rings[VIRGA_MAX_RINGS + number % VIRGA_MAX_WAKES] = ring;
}

// An invocation for each contact, in the order of contacts. Has barriers: call it from all invocations, after one.
void start_wakes()
{
    const uint contact = gl_LocalInvocationIndex, before = rings_head.wakes;
    const bool is_contact = contact < min(tick.contact_count, uint(VIRGA_GROUND_CONTACTS));
    uint count = 0u;
    for (uint i = 0u; is_contact && i < WAKE_BINS; i++)
        count += begins_wake(contact, contact * WAKE_BINS + i) ? 1u : 0u;
    if (contact < VIRGA_GROUND_CONTACTS)
        wake_count[contact] = count;
    barrier();
    uint number = before;
    for (uint i = 0u; i < contact && is_contact; i++)
        number += wake_count[i];
    for (uint i = 0u; is_contact && i < WAKE_BINS; i++)
        if (begins_wake(contact, contact * WAKE_BINS + i))
            start_wake(contact, contact * WAKE_BINS + i, number++);
    if (is_contact && contact + 1u == tick.contact_count)
        rings_head.wakes = number;
}
