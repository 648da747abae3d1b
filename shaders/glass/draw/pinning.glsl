// pinning.glsl - outlines of drops on uneven glass. The rim of a drop is held where the glass wets well, and lets go
// beside it, so no two drops have the same outline. Points of the pane are displaced before densities are summed: each
// drop keeps its place, and its outline shows how the displacement changes around it. A drop that runs changes with the
// glass under it.
//
// The displacement is a sum of waves, each across its own direction. So it has no divergence, and drops keep their
// area: a drop's water is that of its round cap. Lengths of waves are those between specks of dust and wiped streaks.

// How much a wave of each of three lengths shears the glass at a pinning of 1. The short ones are weak: they show on
// large drops, as a serrated rim. Nothing folds over as long as three of each, all at their steepest, are below sqrt(2)
// together.
#define PINNING_SHEAR vec3(0.20, 0.17, 0.08)
#define PINNING_WAVE_M vec3(0.023, 0.0098, 0.0043)

// A wave of the length 1, from -1 to 1, close to a sine (to 0.001). The same bits on every device, unlike sin().
vec3 pinning_wave(vec3 turns)
{
    const vec3 t = fract(turns) - 0.5, arch = 8.0 * t * (2.0 * abs(t) - 1.0);
    return arch * (0.775 + 0.225 * abs(arch));
}

// Three waves of one length, in three directions (unit vectors, given by their x and y).
vec2 pinning_waves(vec2 point, vec3 x, vec3 y, uint octave, vec3 phase)
{
    const vec3 height = pinning_wave((point.x * x + point.y * y) / PINNING_WAVE_M[octave] + phase);
    return vec2(-dot(height, y), dot(height, x)) * (PINNING_SHEAR[octave] * PINNING_WAVE_M[octave] / 6.2831853);
}

// How far a point of the pane is displaced (m).
vec2 pinned(vec2 point)
{
    const vec3 seeds = vec3(virga_unit(virga_hash2(look.pane.seed, 1u)), virga_unit(virga_hash2(look.pane.seed, 2u)),
                            virga_unit(virga_hash2(look.pane.seed, 3u)));
    vec2 sum = pinning_waves(point, vec3(0.966, -0.174, -0.766), vec3(0.259, 0.985, -0.643), 0u, seeds);
    sum += pinning_waves(point, vec3(0.530, -0.978, 0.292), vec3(0.848, 0.208, -0.956), 1u, seeds.yzx + 0.37);
    sum += pinning_waves(point, vec3(-0.087, -0.819, 0.891), vec3(0.996, -0.574, -0.454), 2u, seeds.zxy + 0.71);
    return sum * look.pinning;
}
