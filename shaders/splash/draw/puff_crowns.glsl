// puff_crowns.glsl - where the crowns of a puff are: a splash that stands for several is drawn as several crowns on an
// ellipse, each at its own position in a cell of a grid. Include shared/random.h and
// puff_ring.glsl before.
//
// `shape` and `axis_chance` are those of sprite_corner.glsl. Positions are in pixels: x from the sprite's middle line,
// y from its tail. A pixel belongs to one cell, and only that cell's crown covers it.

// A column of cells. Each has its own offset, or they would form rows.
struct PuffColumn {
    float number, aside; // squared distance from the middle, of the half width
    float lowest, row_px; // (px) where its first cell begins; height of a cell
};

float puff_columns(vec4 axis_chance) { return floor(axis_chance.w); }
float puff_rows(vec4 axis_chance) { return floor(axis_chance.x); }
float puff_column_px(vec4 shape, vec4 axis_chance) { return 2.0 * shape.x / puff_columns(axis_chance); }

PuffColumn puff_column(vec4 shape, vec4 axis_chance, float column)
{
    const float from_middle = (column + 0.5) * 2.0 / puff_columns(axis_chance) - 1.0, aside = from_middle * from_middle;
    const float room = puff_rows(axis_chance) > 1.5 ? 0.85 - 0.3 * aside : 1.0;
    const float lowest = shape.z * (1.0 - room) * fract(0.618 * column + axis_chance.w);
    return PuffColumn(column, aside, lowest, shape.z * room / puff_rows(axis_chance));
}

struct PuffCrown {
    vec2 middle; // of its foot
    float half_wide, high;
    float covers; // how much it covers, of the mean
    float veil;   // part of its coverage that is spread over the whole puff
    vec4 chance;
};

float puff_one_px(vec4 shape) { return 0.5 * min(shape.w, 2.0 * shape.x) + 0.25; }

// They differ in size and age; the one at the opposite position covers less by what one covers more than the mean.
// Together they cover half of their rectangle. Small ones close together are not told apart by the eye: half of their
// coverage is drawn as a uniform veil.
PuffCrown puff_crown(vec4 shape, vec4 axis_chance, PuffColumn column, float row)
{
    const float columns = puff_columns(axis_chance), rows = puff_rows(axis_chance);
    const float column_px = puff_column_px(shape, axis_chance), row_px = column.row_px;
    const float number = row * columns + column.number, opposite = columns * rows - 1.0 - number;
    // From integers, so that all variants of the shader get the same: the sine of a large angle depends on how
    // operations are fused.
    const uint pair = virga_hash1(uint(1024.0 * fract(axis_chance.w)) << 6 | uint(min(number, opposite)));
    const float more = sign(opposite - number), several = columns > 1.5 ? 1.0 : 0.0;
    PuffCrown crown;
    crown.covers = 1.0 + 0.9 * more * unpackUnorm4x8(pair).x;
    const float size = 0.35 + 0.65 * crown.covers;
    const float close = clamp(1.6 - 0.1 * column_px * row_px, 0.0, 1.0) * several;
    crown.veil = close * clamp(1.25 - 0.5 * shape.w, 0.0, 0.5);
    crown.chance = unpackUnorm4x8(more < 0.0 ? pair * 0x9e3779b1u : pair);
    const vec4 chance = crown.chance;
    const float ahead = several * (2.0 * chance.y - 1.0), late = 2.0 * fract(axis_chance.x) - 1.0;
    const float one_high = axis_chance.z * shape.z;
    crown.half_wide = min(puff_one_px(shape) * (1.0 + crown.veil) * size * (1.0 - 0.25 * ahead),
                          0.5 * column_px + 0.25);
    const float depth = axis_chance.y * crown.half_wide;
    const float tall = min(size * (1.0 + 0.55 * ahead * late), 2.0) * one_high;
    crown.high = columns > 1.5 ? min(tall, max(row_px - 2.0 * depth - 1.5, 0.3 * row_px)) : one_high;
    const float up = max(row_px - crown.high - 2.0 * depth, 0.0);
    const float foot = up * (0.5 + (chance.z - 0.5) * (rows > 1.5 ? 1.0 : 1.0 - column.aside)) + depth;
    const float beside = several * max(0.5 * column_px - crown.half_wide, 0.0) * (2.0 * chance.w - 1.0);
    crown.middle = vec2((column.number + 0.5) * column_px + beside - shape.x, column.lowest + row * row_px + foot);
    return crown;
}

// The crown in whose cell a pixel is.
PuffCrown crown_of_pixel(vec4 shape, vec4 axis_chance, vec2 at)
{
    const float columns = puff_columns(axis_chance), rows = puff_rows(axis_chance);
    const float at_column = floor((at.x + shape.x) / puff_column_px(shape, axis_chance));
    const PuffColumn column = puff_column(shape, axis_chance, clamp(at_column, 0.0, columns - 1.0));
    const float row = clamp(floor((at.y - column.lowest) / column.row_px), 0.0, rows - 1.0);
    return puff_crown(shape, axis_chance, column, row);
}

// Where crowns of a puff are drawn one by one: the part of a crown's cell that it may cover, as two opposite corners.
// The cells at the borders go on to the corners of all, `low` and `high`. Empty for numbers past the puff's crowns.
// With a veil it is the whole cell.
vec4 crown_rect(vec4 shape, vec4 axis_chance, uint number, vec2 low, vec2 high)
{
    const uint columns = uint(puff_columns(axis_chance)), rows = uint(puff_rows(axis_chance));
    if (number >= columns * rows)
        return vec4(0.0);
    const uvec2 cell = uvec2(number % columns, number / columns);
    const PuffColumn column = puff_column(shape, axis_chance, float(cell.x));
    const PuffCrown crown = puff_crown(shape, axis_chance, column, float(cell.y));
    const vec2 size = vec2(puff_column_px(shape, axis_chance), column.row_px);
    const vec2 corner = vec2(-shape.x, column.lowest) + vec2(cell) * size, end = corner + size;
    const vec3 box = crown.veil > 0.0 ? vec3(1e6) : crown_box(crown.half_wide, crown.high, axis_chance.y, shape.y);
    const vec2 cell_low = vec2(cell.x == 0u ? low.x : corner.x, cell.y == 0u ? low.y : corner.y);
    const vec2 cell_high = vec2(cell.x + 1u == columns ? high.x : end.x, cell.y + 1u == rows ? high.y : end.y);
    const vec2 from = clamp(crown.middle - box.xy, cell_low, cell_high),
               to = clamp(crown.middle + box.xz, cell_low, cell_high);
    return vec4(clamp(from, low, high), clamp(to, low, high));
}
