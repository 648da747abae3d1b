// mirror.glsl - what rough level water mirrors of the scene: the picture of the world turned upside down about one
// plane, looked up where each of a few facets of the water sends the ray.
layout(set = 0, binding = 7) uniform sampler2D mirror_picture;
layout(set = 0, binding = 9) uniform sampler2D mirror_near; // 1 / distance

const int MIRROR_TAPS = HOST_LOOKS;
const int MIRROR_ROW = 5, MIRROR_STRIDE = 3; // of look i, 5 + 3 i modulo 8: all different, and as many left as right
const float MIRROR_SMOOTH_TEXELS = 0.6;      // the looks' standard deviation where water is a perfect mirror

// Where the mirrored picture has a point of the mirrored world, relative to the camera. Where its edge is passed, the
// last it shows is good for a little farther: a puddle that paled at the picture's edge would be seen.
vec2 mirror_at(vec3 point, out float trust)
{
    const vec4 clip = frame.mirror_from_relative * vec4(point, 1.0);
    const vec2 at = clip.xy / max(clip.w, 1e-3);
    const float over = max(abs(at.x), abs(at.y)) - 1.0;
    trust = clip.w > 0.0 ? 1.0 - smoothstep(0.0, 0.3, over) : 0.0;
    return at * 0.5 + 0.5;
}

// Where a ray that leaves water in direction r and goes so far ends, in the mirrored world. Water that lies `rise`
// above the plane mirrors a world that lies twice as much higher.
vec3 mirror_point(vec3 relative, vec3 r, float way, float rise)
{
    return relative + vec3(r.x, -r.y, r.z) * way - vec3(0.0, 2.0 * rise, 0.0);
}

// Where in a normal distribution, in standard deviations of it, a share u of all lies below: near enough, by the
// logistic distribution's.
float mirror_quantile(float u) { return 0.56 * log(u / (1.0 - u)); }

// Look i of MIRROR_TAPS at a normal distribution of two dimensions: one in each eighth of it along either (a Latin
// square). They are alike for all pixels, as a picture of one sample has nothing that would average noise, and each is
// as blurred as they lie apart; of pictures that are averaged each has its own part of the eighths.
vec2 mirror_look(int i)
{
    const ivec2 eighth = ivec2((MIRROR_ROW + MIRROR_STRIDE * i) % MIRROR_TAPS, i);
    const vec2 u = (vec2(eighth) + 0.5 + frame.screen.zw) / float(MIRROR_TAPS);
    return vec2(mirror_quantile(clamp(u.x, 0.004, 0.996)), mirror_quantile(clamp(u.y, 0.004, 0.996)));
}

// The level of the picture for one look of MIRROR_TAPS. A share of 1 / MIRROR_TAPS of Beckmann's distribution of
// slopes, exp(-s^2 / alpha^2) / (pi alpha^2), lies in a square with the side alpha sqrt(pi / (MIRROR_TAPS (1 - u))),
// where u of it lies nearer to the middle. A facet that tilts turns the ray by twice as much away from the eye, and by
// the cosine to the normal of that across; what is so far away turns that much less around the camera. Were a look
// sharper, one that meets a lamp would be a spark. The mean of both ways, but not twice the smaller: a lamp's pillar
// stays one. A level looked up between its texels, made as they are, is as blurred as a square of one
// and a half times a texel's side or more.
float mirror_level(float alpha, float u, float cosine, float way, float from)
{
    const float side = alpha * sqrt(3.14159265 / (float(MIRROR_TAPS) * (1.0 - u)));
    const float angle = 2.0 * side * min(sqrt(cosine), 2.0 * cosine) * way / (from + way);
    const mat4 clip = frame.clip_from_relative;
    const float focal = length(vec3(clip[0][1], clip[1][1], clip[2][1])) * frame.mirror.y; // clip space per radian
    const float side_px = angle * focal * 0.5 * float(textureSize(mirror_picture, 0).y);
    return log2(max(0.7 * side_px, 1.0));
}

// Facets whose slopes are spread around the normal's as roughness says (Beckmann's distribution), weighted by how much
// of each is seen. rgb: light they mirror of what the picture shows; w: share of a white world's light that would be.
// `fresnel`: that share with what the picture does not show. Were it the flat water's, not the facets' mean, water
// whose waves are too far away to be drawn would be white towards the horizon. `open`: share of the sky that is seen.
vec4 mirror_light(vec3 relative, vec3 v, vec3 normal, float roughness, float open, out float fresnel)
{
    const float rise = relative.y - frame.mirror.x;
    const float off = abs(rise), from = length(relative);
    float near = frame.mirror.z * (1.0 - smoothstep(0.6, 1.4, off));
    const vec2 slope = -normal.xz / normal.y;
    vec3 r = reflect(-v, normal);
    float trust, way = HOST_MIRROR_FAR, seen = 0.0;
    // How far what is mirrored lies: first as if it stood right there, so that a thing's foot is met by its mirrored
    // one; then where that sends the ray. The nearer of both: past an edge, the sky's way leads back to what hides it.
    for (int i = 0; i < 2 && near > 0.0; i++) {
        const vec3 point = mirror_point(relative, vec3(r.x, abs(r.y), r.z), i == 0 ? 0.0 : way, rise);
        seen = 1.0 / textureLod(mirror_near, mirror_at(point, trust), 0.0).r;
        way = clamp(seen - from, 0.05, way);
    }
    // Ground that lies a little above the plane is not in the picture, so on a slope the sky is seen under things, and
    // under a car at once: the car's image lies beside itself by twice the rise.
    const float hidden = (1.0 - smoothstep(0.05, 0.3, open)) * smoothstep(0.02, 0.1, off);
    near *= seen < 0.9 * HOST_MIRROR_FAR ? 1.0 : (1.0 - hidden) * (1.0 - smoothstep(0.3, 0.8, off));
    // Slopes across and along the line of sight: a lamp's pillar stands along it, one look above the other.
    const vec2 along = dot(v.xz, v.xz) > 1e-6 ? normalize(v.xz) : vec2(0.0, 1.0), across = vec2(-along.y, along.x);
    const float alpha = roughness * roughness;
    // Its picture has two pixels to a texel: magnified, edges in it would be stairs.
    const float smooth_texels = MIRROR_SMOOTH_TEXELS * sqrt(frame.sampling.x);
    vec4 sum = vec4(0.0);
    float whole = 0.0, mirrored = 0.0;
    int i = int(frame.sampling.y);
    do { // at least once; a condition at the beginning would cost software Vulkan one more
        const vec2 look = mirror_look(i);
        const float u = 1.0 - exp(-0.5 * dot(look, look));
        const vec2 s = slope + 0.70710678 * alpha * (look.x * across + look.y * along);
        const vec3 facet = normalize(vec3(-s.x, 1.0, -s.y));
        const float cosine = dot(facet, v), seen = max(cosine / facet.y, 0.0);
        const float c = 1.0 - max(cosine, 0.0), c2 = c * c, f = 0.0204 + (1.0 - 0.0204) * c2 * c2 * c;
        whole += seen;
        mirrored += seen * f;
        if (near > 0.0 && seen > 0.0) {
            r = reflect(-v, facet);
            const float level = mirror_level(alpha, u, cosine, way, from);
            const vec3 point = mirror_point(relative, vec3(r.x, abs(r.y), r.z), way, rise);
            const vec2 at = mirror_at(point, trust) + smooth_texels * look / vec2(textureSize(mirror_picture, 0));
            const vec3 color = textureLod(mirror_picture, at, level).rgb;
            sum += seen * f * near * trust * vec4(color, 1.0);
        }
        i += int(frame.sampling.z);
    } while (i < MIRROR_TAPS);
    fresnel = mirrored / max(whole, 1e-6);
    return sum / max(whole, 1e-6);
}
