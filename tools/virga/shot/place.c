/* place.c - light at points of the camera's path, and between them. */
#include "shot/place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define APART_M  2.0 /* from one point of the path to the next; in a street light changes little in less */
#define HIGHER_M 4.0 /* above the eye */
#define FOLLOW_M 1.0 /* way on which a free camera's light becomes that of where it is now */

typedef struct light_point {
    double time_s, way_m; /* of the path when it is there */
    bool begins;          /* a shot does: nothing blends into it */
    bool found;
    float sh[9][3];
} light_point;

typedef struct shot_place {
    host_surroundings surroundings;
    host_camera_key *keys; /* of the path that the points lie on */
    uint32_t key_count;
    double *way_m; /* at each frame, from the pre-roll on */
    uint32_t frame_count;
    light_point *points;
    uint32_t point_count;
    bool free; /* the free camera has been somewhere: */
    double free_m[3];
    float free_sh[9][3];
    virga_light lamps[VIRGA_MAX_LIGHTS]; /* for which all of it was found */
    uint32_t lamp_count;
} shot_place;

/* ---- the path */

static void camera_m(const shot *s, double time_s, double out[3])
{
    host_camera camera;
    const host_camera_path eye = shot_eye(s);
    host_camera_at(&eye, time_s, s->options.width, s->options.height, NULL, &camera);
    memcpy(out, camera.position_m, sizeof camera.position_m);
}

static double apart_m(const double a[3], const double b[3])
{
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static double time_of(const shot *s, uint32_t frame)
{
    return frame / s->scene->frames.fps - shot_preroll_s(s);
}

/* The first point lies where the path begins, and the next ones where it has gone so far from there, in a straight
 * line. */
static void place_points(const shot *s, shot_place *place)
{
    double at[3], before[3], last[3];
    place->point_count = 0;
    for (uint32_t i = 0; i < place->frame_count; i++) {
        const double time_s = time_of(s, i);
        camera_m(s, time_s, at);
        const bool begins = i == 0 || host_camera_shot_start(&s->path, time_s) > time_of(s, i - 1);
        place->way_m[i] = i ? place->way_m[i - 1] + (begins ? 0 : apart_m(at, before)) : 0;
        if (begins || apart_m(at, last) >= APART_M) {
            place->points[place->point_count++] =
                (light_point){.time_s = time_s, .way_m = place->way_m[i], .begins = begins};
            memcpy(last, at, sizeof last);
        }
        memcpy(before, at, sizeof before);
    }
}

/* A user can move keys. */
static bool is_placed_on(const shot_place *place, const host_camera_path *path)
{
    bool same = place->points && place->key_count == path->count;
    for (uint32_t i = 0; same && i < path->count; i++) {
        const host_camera_key *a = &place->keys[i], *b = &path->keys[i];
        same = a->time_s == b->time_s && memcmp(a->position_m, b->position_m, sizeof a->position_m) == 0 &&
               a->cut == b->cut;
    }
    return same;
}

static bool follow_path(const shot *s, shot_place *place, char *error, size_t error_size)
{
    const size_t size = s->path.count * sizeof *s->path.keys;
    if (is_placed_on(place, &s->path))
        return true;
    const scene_frames *frames = &s->scene->frames;
    place->frame_count = (uint32_t)lround(shot_preroll_s(s) * frames->fps) + frames->last - frames->first + 1;
    free(place->keys);
    free(place->way_m);
    free(place->points);
    place->keys = malloc(size);
    place->way_m = calloc(place->frame_count, sizeof *place->way_m);
    place->points = calloc(place->frame_count, sizeof *place->points);
    if (!place->keys || !place->way_m || !place->points)
        return host_fail(error, error_size, "no memory for the light along the camera's path");
    memcpy(place->keys, s->path.keys, size);
    place->key_count = s->path.count;
    place_points(s, place);
    return true;
}

/* ---- the light */

/* From `from` to `to`. */
static void blend(float from[9][3], float to[9][3], double part, float out[9][3])
{
    for (int k = 0; k < 9; k++)
        for (int c = 0; c < 3; c++)
            out[k][c] = (float)((1 - part) * (double)from[k][c] + part * (double)to[k][c]);
}

/* Drops are seen from below the eye up to the roofs. Where nothing is above the camera, the mean of two heights stands
 * for them. */
static bool light_of_heights(shot *s, const double at_m[3], float sh[9][3], char *error, size_t error_size)
{
    host_surroundings *around = &s->place->surroundings;
    const double high_m[3] = {at_m[0], at_m[1] + HIGHER_M, at_m[2]};
    float high[9][3];
    if (!host_surroundings_light(around, s->renderer, at_m, sh, error, error_size))
        return false;
    if (host_surroundings_above(around) < HIGHER_M + 1)
        return true;
    if (!host_surroundings_light(around, s->renderer, high_m, high, error, error_size))
        return false;
    blend(sh, high, 0.5, sh);
    return true;
}

static bool light_at(shot *s, const double at_m[3], float sh[9][3], char *error, size_t error_size)
{
    const uint32_t lights = s->lighting.light_count;
    host_renderer_set_lights(s->renderer, s->lighting.lights, s->scene->light_count); /* without lamps that drive */
    const bool ok = light_of_heights(s, at_m, sh, error, error_size);
    blend(s->environment.sh, sh, s->scene->environment.around, sh);
    host_renderer_set_lights(s->renderer, s->lighting.lights, lights);
    return ok;
}

static bool light_of_point(shot *s, light_point *point, char *error, size_t error_size)
{
    double at[3];
    if (point->found)
        return true;
    camera_m(s, point->time_s, at);
    point->found = light_at(s, at, point->sh, error, error_size);
    return point->found;
}

static double way_at(const shot *s, const shot_place *place, double time_s)
{
    const double frame = (time_s + shot_preroll_s(s)) * s->scene->frames.fps;
    const double inside = fmin(fmax(frame, 0), place->frame_count - 1);
    const uint32_t i = (uint32_t)inside, next = i + 1 < place->frame_count ? i + 1 : i;
    return place->way_m[i] + (inside - i) * (place->way_m[next] - place->way_m[i]);
}

static bool light_of_path(shot *s, double time_s, char *error, size_t error_size)
{
    shot_place *place = s->place;
    uint32_t i = 0;
    if (!follow_path(s, place, error, error_size))
        return false;
    while (i + 1 < place->point_count && place->points[i + 1].time_s <= time_s)
        i++;
    light_point *at = &place->points[i], *next = at;
    if (i + 1 < place->point_count && !at[1].begins)
        next = at + 1;
    const double way = next->way_m - at->way_m, gone = way_at(s, place, time_s) - at->way_m;
    const double part = way > 0 ? fmin(fmax(gone / way, 0), 1) : 0;
    if (!light_of_point(s, at, error, error_size) || (part > 0 && !light_of_point(s, next, error, error_size)))
        return false;
    blend(at->sh, part > 0 ? next->sh : at->sh, part, s->lighting.environment_sh);
    return true;
}

static bool light_of_free_camera(shot *s, double time_s, char *error, size_t error_size)
{
    shot_place *place = s->place;
    double at[3];
    camera_m(s, time_s, at);
    const double moved = place->free ? apart_m(at, place->free_m) : FOLLOW_M;
    if (!place->free || moved > 0.25 * FOLLOW_M) {
        float here[9][3];
        if (!light_at(s, at, here, error, error_size))
            return false;
        blend(s->lighting.environment_sh, here, fmin(moved / FOLLOW_M, 1), place->free_sh);
        memcpy(place->free_m, at, sizeof at);
        place->free = true;
    }
    memcpy(s->lighting.environment_sh, place->free_sh, sizeof place->free_sh);
    return true;
}

/* A user can change lamps: what they light has to be found anew. Those that drive are not in it. */
static void follow_lamps(const shot *s, shot_place *place)
{
    const uint32_t count = s->scene->light_count;
    const size_t size = count * sizeof place->lamps[0];
    if (place->lamp_count == count && memcmp(place->lamps, s->lighting.lights, size) == 0)
        return;
    for (uint32_t i = 0; i < place->point_count; i++)
        place->points[i].found = false;
    place->free = false;
    memcpy(place->lamps, s->lighting.lights, size);
    place->lamp_count = count;
}

bool shot_find_light(shot *s, double time_s, char *error, size_t error_size)
{
    if (!s->place)
        return true;
    follow_lamps(s, s->place);
    if (s->eye_free)
        return light_of_free_camera(s, time_s, error, error_size);
    s->place->free = false;
    return light_of_path(s, time_s, error, error_size);
}

/* ---- life */

bool shot_open_place(shot *s, char *error, size_t error_size)
{
    const bool lights = s->renderer && s->options.parts == HOST_PLATE_WHOLE;
    if (!lights || s->plate || s->scene->environment.around <= 0)
        return true;
    s->place = calloc(1, sizeof *s->place);
    if (!s->place)
        return host_fail(error, error_size, "no memory for the light of a place");
    return host_surroundings_create(&s->device, &s->place->surroundings, error, error_size);
}

void shot_close_place(shot *s)
{
    if (!s->place)
        return;
    host_surroundings_destroy(&s->device, &s->place->surroundings);
    free(s->place->keys);
    free(s->place->way_m);
    free(s->place->points);
    free(s->place);
    s->place = NULL;
}
