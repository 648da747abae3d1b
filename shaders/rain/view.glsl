// view.glsl - a view's parameters, and what a drop shows of the light around it.
layout(scalar, set = 0, binding = 1) uniform View { virga_view_gpu view; };

// A streak that covers less than this is haze, see rain_draw.c; it fades in up to twice as much.
#define LEAST_COVERAGE (1.0 / 400.0)

#define NEAR_W 0.01 // m; streaks are cut where they come nearer to the camera's plane
#define WIDE_PX 3.0 // from here on a streak shows the inside of its drop

// Coverage of the middle line of a streak by one drop: the share of the time that the drop covers it (body / way, and all
// of the time where it moves by less than its own length), and of the sampling's width where the drop is narrower.
float streak_coverage(float width_px, float body, float way)
{
    const float narrow = min(width_px / view.min_width_px, 1.0);
    return min(view.streak_gain * body / max(way, body), 1.0) * narrow;
}

vec3 sh_coefficient(uint i) { return vec3(view.sh[3u * i], view.sh[3u * i + 1u], view.sh[3u * i + 2u]); }

// The environment seen along d through a lobe with Legendre moments 1, g.x, g.y: each band is scaled by its moment
// (Funk-Hecke). A drop's phase function as the lobe gives what the drop shows on average: nearly the whole environment.
vec3 environment(vec3 d, vec2 g)
{
    vec3 sum = sh_coefficient(0u) * 0.282095;
    sum += g.x * 0.488603 * (sh_coefficient(1u) * d.y + sh_coefficient(2u) * d.z + sh_coefficient(3u) * d.x);
    sum += g.y * 1.092548 * (sh_coefficient(4u) * d.x * d.y + sh_coefficient(5u) * d.y * d.z + sh_coefficient(7u) * d.x * d.z);
    sum += g.y * 0.315392 * sh_coefficient(6u) * (3.0 * d.z * d.z - 1.0);
    sum += g.y * 0.546274 * sh_coefficient(8u) * (d.x * d.x - d.y * d.y);
    return max(sum, vec3(0.0));
}

mat4 to_mat(float a[16])
{
    return mat4(a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8], a[9], a[10], a[11], a[12], a[13], a[14], a[15]);
}
