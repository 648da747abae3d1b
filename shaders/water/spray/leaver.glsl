// leaver.glsl - a splash particle from step to step: it leaves the water, its droplets are handed over, it falls back.
//
// A particle that has been spray for a while hands its droplets over, with its water in whole nanolitres. From then on
// it is neither water nor spray here: its droplets fly on their own, and the particle goes along in the host's
// simulation unseen. When there is water around it again, it has fallen back. Then those of its droplets that are still
// in the air end, and their water is the particle's again (splash tells how much it was, in taken_nl). What has landed
// by then stays where it landed, and the particle is smaller by as much. So no water is there twice.
#include "water/spray_part.glsl"

float share_of(uint particle) { return clamp(particles[particle].share, 0.0, 1.0); }

uint particle_nl(uint particle) { return uint(frame.volume_nl * share_of(particle) + 0.5); }

// Water that is still the particle's.
uint own_nl(uint particle, uint given_nl) { return particle_nl(particle) - min(given_nl, particle_nl(particle)); }

// Whether a particle that was handed over has fallen back: when it is water more than spray. It was handed over when it
// was all spray, so the two do not alternate.
bool is_back(float part) { return part <= 0.5; }

uint given_before(virga_leaver_gpu before)
{
    // What a sub-frame shows is as it was in its frame.
    return before.given_nl - (frame.serial == 0u ? 0u : min(before.taken_nl, before.given_nl));
}

// The state of a splash particle as this step begins: that of the last step, or a new one.
virga_leaver_gpu begin_leaver(uint particle, uint before)
{
    virga_leaver_gpu own = virga_leaver_gpu(particles[particle].id, 0.0, 0.0, 0u, float[3](0.0, 0.0, 0.0), particle, 0u,
                                            0u, 0u, 0u);
    if (before < frame.max_splashes) {
        own = splashes[splash_before(before)];
        own.age += gap_s();
        own.particle = particle;
        own.given_nl = given_before(own);
        own.flags &= VIRGA_LEAVER_HANDED;
        own.taken_nl = 0u;
    }
    return own;
}

// What a particle does that is not spray, or not any more: nothing. Returns whether it is one of those.
bool is_done(inout virga_leaver_gpu own, float part)
{
    const bool handed = (own.flags & VIRGA_LEAVER_HANDED) != 0u, water = !handed && part <= 0.0;
    if (handed && is_back(part))
        own.flags = VIRGA_LEAVER_RETURNED;
    if (water || (handed && is_back(part)))
        own.age = own.max_speed = 0.0;
    if (handed || water)
        own.pieces = 0u;
    return handed || water;
}

// Whether its droplets are to be handed over. A particle that is new here stays for a step, so that its droplets have
// been seen where it was. One that appears or vanishes stays until all of it is there: it is drawn by its share, which
// other effects do not know.
void decide_to_leave(inout virga_leaver_gpu own, float part, uint before)
{
    const bool is_whole = part >= 1.0 && share_of(own.particle) >= 1.0;
    const bool leaves = frame.hands_over != 0u && before < frame.max_splashes && is_whole && own.age > 0.0 &&
                        own.age >= frame.hand_age_s && own.pieces > 0u &&
                        own_nl(own.particle, own.given_nl) >= own.pieces;
    own.flags |= leaves ? VIRGA_LEAVER_LEAVING : 0u;
}
