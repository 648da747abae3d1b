/* particle_sequence.h - particles at any time, out of a file for each frame of a simulation.
 *
 * Between two files a particle with an id moves on the cubic Hermite curve through its two positions and velocities; on
 * a line where files have no velocity. Without ids the particles of both files move with their own velocities, and
 * those of the earlier file fade out while those of the later one fade in. A particle that only one of the two files
 * has moves with its velocity, and fades.
 *
 * Fading is the share of a particle's volume that counts. It goes from 0 to 1 along 3 s^2 - 2 s^3, so neither it nor
 * its rate of change jumps. It takes the time `fade_s` around the middle between the two files of which one has the
 * particle, and no less than the time from one to the other: a particle that vanishes begins to fade before its last
 * file, and goes on by its velocity after it. Files are read ahead and behind for that, up to eight each, so a picture
 * depends on its time alone. Without ids nobody knows what appears, and fading takes the time between two files. Before
 * the first file and after the last one the particles stand still. A particle whose position is not finite is not
 * there. */
#ifndef VIRGA_IO_PARTICLE_SEQUENCE_H
#define VIRGA_IO_PARTICLE_SEQUENCE_H

#include "particles.h"

typedef struct particle_sequence particle_sequence; /* opaque */

typedef enum particle_ids {
    PARTICLE_IDS_FILE, /* the attribute; none where files have none */
    PARTICLE_IDS_ROWS, /* particles keep their place in all files, as in most simulations without inflow */
    PARTICLE_IDS_NONE,
} particle_ids;

typedef struct particle_sequence_def {
    const char *files; /* "dam_%04d.ply": a folder's files by their numbers; without %: one file for all times */
    double rate_hz;    /* numbers per second; above 0 */
    uint32_t step;     /* from one number to the next; at least 1 */
    int64_t first;     /* the number at time 0; negative: the smallest there is */
    particle_ids ids;
    double fade_s; /* time that particles take to appear or vanish; at most 16 times that between two files */
} particle_sequence_def;

/* As a virga_particle_gpu: 32 bytes. */
typedef struct particle_sample {
    float position[3], share, velocity[3];
    uint32_t id;
} particle_sample;

/* Lists the files. A missing one between the first and the last is an error. */
bool particle_sequence_open(particle_sequence **sequence, const particle_sequence_def *def, char *error,
                            size_t error_size);

/* Accepts NULL. */
void particle_sequence_close(particle_sequence *sequence);

uint32_t particle_sequence_length(const particle_sequence *sequence);

/* Seconds from the first file to the last. */
double particle_sequence_duration(const particle_sequence *sequence);

/* The name of a file, from 0 on, needs free(); NULL without memory. */
char *particle_sequence_path(const particle_sequence *sequence, uint32_t index);

/* The particles at a time, until the next call: those of the earlier file by their rows, then those that only the later
 * one has. Reads the two files around it, none that the last call has read, and with a longer fade_s those that it
 * needs to know what appears and vanishes: a file for each further one in time, all of them after a jump. */
bool particle_sequence_at(particle_sequence *sequence, double time_s, const particle_sample **samples, uint32_t *count,
                          char *error, size_t error_size);

#endif
