// hand_over.glsl - hands the droplets of a particle over, with its water in whole nanolitres.
#include "handed.glsl"
#include "count.glsl"

// Water that is not yet given to a droplet of the particle, and droplets that have none.
uint left_nl, left_droplets;

void begin_hand_over(uint nl, uint droplets)
{
    left_nl = nl;
    left_droplets = droplets;
}

// `nl`: what the droplet should get. Each gets at least one nanolitre, or it would have no size, and the last one gets
// what is left.
void hand_over(virga_leaver_gpu own, uint i, vec3 position, vec3 velocity, uint nl)
{
    left_droplets--;
    const uint most = left_nl - left_droplets, water_nl = left_droplets == 0u ? left_nl : clamp(nl, 1u, most);
    left_nl -= water_nl;
    virga_handed_droplet_gpu droplet;
    droplet.position = float[3](position.x, position.y, position.z);
    droplet.age_s = own.age;
    droplet.velocity = float[3](velocity.x, velocity.y, velocity.z);
    droplet.diameter_m = pow(1.909859317e-12 * float(water_nl), 1.0 / 3.0); // (6 volume / pi)^(1/3)
    droplet.id = own.id;
    droplet.number = i;
    droplet.water_nl = water_nl;
    droplet.drops = 0.0;
    handed[own.first + i] = droplet;
}

// From now on the particle is neither water nor spray.
void end_hand_over(uint splash, uint nl)
{
    splashes[splash_now(splash)].flags = VIRGA_LEAVER_HANDED;
    splashes[splash_now(splash)].given_nl += nl;
    splashes[splash_now(splash)].pieces = 0u;
    count_handed(nl);
}
