// climb.glsl - light of the strip of water that climbs a wall, a post or a kerb from ground where water stands. Where
// it is narrower than a pixel, all slopes that the pixel has of it are in what it mirrors, so it is no chain of dots.
#include "meniscus.glsl"

const int CLIMB_FACETS = 4;
const float CLIMB_FULL_MM[2] = float[](0.1, 0.5); // from where to where water on the ground is one sheet
const float CLIMB_SOFT = 0.03; // radians: standard deviation of slopes along the strip, which is never quite straight
const float CLIMB_SAME_M = 0.1;

struct Climb {
    float share;  // of the pixel
    float low, high; // slopes in it (radians)
    vec3 out_of_wall;
    float bent; // radians that the wall turns by within the pixel
    MeniscusView view;
};

// Height of the ground before a wall, above the contact map's low corner. A map's texel is wider than what climbs, and
// next to the wall it may be that of the step beyond: looked up farther out, and followed back by its slope.
float ground_before(vec2 at, vec2 out_of_wall)
{
    const float texel = 1.0 / float(textureSize(contact_map, 0).x);
    const float near = textureLod(contact_map, at + 1.5 * texel * out_of_wall, 0.0).y;
    const float far = textureLod(contact_map, at + 3.0 * texel * out_of_wall, 0.0).y;
    const float texel_m = texel / frame.contact.w;
    return near + (abs(near - far) < 0.2 * texel_m ? near - far : 0.0);
}

// How far what stands on the ground there is one sheet of water.
float water_before(vec3 relative, vec3 out_of_wall)
{
    const int cells = max(int(frame.ground_wrap.z), 1);
    const vec2 at = (relative.xz + 0.06 * out_of_wall.xz - frame.ground_low.xz) * frame.ground_low.w;
    const ivec2 cell = ivec2(floor(at));
    const bool inside = min(cell.x, cell.y) >= 0 && max(cell.x, cell.y) < cells;
    const vec4 ground = virga_ground_texel(wet_map, ivec2(frame.ground_wrap.xy), cells, cell);
    const bool same = abs(relative.y - frame.ground_low.y - ground.a) < CLIMB_SAME_M;
    return inside && same ? smoothstep(CLIMB_FULL_MM[0], CLIMB_FULL_MM[1], ground.g) : 0.0;
}

// Of pictures that are averaged each has the whole pixel: where they share shading it is the only one. Software Vulkan
// runs what stands under a condition for all pixels, but goes on in a loop only while one is in it.
Climb climb_at(vec3 relative, vec3 n, vec3 v)
{
    const float flat_n = max(length(n.xz), 1e-3);
    Climb climb = Climb(0.0, 0.1, 0.2, vec3(n.x, 0.0, n.z) / flat_n, 0.0, MeniscusView(1.0, 0.0, 0.0));
    const vec2 up = vec2(dFdx(relative.y), dFdy(relative.y));
    const vec3 right = dFdx(climb.out_of_wall), down = dFdy(climb.out_of_wall);
    const float pixel_m = max(length(up), 1e-5), facing = dot(v, climb.out_of_wall);
    const vec2 at = (relative.xz - frame.contact.xz) * frame.contact.w, inside = min(at, 1.0 - at);
    const bool may = frame.sampling.w > 0.0 && frame.contact.w > 0.0 && min(inside.x, inside.y) > 0.01 &&
                     abs(n.y) < HOST_STEEP_Y && facing > 0.02;
    /* Which triangles have it is told from their heights, so pixels are not looked at up to any height. */
    const float reach_m = min(0.005 + pixel_m, HOST_CLIMB_M - 0.01), height_m = relative.y - frame.contact.y;
    climb.bent = sqrt(dot(right, right) + dot(down, down));
    /* Where a smooth normal leans over so far that it turns away from the eye, rays would meet the wall from behind. */
    const float lean = n.y / flat_n, most = 0.8 / max(-lean, 0.08);
    climb.view = MeniscusView(meniscus_top(n), clamp(v.y / max(facing, 0.02), 0.0, min(most, 10.0)), lean);
    bool near = false;
    for (int i = 0; i < (may ? 1 : 0); i++) {
        const vec2 before = at + 0.0015 * climb.out_of_wall.xz;
        const ivec2 texel = ivec2(before * float(textureSize(contact_map, 0).x));
        near = abs(height_m - texelFetch(contact_map, texel, 0).y) < reach_m + 0.01;
    }
    for (int i = 0; i < (near ? 1 : 0); i++) {
        const float ground_m = ground_before(at, climb.out_of_wall.xz), above_m = height_m - ground_m;
        const float water = water_before(relative, climb.out_of_wall);
        if (above_m < -0.002 || above_m > reach_m || water <= 0.0)
            break;
        const vec3 seen = meniscus_seen(climb.view, max(above_m, 0.0), pixel_m);
        climb.low = seen.x;
        climb.high = max(seen.y, seen.x + 0.01);
        /* The map has half floats: where the ground is more than 2 m above its lowest place within the map, their steps
         * are as large as the strip is high. */
        const float step_m = exp2(floor(log2(max(ground_m, 0.5))) - 10.0);
        climb.share = water * seen.z * (1.0 - smoothstep(0.001, 0.003, step_m)) *
                      (1.0 - smoothstep(0.5 * HOST_CLIMB_M, 0.9 * HOST_CLIMB_M, pixel_m));
    }
    return climb;
}

vec3 climb_normal(Climb climb, float slope)
{
    return climb.out_of_wall * sin(slope) + vec3(0.0, cos(slope), 0.0);
}

float climb_fresnel(float cosine)
{
    const float c = 1.0 - clamp(cosine, 0.0, 1.0), c2 = c * c;
    return 0.0204 + (1.0 - 0.0204) * c2 * c2 * c;
}

// How far a direction from the strip, which is next to the wall, leads away from it: mean of those within so many
// radians.
float climb_open(Climb climb, vec3 d, float width)
{
    return clamp(dot(d, climb.out_of_wall) / width + 0.5, 0.0, 1.0);
}

// What it mirrors of the sky and of the wall, whose colour is given, and (w) the share of light that it mirrors: by
// facets of equal steps of the slope, each as rough as a step is wide (a uniform distribution has the standard
// deviation of its width over sqrt(12); Beckmann's alpha is sqrt(2) of one), and as large as it is seen.
vec4 climb_sky(vec3 color, Climb climb, vec3 v, vec4 moments)
{
    const float step_width = (climb.high - climb.low) / float(CLIMB_FACETS);
    const float roughness = clamp(sqrt(step_width * 0.408), 0.05, 0.5);
    vec4 sum = vec4(0.0);
    float whole = 1e-9, below = meniscus_height(climb.view, climb.low);
    for (int i = 0; i < CLIMB_FACETS; i++) {
        const float slope = climb.low + step_width * (float(i) + 0.5);
        const float above = meniscus_height(climb.view, slope + 0.5 * step_width), seen = max(above - below, 0.0);
        const vec3 facet = climb_normal(climb, slope), r = reflect(-v, facet);
        const float f = climb_fresnel(dot(facet, v));
        const vec3 sky = reflected_light(r, roughness) * sky_share(moments, r);
        sum += seen * f * vec4(mix(color, sky, climb_open(climb, r, max(2.0 * step_width, 0.05))), 1.0);
        whole += seen;
        below = above;
    }
    return sum / whole;
}

// What it mirrors of lamps. Of facets whose normals have the density p, by the area that is seen of them, a lamp that
// gives the irradiance E at right angles is mirrored as F(v h) p(h) E / (4 v h): a change of h turns the ray by twice
// as much, which is four v h of solid angle. Along the slope p is the width of the strip that has it; across it is a
// normal distribution.
vec3 climb_lamps(Climb climb, vec3 v, int lamps)
{
    const vec3 along = cross(climb.out_of_wall, vec3(0.0, 1.0, 0.0));
    const float soft = sqrt(CLIMB_SOFT * CLIMB_SOFT + 0.25 * climb.bent * climb.bent);
    const float seen_m = max(meniscus_height(climb.view, climb.high) - meniscus_height(climb.view, climb.low), 1e-7);
    const float grown = (climb.high - climb.low) / (climb.high - climb.low + 2.0 * CLIMB_SOFT);
    vec3 sum = vec3(0.0);
    while (lamps != 0) {
        const int i = findLSB(lamps);
        lamps &= lamps - 1;
        const vec3 to = frame.lights[i].position.xyz - in_relative;
        const vec3 l = to * inversesqrt(max(dot(to, to), 1e-4)), both = v + l;
        const vec3 h = both * inversesqrt(max(dot(both, both), 1e-6));
        const float slope = atan(dot(h, climb.out_of_wall), h.y), across = dot(h, along) / soft;
        const float inside = clamp(slope, climb.low, climb.high);
        const float off = clamp(1.0 - abs(slope - inside) / (2.0 * CLIMB_SOFT), 0.0, 1.0);
        const float p = off * grown * meniscus_width(climb.view, inside) / seen_m * exp(-0.5 * across * across) /
                        (soft * 2.5066283);
        const float cosine = max(dot(v, h), 0.05);
        sum += lamp_light(i, to) * climb_open(climb, l, 0.05) * (p * climb_fresnel(cosine) / (4.0 * cosine));
    }
    return sum;
}

// The colour of a wall with the strip. Under water the wall does not mirror what it `reflected` of the sky; `lamps`:
// bits of those that may reach it.
vec3 under_climb(vec3 color, vec3 reflected, Climb climb, vec3 v, vec4 moments, int lamps)
{
    const vec3 below = max(color - reflected, 0.0);
    for (int i = 0; i < (climb.share > 0.0 ? 1 : 0); i++) {
        const vec4 mirrored = climb_sky(below, climb, v, moments);
        const vec3 water = below * (1.0 - mirrored.w) + mirrored.rgb + climb_lamps(climb, v, lamps);
        color = mix(color, water, climb.share);
    }
    return color;
}
