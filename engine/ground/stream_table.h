/* ground/stream_table.h - a picture of waves of one length in all directions, which the waves of running water are made
 * of. Internal. */
#ifndef VIRGA_GROUND_STREAM_TABLE_H
#define VIRGA_GROUND_STREAM_TABLE_H

#include <stdint.h>

#include <virga/shared/ground_gpu.h>

/* Fills `texels`: for each, the slopes of two surfaces A and B along x and y, as 128 + 127 slope / TILE_SLOPE. A side
 * of the picture has the length 1, and both surfaces a standard deviation of 1.
 *
 * Each is the sum of all waves a cos(2 pi (m x + n y) + phase) with whole numbers m and n, hypot(m, n) 7 to 9.5 (the
 * mean is VIRGA_STREAM_TILE_WAVES), of random phases. They are whole, so the picture goes on at its other side without
 * a seam. A and B are independent, so A cos(w t) + B sin(w t) are waves that go to all sides:
 *
 *     a cos(p) cos(w t) + b cos(q) sin(w t),  p and q the phase of a wave in A and B,
 *
 * is the sum of one that goes forward and one that goes back, of independent heights. Runs in about 0.02 s. */
void stream_table_fill(uint8_t texels[VIRGA_STREAM_TILE][VIRGA_STREAM_TILE][4]);

#endif
