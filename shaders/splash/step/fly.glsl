// fly.glsl - a tick of a droplet: it flies, leaves its pile, and falls. The includer defines STEP_WORDS: for how many
// words of 32 droplets its workgroup has shared memory.
#define MAX_PARTS 4   // max parts of a tick
#define MAX_AGE_S 3.0 // older droplets are blown away: their water counts as fallen where they are

#include "floors.glsl"
#include "panes.glsl"

shared uint fallen_bits[STEP_WORDS], alive_bits[STEP_WORDS];

bool is_cone(virga_droplet_gpu droplet)
{
    return VIRGA_DROPLET_MODEL(droplet.kind) == VIRGA_SPLASH_CROWN_CONE && VIRGA_DROPLET_INDEX(droplet.kind) == 0u;
}

// The fraction of a part of the tick at which the droplet leaves its pile; above 1: not in it. A pile stops growing
// after the unit time or at the unit height (section 4.1, step 5), a cone when it is highest (section 4.2, step 3).
float leaves_pile(virga_droplet_gpu droplet, vec3 from, vec3 to, float before_s, float part_s, vec2 rise)
{
    if (is_cone(droplet))
        return rise.y <= 0.0 ? rise.x / max(rise.x - rise.y, 1e-6) : 2.0;
    const vec3 base = to_vec(droplet.base);
    const float length_before = distance(from, base), length_after = distance(to, base);
    const float by_time = (tick.pile_max_s - before_s) / part_s;
    const float by_way = length_after > tick.pile_max_m
                             ? (tick.pile_max_m - length_before) / max(length_after - length_before, 1e-9)
                             : 2.0;
    return max(min(by_time, by_way), 0.0);
}

bool is_spray(virga_droplet_gpu droplet) { return (droplet.kind & VIRGA_DROPLET_SPRAY) != 0u; }

// Height above the surface that the droplet came from, or that spray falls on.
float height_above(virga_droplet_gpu droplet, vec3 position)
{
    if (is_spray(droplet))
        return height_above_floor(position);
    const vec3 base = to_vec(droplet.base);
    return position.y - base.y - dot(unpackHalf2x16(droplet.slopes), position.xz - base.xz);
}

// The number of parts of a tick: by its drag; on a pile enough to find when it leaves the pile.
int parts_of(virga_droplet_gpu droplet, float against_air, float time_s)
{
    const float by_drag = ceil(12.0 * drag_rate(droplet.diameter_m, against_air) * time_s);
    return (droplet.kind & VIRGA_DROPLET_FREE) == 0u ? MAX_PARTS : int(clamp(by_drag, 1.0, float(MAX_PARTS)));
}

// A droplet on a pane has the position of its hit there, and is not drawn any more.
bool land_on_pane(inout virga_droplet_gpu droplet, vec3 from, vec3 to, float left_s, float part_s)
{
    vec2 hit = vec2(0.0);
    const uint pane = pane_hit(from, to, left_s, part_s, hit);
    if (pane == 0u)
        return false;
    droplet.kind |= pane << 12 | VIRGA_DROPLET_FALLEN;
    droplet.position = float[3](hit.x, hit.y, 0.0);
    droplet.weight_free = 0u;
    return true;
}

void move(inout virga_droplet_gpu droplet, float time_s)
{
    vec3 position = to_vec(droplet.position), velocity = to_vec(droplet.velocity);
    const vec3 wind = is_cone(droplet) ? vec3(0.0) : to_vec(tick.wind);
    const int parts = parts_of(droplet, distance(velocity, wind), time_s);
    const float part_s = time_s / float(parts);
    float age = droplet.age_s - time_s;
    for (int i = 0; i < parts; i++) {
        const vec3 from = position, before = velocity;
        fly(position, velocity, wind, droplet.diameter_m, part_s);
        if ((droplet.kind & VIRGA_DROPLET_FREE) == 0u) {
            const float share = leaves_pile(droplet, from, position, age, part_s, vec2(before.y, velocity.y));
            if (share <= 1.0) {
                droplet.kind |= VIRGA_DROPLET_FREE;
                droplet.weight_free = halves(unpackHalf2x16(droplet.weight_free).x, age + share * part_s);
            }
        }
        age += part_s;
        const float left_s = time_s - float(i) * part_s;
        if (is_spray(droplet) && land_on_pane(droplet, from, position, left_s, part_s))
            return;
        const float above = height_above(droplet, position), above_before = height_above(droplet, from);
        if (above < 0.0 && above < above_before) {
            position = mix(position, from, clamp(above / min(above - above_before, -1e-9), 0.0, 1.0));
            droplet.kind |= VIRGA_DROPLET_FALLEN | VIRGA_DROPLET_FREE;
            break;
        }
    }
    droplet.position = float[3](position.x, position.y, position.z);
    droplet.velocity = float[3](velocity.x, velocity.y, velocity.z);
}

// Writes what may have changed: everything but the base.
void store(uint slot, virga_droplet_gpu droplet)
{
    const uvec4 texels[4] = texels_of(droplet);
    droplets[4u * slot] = texels[0];
    droplets[4u * slot + 1u] = texels[1];
    droplets[4u * slot + 3u] = texels[3];
}

// `bit`: the droplet's bit in the workgroup's words.
void step_droplet(uint slot, virga_droplet_gpu droplet, uint bit)
{
    if ((droplet.kind & VIRGA_DROPLET_FALLEN) == 0u) {
        droplet.age_s += tick.tick_s;
        const float time_s = min(tick.tick_s, droplet.age_s);
        if (time_s > 0.0)
            move(droplet, time_s);
        if (droplet.age_s > MAX_AGE_S)
            droplet.kind |= VIRGA_DROPLET_FALLEN;
        store(slot, droplet);
    }
    atomicOr(alive_bits[bit >> 5], 1u << (bit & 31u));
    if ((droplet.kind & VIRGA_DROPLET_FALLEN) != 0u)
        atomicOr(fallen_bits[bit >> 5], 1u << (bit & 31u));
}

// Call it before droplets are stepped, followed by a barrier.
void clear_bits(uint lane)
{
    if (lane < STEP_WORDS)
        fallen_bits[lane] = alive_bits[lane] = 0u;
}
