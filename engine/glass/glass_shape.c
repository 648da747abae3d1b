/* glass/glass_shape.c - the shape of a pane (flat or bent), its mask and its bump map. Fills the nodes and cells. */
#include "glass/glass_internal.h"

#include "core/settings.h"
#include "gpu/errors.h"

#include <virga/shared/random.h>

#include <math.h>
#include <string.h>

#define NODES          VIRGA_GLASS_NODES
#define MAX_GRID       1025    /* columns and rows of positions */
#define MAX_POSITION_M 1000.0f /* from the origin of a pane's own frame */

virga_glass_shape virga_default_glass_shape(void)
{
    return (virga_glass_shape){.size = sizeof(virga_glass_shape),
                               .cookie = virga_settings_cookie("glass_shape"),
                               .columns = 2,
                               .rows = 2,
                               .mask_columns = 1,
                               .mask_rows = 1,
                               .bump_columns = 2,
                               .bump_rows = 2,
                               .bump_width_m = 0.1f,
                               .bump_height_m = 0.1f,
                               .bump_affinity = 1};
}

/* ---- shapes for hosts */

void virga_glass_fill_windshield(float width_m, float height_m, float rake_deg, float bend_m, uint32_t columns,
                                 uint32_t rows, float *positions)
{
    const float numbers[4] = {width_m, height_m, rake_deg, bend_m};
    if (!positions || columns < 2 || rows < 2 || columns > MAX_GRID || rows > MAX_GRID ||
        virga_settings_check_finite(NULL, "windshield", numbers, 4))
        return;
    const double rake = (double)rake_deg * 3.14159265358979323846 / 180;
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++) {
            const double u = (double)width_m * (column / (columns - 1.0) - 0.5),
                         v = (double)height_m * row / (rows - 1.0);
            const double r = (double)bend_m, x = r > 0 ? r * sin(u / r) : u, back = r > 0 ? r * (1 - cos(u / r)) : 0;
            float *out = positions + 3 * (row * columns + column);
            out[0] = (float)x;
            out[1] = (float)(v * cos(rake) - back * sin(rake));
            out[2] = (float)(-v * sin(rake) - back * cos(rake));
        }
}

/* Barycentric coordinates of p in a triangle. False if the triangle has no area. */
static bool barycentric(const float *a, const float *b, const float *c, const double p[2], double out[3])
{
    const double ab[2] = {(double)b[0] - (double)a[0], (double)b[1] - (double)a[1]};
    const double ac[2] = {(double)c[0] - (double)a[0], (double)c[1] - (double)a[1]};
    const double ap[2] = {p[0] - (double)a[0], p[1] - (double)a[1]}, area = ab[0] * ac[1] - ab[1] * ac[0];
    if (!(fabs(area) >= 1e-14))
        return false;
    out[1] = (ap[0] * ac[1] - ap[1] * ac[0]) / area;
    out[2] = (ab[0] * ap[1] - ab[1] * ap[0]) / area;
    out[0] = 1 - out[1] - out[2];
    return true;
}

/* Sets the position of each grid point that the triangle covers. Returns whether it covers any. */
static bool cover(const float *positions, const float *uvs, const uint32_t corners[3], float width_m, float height_m,
                  uint32_t columns, uint32_t rows, float *grid, uint8_t *mask)
{
    const float *a = uvs + 2 * corners[0], *b = uvs + 2 * corners[1], *c = uvs + 2 * corners[2];
    bool any = false;
    for (uint32_t row = 0; row < rows; row++)
        for (uint32_t column = 0; column < columns; column++) {
            const double p[2] = {(double)width_m * column / (columns - 1.0), (double)height_m * row / (rows - 1.0)};
            double share[3];
            if (!barycentric(a, b, c, p, share) || !(share[0] >= -1e-6 && share[1] >= -1e-6 && share[2] >= -1e-6))
                continue;
            float *out = grid + 3 * (row * columns + column);
            for (int axis = 0; axis < 3; axis++)
                out[axis] = (float)(share[0] * (double)positions[3 * corners[0] + axis] +
                                    share[1] * (double)positions[3 * corners[1] + axis] +
                                    share[2] * (double)positions[3 * corners[2] + axis]);
            mask[row * columns + column] = 255;
            any = true;
        }
    return any;
}

/* The covered column nearest to `column` in a row. Of two at the same distance, the left one. -1 if there is none. */
static float nearest_in_row(const uint8_t *row, uint32_t columns, uint32_t column)
{
    for (uint32_t away = 0; away < columns; away++) {
        if (column >= away && row[column - away])
            return (float)(column - away);
        if (column + away < columns && row[column + away])
            return (float)(column + away);
    }
    return -1;
}

/* The covered grid point nearest to the uncovered point i. Of several at the same distance, the one in the first row.
 * The x of an uncovered point holds the nearest covered column of its row, see nearest_in_row. */
static uint32_t nearest_covered(uint32_t columns, uint32_t rows, const float *grid, const uint8_t *mask, uint32_t i)
{
    const double column = i % columns, row = i / columns;
    double squared_min = INFINITY;
    uint32_t nearest = 0;
    for (uint32_t k = 0; k < rows; k++) {
        const uint32_t above = k * columns + i % columns;
        const double found = mask[above] ? column : (double)grid[3 * above], x = found - column, y = k - row;
        if (found >= 0 && x * x + y * y < squared_min) {
            squared_min = x * x + y * y;
            nearest = k * columns + (uint32_t)found;
        }
    }
    return nearest;
}

/* Gives each uncovered grid point the position of the nearest covered one, because drops at the edge need valid frames.
 * Intermediate results are stored in the grid itself. With them the largest grid needs seconds instead of hours. */
static void fill_uncovered(uint32_t columns, uint32_t rows, float *grid, const uint8_t *mask)
{
    for (uint32_t i = 0; i < columns * rows; i++)
        if (!mask[i])
            grid[3 * i] = nearest_in_row(mask + i / columns * columns, columns, i % columns);
    for (uint32_t i = 0; i < columns * rows; i++)
        if (!mask[i])
            grid[3 * i + 1] = (float)nearest_covered(columns, rows, grid, mask, i);
    for (uint32_t i = 0; i < columns * rows; i++)
        if (!mask[i])
            memcpy(grid + 3 * i, grid + 3 * (uint32_t)grid[3 * i + 1], 3 * sizeof *grid);
}

virga_result virga_glass_fill_from_mesh(const float *positions, const float *uvs_m, uint32_t vertex_count,
                                        const uint32_t *indices, uint32_t index_count, float width_m, float height_m,
                                        uint32_t columns, uint32_t rows, float *grid, uint8_t *mask)
{
    if (!positions || !uvs_m || !indices || !grid || !mask || columns < 2 || rows < 2 || columns > MAX_GRID ||
        rows > MAX_GRID || !(width_m > 0 && width_m <= 10) || !(height_m > 0 && height_m <= 10))
        return VIRGA_ERROR_INVALID;
    memset(mask, 0, (size_t)columns * rows);
    bool any = false;
    for (uint32_t i = 0; i + 2 < index_count; i += 3) {
        for (uint32_t k = 0; k < 3; k++)
            if (indices[i + k] >= vertex_count)
                return VIRGA_ERROR_INVALID;
        any = cover(positions, uvs_m, indices + i, width_m, height_m, columns, rows, grid, mask) || any;
    }
    if (!any)
        return VIRGA_ERROR_INVALID;
    fill_uncovered(columns, rows, grid, mask);
    return VIRGA_OK;
}

/* ---- nodes */

static void subtract(const float *a, const float *b, double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = (double)a[i] - (double)b[i];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* False if the vector has no direction. */
static bool normalise(double v[3])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++)
        v[i] /= length > 0 ? length : 1;
    return length > 1e-9;
}

/* The point of the shape at (s, t), each in [0; 1], interpolated between four grid points. */
static void point_of(const virga_glass_shape *shape, double s, double t, float out[3])
{
    const double x = s * (shape->columns - 1), y = t * (shape->rows - 1);
    const uint32_t column = (uint32_t)fmin(x, shape->columns - 2), row = (uint32_t)fmin(y, shape->rows - 2);
    const double fx = x - column, fy = y - row;
    const float *low = shape->positions + 3 * (row * shape->columns + column), *high = low + 3 * shape->columns;
    for (int i = 0; i < 3; i++)
        out[i] = (float)((1 - fy) * ((1 - fx) * (double)low[i] + fx * (double)low[3 + i]) +
                         fy * ((1 - fx) * (double)high[i] + fx * (double)high[3 + i]));
}

static bool fill_frame(virga_glass_node_gpu *nodes, uint32_t column, uint32_t row)
{
    const uint32_t left = column ? column - 1 : 0, right = column + 1 < NODES ? column + 1 : column;
    const uint32_t below = row ? row - 1 : 0, above = row + 1 < NODES ? row + 1 : row;
    double u[3], v[3], n[3];
    subtract(nodes[right + row * NODES].position, nodes[left + row * NODES].position, u);
    subtract(nodes[column + above * NODES].position, nodes[column + below * NODES].position, v);
    cross(u, v, n);
    if (!normalise(u) || !normalise(n))
        return false;
    cross(n, u, v);
    virga_glass_node_gpu *node = &nodes[column + row * NODES];
    for (int i = 0; i < 3; i++) {
        node->along_u[i] = (float)u[i];
        node->along_v[i] = (float)v[i];
        node->normal[i] = (float)n[i];
    }
    return true;
}

static bool fill_nodes(const virga_glass *glass, const virga_glass_shape *shape, virga_glass_node_gpu *nodes)
{
    for (uint32_t row = 0; row < NODES; row++)
        for (uint32_t column = 0; column < NODES; column++) {
            const double s = column / (NODES - 1.0), t = row / (NODES - 1.0);
            float *position = nodes[column + row * NODES].position;
            if (shape->positions)
                point_of(shape, s, t, position);
            else {
                position[0] = (float)(s * (double)glass->def.width_m);
                position[1] = (float)(t * (double)glass->def.height_m);
                position[2] = 0;
            }
        }
    bool sound = true;
    for (uint32_t row = 0; row < NODES; row++)
        for (uint32_t column = 0; column < NODES; column++)
            sound = fill_frame(nodes, column, row) && sound;
    return sound;
}

/* ---- cells */

/* The hashed values at the corners of one cell of value noise. Cells of a pane ask for the same one many times. */
typedef struct noise_corners {
    uint32_t seed;
    int32_t x, y;
    double values[4];
} noise_corners;

static void find_corners(int32_t x, int32_t y, noise_corners *corners)
{
    corners->x = x;
    corners->y = y;
    for (int i = 0; i < 4; i++) {
        const uint32_t hash = virga_hash3(corners->seed, (uint32_t)(x + (i & 1)), (uint32_t)(y + (i >> 1)));
        corners->values[i] = (double)virga_unit(hash) + (double)virga_unit(virga_hash1(hash)) - 1;
    }
}

static noise_corners first_corners(uint32_t seed)
{
    noise_corners corners = {.seed = seed};
    find_corners(0, 0, &corners);
    return corners;
}

/* Value noise: hashed values on a grid, interpolated by a cubic whose slope is 0 at both ends (smoothstep). */
static double noise(noise_corners *corners, double x, double y)
{
    const int32_t ix = (int32_t)floor(x), iy = (int32_t)floor(y);
    if (ix != corners->x || iy != corners->y)
        find_corners(ix, iy, corners);
    const double *corner = corners->values;
    double fx = x - ix, fy = y - iy;
    fx *= fx * (3 - 2 * fx);
    fy *= fy * (3 - 2 * fy);
    return (corner[0] * (1 - fx) + corner[1] * fx) * (1 - fy) + (corner[2] * (1 - fx) + corner[3] * fx) * fy;
}

/* Logarithm of a cell's affinity, in standard deviations. It is a sum of two octaves of noise. The first has the width
 * from the settings. The second has a third of this width and half the amplitude. The sum of two uniform random numbers
 * has a variance of 1/6; interpolation reduces it to about half. */
static double uneven(noise_corners octaves[2], double width, double u, double v)
{
    const double sum =
        noise(&octaves[0], u / width, v / width) + 0.5 * noise(&octaves[1], 3 * u / width, 3 * v / width);
    return sum / 0.27;
}

/* Height of the bump map at a position: bilinear filter, repeated in both directions. */
static double bump(const virga_glass_shape *shape, double u, double v)
{
    const double x = u / (double)shape->bump_width_m * shape->bump_columns,
                 y = v / (double)shape->bump_height_m * shape->bump_rows;
    const double wx = x - floor(x / shape->bump_columns) * shape->bump_columns;
    const double wy = y - floor(y / shape->bump_rows) * shape->bump_rows;
    const uint32_t x0 = (uint32_t)wx % shape->bump_columns, y0 = (uint32_t)wy % shape->bump_rows;
    const uint32_t x1 = (x0 + 1) % shape->bump_columns, y1 = (y0 + 1) % shape->bump_rows;
    const double fx = wx - floor(wx), fy = wy - floor(wy);
    const float *h = shape->bumps_m;
    return (1 - fy) *
               ((1 - fx) * (double)h[x0 + y0 * shape->bump_columns] + fx * (double)h[x1 + y0 * shape->bump_columns]) +
           fy * ((1 - fx) * (double)h[x0 + y1 * shape->bump_columns] + fx * (double)h[x1 + y1 * shape->bump_columns]);
}

static double bump_deviation(const virga_glass_shape *shape, double *mean)
{
    double sum = 0, squares = 0;
    const size_t count = (size_t)shape->bump_columns * shape->bump_rows;
    for (size_t i = 0; i < count; i++) {
        sum += (double)shape->bumps_m[i];
        squares += (double)shape->bumps_m[i] * (double)shape->bumps_m[i];
    }
    *mean = sum / (double)count;
    return sqrt(fmax(squares / (double)count - *mean * *mean, 1e-18));
}

static uint32_t byte_of(double value, double scale)
{
    const double whole = floor(128 + value * scale + 0.5);
    return whole > 0 ? (uint32_t)(whole < 255 ? whole : 255) : 0;
}

static bool has_glass(const virga_glass_shape *shape, double s, double t)
{
    if (!shape->mask)
        return true;
    const uint32_t column = (uint32_t)(s * shape->mask_columns), row = (uint32_t)(t * shape->mask_rows);
    return shape->mask[column + row * shape->mask_columns] != 0;
}

static void fill_cells(const virga_glass *glass, const virga_glass_shape *shape, uint32_t *cells)
{
    double mean = 0;
    const double cell = (double)glass->def.cell_m, deviation = shape->bumps_m ? bump_deviation(shape, &mean) : 1;
    const double width = (double)glass->def.affinity_size_m;
    noise_corners octaves[2] = {first_corners(glass->def.seed ^ 0x51ed27u), first_corners(glass->def.seed ^ 0x77b3e1u)};
    for (uint32_t row = 0; row < glass->rows; row++)
        for (uint32_t column = 0; column < glass->columns; column++) {
            const double u = (column + 0.5) * cell, v = (row + 0.5) * cell;
            double affinity = uneven(octaves, width, u, v), slope[2] = {0, 0};
            if (shape->bumps_m) {
                /* Low areas attract drops. Chen and Zhang name affinity from the bump map as future work. */
                affinity -= (double)shape->bump_affinity * (bump(shape, u, v) - mean) / deviation;
                slope[0] = (bump(shape, u + 0.5 * cell, v) - bump(shape, u - 0.5 * cell, v)) / cell;
                slope[1] = (bump(shape, u, v + 0.5 * cell) - bump(shape, u, v - 0.5 * cell)) / cell;
            }
            const double length = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
            const bool there = has_glass(shape, fmin(u / (double)glass->def.width_m, 0.999999),
                                         fmin(v / (double)glass->def.height_m, 0.999999));
            cells[column + row * glass->columns] = byte_of(affinity, 32) | byte_of(-slope[0] / length, 128) << 8 |
                                                   byte_of(-slope[1] / length, 128) << 16 | (there ? 0x1000000u : 0);
        }
}

/* ---- setting a shape */

static virga_result check_shape(const virga_log *log, const virga_glass_shape *shape)
{
    const virga_result result = virga_settings_check(log, "glass_shape", shape->size, sizeof *shape, shape->cookie);
    if (result)
        return result;
    if (shape->positions &&
        (shape->columns < 2 || shape->rows < 2 || shape->columns > MAX_GRID || shape->rows > MAX_GRID))
        return virga_wrong_argument(log, "glass_shape: expected 2 to 1025 columns and rows, got %u x %u",
                                    shape->columns, shape->rows);
    if (shape->mask &&
        (!shape->mask_columns || !shape->mask_rows || shape->mask_columns > 8192 || shape->mask_rows > 8192))
        return virga_wrong_argument(log, "glass_shape: expected a mask of 1 to 8192 columns and rows, got %u x %u",
                                    shape->mask_columns, shape->mask_rows);
    if (shape->bumps_m &&
        (shape->bump_columns < 2 || shape->bump_rows < 2 || shape->bump_columns > 8192 || shape->bump_rows > 8192))
        return virga_wrong_argument(log, "glass_shape: expected a bump map of 2 to 8192 columns and rows, got %u x %u",
                                    shape->bump_columns, shape->bump_rows);
    if (shape->bumps_m && !(shape->bump_width_m >= 1e-4f && shape->bump_width_m <= 100 &&
                            shape->bump_height_m >= 1e-4f && shape->bump_height_m <= 100))
        return virga_wrong_argument(log, "glass_shape: expected a bump map of 0.0001 to 100 m, got %g x %g",
                                    (double)shape->bump_width_m, (double)shape->bump_height_m);
    if (!(shape->bump_affinity >= 0 && shape->bump_affinity <= 10))
        return virga_wrong_argument(log, "glass_shape.bump_affinity: expected 0 to 10, got %g",
                                    (double)shape->bump_affinity);
    for (uint32_t i = 0; shape->positions && i < 3 * shape->columns * shape->rows; i++)
        if (!(fabsf(shape->positions[i]) <= MAX_POSITION_M))
            return virga_wrong_argument(log,
                                        "glass_shape.positions[%u]: is %g, expected no more than %g m from the "
                                        "pane's origin",
                                        i, (double)shape->positions[i], (double)MAX_POSITION_M);
    if (shape->bumps_m &&
        virga_settings_check_finite(log, "glass_shape.bumps_m", shape->bumps_m, shape->bump_columns * shape->bump_rows))
        return VIRGA_ERROR_INVALID;
    return VIRGA_OK;
}

/* Whether all nodes are where a parallelogram over three of the corners has them, to a hundredth of a millimetre. */
static bool is_flat(const virga_glass_node_gpu *nodes)
{
    const float *from = nodes[0].position, *u = nodes[NODES - 1].position, *v = nodes[NODES * (NODES - 1)].position;
    for (uint32_t i = 0; i < NODES * NODES; i++)
        for (int axis = 0; axis < 3; axis++) {
            const double s = i % NODES / (NODES - 1.0), t = i / NODES / (NODES - 1.0);
            const double at = (1 - s - t) * (double)from[axis] + s * (double)u[axis] + t * (double)v[axis];
            if (!(fabs((double)nodes[i].position[axis] - at) < 1e-5))
                return false;
        }
    return true;
}

/* Copies the parts of the shape that the CPU needs later. */
static void remember(virga_glass *glass, const virga_glass_node_gpu *nodes)
{
    glass->farthest_m = 0;
    glass->flat = is_flat(nodes);
    memcpy(glass->low_m, nodes[0].position, sizeof glass->low_m);
    memcpy(glass->high_m, nodes[0].position, sizeof glass->high_m);
    for (uint32_t i = 0; i < NODES * NODES; i++) {
        const float *p = nodes[i].position, far = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        memcpy(glass->normals[i], nodes[i].normal, sizeof glass->normals[i]);
        glass->farthest_m = far > glass->farthest_m ? far : glass->farthest_m;
        for (int axis = 0; axis < 3; axis++) {
            glass->low_m[axis] = fminf(glass->low_m[axis], p[axis]);
            glass->high_m[axis] = fmaxf(glass->high_m[axis], p[axis]);
        }
    }
    for (uint32_t i = 0; i < 9; i++)
        memcpy(glass->outline[i], nodes[(i % 3 + i / 3 * NODES) * (NODES / 2)].position, sizeof glass->outline[i]);
}

static void direction(const float from[3], const float to[3], double out[3])
{
    subtract(to, from, out);
    if (!normalise(out))
        out[0] = 1;
}

void virga_glass_rectangle(const virga_glass *glass, float corner[3], float along_u[3], float along_v[3],
                           float *width_m, float *height_m)
{
    if (!glass || !corner || !along_u || !along_v || !width_m || !height_m)
        return;
    double u[3], v[3], n[3], middle[3] = {0, 0, 0};
    direction(glass->outline[0], glass->outline[2], u);
    direction(glass->outline[0], glass->outline[6], v);
    cross(u, v, n);
    normalise(n);
    cross(n, u, v); /* perpendicular to u, as the sides of a rectangle are */
    for (int i = 0; i < 9; i++)
        for (int axis = 0; axis < 3; axis++)
            middle[axis] += (double)glass->outline[i][axis] / 9;
    for (int axis = 0; axis < 3; axis++) {
        along_u[axis] = (float)u[axis];
        along_v[axis] = (float)v[axis];
        corner[axis] = (float)(middle[axis] - 0.5 * (double)glass->def.width_m * u[axis] -
                               0.5 * (double)glass->def.height_m * v[axis]);
    }
    *width_m = glass->def.width_m;
    *height_m = glass->def.height_m;
}

/* Writes the shape into new upload buffers. The next step copies them. */
virga_result virga_glass_shape_set(virga_glass *glass, const virga_glass_shape *shape)
{
    if (!glass)
        return VIRGA_ERROR_INVALID;
    virga_context *context = glass->base.context;
    if (!shape)
        return virga_wrong_argument(&context->log, "virga_glass_shape_set: NULL argument");
    if (context->lost)
        return VIRGA_ERROR_DEVICE_LOST;
    virga_result result = check_shape(&context->log, shape);
    if (result)
        return result;
    const bool masked = glass->masked;
    virga_buffer *cells = NULL, *nodes = NULL;
    TRY(virga_buffer_create(context, glass->surface->size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, VIRGA_HEAP_UPLOAD,
                            "glass.surface_upload", &cells));
    TRY(virga_buffer_create(context, glass->nodes->size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, VIRGA_HEAP_UPLOAD,
                            "glass.nodes_upload", &nodes));
    if (!fill_nodes(glass, shape, nodes->memory.block.mapped)) {
        result = virga_wrong_argument(&context->log, "glass_shape.positions: a part of the pane has no area");
        goto error;
    }
    fill_cells(glass, shape, cells->memory.block.mapped);
    virga_buffer_flush(context, cells, 0, cells->size);
    virga_buffer_flush(context, nodes, 0, nodes->size);
    glass->masked = shape->mask != NULL;
    TRY(glass_picture_need(glass, &glass->settings));
    TRY(virga_recording_result(context));
    remember(glass, nodes->memory.block.mapped);
    glass->shape_count++;
    VIRGA_RETIRE(context, glass->surface_upload);
    VIRGA_RETIRE(context, glass->nodes_upload);
    glass->surface_upload = cells;
    glass->nodes_upload = nodes;
    return VIRGA_OK;
error:
    glass->masked = masked;
    VIRGA_RETIRE(context, cells);
    VIRGA_RETIRE(context, nodes);
    return result;
}

virga_result glass_shape_init(virga_glass *glass)
{
    const virga_glass_shape flat = virga_default_glass_shape();
    return virga_glass_shape_set(glass, &flat);
}
