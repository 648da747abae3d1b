// light.glsl - light around a drop: environment and lamps. The includer has gpu/vectors.glsl and a block with a member
// `virga_view_gpu view`.

#define uniform_coefficient(i) vec3(view.sh[3u * (i)], view.sh[3u * (i) + 1u], view.sh[3u * (i) + 2u])
#ifndef SH_FETCHED // otherwise the includer defines it
#define sh_coefficient(i) uniform_coefficient(i)
#endif

// The environment in direction d, seen through a lobe with the Legendre moments 1, g.x, g.y: each band of the spherical
// harmonics is scaled by its moment (Funk-Hecke). With a drop's phase function as the lobe, this is what the drop shows
// on average: nearly the whole environment.
vec3 environment(vec3 d, vec2 g)
{
    const vec3 first = g.x * 0.488603 * d, second = g.y * 1.092548 * d.xyz * d.yzx;
    const float sixth = g.y * 0.315392 * (3.0 * d.z * d.z - 1.0), eighth = g.y * 0.546274 * (d.x * d.x - d.y * d.y);
    vec3 sum = sh_coefficient(0u) * 0.282095;
    sum += sh_coefficient(1u) * first.y + sh_coefficient(2u) * first.z + sh_coefficient(3u) * first.x;
    sum += sh_coefficient(4u) * second.x + sh_coefficient(5u) * second.y + sh_coefficient(7u) * second.z;
    sum += sh_coefficient(6u) * sixth + sh_coefficient(8u) * eighth;
    return max(sum, vec3(0.0));
}

// A drop's phase function (1/sr).
float phase(float cos_angle)
{
    const float x = acos(clamp(cos_angle, -1.0, 1.0)) * (64.0 / 3.14159265) - 0.5;
    const int bin = clamp(int(floor(x)), 0, 62);
    return mix(view.phase[bin], view.phase[bin + 1], clamp(x - float(bin), 0.0, 1.0));
}

#define LAMP_RADIUS_M 0.1 // a lamp is not a point: its light does not grow any more below this distance

struct Lamp {
    vec3 towards; // unit vector from the point
    vec3 light;   // irradiance at right angles to it
    float distance2;
};

// A point or spot light, as a point at p (relative to the camera) sees it.
Lamp lamp_at(uint i, vec3 p)
{
    const vec3 to_light = to_vec(view.lights[i].position) - p;
    const float distance2 = max(dot(to_light, to_light), LAMP_RADIUS_M * LAMP_RADIUS_M);
    const vec3 towards = to_light * inversesqrt(distance2);
    const float x = distance2 * view.lights[i].inv_range * view.lights[i].inv_range;
    const float ends = clamp(1.0 - x * x, 0.0, 1.0);
    const float cone = clamp((dot(-towards, to_vec(view.lights[i].direction)) - view.lights[i].cos_outer) *
                                 view.lights[i].inv_cos_width,
                             0.0, 1.0);
    return Lamp(towards, to_vec(view.lights[i].intensity) * (ends * ends * cone * cone / distance2), distance2);
}

// Point and spot lights: irradiance on a drop at p (relative to the camera) times its phase function. d is the viewing
// direction; light from straight ahead is scattered forward, so a lamp behind the water glitters most.
vec3 lamps(vec3 p, vec3 d)
{
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < view.light_count; i++) {
        const Lamp lamp = lamp_at(i, p);
        sum += lamp.light * phase(dot(lamp.towards, d));
    }
    return sum * view.light_gain;
}
