/* particles.h - reads a frame of simulated particles, as other programs write it.
 *
 * Formats, found out from the first bytes, each plain or compressed by gzip:
 *
 *     PLY     ascii and binary, both byte orders, every scalar type; lists and other elements are skipped
 *     VTK     legacy files, ascii and binary: POLYDATA and UNSTRUCTURED_GRID; POINT_DATA as SCALARS, VECTORS and FIELD
 *     bgeo    version 5, the classic format: SPlisHSPlasH, Partio, Houdini up to 11 and its .bhclassic
 *
 * Names of attributes, in small or capital letters:
 *
 *     velocity   velocity, velocities, vel, v with 3 components; in PLY vx vy vz, velocity_x ..., vel0 ...
 *     id         id, ids, pid, particle_id, particleid, global_ids; a whole number of 32 bits
 *     density    density, densities, dens, rho
 *
 * Of two attributes of one meaning the first counts. Memory is taken as the rows come in, not as a header promises.
 * What is wrong is one line: the file, the line or byte, what is there and what was expected. Bytes are those of the
 * data after gzip. */
#ifndef VIRGA_IO_PARTICLES_H
#define VIRGA_IO_PARTICLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PARTICLES_MAX 33554432 /* of a file: 1 GiB with all attributes */

typedef struct particles {
    uint32_t count;
    float (*position)[3]; /* in the units and axes of the file; may be not finite */
    float (*velocity)[3]; /* NULL: the file has none; the same for the others */
    uint32_t *id;
    float *density;
} particles;

/* On failure `particles` is empty. 0 particles are fine. */
bool particles_read(const char *path, particles *particles, char *error, size_t error_size);

/* Empties it; zeroed particles are fine. */
void particles_free(particles *particles);

/* "PLY", "VTK", "bgeo" by the first bytes of a file, NULL for any other file and for one that cannot be read. */
const char *particles_format(const char *path);

#endif
