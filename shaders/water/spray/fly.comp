// fly.comp - splash particles break into droplets, and the droplets fly on: the physical style.
//
// When a particle leaves the water, it breaks into pieces that the motion within it, a part of its speed, can tear no
// further (whole_diameter). Their volumes follow an exponential distribution; they fly apart with that speed, and their
// center of mass stays that of the particle.
//
// After that each piece is a drop in air at rest. The particle itself has no drag, so a piece falls behind it. Its
// position is kept relative to the particle, which walls and other water turn away as the simulation says: were the
// orbit free, pieces would fly through walls. For the same reason a piece never gets farther away than
// VIRGA_WATER_SPRAY_REACH spacings. Pieces that the air stream tears break in two.
//
// One invocation per splash particle. Reads: the list, particles, densities, the last frame's splashes and pieces.
// Writes: splashes, pieces, table.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "spray.glsl"
#include "water/packed_share.glsl"
#include "list.glsl"
#include "table.glsl"
#include "enter.glsl"
#include "leaver.glsl"
#include "pieces.glsl"
#include "pattern.glsl"
#include "air.glsl"

layout(local_size_x = VIRGA_WATER_LANES) in;

#define STEPS_PER_S 480.0
#define DIAMETER_OF_VOLUME(volume) pow(1.909859317 * (volume), 1.0 / 3.0) // (6 volume / pi)^(1/3)

float random(uint id, uint i, uint use) { return virga_unit(virga_hash3(id, i, use)); }

// New pieces of a particle. Returns their number.
uint break_up(uint splash, uint id, vec3 velocity, float volume)
{
    const float apart = frame.turbulence * length(velocity);
    const float ratio = DIAMETER_OF_VOLUME(volume) / whole_diameter(apart);
    const uint count = uint(clamp(ratio * ratio * ratio, 1.0, float(frame.max_pieces)));
    float sum = 0.0;
    for (uint i = 0u; i < count; i++)
        sum += 0.1 - log(1.0 - random(id, i, 1u));
    vec3 points = vec3(0.0); // their center of mass
    for (uint i = 0u; i < count; i++) {
        const float part = (0.1 - log(1.0 - random(id, i, 1u))) / sum;
        points += part * pattern_point(id, i, count);
    }
    // The points of a unit ball are 0.775 from its center, RMS. The ball of the particle's volume has a radius of
    // 0.62 spacings.
    for (uint i = 0u; i < count; i++) {
        const float part = (0.1 - log(1.0 - random(id, i, 1u))) / sum;
        const vec3 point = pattern_point(id, i, count) - points;
        const vec3 offset = 0.62 * frame.spacing * point, drift = apart / 0.775 * point;
        pieces[piece_now(splash, i)] = virga_water_piece_gpu(float[3](offset.x, offset.y, offset.z), part,
                                                             float[3](drift.x, drift.y, drift.z), 0.0);
    }
    return count;
}

// Moves a piece over the time since the last step, while the particle's velocity goes from `from` to `to`.
virga_water_piece_gpu flown(virga_water_piece_gpu piece, vec3 from, vec3 to, float diameter, float gap)
{
    const uint steps = clamp(uint(ceil(gap * STEPS_PER_S)), 1u, 128u);
    const float step_s = gap / float(steps);
    vec3 offset = to_vec(piece.offset), drift = to_vec(piece.drift);
    for (uint i = 0u; i < steps; i++) {
        const vec3 velocity = mix(from, to, (float(i) + 0.5) / float(steps)) + drift;
        const float speed = length(velocity), slowed = drag_rate(speed, diameter) * step_s;
        const vec3 before = drift;
        drift -= velocity * (slowed / (1.0 + slowed));
        offset += 0.5 * step_s * (before + drift);
        piece.wear += step_s * break_rate(speed, diameter);
    }
    const float reach = VIRGA_WATER_SPRAY_REACH * frame.spacing, far = length(offset);
    if (far > reach) {
        const vec3 outwards = offset / far;
        offset = reach * outwards;
        drift -= max(dot(drift, outwards), 0.0) * outwards;
    }
    piece.offset = float[3](offset.x, offset.y, offset.z);
    piece.drift = float[3](drift.x, drift.y, drift.z);
    return piece;
}

// Breaks a piece in two, as number i and `last`. They fly apart across their way with a twentieth of the speed.
void split(inout virga_water_piece_gpu piece, uint splash, uint id, uint i, uint last, vec3 velocity)
{
    const float larger = mix(0.5, 0.7, random(id, last, 2u)), angle = 6.28318531 * random(id, last, 3u);
    const vec3 way = velocity + to_vec(piece.drift);
    const vec3 side = normalize(cross(way, abs(way.y) < 0.9 * length(way) ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0)) +
                                vec3(1e-6, 0.0, 0.0));
    const vec3 other = normalize(cross(way, side) + vec3(0.0, 1e-6, 0.0));
    const vec3 kick = 0.05 * length(way) * (cos(angle) * side + sin(angle) * other);
    virga_water_piece_gpu second = piece;
    for (uint axis = 0u; axis < 3u; axis++) {
        second.drift[axis] += larger * kick[axis];
        piece.drift[axis] -= (1.0 - larger) * kick[axis];
    }
    second.part = (1.0 - larger) * piece.part;
    piece.part *= larger;
    second.wear = piece.wear = 0.0;
    pieces[piece_now(splash, last)] = second;
}

// Pieces of a particle that had some in the last step.
void fly_on(inout virga_leaver_gpu own, uint splash, uint before, vec3 velocity, float volume)
{
    const vec3 from = to_vec(own.velocity);
    const uint count = own.pieces;
    const float gap = gap_s();
    for (uint i = 0u; i < count; i++) {
        virga_water_piece_gpu piece = pieces[piece_before(before, i)];
        const float diameter = max(DIAMETER_OF_VOLUME(volume * piece.part), 1e-5);
        piece = flown(piece, from, velocity, diameter, gap);
        if (piece.wear >= 1.0 && own.pieces < frame.max_pieces) {
            split(piece, splash, own.id, i, own.pieces, velocity);
            own.pieces++;
        }
        pieces[piece_now(splash, i)] = piece;
    }
}

void main()
{
    const uint splash = gl_GlobalInvocationID.x;
    if (splash >= splash_list.count)
        return;
    const uint particle = splash_particle(splash), before = find_before(particles[particle].id);
    const float part = spray_part(densities[particle]);
    const float volume = frame.volume * counted_share(sorted[splash_sorted[splash]].w);
    const vec3 velocity = particle_velocity(particle);
    virga_leaver_gpu own = begin_leaver(particle, before);
    if (!is_done(own, part)) {
        if (own.pieces > 0u)
            fly_on(own, splash, before, velocity, volume);
        else
            own.pieces = break_up(splash, own.id, velocity, volume);
        own.max_speed = max(own.max_speed, length(velocity));
        decide_to_leave(own, part, before);
    }
    own.velocity = float[3](velocity.x, velocity.y, velocity.z);
    splashes[splash_now(splash)] = own;
    enter(splash, own.id);
}
