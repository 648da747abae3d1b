// choose_cell.glsl - round of movement, first half, for one drop: records its move of the round before, and chooses its
// next cell. That is the cell ahead or one of the two beside it, at random with the affinities as weights.
// Paper: Goto et al. 2009, section 4.1 and figure 1, after Kaneda et al. 1993.

// Thickness of the film behind a drop, by its speed. As behind a plate that is drawn out of water, it grows with the
// capillary number to the power of 2/3 (Landau and Levich 1942; Derjaguin 1943); and where the contact line keeps up
// with the drop there is none (de Gennes 1986). So fast drops leave wet paths and soon use themselves up, and slow ones
// leave dry glass: on a wet path a drop takes up what faster ones left, and runs faster itself.
float film_behind(float speed)
{
    return speed < tick.left_from_m_s ? 0.0 : tick.trail_m * pow(speed, 2.0 / 3.0);
}

// What a drop leaves on the cell that it leaves: film, and now and then a tail. The tail is a seed; it becomes a drop
// at the end of the tick.
void leave_trail(uint slot, uint entry, uint cell, inout virga_glass_drop_gpu drop)
{
    const float square_m2 = tick.pane.cell_m * tick.pane.cell_m, a = base_radius(drop.water_nl);
    const float width = min(2.0 * a / tick.pane.cell_m, 1.0), thick = film_behind(length(to_vec2(drop.velocity)));
    const uint left = min(round_randomly(thick * square_m2 * width * 1e12, virga_hash3(drop.random, tick.tick, cell)),
                          drop.water_nl / 8u);
    if (left != 0u) {
        const ivec2 step_there = cell_coordinates(drop.cell) - cell_coordinates(cell);
        film[cell] += left;
        mark_film(cell);
        passed[cell] = wetted_now() | uint(5 + step_there.x + 3 * step_there.y) << VIRGA_GLASS_LINK_BIT;
    }
    drop.water_nl -= left;
    drop.tail_spacing_m += tick.pane.cell_m;
    const uint seed = landing_count() + entry;
    const uint hash = virga_hash3(drop.random, tick.tick, 2u);
    if (tick.tail_max_radius_m <= 0.0 || drop.tail_spacing_m < tick.tail_spacing_m * (0.4 + 1.2 * virga_unit(hash)) ||
        seeds[seed].water_nl != 0u)
        return;
    const float radius = tick.tail_max_radius_m * (0.35 + 0.65 * virga_unit(virga_hash1(hash)));
    const uint water =
        min(uint(tick.drop_nl_of_m3 * radius * radius * radius), uint(tick.tail_share * float(drop.water_nl)));
    if (water == 0u)
        return;
    drop.tail_spacing_m = 0.0;
    drop.water_nl -= water;
    const vec2 shift = vec2(virga_unit(virga_hash2(hash, 1u)), virga_unit(virga_hash2(hash, 2u))) - 0.5;
    seeds[seed] =
        virga_glass_seed_gpu(to_array(to_pane(cell_middle(cell) + 0.6 * shift * tick.pane.cell_m)), float[2](0.0, 0.0),
                             water, 0u, 0u, cell, virga_hash2(drop.id, tick.tick), VIRGA_GLASS_DROP | VIRGA_GLASS_TAIL);
}

// Records the move of the round before. Each cell has one writer: the drop that entered it, else the one that left it.
void record_move(uint slot, uint entry, inout virga_glass_drop_gpu drop)
{
    if (drop.target == NONE)
        return;
    const bool entered = kind_of(drop) == VIRGA_GLASS_DROP;
    const uint left = entered ? drop.from_cell : drop.cell;
    const bool reclaimed = claims[claim_of(left, round_index - 1u)] != NONE;
    if (!reclaimed) {
        occupants[left] = 0u;
        if (entered)
            leave_trail(slot, entry, left, drop);
    }
    if (entered) {
        occupants[drop.cell] = slot + 1u;
        drop.water_nl += film[drop.cell]; // the drop takes up the film
        film[drop.cell] = 0u;
    }
}

const ivec2 directions[8] = ivec2[8](ivec2(1, 0), ivec2(1, 1), ivec2(0, 1), ivec2(-1, 1), ivec2(-1, 0), ivec2(-1, -1),
                                     ivec2(0, -1), ivec2(1, -1));

// Weights of the cell ahead and those to its right and left, without affinity. Their mean step lies in the direction of
// motion, whose tangent to the left of the middle direction is `tangent`. With weights s + t to the left and s - t to
// the right, the mean of three steps on a square grid deviates by 2 t where the middle direction is along an axis, and
// by t / (1 - s) where it is diagonal. No weight is negative if s >= |t|. A larger s makes the drop meander.
vec3 direction_weights(float tangent, bool diagonal)
{
    const float min_s = diagonal ? abs(tangent) / (1.0 + abs(tangent)) : 0.5 * abs(tangent);
    const float s = mix(min_s, max(min_s, 0.35), tick.meander);
    const float t = diagonal ? (1.0 - s) * tangent : 0.5 * tangent;
    return vec3(1.0 - 2.0 * s, s - t, s + t);
}

// Factor of a weight. Drops prefer cells of high affinity, low cells of a bump map (both packed in the cell), and wet
// paths.
float cell_attraction(ivec2 cell)
{
    if (!on_pane(cell))
        return 1.0;
    const uint number = cell_number(cell);
    return exp(tick.affinity_sigma * cell_affinity(surface[number])) * (1.0 + 4.0 * tick.path_ease * cell_wet(number));
}

ivec2 choose_direction(virga_glass_drop_gpu drop, ivec2 cell)
{
    const vec2 v = to_vec2(drop.velocity);
    const float octant = atan(v.y, v.x) * (4.0 / 3.14159265);
    const float nearest = floor(octant + 0.5);
    const uint ahead = uint(int(nearest) + 8) & 7u, right = (ahead + 7u) & 7u, left = (ahead + 1u) & 7u;
    const vec3 weights = direction_weights(tan((octant - nearest) * (3.14159265 / 4.0)), (ahead & 1u) != 0u) *
                         vec3(cell_attraction(cell + directions[ahead]), cell_attraction(cell + directions[right]),
                              cell_attraction(cell + directions[left]));
    const float random =
        virga_unit(virga_hash3(drop.random, tick.tick, 16u + round_index)) * (weights.x + weights.y + weights.z);
    return directions[random < weights.x ? ahead : random < weights.x + weights.y ? right : left];
}

// The drop runs over the edge, with its water.
void run_off(inout virga_glass_drop_gpu drop)
{
    count(VIRGA_GLASS_RUN_OFF, drop.water_nl + drop.merged_nl);
    drop.kind = VIRGA_GLASS_FREE;
    drop.water_nl = drop.merged_nl = 0u;
    drop.merged_momentum = drop.merged_nl_10um = int[2](0, 0);
    drop.target = OUTSIDE;
}

// Claims the next cell, or leaves the pane.
void claim_next_cell(uint slot, inout virga_glass_drop_gpu drop)
{
    const ivec2 cell = cell_coordinates(drop.cell), direction = choose_direction(drop, cell);
    drop.progress_m -= tick.pane.cell_m * length(vec2(direction));
    drop.kind |= VIRGA_GLASS_RUNNING;
    if (on_pane(cell + direction)) {
        drop.target = cell_number(cell + direction);
        atomicMin(claims[claim_of(drop.target, round_index)], slot);
    } else
        run_off(drop);
}

// Writes what a choice changes. The whole slot would take a register for each of its words.
void store_choice(uint slot, virga_glass_drop_gpu drop)
{
    drops[slot].water_nl = drop.water_nl;
    drops[slot].kind = drop.kind;
    drops[slot].progress_m = drop.progress_m;
    drops[slot].tail_spacing_m = drop.tail_spacing_m;
    drops[slot].merged_nl = drop.merged_nl;
    drops[slot].merged_momentum = drop.merged_momentum;
    drops[slot].merged_nl_10um = drop.merged_nl_10um;
    drops[slot].target = drop.target;
    drops[slot].absorbed_by = drop.absorbed_by;
}

// For an entry of the active list.
void choose_cell(uint entry)
{
    const uint slot = slot_of_active(entry);
    if (round_index == 0u)
        seeds[landing_count() + entry].water_nl = 0u;
    const uint kind = drops[slot].kind & VIRGA_GLASS_KIND;
    const bool moves = round_index < rounds && kind == VIRGA_GLASS_DROP && drops[slot].progress_m >= tick.pane.cell_m;
    if (kind == VIRGA_GLASS_PARTICLE)
        return;
    if (!moves && drops[slot].target == NONE) {
        if (drops[slot].absorbed_by != NONE)
            drops[slot].absorbed_by = NONE;
        return;
    }
    virga_glass_drop_gpu drop = drops[slot];
    record_move(slot, entry, drop);
    if (round_index < rounds) {
        drop.absorbed_by = drop.target; // its claim is cleared by the next pass
        drop.target = NONE;
    } else
        drop.absorbed_by = NONE; // the last claims are cleared in split_drops.comp
    if (moves && to_vec2(drop.velocity) == vec2(0.0))
        drop.progress_m = 0.0; // a drop at rest has no direction
    else if (moves)
        claim_next_cell(slot, drop);
    store_choice(slot, drop);
}
