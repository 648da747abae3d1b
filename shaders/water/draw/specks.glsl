// specks.glsl - droplets of spray that are too small in the picture to have a surface there.
//
// They lie over the surface with the coverage that their discs have, and do not hide what is behind the rest of a
// pixel. Their light is that of a drop on average, which shows what is behind it from a wide angle, blurred: the host's
// picture around the pixel, or without one the environment through its phase function, as of falling rain. The third
// and fourth channel of the image of motion hold their sums of weight, and of weight times depth.
//
// The includer includes view.glsl, gpu/scene_depth.glsl, gpu/light.glsl, surface.glsl and scene_color.glsl, and defines
// HAS_DEPTH and HAS_COLOR.
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

#define MIRRORED 0.1 // of the light that a drop turns towards the eye

// What a drop shows of the environment or the scene in a direction of view.
vec3 through_drop(vec3 direction)
{
    const vec3 all = environment(direction, vec2(view.phase_moment[1], view.phase_moment[2]));
    if (!HAS_COLOR)
        return all;
    const vec2 low = vec2(view.viewport[0], view.viewport[1]), size = vec2(view.viewport[2], view.viewport[3]);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 8; i++) {
        const float angle = 0.785398 * float(i), radius = (i & 1) == 0 ? 0.06 : 0.15;
        const vec2 pixel = gl_FragCoord.xy + radius * size.y * vec2(cos(angle), sin(angle));
        const vec4 texel = texelFetch(scene_color, ivec2(clamp(pixel, low, low + size - 1.0)), 0);
        sum += host_color(texel.rgb, view.color_given);
    }
    return mix(sum / 8.0, all, MIRRORED);
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
    specks.light = through_drop(direction) + lamps(ray * specks.depth, direction);
    return specks;
}

// Specks over the surface; `surface`: premultiplied.
vec4 specks_over(Specks specks, vec4 surface)
{
    return vec4(specks.light * specks.covered, specks.covered) + (1.0 - specks.covered) * surface;
}
