#version 460
// show.frag - the finished picture for the display: a stop brighter, highlights rolled off, and stairs along edges
// smoothed. sRGB is the target's format.

layout(set = 0, binding = 0) uniform sampler2D picture;

layout(location = 0) out vec4 out_color;

const int REACH = 8; // pixels along an edge to look for its ends

vec3 shown(ivec2 at)
{
    at = clamp(at, ivec2(0), textureSize(picture, 0) - 1);
    vec3 light = 2.0 * texelFetch(picture, at, 0).rgb;
    vec3 over = max(light - 0.6, 0.0); // identity up to 0.6, then a shoulder of the same slope that ends at 1
    return min(light, 0.6) + 0.4 * over / (0.4 + over);
}

float brightness(ivec2 at)
{
    return sqrt(dot(shown(at), vec3(0.2126, 0.7152, 0.0722))); // about as the eye has it
}

// How far the pair of pixels on both sides of an edge goes on as it is here: (steps, whether it ends on the far side).
vec2 follow(ivec2 at, ivec2 across, ivec2 along, float middle, float contrast)
{
    for (int i = 1; i <= REACH; i++) {
        float here = 0.5 * (brightness(at + i * along) + brightness(at + across + i * along)) - middle;
        if (abs(here) > 0.25 * contrast)
            return vec2(float(i), here > 0.0 ? 1.0 : -1.0);
    }
    return vec2(float(REACH), 0.0);
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    float m = brightness(at), n = brightness(at + ivec2(0, -1)), s = brightness(at + ivec2(0, 1)),
          w = brightness(at + ivec2(-1, 0)), e = brightness(at + ivec2(1, 0));
    float high = max(max(max(n, s), max(w, e)), m), low = min(min(min(n, s), min(w, e)), m);
    vec3 color = shown(at);
    if (high - low > max(0.04, 0.12 * high)) {
        bool level = abs(n + s - 2.0 * m) > abs(w + e - 2.0 * m); // the edge runs from left to right
        float before = level ? n : w, behind = level ? s : e;
        float side = abs(before - m) > abs(behind - m) ? -1.0 : 1.0, other = side < 0.0 ? before : behind;
        ivec2 across = level ? ivec2(0, int(side)) : ivec2(int(side), 0), along = level ? ivec2(1, 0) : ivec2(0, 1);
        float middle = 0.5 * (m + other), contrast = abs(m - other);
        vec2 ahead = follow(at, across, along, middle, contrast), back = follow(at, across, -along, middle, contrast);
        vec2 near = ahead.x < back.x ? ahead : back;
        // A line through the middle of the step: nearer its end, this pixel is covered up to a half by the other side.
        bool covered = near.y * (m - middle) < 0.0;
        float share = covered ? 0.5 - near.x / (ahead.x + back.x) : 0.0;
        color = mix(color, shown(at + across), max(share, 0.0));
    }
    out_color = vec4(color, 1.0);
}
