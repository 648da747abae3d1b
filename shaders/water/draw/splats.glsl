// splats.glsl - what a surfel is in the picture: where it is drawn, how large, and with which weight.
//
// A surfel is a disc. Where it is smaller in the picture than MIN_PX, or seen from so far aside that its ellipse is
// narrower, the ellipse is made as large, so that no surfel falls between pixels. Its weight is divided by its area in
// the picture: the weights of all surfels of a surface add up to 1 in each pixel, whatever their size. At the border of
// the water the sum falls to 0, and is about 1/2 at the border itself.
//
// A splat is three texels:
//
//     center x, y, w   clip coordinates
//     facing           see facing_of and pack_facing
//     first axis       clip coordinates x, y, w, per radius; in the lowest bits of x the share of a surfel of the
//                      surface that is there, see packed_share.glsl
//     weight           half float: at its center; negative for specks (specks.glsl)
//     push, scale      see pack_push_scale
//     second axis      clip coordinates x, y, w, per radius
//     motion           two half floats, px
//
// The includer includes surfels.glsl.

#define SPECK_PX 1.0 // droplets of this radius and below are specks
#define NO_SPECK_PX 2.5 // in between, some of their surfels are
#define MIN_PX 1.2   // half a width: each pixel's center is in the ellipse of what is less than that away
#define RIM_PX 1.0
#define DROPLET_RIM 0.45 // see depth_scale; radii
#define MIN_ROOM_PX 0.3
#define PUSH 1.5     // radii
#define MAX_PUSH 20.0 // of what is seen at grazing angles

// The weight of a surfel of a droplet, as a factor of what its area gives; negative: it is a speck. Small droplets are
// specks. One whose particle appears or vanishes is made of specks as well, as only they cover a part of a pixel. They
// cover as much as its share; those of one that is no speck by its size cover all from half of the share on, and from
// there on turn into a surface one by one.
float droplet_factor(Surfel s, float droplet_px)
{
    const float specks = 1.0 - smoothstep(SPECK_PX, NO_SPECK_PX, droplet_px), whole = mix(0.5, 1.0, specks);
    const float fading = min((1.0 - s.share) / max(1.0 - whole, 1e-3), 1.0);
    return s.turn < max(specks, fading) ? -min(s.share / whole, 1.0) : 1.0;
}

vec2 motion_of(Surfel s, vec4 now)
{
    const vec3 before = s.position - s.velocity * view.frame_interval_s;
    return motion_px(now, project(to_mat(view.previous_clip_from_rel), before));
}

// Factor of the size in the depth pass; 0: it is not drawn there. What is not drawn there hides nothing: other water
// behind it is added to it. So it may reach only where the water in front is whole, else a ring around it would let the
// scene through. A splat ends before its surfel does, without what makes it wider; far away, where that leaves
// nothing, it is as wide as pixels need it. Of a droplet it is the inner part alone, as few surfels leave gaps in its
// rim, and specks hide nothing.
float depth_scale(Surfel s, float cosine, vec2 size_px, float radius_px, float droplet_px, bool is_speck)
{
    float room = radius_px * cosine - RIM_PX;
    if (s.droplet > 0.0)
        room = min(room, droplet_px * (1.0 - DROPLET_RIM - sqrt(1.0 - cosine * cosine)) - 1.0);
    const float near_scale = room < MIN_ROOM_PX ? 0.0 : min(room / size_px.y, 1.0);
    if (s.droplet > 0.0)
        return is_speck ? 0.0 : near_scale;
    return mix(0.7, near_scale, smoothstep(MIN_PX, 2.0 * MIN_PX, radius_px));
}

#define MIN_STREAK_PX 0.1
#define MAX_STREAK_PX 1024.0

// How far a surfel has come in the picture since the shutter opened, in pixels. Specks are drawn along it: else a
// picture of a few sub-frames has rows of dots where spray is fast.
vec2 streak_of(Surfel s, vec4 now)
{
    const vec3 opened = s.position - s.velocity * (view.time_close_s - view.time_open_s);
    const vec2 streak = -motion_px(now, project(to_mat(view.open_clip_from_rel), opened)) * look.scale;
    return clamp(streak, vec2(-MAX_STREAK_PX), vec2(MAX_STREAK_PX));
}

// The ellipse of a speck that moves by `streak` pixels: its center, its two axes, and the factor of its weight against
// that of a disc of `radius_px`. The weight (1 - r^2)^2 has the variance A^2 / 8 along an axis A, and a segment of the
// length L has L^2 / 12: A^2 = radius^2 + 2 L^2 / 3.
float stretch_speck(vec2 streak, float radius_px, inout vec4 center, out vec3 first, out vec3 second)
{
    const float length_px = length(streak), axis_px = sqrt(radius_px * radius_px + length_px * length_px / 1.5);
    const vec2 along = streak / length_px, clip_of_px = 2.0 * center.w / vec2(look.width, look.height);
    first = vec3(axis_px * along * clip_of_px, 0.0);
    second = vec3(radius_px * vec2(-along.y, along.x) * clip_of_px, 0.0);
    center.xy -= 0.5 * streak * clip_of_px;
    return radius_px / axis_px;
}

// The three texels of a splat.
struct Splat {
    uvec4 one, two, three;
};

Splat splat_of(Surfel s)
{
    const mat4 clip_from_rel = to_mat(view.clip_from_rel);
    vec4 center = project(clip_from_rel, s.position);
    const vec3 eye = -normalize(s.position);
    const float cosine = clamp(dot(s.normal, eye), 1e-3, 1.0), sine = sqrt(1.0 - cosine * cosine);
    const float pixel_m = look.pixel_angle * center.w, radius = look.surfel_scale * s.radius;
    const vec3 aside = sine > 1e-3 ? normalize(cross(s.normal, eye))
                                   : normalize(cross(eye, abs(eye.y) < 0.7 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    const float wide = max(radius, MIN_PX * pixel_m), narrow = max(radius * cosine, MIN_PX * pixel_m);
    const vec3 across = cross(eye, aside);
    const vec3 second = radius * cross(s.normal, aside) + across * (narrow - radius * cosine);
    // The integral of (1 - r^2)^2 over a disc is a third of its area.
    float weight = 3.0 * s.area * cosine / (3.14159265 * wide * narrow);
    // What was made wider without being tilted lies in front of the surface or behind it by so much.
    const float off = (narrow - radius * cosine) * sine / cosine;
    const float push = min(PUSH * wide + off, MAX_PUSH * wide) / length(s.position);
    vec3 a = (clip_from_rel * vec4(wide * aside, 0.0)).xyw, b = (clip_from_rel * vec4(second, 0.0)).xyw;
    const float droplet_px = s.droplet / pixel_m;
    const float factor = s.droplet > 0.0 ? droplet_factor(s, droplet_px) : 1.0;
    const float scale = depth_scale(s, cosine, vec2(wide, narrow) / pixel_m, radius / pixel_m, droplet_px,
                                    factor < 0.0);
    const vec2 facing = facing_of(s.normal), motion = motion_of(s, center), streak = streak_of(s, center);
    if (factor < 0.0 && dot(streak, streak) > MIN_STREAK_PX * MIN_STREAK_PX)
        weight *= stretch_speck(streak, sqrt(wide * narrow) / pixel_m, center, a, b);
    a.x = with_share(a.x, s.droplet > 0.0 ? 1.0 : s.share);
    return Splat(uvec4(floatBitsToUint(center.xyw), pack_facing(facing)),
                 uvec4(floatBitsToUint(a), (halves(factor * weight, 0.0) & 0xffffu) |
                                               pack_push_scale(vec2(push, scale))),
                 uvec4(floatBitsToUint(b), halves(motion.x, motion.y)));
}
