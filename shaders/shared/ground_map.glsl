// ground_map.glsl - how a host's material reads Virga's ground maps (virga/ground.h, virga_ground_maps). For GLSL
// hosts: include it, or port it.
//
// `at` is a position in cells, relative to the window's low corner: (world.xz - low_m) / cell_m. Compute it on the CPU
// for the camera and add the offset from the camera here, so that it stays exact at a great distance from the origin.
// `low_cell` is the index of the corner's cell, floor(low_m / cell_m), modulo `cells`.

// Outside the window use virga_ground_far_at, with `far_at` in far cells, relative to far_low_m. Blend from the window
// to there with
//     virga_ground_mix(far, near, virga_ground_near_share(at - camera_at, reach_m / cell_m))
// From there to the horizon use virga_ground_open with the surface's material, or dry ground if the host has no
// material.

struct virga_ground_wetness {
    float wet;         // [0; 1] filled fraction of the pores, or coverage by a film
    float depth_mm;    // mm, of the water
    float slope2;      // variance of the slope of ripples
    float spot;        // [0; 1] how dark spots of first drops make it
};

vec4 virga_ground_texel(sampler2D wet_map, ivec2 low_cell, int cells, ivec2 cell)
{
    return texelFetch(wet_map, (low_cell + cell) & (cells - 1), 0);
}

// ---- dark spots of first drops
//
// Each of the 8 x 8 bits of a cell is a place for one drop's spot. The places have random middles and radii, which stay
// the same, so spots lie on no lattice; a drop takes the places around it that fit its size (ground/land.comp).

const float VIRGA_GROUND_SPOTS_UNTIL = 0.8; // fuller pores are as dark as a spot: none can be seen
const float VIRGA_GROUND_SPOT_MEAN = 0.69;  // darkness of a spot by itself, summed over it, in bits

// Four random numbers in [0; 1) for the bit with this index, which counts from the corner of the cells' wrap-around.
vec4 virga_ground_spot_chance(ivec2 index)
{
    uint mixed = uint(index.x) * 0x8DA6B343u + uint(index.y) * 0xD8163841u;
    mixed = (mixed ^ mixed >> 15) * 0xCB1AB31Fu;
    mixed ^= mixed >> 14;
    return vec4(mixed & 255u, mixed >> 8 & 255u, mixed >> 16 & 255u, mixed >> 24) / 256.0;
}

// The middle of a spot, from its bit's low corner, and its radius, in bits. Together less than 2: around a position the
// 3 x 3 bits are enough.
vec2 virga_ground_spot_middle(vec4 chance) { return 0.1 + 0.8 * chance.xy; }
float virga_ground_spot_radius(vec4 chance) { return 0.35 + 0.55 * chance.z; }

// Water of a spot at an offset from its middle, 1 in the middle of a fresh one. Pores draw it outwards, so that a spot
// is darkest in its middle and has a soft rim, which is no circle. `shrunk`: part of its radius that is still dark.
// `blur`: the width over which a pixel blurs the rim, in bits.
float virga_ground_spot(vec2 from, vec4 chance, float shrunk, float blur)
{
    const float far = length(from);
    const vec2 turn = normalize(chance.yw - 0.4999), to = from / max(far, 1e-4);
    const vec2 v = vec2(dot(to, turn), to.x * turn.y - to.y * turn.x);
    const float lobes = 0.12 * (v.x * v.x - v.y * v.y) + 0.08 * v.x * (v.x * v.x - 3.0 * v.y * v.y);
    const float rim = virga_ground_spot_radius(chance) * (1.0 + lobes) * shrunk;
    return 1.0 - smoothstep(min(0.4 * rim, rim - blur), rim, far);
}

// Mean darkness where spots cover this share of the ground: their rims are paler, until they join.
float virga_ground_spot_mean(float share) { return share * mix(VIRGA_GROUND_SPOT_MEAN, 1.0, share); }

// Part of its radius that a spot still has as it dries. `wet` is the filled fraction of the pores of all the ground
// around, of which spots cover `share`. A tenth of the pores under a spot is enough to darken all of it. Below that the
// water that is left is in the middle, and the rim dries first. Volume over area grows with a drop's size, so small
// spots dry before large ones; and some are older than others.
float virga_ground_spot_wicked(float wet, float share, vec4 chance)
{
    const float water = virga_ground_spot_radius(chance) * (0.8 + 1.6 * chance.w);
    return pow(clamp(10.0 * wet * water / max(share, 1e-3), 0.0, 1.0), 0.25);
}

// Darkness by spots, [0; 1]. Where spots meet there is more water, so it is darker; and where those of all places
// around are there, none of the ground between them stays dry. If a pixel is larger than a bit, or no spot can be seen,
// the result is the mean of the cell. `pixel_cells`: size of a pixel in cells. `wet` as in virga_ground_wetness.
float virga_ground_spots(usampler2D spot_map, ivec2 low_cell, int cells, vec2 at, float pixel_cells, float wet)
{
    const ivec2 texel = (low_cell + ivec2(floor(at))) & (cells - 1);
    const int bits = bitCount(texelFetch(spot_map, ivec2(2 * texel.x, texel.y), 0).r) +
                     bitCount(texelFetch(spot_map, ivec2(2 * texel.x + 1, texel.y), 0).r);
    const float mean = virga_ground_spot_mean(float(bits) / 64.0);
    const float far = clamp(pixel_cells * 8.0 - 1.0, 0.0, 1.0), blur = clamp(pixel_cells * 8.0, 0.15, 1.0);
    const bool shows = wet < VIRGA_GROUND_SPOTS_UNTIL && far < 1.0;
    const ivec2 own = ivec2(floor(at * 8.0));
    float water = 0.0, held = 0.0, all = 1e-6;
    // Software Vulkan leaves a loop as soon as no lane needs it, but runs both sides of a branch.
    for (int i = 0; i < (shows && wet > 0.0 ? 9 : 0); i++) {
        const ivec2 bit = own + ivec2(i % 3, i / 3) - 1, inside = bit & 7;
        const ivec2 cell = (low_cell + (bit >> 3)) & (cells - 1);
        const uint word = texelFetch(spot_map, ivec2(2 * cell.x + (inside.y >> 2), cell.y), 0).r;
        const float is_set = float(word >> uint((inside.y & 3) * 8 + inside.x) & 1u);
        const vec4 chance = virga_ground_spot_chance(8 * cell + inside);
        const vec2 from = at * 8.0 - vec2(bit) - virga_ground_spot_middle(chance);
        // The share is that of the spot's half of its cell, wherever it is seen from, so it is cut nowhere.
        const float wicked = is_set * virga_ground_spot_wicked(wet, float(bitCount(word)) / 32.0, chance);
        water += is_set * (0.4 + 0.6 * chance.w) * virga_ground_spot(from, chance, max(wicked, 1e-3), blur);
        const float near = max(1.5 - dot(from, from), 0.0);
        held += wicked * near;
        all += near;
    }
    const float dark = max(min(1.09 * (1.0 - exp(-2.5 * water)), 1.0), smoothstep(0.75, 0.999, held / all));
    return mix(shows ? dark : mean, mean, far);
}

// ---- joints between stones
//
// Liquid that wets the walls of a pore of radius r, at contact angle theta, is drawn into it by gamma cos(theta) / r
// and held back by its viscosity mu, and gets to x with x^2 = r gamma cos(theta) t / (2 mu) (Washburn 1921, The
// dynamics of capillary flow, from memory). In the sand of a joint, r = 0.03 mm and cos(theta) = 0.5: 2 cm in a second
// and 7 cm in ten. So along a joint the water of a cell is soon everywhere alike, and shows no spots. In concrete or
// stone pores are of half a micrometre: 3 mm in a second, 9 mm in ten. But finer pores pull harder, and take the water
// out of the sand, whose grains keep a film. A joint of width w has caught w times `wet` (of the pores' volume on an
// area); where a tenth of the pores is full the stone is dark, as under a spot. Beside it, on each side, a strip of
// width x is so:
//
//     0.1 (2 x) = wet (w + 2 x),   x = w wet / (2 (0.1 - wet)),
//
// as the strip has its own rain, too. Joints are the first to be dark along all their length, and the last to dry.

// Width (m) of the dark strip on each side, at most most_m. `wet`: [0; 1] of the pores' volume, as
// virga_ground_wetness.wet; `width_m`: of the joint, above 0.
float virga_ground_joint_strip(float wet, float width_m, float most_m)
{
    return min(0.5 * width_m * wet / max(0.1 - wet, 1e-6), most_m);
}

// [0; 1] Darkness at a distance from a joint's edge, < 0 in the joint: by the grains' films in it and by the strip
// beside it, which fades over its outer half. `pixel_m`: over so much the result is averaged. 0 from most_m (above 0)
// on.
float virga_ground_joint(float wet, float away_m, float width_m, float most_m, float pixel_m)
{
    const float strip = virga_ground_joint_strip(wet, width_m, most_m / 1.5);
    const float pixel = clamp(pixel_m, 1e-6, 2.0 * most_m);
    const float fade = min(max(0.5 * strip, 0.5 * pixel), most_m - strip);
    const float joint = clamp(0.5 - away_m / pixel, 0.0, 1.0);
    const float both = clamp(0.5 + 0.5 * (strip - away_m) / fade, 0.0, 1.0);
    return joint * min(10.0 * wet, 1.0) + max(both - joint, 0.0);
}

// Ground that is steeper than this is a step from one surface to another.
const float virga_ground_steepest = 1.2;

// The change of height per cell, along x and z, between the four cells around a position; `t` is where it is among
// them. 0 along an axis on which they belong to different surfaces, or some of them are no ground.
vec2 virga_ground_slope(vec4 heights, vec2 t, float cell_m)
{
    const vec2 rise_x = vec2(heights.y - heights.x, heights.w - heights.z);
    const vec2 rise_z = vec2(heights.z - heights.x, heights.w - heights.y);
    const float most = virga_ground_steepest * cell_m;
    return vec2(max(abs(rise_x.x), abs(rise_x.y)) <= most ? mix(rise_x.x, rise_x.y, t.y) : 0.0,
                max(abs(rise_z.x), abs(rise_z.y)) <= most ? mix(rise_z.x, rise_z.y, t.x) : 0.0);
}

// 1 if a cell and a position belong to one surface, else 0: their heights are alike, or the slope explains by how much
// they differ. `off` leads from the middle of the cell to the position, in cells.
float virga_ground_same(float cell_height_m, float height_m, vec2 slope, vec2 off)
{
    const float apart = height_m - cell_height_m;
    return float(min(abs(apart), abs(apart - dot(slope, off))) < 0.2);
}

// The ground at a position. `height_m` is its height above the maps' base_m; `cell_m` is the maps' cell_m. The foot of
// a wall, a car or a bridge does not become wet because the ground below it is wet.
virga_ground_wetness virga_ground_at(sampler2D wet_map, usampler2D spot_map, ivec2 low_cell, int cells, vec2 at,
                                     float height_m, float pixel_cells, float cell_m)
{
    virga_ground_wetness found = virga_ground_wetness(0.0, 0.0, 0.0, 0.0);
    const vec2 middle = at - 0.5;
    const ivec2 low = ivec2(floor(middle));
    const vec2 t = middle - vec2(low);
    vec4 texels[4], heights;
    for (int i = 0; i < 4; i++) {
        texels[i] = virga_ground_texel(wet_map, low_cell, cells, low + ivec2(i & 1, i >> 1));
        heights[i] = texels[i].a;
    }
    const vec2 slope = virga_ground_slope(heights, t, cell_m);
    vec3 sum = vec3(0.0);
    float own = 0.0, all = 1e-6;
    for (int i = 0; i < 4; i++) {
        const vec2 corner = vec2(i & 1, i >> 1), share = mix(1.0 - t, t, corner);
        const float same = virga_ground_same(heights[i], height_m, slope, t - corner);
        sum += texels[i].xyz * (share.x * share.y * same);
        all += share.x * share.y * same;
        own = corner == step(vec2(0.5), t) ? same : own;
    }
    const bool inside = min(low.x, low.y) >= 0 && max(low.x, low.y) < cells - 1;
    sum /= all; // beside a wall some of the cells are its top
    if (inside) {
        found = virga_ground_wetness(sum.x, sum.y, sum.z,
                                     own * virga_ground_spots(spot_map, low_cell, cells, at, pixel_cells, sum.x));
    }
    return found;
}

// ---- stones above the water
//
// depth_mm is the water of a cell divided by its area. Real ground is rougher than a cell: water first fills pores
// between stones, and the shore of a puddle runs around each stone. A host that renders the heights of stones (a height
// map, noise: 4 to 20 mm wide, half a millimetre deep on asphalt) computes here which of them are under water. Heights
// are relative to their mean, in mm. `rough_mm` (>= 0) is the standard deviation of all heights. They are assumed to
// have a logistic distribution, for which both functions are closed forms. They cost a few exponentials and read no
// texture.

// Height (mm) of the water level above the mean of the stones; < 0 while only the lowest pores are full. Such a level
// leaves depth_mm of water on the area: depth_mm = s ln(1 + e^(level / s)) with s = sqrt(3) / pi times rough_mm.
float virga_ground_level_mm(float depth_mm, float rough_mm)
{
    const float s = 0.5513 * max(rough_mm, 1e-3);
    return depth_mm + s * log(max(1.0 - exp(-depth_mm / s), 1e-6));
}

// [0; 1] Fraction of a position that is under that level. The position is height_mm above the mean. blur_mm (>= 0) is
// the standard deviation of the heights that height_mm leaves out, because they are too fine for a pixel. A height of 0
// with blur_mm = rough_mm gives the mean over all stones, 1 - e^(-depth_mm / s). So a host may fade from one to the
// other as pixels get larger than stones, and the ground stays equally wet.
float virga_ground_under_water(float level_mm, float height_mm, float blur_mm)
{
    return 1.0 / (1.0 + exp(clamp((height_mm - level_mm) / (0.5513 * max(blur_mm, 1e-3)), -60.0, 60.0)));
}

// ---- outside the window

virga_ground_wetness virga_ground_mix(virga_ground_wetness a, virga_ground_wetness b, float t)
{
    return virga_ground_wetness(mix(a.wet, b.wet, t), mix(a.depth_mm, b.depth_mm, t), mix(a.slope2, b.slope2, t),
                                mix(a.spot, b.spot, t));
}

// Weight of the window at an offset from the camera; `off` and `reach` are in cells. It falls from half of the reach
// on: with distance each impact represents more drops, so single cells get wet at random there. 1 if reach is 0:
// smoothstep is undefined if its edges do not increase.
float virga_ground_near_share(vec2 off, float reach)
{
    const float edge = max(reach, 1e-3);
    return reach > 0.0 ? 1.0 - smoothstep(0.5 * edge, edge, max(abs(off.x), abs(off.y))) : 1.0;
}

// Level ground in the open, of a material (virga_occluder.material).
virga_ground_wetness virga_ground_open(sampler2D far_map, int far_cells, uint material)
{
    const vec4 texel = texelFetch(far_map, ivec2(min(material, 31u), far_cells), 0);
    return virga_ground_wetness(texel.x, texel.y, max(texel.z, 0.0),
                                virga_ground_spot_mean(max(-texel.z, 0.0)));
}

// The ground at a position outside the window, as virga_ground_at. `open` is used where this map ends. `far_cell_m` is
// the maps' far_cell_m.
virga_ground_wetness virga_ground_far_at(sampler2D far_map, int far_cells, vec2 far_at, float height_m,
                                         virga_ground_wetness open, float far_cell_m)
{
    const vec2 middle = far_at - 0.5;
    const ivec2 last = ivec2(max(far_cells - 1, 0)), low = clamp(ivec2(floor(middle)), ivec2(0), max(last - 1, 0));
    const vec2 t = clamp(middle - vec2(low), 0.0, 1.0);
    vec4 texels[4], heights, sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        texels[i] = texelFetch(far_map, min(low + ivec2(i & 1, i >> 1), last), 0); // valid, also if there is one row
        heights[i] = texels[i].a;
    }
    const vec2 slope = virga_ground_slope(heights, t, far_cell_m);
    float found = 1e-6;
    for (int i = 0; i < 4; i++) {
        const vec2 corner = vec2(i & 1, i >> 1), side = mix(1.0 - t, t, corner);
        const vec4 texel = texels[i];
        const float share = side.x * side.y * virga_ground_same(texel.a, height_m, slope, t - corner);
        sum += vec4(texel.xy, max(texel.z, 0.0), max(-texel.z, 0.0)) * share;
        found += share;
    }
    sum /= found;
    const vec2 inside = min(far_at, float(far_cells) - far_at);
    const float share = smoothstep(0.5, 16.0, min(inside.x, inside.y));
    const virga_ground_wetness own = virga_ground_wetness(sum.x, sum.y, sum.z, virga_ground_spot_mean(sum.w));
    return virga_ground_mix(open, own, share);
}
