// pieces.glsl - where the water of an impact lands.
//
// A distant impact stands for many drops. Its water is scattered in up to 32 pieces over the ground within two metres,
// not poured on one cell; otherwise a distant pavement would look spotted.
#include "standing.glsl"
#include "shelter.glsl"

layout(scalar, set = 0, binding = 2) readonly buffer Impacts
{
    virga_impacts_gpu head;
    virga_impact_gpu impacts[];
};

#define SAME_SURFACE_M 0.5 // an impact this far above or below a cell's floor hit something else

struct Piece {
    uint cell_index; // NO_CELL: not on ground
    vec2 at;         // in cells, from the window's low corner
    ivec2 cell;
    vec2 in_cell; // [0; 1)
    uint water_nl;
};

// Height above the ground's base of a height above the impacts' origin. Both are large numbers far from the world's
// origin.
float above_base(float height_m)
{
    precise float above = (head.origin[1] - tick.base_m) + height_m;
    return above;
}

// Clamped to the buffer's size, because a host's buffer is not trusted.
uint head_count() { return min(head.count, head.is_return != 0u ? tick.max_returned_droplets : tick.max_impacts); }

// Whether an impact belongs to this tick. Returns (water that splashes give back) belong to the tick in which they
// come, but for those that have hit a pane.
bool is_of_tick(uint index)
{
    if (index >= head_count())
        return false;
    return head.is_return != 0u ? VIRGA_IMPACT_PANE(impacts[index].material) == 0u : impacts[index].tick == tick.tick;
}

// The index of an impact's landing: returns follow behind drops.
uint landing_index(uint index) { return index + head.is_return * tick.max_impacts; }

uint piece_count(virga_impact_gpu impact)
{
    if (head.is_return != 0u)
        return 1u;
    return uint(clamp(ceil(impact.weight - 1e-3), 1.0, float(VIRGA_GROUND_MAX_PIECES)));
}

#define FIRST_HASH 128u // first hash number for what a piece starts: its splash, its ring
#define MAX_SCATTERED (VIRGA_GROUND_SCATTER_M / VIRGA_GROUND_DROP_M * VIRGA_GROUND_SCATTER_M / VIRGA_GROUND_DROP_M)

uint piece_hash(virga_impact_gpu impact, uint i)
{
    // Droplets of one drop may land in the same tick: their water distinguishes them.
    const uint own = head.is_return != 0u ? impact.id ^ impact.water_nl * 0x9e3779b1u : impact.id;
    return virga_hash4(tick.seed, own, impact.tick, FIRST_HASH + i);
}

// The drops that an impact stands for do not fall at one instant: ticks from the impact to the splash and ring of piece
// i, one of them in each span of VIRGA_GROUND_PIECE_S.
float delay_ticks(virga_impact_gpu impact, uint i, uint hash)
{
    const float spans = float(i) + virga_unit(virga_hash2(hash, 3u));
    return impact.weight > 1.0 ? VIRGA_GROUND_PIECE_S * spans / tick.tick_s : 0.0;
}

// In cells from the window's low corner. That corner is far from the origin, so it is given as two floats.
vec2 cells_in_window_of(virga_impact_gpu impact)
{
    const vec2 position = vec2(impact.position[0], impact.position[2]);
    const vec2 origin = vec2(head.origin[0], head.origin[2]);
    const vec2 high = vec2(tick.window_high[0], tick.window_high[2]),
               low = vec2(tick.window_low[0], tick.window_low[2]);
    // `precise`: the same in every pass, or a pass that finds another cell would leave water behind.
    precise vec2 at = (position + ((origin - high) - low)) * tick.inv_cell_m;
    return at;
}

Piece piece_at(vec2 cells_in_window, float height_m) // above the base
{
    Piece piece;
    piece.at = cells_in_window;
    const vec2 whole = floor(cells_in_window);
    piece.cell = ivec2(whole) + ivec2(tick.low_tile[0], tick.low_tile[1]) * VIRGA_GROUND_TILE;
    piece.in_cell = cells_in_window - whole;
    piece.cell_index = index_of_cell(piece.cell);
    if (piece.cell_index != NO_CELL) {
        const virga_floor_gpu found = floor_of(piece.cell_index);
        precise float above = height_m - float(found.height_um) * 1e-6;
        if (found.material == NO_GROUND || abs(above) > SAME_SURFACE_M)
            piece.cell_index = NO_CELL;
    }
    piece.water_nl = 0u;
    return piece;
}

Piece first_piece(virga_impact_gpu impact)
{
    return piece_at(cells_in_window_of(impact), above_base(impact.position[1]));
}

// Piece i of n. The first is at the impact's position and has the remainder of the division.
Piece get_piece(virga_impact_gpu impact, Piece first, uint i, uint n)
{
    const float height_m = above_base(impact.position[1]);
    Piece piece = first;
    if (i > 0u) {
        const uint h = virga_hash4(tick.seed, impact.id, impact.tick, i);
        const float drops = clamp(impact.weight, float(n), float(MAX_SCATTERED));
        precise float radius = sqrt(virga_unit(h) * drops) * VIRGA_GROUND_DROP_M * tick.inv_cell_m;
        precise float angle = 6.2831853 * virga_unit(virga_hash1(h));
        precise vec2 beside = first.at + radius * vec2(cos(angle), sin(angle));
        const Piece scattered = piece_at(beside, height_m);
        // Not from the open to under a roof.
        const bool stays_open = !is_sheltered(scattered.cell) || is_sheltered(first.cell);
        if (scattered.cell_index != NO_CELL && first.cell_index != NO_CELL && stays_open)
            piece = scattered;
    }
    piece.water_nl = impact.water_nl / n + (i == 0u ? impact.water_nl % n : 0u);
    return piece;
}

// A piece that stands for several drops spreads over the cells around it, up to this many to each side: one with the
// water of fifty drops would later be a bright spot on a wet road, or a dark one on a dry road.
int spread_of(float drops) { return drops >= 40.0 ? 3 : drops >= 16.0 ? 2 : drops >= 3.0 ? 1 : 0; }

// The index of a cell beside a piece's own, if it is ground of about the same height.
uint index_beside(Piece piece, ivec2 beside, int floor_um)
{
    const uint cell_index = index_of_cell(piece.cell + beside);
    if (cell_index == NO_CELL)
        return NO_CELL;
    const virga_floor_gpu found = floor_of(cell_index);
    const int max_um = int(SAME_SURFACE_M * 1e6);
    return found.material != NO_GROUND && abs(found.height_um - floor_um) <= max_um ? cell_index : NO_CELL;
}
