// pieces.glsl - where the water of an impact comes to lie.
//
// An impact far from the camera stands for many drops. Its water is not poured on one cell but scattered in up to 32
// pieces over the ground within two metres of it, or a distant pavement would be spotted like a leopard.
#include "standing.glsl"
#include "shelter.glsl"

layout(scalar, set = 0, binding = 2) readonly buffer Impacts
{
    virga_impacts_gpu head;
    virga_impact_gpu impacts[];
};

#define SAME_SURFACE_M 0.5 // an impact this far above or below a cell's floor fell on something else

struct Piece {
    uint place;      // NO_CELL: not on the ground
    vec2 at;         // cells from the window's low corner
    ivec2 cell;
    vec2 in_cell;    // [0; 1)
    uint water_nl;
};

// Height above the ground's base of what lies that far above the impacts' origin; both are large far from the world's.
float above_base(float height_m)
{
    precise float above = (head.origin[1] - tick.base_m) + height_m;
    return above;
}

// As many as there can be, whatever a host's buffer says.
uint head_count() { return min(head.count, head.is_return != 0u ? tick.max_returns : tick.max_impacts); }

// Whether an impact belongs to this tick; water that splashes give back lands whenever it comes.
bool is_of_tick(uint index)
{
    return index < head_count() && (head.is_return != 0u || impacts[index].tick == tick.tick);
}

// Where an impact's landing is: those of returns lie behind those of drops.
uint landing_index(uint index) { return index + head.is_return * tick.max_impacts; }

uint piece_count(virga_impact_gpu impact)
{
    if (head.is_return != 0u)
        return 1u;
    return uint(clamp(ceil(impact.weight - 1e-3), 1.0, float(VIRGA_GROUND_SCATTER)));
}

#define FIRST_HASH 128u // of the numbers of hashes for what a piece starts: its splash, its ring
#define MOST_SCATTERED (VIRGA_GROUND_SCATTER_M / VIRGA_GROUND_DROP_M * VIRGA_GROUND_SCATTER_M / VIRGA_GROUND_DROP_M)
#define PIECES_LATER_S 0.1 // within which the pieces fall of an impact that stands for several drops

uint piece_hash(virga_impact_gpu impact, uint i)
{
    // Droplets of one drop may fall in one tick: their water tells them apart.
    const uint own = head.is_return != 0u ? impact.id ^ impact.water_nl * 0x9e3779b1u : impact.id;
    return virga_hash4(tick.seed, own, impact.tick, FIRST_HASH + i);
}

// What one impact stands for does not fall at one instant: ticks from the impact to the splash and ring of a piece.
float later_ticks(virga_impact_gpu impact, uint hash)
{
    return impact.weight > 1.0 ? PIECES_LATER_S * virga_unit(virga_hash2(hash, 3u)) / tick.tick_s : 0.0;
}

// In units of cells from the window's low corner. The corner is far from the origin, so it comes as two floats.
vec2 in_window(virga_impact_gpu impact)
{
    const vec2 position = vec2(impact.position[0], impact.position[2]);
    const vec2 origin = vec2(head.origin[0], head.origin[2]);
    const vec2 high = vec2(tick.window_high[0], tick.window_high[2]),
               low = vec2(tick.window_low[0], tick.window_low[2]);
    // The same in every pass that asks: one that found another cell would leave water on its way.
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
    piece.place = cell_place(piece.cell);
    if (piece.place != NO_CELL) {
        const virga_floor_gpu found = floor_of(piece.place);
        precise float above = height_m - float(found.height_um) * 1e-6;
        if (found.material == NO_GROUND || abs(above) > SAME_SURFACE_M)
            piece.place = NO_CELL;
    }
    piece.water_nl = 0u;
    return piece;
}

Piece first_piece(virga_impact_gpu impact) { return piece_at(in_window(impact), above_base(impact.position[1])); }

// Piece i of n; the first lies where the impact is, and takes what does not divide.
Piece get_piece(virga_impact_gpu impact, Piece first, uint i, uint n)
{
    const float height_m = above_base(impact.position[1]);
    Piece piece = first;
    if (i > 0u) {
        const uint h = virga_hash4(tick.seed, impact.id, impact.tick, i);
        const float drops = clamp(impact.weight, float(n), float(MOST_SCATTERED));
        precise float radius = sqrt(virga_unit(h) * drops) * VIRGA_GROUND_DROP_M * tick.inv_cell_m;
        precise float angle = 6.2831853 * virga_unit(virga_hash1(h));
        precise vec2 beside = first.at + radius * vec2(cos(angle), sin(angle));
        const Piece scattered = piece_at(beside, height_m);
        // Not from the open to under a roof.
        const bool stays_open = !is_sheltered(scattered.cell) || is_sheltered(first.cell);
        if (scattered.place != NO_CELL && first.place != NO_CELL && stays_open)
            piece = scattered;
    }
    piece.water_nl = impact.water_nl / n + (i == 0u ? impact.water_nl % n : 0u);
    return piece;
}

// A piece that stands for several drops lies on the cells around it as well, up to so many to each side: one that takes
// the water of fifty is a pale blot on a wet road, and a dark one on a dry road, for whoever comes by later.
int spread_of(float drops) { return drops >= 40.0 ? 3 : drops >= 16.0 ? 2 : drops >= 3.0 ? 1 : 0; }

// The cell beside a piece's own where it is ground of about the same height.
uint place_beside(Piece piece, ivec2 beside, int floor_um)
{
    const uint place = cell_place(piece.cell + beside);
    if (place == NO_CELL)
        return NO_CELL;
    const virga_floor_gpu found = floor_of(place);
    const int most_um = int(SAME_SURFACE_M * 1e6);
    return found.material != NO_GROUND && abs(found.height_um - floor_um) <= most_um ? place : NO_CELL;
}
