// specks.glsl - droplets of spray that are too small in the picture to have a surface there.
//
// They lie over the surface with the coverage that their discs have, and do not hide what is behind the rest of a
// pixel. Their light is that of a drop on average, as of falling rain: the environment and lamps through its phase
// function. The third and fourth channel of the image of motion hold their sums of weight, and of weight times depth.
// The includer includes view.glsl, gpu/scene_depth.glsl, gpu/light.glsl and surface.glsl, and defines HAS_DEPTH.
struct Specks {
    vec3 light; // radiance
    float covered;
    float depth; // view depth
};

// Sums of motion, of weight, and of weight times depth.
vec4 motion_sums_at(vec2 at)
{
    return SCALED ? between_texels(motion_image, at, ivec2(look.width, look.height))
                  : texelFetch(motion_image, ivec2(at), 0);
}

Specks specks_of(vec4 motion_sums, vec3 ray)
{
    Specks specks = Specks(vec3(0.0), 0.0, 1.0);
    if (motion_sums.z < 1e-4)
        return specks;
    specks.depth = motion_sums.w / motion_sums.z;
    specks.covered = min(motion_sums.z, 1.0);
    if (HAS_DEPTH)
        specks.covered *= soft_edge(specks.depth);
    const vec3 direction = normalize(ray);
    specks.light = environment(direction, vec2(view.phase_moment[1], view.phase_moment[2])) +
                   lamps(ray * specks.depth, direction);
    return specks;
}

// Specks over the surface; `surface`: premultiplied.
vec4 specks_over(Specks specks, vec4 surface)
{
    return vec4(specks.light * specks.covered, specks.covered) + (1.0 - specks.covered) * surface;
}
