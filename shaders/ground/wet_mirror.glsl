// wet_mirror.glsl - what a mirror on the ground shows: the host's picture, where a ray through its depth ends. The
// includer has wet_view.glsl, gpu/light.glsl, gpu/scene_depth.glsl and scene_color.
#define STEPS 32
#define HALVINGS 8
#define TAPS 24
#define NEAR_M 0.05   // first step
#define EDGE 0.08     // share of the picture along its borders over which it fades into the environment
#define THICKNESS 0.3 // m, and a step: a ray that is farther behind a thing than that passes behind it

// The pixel of a point, or of a direction (w = 0), and its view depth. False: behind the camera.
bool pixel_of(vec4 point, out vec2 pixel, out float depth)
{
    const vec4 clip = to_mat(view.clip_from_rel) * point;
    depth = clip.w;
    pixel = vec2(view.viewport[0], view.viewport[1]) +
            (0.5 * clip.xy / max(clip.w, 1e-6) + 0.5) * vec2(view.viewport[2], view.viewport[3]);
    return clip.w > 1e-6;
}

// 1 within the picture, falling to 0 at its borders and beyond.
float inside_picture(vec2 pixel)
{
    const vec2 uv = (pixel - vec2(view.viewport[0], view.viewport[1])) / vec2(view.viewport[2], view.viewport[3]);
    const vec2 inside = smoothstep(vec2(0.0), vec2(EDGE), min(uv, 1.0 - uv));
    return inside.x * inside.y;
}

vec2 in_viewport(vec2 pixel)
{
    const vec2 low = vec2(view.viewport[0], view.viewport[1]) + 0.5;
    return clamp(pixel, low, low + vec2(view.viewport[2], view.viewport[3]) - 1.0);
}

struct Ray {
    vec3 from, d, up; // `up`: normal of the mirror
};

// How far a point of the ray is behind what the picture shows there (m, along the view). What lies less than half as
// high above the mirror as the point is the mirror itself: in its own pixel the ray would seem to be behind it.
float behind(Ray ray, float way)
{
    vec2 pixel;
    float depth;
    if (!pixel_of(vec4(ray.from + ray.d * way, 1.0), pixel, depth) || inside_picture(pixel) <= 0.0)
        return -1e9;
    const vec2 at = floor(in_viewport(pixel)) + 0.5;
    const float stored = buffer_depth(at);
    if (stored == view.far_depth)
        return -1e9;
    const float there = view_depth(stored), high = dot(pixel_ray(at) * there - ray.from, ray.up);
    return high < 0.5 * way * dot(ray.d, ray.up) ? -1e9 : depth - there;
}

// Where the ray from a point meets something on the picture (m along it); 0: nowhere. Steps grow, so that each covers
// about as many pixels as the last.
float meeting(Ray ray)
{
    const float grow = pow(wet.mirror_reach_m / NEAR_M, 1.0 / float(STEPS - 1));
    float before = 0.0, after = NEAR_M;
    for (int i = 0; i < STEPS; i++) {
        const float deep = behind(ray, after);
        if (deep > 0.0 && deep < THICKNESS + (after - before))
            break;
        before = after;
        after *= grow;
    }
    if (after > wet.mirror_reach_m * 1.001)
        return 0.0;
    for (int i = 0; i < HALVINGS; i++) {
        const float middle = 0.5 * (before + after);
        const bool is_behind = behind(ray, middle) > 0.0;
        before = is_behind ? before : middle;
        after = is_behind ? middle : after;
    }
    // Nearer than the last halving by a line through its ends.
    const float low = behind(ray, before), high = behind(ray, after);
    return low < -1e8 || high <= low ? after : mix(before, after, clamp(-low / (high - low), 0.0, 1.0));
}

// The mean of the picture over an ellipse of this radius across the line from `seen_from` to `pixel`, and longer along
// it: a rough mirror is drawn out towards the viewer. The taps are turned from pixel to pixel (interleaved gradient
// noise, Jimenez 2014, "Next generation post processing in Call of Duty", slide 123), or lamps would be seen as rows of
// dots.
vec3 blurred(vec2 pixel, vec2 seen_from, float radius_px, float longer)
{
    const vec2 way = pixel - seen_from;
    const vec2 along = dot(way, way) > 1.0 ? normalize(way) : vec2(0.0, 1.0), across = vec2(-along.y, along.x);
    const float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < TAPS; i++) {
        const float angle = 2.3999632 * float(i) + turn, radius = radius_px * sqrt((float(i) + 0.5) / float(TAPS));
        sum += scene_light(pixel + across * (radius * cos(angle)) + along * (radius * longer * sin(angle)));
    }
    return sum / float(TAPS);
}

// Light from where the picture does not reach: the environment, which the surroundings hide near the horizon. There the
// nearest pixel of the picture stands for them.
vec3 around_picture(vec3 d, vec2 pixel)
{
    const vec3 open = environment(d, vec2(1.0));
    return mix(min(scene_light(in_viewport(pixel)), open), open, smoothstep(0.1, 0.6, d.y));
}

// `up`: the mirror's normal. `lobe`: half the angle over which a rough mirror spreads light (tangent). `cosine`: to the
// mirror's normal. A ray that ends hidden behind something shows what is seen in its direction: mostly that thing.
vec3 mirrored(vec3 from, vec3 d, vec3 up, float lobe, float cosine)
{
    const float way = meeting(Ray(from, d, up));
    vec2 pixel;
    float depth;
    if (!pixel_of(way > 0.0 ? vec4(from + d * way, 1.0) : vec4(d, 0.0), pixel, depth))
        return environment(d, vec2(1.0));
    const float shown = inside_picture(pixel);
    const vec3 around = around_picture(d, pixel);
    if (shown <= 0.0)
        return around;
    // The lobe is as wide on the picture as it is seen from the camera: small for what is near the mirror.
    const float spread = way > 0.0 ? way / (way + length(from)) : 1.0;
    const float radius_px = lobe * spread / view.pixel_angle;
    return mix(around, blurred(pixel, gl_FragCoord.xy, radius_px, clamp(1.0 / max(cosine, 0.1), 1.0, 4.0)), shown);
}
