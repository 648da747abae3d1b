// gather.glsl - both fields of a texel, from samples that the includer has: sample_in and spread_in, which get the row
// of a texel as row_of gives it, and the texel. It also says whether there is a near field (NEAR), whether a layer lies
// on the scene (ON_SCENE), and with NARROW that no disc is wider than VIRGA_LENS_FINE texels, so that there are no
// blocks.
//
// In front of the focus, a sample covers every texel in its circle: the near field has a coverage of its own, and lies
// over the rest. Behind the focus, a sample is cut by what is nearer: it spreads no farther than the circle of the
// texel that it would cover, so nothing bleeds over a sharp edge in front of it. The far field is divided by the sum
// of its weights. Its fourth component is the near field's mean circle of confusion, which says what layers are in
// front of it. Where the near field hides the far field, the samples around fill in what the near blur uncovers: those
// that are not in front of the focus, and those that are much less so (behind_share in lens.glsl). Else everything in a
// picture that is focused beyond all of it would have a sharp outline.
//
// At half resolution a texel in focus has no far field of its own to show, as its pixels are shown as they are. Pixels
// behind it, at its edge, read between it and its neighbours. So it gets the far field that is behind it there, and
// neither is a dark edge of it around what is in focus, nor a hole.
//
// A layer that lies on the scene, as haze does, is spread by the same weights.

// The sum of the coverage of a disc on the grid, about: exact enough for weights that are divided by their sum.
float disc_area(float radius) { return 3.14159265 * (radius * radius + 1.0 / 12.0) + 0.1; }

// Behind what is out of focus in front, the scene is not known: it is filled in from around, mostly from the nearest
// samples. Those that would reach this far by themselves count in full.
float nearness(vec2 apart, float radius)
{
    const float share = dot(apart, apart) / max(radius * radius, 1.0);
    return 1.0 / max(share * share * share, 1.0);
}

// Up to this radius (texels) a texel has no far field of its own to show. Of the coarse fields a pixel shows nothing
// where its disc is not wide (VIRGA_LENS_COARSE_FROM), so such a texel gets the far field of the wide ones beside it.
#define BESIDE BY_SCALE(2.0, POINT)

// Whether light of this radius is gathered from single texels, up to radii of `most`. With NARROW the includer also has
// gathering_circle.
#ifdef NARROW
#define is_fine(radius, most) true
#else
float gathering_circle(float radius) { return radius; }
bool is_fine(float radius, float most) { return radius <= most; }
#endif

// What is gathered of a field: the scene's color and weight, and the layer on it.
struct field_sum {
    vec4 scene, on;
};

// What a texel gathers. Each field has loops of its own, because few tiles have both.
struct gatherer {
    ivec2 texel;
    float own;    // its circle of confusion
    vec2 reach;   // the largest radius that reaches its tile, in front of the focus and behind it
    uint levels;  // that have such light
    int top;      // the highest of them
    barrel cut;
    bool behind;  // it is in front of the focus, and looks for what is behind it
    bool beside;  // (half resolution) it is in focus, and looks for the far field of its neighbours
};

// Whether gather_far was done before.
#ifdef NARROW
bool is_known(gatherer to) { return !SHAPED && !to.behind && !(COARSE && to.beside); }
#else
bool is_known(gatherer to) { return false; }
#endif

bool has_level(gatherer to, uint group, uint level) { return (to.levels & level_bit(group, level)) != 0u; }

// As `covers`, for a squared distance that is known already.
float covered(ivec2 apart, float squared, float radius, barrel cut)
{
    return SHAPED ? covers(apart, radius, cut) : clamp(max(radius, 0.5) - sqrt(squared) + 0.5, 0.0, 1.0);
}

// In front of the focus, from samples. Wide discs come from blocks.
field_sum gather_near(gatherer to, inout vec2 circles, inout field_sum front)
{
    field_sum sum = field_sum(vec4(0.0), vec4(0.0));
    const float most = level_radius(0u), reach = min(to.reach.x, most);
    const int rows = reach > POINT && has_level(to, 1u, 0u) ? disc_rows(reach) : -1;
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(reach, y), row = row_of(to.texel + ivec2(0, y));
        const float down = float(y) * float(y);
        for (int x = -columns; x <= columns; x++) {
            const ivec2 apart = ivec2(x, y), from = to.texel + apart;
            const vec4 source = sample_in(row, from);
            // Seen from the source, this texel is at -apart, and the image is upside down.
            const float weight = source.a < -POINT && is_fine(-source.a, most)
                                     ? spread_in(row, from) *
                                           covered(apart, float(x) * float(x) + down, -source.a, to.cut)
                                     : 0.0;
            sum.scene += weight * vec4(source.rgb, 1.0);
            circles.x += weight * source.a;
            if (ON_SCENE)
                sum.on += weight * on_scene_mean(inside(from));
            if (to.behind && weight > 0.0) {
                const float before = weight * behind_share(to.own, source.a);
                front.scene += before * vec4(source.rgb, 1.0);
                circles.y += before * source.a;
                if (ON_SCENE)
                    front.on += before * on_scene_mean(inside(from));
            }
        }
    }
    return sum;
}

#ifndef NARROW
// The same, from the blocks of a level.
field_sum gather_near_blocks(gatherer to, uint level, inout vec2 circles, inout field_sum front)
{
    field_sum sum = field_sum(vec4(0.0), vec4(0.0));
    const float reach = has_level(to, 1u, level) ? min(to.reach.x, level_radius(level)) : -1.0;
    const seen_level at = see_level(level, to.texel, reach);
    const ivec2 rows = rows_of(at);
    for (int y = rows.x; y <= rows.y; y++) {
        const ivec2 columns = columns_of(at, y);
        for (int x = columns.x; x <= columns.y; x++) {
            const block source = block_at(at, ivec2(x, y), VIRGA_LENS_BLOCKS_NEAR);
            const vec2 weights = block_covers(source, source.radius, to.cut) / BLOCKS_PER_DISC;
            sum.scene += weights.xxxy * source.light;
            circles.x += weights.y * source.light.a * source.radius;
            if (ON_SCENE)
                sum.on += weights.y * block_on_scene(at, ivec2(x, y), VIRGA_LENS_BLOCKS_NEAR);
            if (to.behind && source.light.a > 0.0) {
                const vec2 before = weights * behind_share(to.own, source.radius);
                front.scene += before.xxxy * source.light;
                circles.y += before.y * source.light.a * source.radius;
                if (ON_SCENE)
                    front.on += before.y * block_on_scene(at, ivec2(x, y), VIRGA_LENS_BLOCKS_NEAR);
            }
        }
    }
    return sum;
}
#endif

// How far a texel looks for samples behind the focus, one by one. A texel behind the focus is covered by nothing wider
// than its own circle; behind a near one it may be any.
float far_reach(gatherer to)
{
    const float most = level_radius(0u);
    if (to.behind)
        return min(max(to.reach.y, -to.own), most);
    if (level_of(to.own) == 0u && !to.beside)
        return max(to.own, POINT);
    return has_level(to, 0u, 0u) ? min(to.reach.y, most) : -1.0;
}

// `trusted`: the sum of the weights, each times its share of being behind.
field_sum gather_far(gatherer to, inout float trusted)
{
#ifdef WIDE_PASS
    const float wide = COARSE ? 0.0 : coarseness(radius_at(row_of(to.texel) + to.texel.x) * float(STEP));
    finer_nearness = all_nearness = 0.0;
#endif
    field_sum sum = field_sum(vec4(0.0), vec4(0.0));
    const float reach = far_reach(to);
    // What is in blocks is not looked for here, but a texel that is nearly in focus cuts all to its own small circle.
    const bool small = !to.behind && !to.beside && level_of(to.own) == 0u;
    const float most = small ? MAX_RADIUS : level_radius(0u), least = to.beside ? BESIDE : -POINT;
    const float cut_to = to.beside ? MAX_RADIUS : max(to.own, POINT);
    const int rows = reach < 0.0 ? -1 : disc_rows(reach);
    for (int y = -rows; y <= rows; y++) {
        const int columns = row_reach(reach, y), row = row_of(to.texel + ivec2(0, y));
        const float down = float(y) * float(y);
        for (int x = -columns; x <= columns; x++) {
            const ivec2 apart = ivec2(x, y), from = to.texel + apart;
            const vec4 source = sample_in(row, from);
            const float radius = NEAR && to.behind ? max(source.a, -to.own) : min(source.a, cut_to);
            float gathered = source.a >= least && is_fine(source.a, most) ? 1.0 : 0.0;
            if (NEAR && to.behind)
                gathered = is_fine(source.a, most) ? behind_share(source.a, to.own) : 0.0;
            const float covers_it = covered(-apart, float(x) * float(x) + down, radius, to.cut);
            float weight = gathered * covers_it / disc_area(max(radius, POINT));
            if (NEAR && to.behind) {
                weight *= nearness(vec2(apart), max(source.a, 0.0));
#ifdef WIDE_PASS
                if (FINER) {
                    const float coarse = coarseness(source.a * float(STEP));
                    weight *= 1.0 - wide * coarse;
                    all_nearness += gathered * nearness(vec2(apart), 0.0);
                    finer_nearness += (1.0 - coarse) * gathered * nearness(vec2(apart), 0.0);
                }
#endif
                trusted += weight * gathered;
            }
            sum.scene += weight * vec4(source.rgb, 1.0);
            if (ON_SCENE)
                sum.on += weight * on_scene_mean(inside(from));
        }
    }
    return sum;
}

#ifndef NARROW
// How far it looks in the blocks of a level.
float far_block_reach(gatherer to, uint level)
{
    const float most = level_radius(level), fill = max(to.reach.y, -to.own);
    if (to.behind)
        return level_of(fill) == level ? fill : -1.0;
    if (!has_level(to, 0u, level) || (level_of(to.own) == 0u && !to.beside))
        return -1.0;
    return min(min(to.reach.y, most), to.beside ? most : to.own);
}

field_sum gather_far_blocks(gatherer to, uint level, inout float trusted)
{
    field_sum sum = field_sum(vec4(0.0), vec4(0.0));
    const uint kind = to.behind ? VIRGA_LENS_BLOCKS_ALL : VIRGA_LENS_BLOCKS_FAR;
    const float cut_to = to.beside ? view.max_radius : to.own;
    const seen_level at = see_level(level, to.texel, far_block_reach(to, level));
    const ivec2 rows = rows_of(at);
    for (int y = rows.x; y <= rows.y; y++) {
        const ivec2 columns = columns_of(at, y);
        for (int x = columns.x; x <= columns.y; x++) {
            const block source = block_at(at, ivec2(x, y), kind);
            const float radius = NEAR && to.behind ? max(source.radius, -to.own) : min(source.radius, cut_to);
            vec2 weights = block_covers(source, radius, to.cut) /
                           (3.14159265 * vec2(soft_area(radius, source.softs.x), soft_area(radius, source.softs.y)));
            // What is near is filled in from single texels, so that something thin before a lamp does not dim it. Light
            // is weighted as its weight is: at the rim of a block's disc, that of a lamp would be divided by next to
            // nothing.
            if (NEAR && to.behind) {
                weights.x = weights.y;
                const float apart = max(length(source.weight_apart), level_radius(0u));
                const float share = behind_share(source.radius, to.own);
                weights *= share * nearness(vec2(apart, 0.0), max(source.radius, 0.0));
                trusted += float(1 << 2 * level) * share * weights.y * source.light.a;
            }
            sum.scene += weights.xxxy * source.light;
            if (ON_SCENE)
                sum.on += weights.y * block_on_scene(at, ivec2(x, y), kind);
        }
    }
    return sum;
}
#endif

field_sum plus(field_sum a, field_sum b) { return field_sum(a.scene + b.scene, a.on + b.on); }

// The far field of a texel, with weights. `fine`: from single texels.
field_sum scene_behind(gatherer to, vec3 own_color, field_sum fine, inout float trusted)
{
    field_sum sum = fine;
#ifndef NARROW
    for (int level = 1; level <= to.top; level++) {
        const field_sum wide = gather_far_blocks(to, uint(level), trusted);
        const float texels = float(1 << 2 * level); // a block keeps means
        sum = plus(sum, field_sum(texels * wide.scene, texels * wide.on));
    }
#endif
    if (!to.beside)
        return sum;
    // From half a pixel on, its pixels are mixed with its own field, see compose.glsl.
    const float share = sum.scene.a > 0.0 ? smoothstep(0.5 * BESIDE, BESIDE, abs(to.own)) : 1.0;
    const float per_weight = sum.scene.a > 0.0 ? 1.0 / sum.scene.a : 0.0;
    sum.scene = mix(sum.scene * per_weight, vec4(own_color, 1.0), share);
    if (ON_SCENE)
        sum.on = mix(sum.on * per_weight, on_scene_mean(to.texel), share);
    return sum;
}

// The near field. `front`: what of it is before a texel that is in front of the focus itself. `circles`: the sums of
// the circles of confusion of both.
field_sum scene_before(gatherer to, inout vec2 circles, inout field_sum front)
{
    field_sum sum = gather_near(to, circles, front);
#ifndef NARROW
    for (int level = 1; level <= to.top; level++)
        sum = plus(sum, gather_near_blocks(to, uint(level), circles, front));
#endif
    return sum;
}

// Draws in place read near fields in tiles that have them, and between them and the rim of the tile beside it: or, if
// they know what is beside (CORNERS_ARE_READ), between them and its corner alone.
bool near_is_read(ivec2 texel)
{
    const ivec2 in_tile = texel & (VIRGA_LENS_TILE - 1);
    const bvec2 at_rim = bvec2(in_tile.x == 0 || in_tile.x == VIRGA_LENS_TILE - 1,
                               in_tile.y == 0 || in_tile.y == VIRGA_LENS_TILE - 1);
    return !IN_PLACE || NEAR || (CORNERS_ARE_READ ? all(at_rim) : any(at_rim));
}

void store(ivec2 texel, vec4 far, vec4 near, vec4 on)
{
    write_field(ivec3(texel, VIRGA_LENS_FAR), far);
    if (near_is_read(texel))
        write_field(ivec3(texel, VIRGA_LENS_NEAR), near);
    if (ON_SCENE)
        write_field(ivec3(texel, VIRGA_LENS_FIRST_LAYER + int(view.on_scene) - 1), on);
}

// The coarse and the finer field each have a part of what is near at a texel. How much of it is in this one, by the
// mean of its circles (texels). The coarse one does without: only the finer one knows what is behind that is not wide.
float part_of(float mean_circle)
{
    return FINER ? 1.0 - coarseness(mean_circle * float(STEP)) : COARSE ? 0.0 : 1.0;
}

// A near field that is all it can be, or a share of that. What is before the texel itself (`front`) hides as much of it
// as it covers, as if the texel were in focus.
void make_all(inout field_sum near, inout field_sum front, float part, float share)
{
    const float most = min(max(near.scene.a, part), 1.0);
    const float rest = near.scene.a - front.scene.a, open = most - front.scene.a;
    if (near.scene.a <= 0.0 || share <= 0.0)
        return;
    const bool hides = rest <= 1e-4 || open <= 0.0;
    const float scale = mix(1.0, hides ? most / near.scene.a : open / rest, share), of_front = hides ? scale : 1.0;
    near.scene = scale * (near.scene - front.scene) + of_front * front.scene;
    near.on = scale * (near.on - front.on) + of_front * front.on;
    front.scene *= of_front;
    front.on *= of_front;
}

// What is behind the near field. Where nothing was found that is its own color: it hides it, but draws read between
// texels.
//
// Of two near fields one is a part p of all that is near, N. One field alone is made n' = N + (1 - f) (1 - N), where f
// is how far what was found is behind, and f (1 - N) of the far field is seen. Of two, this one is made p n', the other
// one stays (1 - p) N, and (f + (1 - p) (1 - f)) (1 - N) is open. So f of that is the far field, and the rest has the
// color of what is near.
vec4 behind_near(vec4 far, vec4 near, vec3 own, float part, float found)
{
    const vec4 own_near = near.a > 0.0 ? near / near.a : vec4(own, 1.0);
    if (far.a <= 0.0)
        return own_near;
    return part < 1.0 && found < 1.0 ? mix(own_near, far / far.a, found / (found + (1.0 - part) * (1.0 - found))) : far;
}

// (half resolution) How much of a texel that is a little in front of the focus is in the far field, with what is behind
// it: its pixels are still shown in part as they are, and what is before them hides that part as well.
float share_in_far(gatherer to)
{
    return HALVED && !COARSE && to.behind ? 1.0 - smoothstep(POINT, 2.0 * POINT, -to.own) : 0.0;
}

#ifdef WIDE_PASS
// The coarse field knows nothing within 4 px to 8 px of the edge of a wide near disc, so that what it fills in there is
// not what is seen beside it. There it is filled in from the finer samples that are not wide, and farther away from the
// coarse ones. Beside a straight edge, d texels from it, nearness sums up to about 1.3 / d^5: so d is known. A texel of
// a wide disc behind the focus has the coarse field as well, since draws read between it and those in front of it.
//
// Coarse fields are being made by other workgroups now, so it is the draw that adds them: the fourth component says how
// much of them. What layers need of the near field, its circle of confusion, is in an image of its own (near_circles).
vec4 fill_of_both(gatherer to, vec3 behind, vec4 filled)
{
    const float wide = coarseness(radius_at(row_of(to.texel) + to.texel.x) * float(STEP));
    if (wide == 0.0)
        return vec4(behind, 0.0);
    const float apart = pow(1.3 / max(finer_nearness, 1e-6), 0.2);
    float fine = to.behind ? 1.0 - smoothstep(0.25, 0.75, apart / -to.own) : 0.0; // of how far it looks
    if (to.behind)
        fine *= finer_nearness / max(all_nearness, 1e-6); // where most of what is near is wide, the coarse field has it
    return vec4(mix(behind, fine * filled.rgb / max(filled.a, 1e-12), wide), wide * (1.0 - fine));
}
#endif

// Both fields of a texel, and the layer on the scene. `reach`: the largest radius that reaches its tile, in front of
// the focus and behind it. `levels`: that have such light. `known`: what gather_far finds, if is_known.
void gather_texel(ivec2 texel, vec2 reach, uint levels, vec4 known)
{
    vec4 own = sample_in(row_of(texel), texel);
    own.a = gathering_circle(own.a);
    if (max(reach.x, reach.y) <= POINT && !(FINER && own.a < -BESIDE)) {
        store(texel, vec4(own.rgb, 0.0), vec4(0.0), ON_SCENE ? on_scene_mean(texel) : vec4(0.0));
        return;
    }
    const gatherer to = gatherer(texel, own.a, reach, levels, top_level(levels | levels >> 4), barrel_at(texel),
                                 own.a < -BESIDE, HALVED && abs(own.a) <= BESIDE);
    vec2 circles = vec2(0.0);
    field_sum near = field_sum(vec4(0.0), vec4(0.0)), front = near;
    if (NEAR)
        near = scene_before(to, circles, front);
    const float moved = share_in_far(to), stays = near.scene.a - moved * (near.scene.a - front.scene.a);
    const float near_circle = stays > 0.0 ? (circles.x - moved * (circles.x - circles.y)) / stays : 0.0;
    field_sum fine = field_sum(known, vec4(0.0));
    float trusted = 0.0;
    if (!is_known(to))
        fine = gather_far(to, trusted);
    field_sum far = scene_behind(to, own.rgb, fine, trusted);
    // How far what was found is behind it. As the focus moves, what is there becomes so bit by bit.
    const float found = far.scene.a <= 0.0 ? 0.0 : NEAR && to.behind ? trusted / far.scene.a : 1.0;
    const vec4 filled = far.scene;
    // Where there is nothing behind, or more than one near sample a texel, the near field is all.
    const float part = part_of(near.scene.a > 0.0 ? circles.x / near.scene.a : 0.0);
    far.scene = behind_near(far.scene, near.scene, own.rgb, part, found);
    make_all(near, front, part, near.scene.a > 1.0 ? 1.0 : 1.0 - found);
    const float per_weight = 1.0 / far.scene.a;
    const vec4 on = near.on + (1.0 - near.scene.a) * far.on * per_weight;
    vec3 behind = far.scene.rgb * per_weight;
    if (moved > 0.0) {
        const vec4 with_far = moved * (near.scene - front.scene);
        const float open = 1.0 - near.scene.a + with_far.a;
        behind = open > 1e-4 ? (with_far.rgb + (1.0 - near.scene.a) * behind) / open : own.rgb;
        near.scene -= with_far;
    }
    vec4 stored = vec4(behind, near_circle);
#ifdef WIDE_PASS
    if (FINER)
        stored = fill_of_both(to, behind, filled);
    finer_circle = near_circle;
#endif
    store(texel, stored, near.scene, on);
#ifdef WIDE_PASS
    finer_circle = 0.0;
#endif
}
