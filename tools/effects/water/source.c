/* source.c - particles from files, in the units and axes of the world. */
#include "water_state.h"

#include "particle_spacing.h"
#include "particles.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

_Static_assert(sizeof(particle_sample) == sizeof(virga_particle_gpu), "samples are copied as they are");
_Static_assert(offsetof(particle_sample, velocity) == offsetof(virga_particle_gpu, velocity), "the same order");
_Static_assert(offsetof(particle_sample, id) == offsetof(virga_particle_gpu, id), "the same order");

/* ---- opening */

bool water_open_sequence(const scene_file *scene, particle_sequence **sequence, char *error, size_t error_size)
{
    const scene_water *from = scene_water_of(scene);
    const particle_sequence_def def = {.files = from->files,
                                       .rate_hz = from->rate_hz,
                                       .step = from->step,
                                       .first = from->first ? (int64_t)*from->first : -1,
                                       .ids = (particle_ids)from->ids,
                                       .fade_s = from->fade_s};
    char reason[1024];
    return particle_sequence_open(sequence, &def, reason, sizeof reason) ||
           scene_file_refuse(scene, "water.files", error, error_size, "%s", reason);
}

/* Takes the count and the box of a frame into account. */
static void note_frame(const particles *frame, double unit_m, water_source *source)
{
    float low[3], high[3];
    uint32_t invalid;
    source->most = frame->count > source->most ? frame->count : source->most;
    source->has_ids = frame->id;
    source->has_velocity = frame->velocity;
    if (!particles_bounds(frame, low, high, &invalid))
        return;
    for (int axis = 0; axis < 3; axis++)
        source->extent_m[axis] = fmax(source->extent_m[axis], unit_m * ((double)high[axis] - (double)low[axis]));
}

/* What the particles of the files say of their spacing. */
typedef struct guessed {
    particle_spacing spacing; /* 0: no guess; in units of the files */
    char path[4096];          /* the file that says so */
    bool settled;             /* it is not the first one, whose water may not have moved yet */
} guessed;

static bool read_frame(water_source *source, uint32_t index, double unit_m, guessed *guess, char *error,
                       size_t error_size)
{
    particles frame;
    char *path = particle_sequence_path(source->sequence, index);
    if (!path)
        return host_fail(error, error_size, "no memory for the name of a file");
    if (!particles_read(path, &frame, error, error_size)) {
        free(path);
        return false;
    }
    note_frame(&frame, unit_m, source);
    if (!(guess->spacing.spacing > 0) && particle_spacing_guess(&frame, &guess->spacing)) {
        snprintf(guess->path, sizeof guess->path, "%s", path);
        guess->settled = index > 0;
    }
    particles_free(&frame);
    free(path);
    return true;
}

/* The number of particles per volume is known within 2 % in spacing, which is 6 % in volume. */
static void compare_volume(const scene_file *scene, const water_source *source, const guessed *guess)
{
    const scene_water *from = scene_water_of(scene);
    const double measured_m3 = pow(from->unit_m * guess->spacing.spacing, 3);
    const double cube_m3 = pow(source->spacing_m, 3), given_m3 = from->volume * cube_m3;
    char line[8192];
    if (!guess->settled || fabs(given_m3 / measured_m3 - 1) <= 0.1)
        return;
    scene_file_refuse(scene, "water.volume", line, sizeof line,
                      "expected about %.2g: %g makes a particle %.3g m^3, and each takes up %.3g m^3 in %s",
                      measured_m3 / cube_m3, from->volume, given_m3, measured_m3, guess->path);
    fprintf(stderr, "virga: %s\n", line);
}

static bool choose_spacing(const scene_file *scene, water_source *source, const guessed *guess, char *error,
                           size_t error_size)
{
    const scene_water *from = scene_water_of(scene);
    const bool given = from->spacing_m > 0;
    source->spacing_m = given ? from->spacing_m : from->unit_m * guess->spacing.spacing;
    if (!given && !(source->spacing_m >= 0.0001 && source->spacing_m <= 10))
        return scene_file_refuse(scene, "water.spacing_m", error, error_size,
                                 "no guess from these particles (%g m); expected a spacing from 0.0001 to 10",
                                 source->spacing_m);
    if (!given)
        fprintf(stderr,
                "virga: water.spacing_m: guessed %.4g from %s, by its particles per volume; a particle is %.3g m^3 "
                "(water.volume is %g)\n",
                source->spacing_m, guess->path, from->volume * pow(source->spacing_m, 3), from->volume);
    compare_volume(scene, source, guess);
    return true;
}

bool water_mixes_files(const scene_file *scene, const water_source *source)
{
    const scene_water *from = scene_water_of(scene);
    const bool paired = from->ids == SCENE_WATER_IDS_ROWS || (from->ids == SCENE_WATER_IDS_FILE && source->has_ids);
    return source->sequence && !paired && particle_sequence_length(source->sequence) > 1;
}

static uint32_t most_at_once(const scene_file *scene, const water_source *source)
{
    return water_mixes_files(scene, source) ? 2 * source->most : source->most;
}

uint32_t water_left_out(const scene_file *scene, const water_source *source)
{
    const uint32_t given = scene_water_of(scene)->max_particles, most = most_at_once(scene, source);
    const uint32_t room = !given ? WATER_MAX_PARTICLES : given < WATER_MIN_PARTICLES ? WATER_MIN_PARTICLES : given;
    return most > room ? most - room : 0;
}

static void say_left_out(const scene_file *scene, const water_source *source)
{
    const uint32_t most = most_at_once(scene, source), out = water_left_out(scene, source);
    const bool given = scene_water_of(scene)->max_particles;
    char line[8192];
    if (!out)
        return;
    scene_file_refuse(scene, given ? "water.max_particles" : "water.files", line, sizeof line,
                      "expected at most %u particles at once%s, got up to %u%s: %u are left out", most - out,
                      given ? "" : ", all that water can have", most,
                      most > source->most ? " (those of two files, as there are no ids)" : "", out);
    fprintf(stderr, "virga: %s\n", line);
}

/* The last file comes first: its water is more likely to have settled. */
static bool read_frames(const scene_file *scene, water_source *source, char *error, size_t error_size)
{
    const uint32_t length = particle_sequence_length(source->sequence);
    const uint32_t order[] = {length - 1, length / 2, 0};
    guessed guess = {0};
    for (int i = 0; i < 3; i++)
        if (!(i && order[i] == order[i - 1]) &&
            !read_frame(source, order[i], scene_water_of(scene)->unit_m, &guess, error, error_size))
            return false;
    if (!choose_spacing(scene, source, &guess, error, error_size))
        return false;
    say_left_out(scene, source);
    return true;
}

bool water_open_source(const scene_file *scene, water_source *source, char *error, size_t error_size)
{
    if (water_is_solved(scene)) {
        water_describe_solver(scene, source);
        return true;
    }
    return water_open_sequence(scene, &source->sequence, error, error_size) &&
           read_frames(scene, source, error, error_size);
}

/* ---- a step */

/* Rows of the matrix from the file's axes to the world's, with the unit. Z up: x stays, y goes to the back. */
static void world_from_file(const scene_water *from, float matrix[9])
{
    float turn[12];
    const scene_mesh place = {.scale = from->unit_m,
                              .rotation_deg = {from->rotation_deg[0], from->rotation_deg[1], from->rotation_deg[2]}};
    shot_mesh_transform(&place, turn);
    for (int row = 0; row < 3; row++) {
        const float *r = turn + (ptrdiff_t)row * 4;
        const bool z_up = from->up == SCENE_WATER_UP_Z;
        matrix[row * 3] = r[0];
        matrix[row * 3 + 1] = z_up ? -r[2] : r[1];
        matrix[row * 3 + 2] = z_up ? r[1] : r[2];
    }
}

static void turn(const float matrix[9], const float in[3], float out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = matrix[row * 3] * in[0] + matrix[row * 3 + 1] * in[1] + matrix[row * 3 + 2] * in[2];
}

static void copy_samples(const float matrix[9], const particle_sample *samples, uint32_t count, virga_particle_gpu *out)
{
    for (uint32_t i = 0; i < count; i++) {
        turn(matrix, samples[i].position, out[i].position);
        turn(matrix, samples[i].velocity, out[i].velocity);
        out[i].share = samples[i].share;
        out[i].id = samples[i].id;
    }
}

double water_volume_l(const scene_water *from, const water_source *source, const virga_particle_gpu *particles,
                      uint32_t count)
{
    double shares = 0;
    for (uint32_t i = 0; i < count; i++)
        shares += (double)particles[i].share;
    return 1000 * shares * from->volume * pow(source->spacing_m, 3);
}

bool water_fill_particles(shot *s, water_state *state, double time_s, virga_water_step_info *info, char *error,
                          size_t error_size)
{
    const scene_water *from = scene_water_of(s->scene);
    const particle_sample *samples;
    const VkDeviceSize part = (VkDeviceSize)state->max_particles * sizeof(virga_particle_gpu);
    float matrix[9];
    state->time_s = time_s;
    if (state->solver.fluid)
        return water_fill_solved(s, state, time_s, info, error, error_size);
    if (!shot_blame_input(
            s, particle_sequence_at(state->source.sequence, state->time_s, &samples, &info->count, error, error_size)))
        return false;
    world_from_file(from, matrix);
    info->time_s = time_s;
    info->particles = state->particles.buffer;
    info->offset = s->device.frame % HOST_FRAMES * part;
    memcpy(info->origin_m, from->position_m, sizeof info->origin_m);
    /* The step leaves further ones out, and says so. */
    const uint32_t count = info->count < state->max_particles ? info->count : state->max_particles;
    virga_particle_gpu *out = (void *)((char *)state->particles.mapped + info->offset);
    copy_samples(matrix, samples, count, out);
    state->given = out;
    state->count = count;
    state->step_frame = s->device.frame;
    return true;
}

/* Those of the solver, or those of files once more. */
static bool count_particles(water_state *state, const particle_sample **samples, uint32_t *count, char *error,
                            size_t error_size)
{
    *count = state->solver.count;
    if (!state->solver.fluid &&
        !particle_sequence_at(state->source.sequence, state->time_s, samples, count, error, error_size))
        return false;
    *count = *count < state->max_particles ? *count : state->max_particles;
    return true;
}

virga_particle_gpu *water_copy_particles(shot *s, water_state *state, uint32_t *count, char *error, size_t error_size)
{
    const particle_sample *samples = NULL;
    float matrix[9];
    if (!count_particles(state, &samples, count, error, error_size))
        return NULL;
    virga_particle_gpu *particles = malloc(*count * sizeof *particles + 1);
    if (!particles) {
        host_fail(error, error_size, "no memory for %u particles", *count);
        return NULL;
    }
    if (samples) {
        world_from_file(scene_water_of(s->scene), matrix);
        copy_samples(matrix, samples, *count, particles);
    } else if (!water_copy_solved(s, state, particles, error, error_size)) {
        free(particles);
        return NULL;
    }
    return particles;
}
