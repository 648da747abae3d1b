// mirror.glsl - what rough level water mirrors of the scene: the picture of the world turned upside down about one
// plane, looked up where each of a few facets of the water sends the ray.
layout(set = 0, binding = 7) uniform sampler2D mirror_picture;

const int MIRROR_TAPS = 8;

// The mirrored picture at a place of the mirrored world, relative to the camera. Where its edge is passed, the last it
// shows is good for a little farther: a puddle that paled at the picture's edge would be seen.
// a: 1 / distance.
vec4 mirror_at(vec3 place, out float trust)
{
    const vec4 clip = frame.clip_from_relative * vec4(place, 1.0);
    const vec2 at = clip.xy / max(clip.w, 1e-3) * frame.mirror.y;
    const float over = max(abs(at.x), abs(at.y)) - 1.0;
    trust = clip.w > 0.0 ? 1.0 - smoothstep(0.0, 0.3, over) : 0.0;
    return textureLod(mirror_picture, at * 0.5 + 0.5, 0.0);
}

// Where a ray that leaves water in direction r and goes so far ends, in the mirrored world. Water that lies `rise`
// above the plane mirrors a world that lies twice as much higher.
vec3 mirror_place(vec3 relative, vec3 r, float way, float rise)
{
    return relative + vec3(r.x, -r.y, r.z) * way - vec3(0.0, 2.0 * rise, 0.0);
}

// Facets whose slopes are spread around the normal's as roughness says (Beckmann's distribution), weighted by how much
// of each is seen. rgb: light they mirror of what the picture shows; w: share of a white world's light that would be.
// `fresnel`: that share with what the picture does not show. Were it the flat water's, not the facets' mean, water
// whose waves are too far away to be drawn would be white towards the horizon.
vec4 mirror_light(vec3 relative, vec3 v, vec3 normal, float roughness, out float fresnel)
{
    const float rise = relative.y - frame.mirror.x;
    const float near = frame.mirror.z * (1.0 - smoothstep(0.3, 0.8, abs(rise))), from = length(relative);
    const vec2 slope = -normal.xz / normal.y;
    vec3 r = reflect(-v, normal);
    float trust, way = HOST_MIRROR_FAR;
    // How far what is mirrored lies: first as if it stood right there, so that a thing's foot is met by its mirrored
    // one; then where that sends the ray. The nearer of both: past an edge, the sky's way leads back to what hides it.
    for (int i = 0; i < 2 && near > 0.0; i++) {
        const vec3 place = mirror_place(relative, vec3(r.x, abs(r.y), r.z), i == 0 ? 0.0 : way, rise);
        way = clamp(1.0 / mirror_at(place, trust).a - from, 0.05, way);
    }
    // Turned from pixel to pixel (interleaved gradient noise, Jimenez 2014) and from sub-frame to sub-frame.
    const vec2 pixel = gl_FragCoord.xy + 37.0 * frame.screen.zw;
    const float turn = 6.2831853 * fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715))));
    vec4 sum = vec4(0.0);
    float whole = 0.0, mirrored = 0.0;
    for (int i = 0; i < MIRROR_TAPS; i++) {
        const float spread = roughness * roughness * sqrt(-log(1.0 - (float(i) + 0.5) / float(MIRROR_TAPS)));
        const float angle = turn + 2.3999632 * float(i);
        const vec2 s = slope + spread * vec2(cos(angle), sin(angle));
        const vec3 facet = normalize(vec3(-s.x, 1.0, -s.y));
        const float cosine = dot(facet, v), seen = max(cosine / facet.y, 0.0);
        const float c = 1.0 - max(cosine, 0.0), c2 = c * c, f = 0.0204 + (1.0 - 0.0204) * c2 * c2 * c;
        whole += seen;
        mirrored += seen * f;
        if (near > 0.0 && seen > 0.0) {
            r = reflect(-v, facet);
            const vec3 color = mirror_at(mirror_place(relative, vec3(r.x, abs(r.y), r.z), way, rise), trust).rgb;
            sum += seen * f * near * trust * vec4(color, 1.0);
        }
    }
    fresnel = mirrored / max(whole, 1e-6);
    return sum / max(whole, 1e-6);
}
