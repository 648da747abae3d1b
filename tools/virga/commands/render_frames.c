/* render_frames.c - draws the frames of `virga render` and writes them, each whole or absent. */
#include "commands/render_job.h"
#include "file.h"
#include "frame/claims.h"
#include "frame/files.h"
#include "progress.h"
#include "shot/checkpoint.h"

#include <stdio.h>
#include <string.h>

bool render_open_stats(render_job *job)
{
    char path[4096];
    if (!job->stats)
        return true;
    if (job->worker >= 0)
        workers_lines_path(&job->workers, job->worker, path, sizeof path);
    else if (job->task)
        snprintf(path, sizeof path, "%s/farm/stats.%s.jsonl", job->directory, job->task);
    else
        snprintf(path, sizeof path, "%s/stats.jsonl", job->directory);
    job->stats_open =
        jsonl_open(&job->stats_file, path, job->resume || job->worker >= 0 ? JSONL_APPEND : JSONL_TRUNCATE, job->error,
                   sizeof job->error);
    return job->stats_open;
}

/* ---- frames */

/* A worker's parent hears Ctrl-C. */
static bool is_stopped(const render_job *job)
{
    return render_is_worker(job) ? workers_stopped(&job->workers) : interrupt_requested();
}

/* Goes on from the nearest checkpoint, if one is nearer than the current frame. One that can not be loaded is only
 * slower, unless a part of it was. */
static bool start_from_checkpoint(render_job *job, uint32_t frame)
{
    char reason[1024];
    uint32_t found;
    bool torn;
    shot *s = &job->shot;
    if (!checkpoint_find(s, job->directory, frame, &found))
        return true;
    const bool preroll = found + 1 == job->scene->frames.first;
    const bool loaded = checkpoint_load(s, job->directory, found, &torn, reason, sizeof reason);
    if (torn)
        return host_fail(job->error, sizeof job->error, "the checkpoint of frame %u is damaged, delete it: %s", found,
                         reason);
    if (!loaded)
        fprintf(stderr, "virga render: a checkpoint is not used: %s\n", reason);
    else if (preroll)
        fprintf(stderr, "starts from the checkpoint after the pre-roll\n");
    else
        fprintf(stderr, "starts from the checkpoint of frame %u\n", found);
    return true;
}

/* Steps to the frame before, frame by frame, as the way may be long and Ctrl-C is to be heard on it. */
static bool step_before(render_job *job, uint32_t frame)
{
    shot *s = &job->shot;
    while (s->frame_index + 1 < frame && !is_stopped(job))
        if (!shot_step_unseen(s, job->error, sizeof job->error))
            return false;
    return true;
}

/* The EXR is written last: it being there means that the frame is whole. It and the pictures are written by a thread
 * while the next frame is drawn; but a task that others share frames with first ends one. */
static bool write_frame(render_job *job, uint32_t frame)
{
    host_camera camera;
    shot *s = &job->shot;
    char *error = job->error;
    const size_t size = sizeof job->error;
    if (job->simulate)
        return shot_step(s, frame, error, size);
    if (!shot_draw(s, frame, &camera, error, size))
        return false;
    virga_frame_completed(s->context, s->device.completed);
    if (!frame_writer_wait(&job->writer, error, size) ||
        (job->points && !frame_write_points(s, job->directory, frame, error, size)) ||
        (job->meshes && !frame_write_meshes(s, job->directory, frame, error, size)) ||
        (job->volumes && !frame_write_volumes(s, job->directory, frame, error, size)) ||
        (job->stats && !frame_write_stats(s, &job->stats_file, frame, error, size)))
        return false;
    frame_writer_begin(&job->writer, s, &camera, frame);
    return !job->task || frame_writer_wait(&job->writer, error, size);
}

/* Nothing was drawn. */
int render_stop_early(render_job *job, int code)
{
    if (render_is_worker(job))
        workers_fail(&job->workers, job->worker, code, false, job->error);
    else
        options_complain("render", "%s", job->error);
    return code;
}

/* Both leave what is finished; `frame` is the one to go on with. */
static int stop_failed(render_job *job)
{
    char ignored[256];
    frame_writer_wait(&job->writer, ignored, sizeof ignored);
    if (render_is_worker(job)) {
        workers_fail(&job->workers, job->worker, EXIT_FAILED, true, job->error);
        return EXIT_FAILED;
    }
    options_complain("render", "%s; %u finished frames are kept in %s", job->error, job->writer.written,
                     job->directory);
    return EXIT_FAILED;
}

static int stop_interrupted(render_job *job, uint32_t frame)
{
    if (!frame_writer_wait(&job->writer, job->error, sizeof job->error))
        return stop_failed(job);
    if (render_is_worker(job))
        return EXIT_OK;
    options_complain("render", "interrupted: %u frames are in %s; --resume goes on with frame %u", job->writer.written,
                     job->directory, frame);
    return EXIT_INTERRUPTED;
}

bool render_is_there(const render_job *job, uint32_t frame)
{
    if (frame < job->frames[0])
        return false;
    return render_is_worker(job) ? workers_was_there(&job->workers, frame)
                                 : job->there && job->there[frame - job->frames[0]];
}

uint32_t render_count_missing(const render_job *job)
{
    uint32_t count = 0;
    for (uint32_t frame = job->frames[0]; frame <= job->frames[1]; frame++)
        count += !render_is_there(job, frame);
    return count;
}

uint32_t render_first_missing(const render_job *job)
{
    uint32_t frame = job->frames[0];
    while (render_is_there(job, frame))
        frame++;
    return frame;
}

/* Whether frames that are there lie between the current one and this one: a checkpoint may lead past them. */
static bool is_behind_gap(const render_job *job, uint32_t frame)
{
    for (uint32_t before = job->shot.frame_index + 1; before < frame; before++)
        if (render_is_there(job, before))
            return true;
    return false;
}

/* Through the pre-roll, with a bar of its own, as it may be long and Ctrl-C is to be heard on it. */
static bool step_preroll(render_job *job)
{
    shot *s = &job->shot;
    progress bar;
    progress_begin(&bar, "pre-roll", s->preroll);
    while (s->preroll && !is_stopped(job)) {
        if (!shot_step_preroll(s, job->error, sizeof job->error))
            break;
        progress_step(&bar, NULL);
    }
    progress_end(&bar);
    return !s->preroll;
}

/* Draws a frame, if no other task does. False: failed. */
static bool write_claimed(render_job *job, uint32_t frame, const char **left_out)
{
    claim taken;
    if (!job->task)
        return write_frame(job, frame);
    switch (claim_take(job->directory, job->task, frame, &taken, job->error, sizeof job->error)) {
    case CLAIM_ERROR: return false;
    case CLAIM_THERE: *left_out = "(there already)"; return true;
    case CLAIM_BUSY: *left_out = "(another task draws it)"; return true;
    case CLAIM_FAILED:
        *left_out = "(failed three times)";
        job->gave_up++;
        return true;
    case CLAIM_TAKEN: break;
    }
    const bool written = write_frame(job, frame);
    claim_release(job->directory, frame, &taken, !written);
    return written;
}

/* The frames that this task has finished are whole; others may still be drawn. */
static int end_frames(render_job *job)
{
    if (!frame_writer_wait(&job->writer, job->error, sizeof job->error))
        return stop_failed(job);
    if (!job->gave_up)
        return EXIT_OK;
    options_complain("render", "%u frames that failed %d times are missing; see virga farm --status %s", job->gave_up,
                     CLAIM_MAX_FAILURES, job->directory);
    return EXIT_GAVE_UP;
}

/* Whether the frame is to be drawn here. */
static bool is_ours(render_job *job, uint32_t frame)
{
    return !render_is_there(job, frame) && (!render_is_worker(job) || workers_take(&job->workers, job->worker, frame));
}

/* Worker 0 writes all checkpoints, also those of frames that others have drawn behind its last one. */
static bool step_to_last_checkpoint(render_job *job)
{
    uint32_t last = job->frames[1];
    while (render_is_there(job, last))
        last--;
    return !render_is_worker(job) || !job->how.checkpoint_every || step_before(job, last + 1);
}

/* The parent of workers shows a bar for all of them. */
static void show_frame(const render_job *job, progress *bar, const char *note)
{
    if (!render_is_worker(job))
        progress_step(bar, note);
}

static int draw_frames(render_job *job, progress *bar)
{
    for (uint32_t frame = job->frames[0]; frame <= job->frames[1]; frame++) {
        const char *left_out = "(there already)";
        if (is_ours(job, frame)) {
            left_out = NULL;
            const bool stepped =
                (!is_behind_gap(job, frame) || start_from_checkpoint(job, frame)) && step_before(job, frame);
            if (stepped && is_stopped(job)) {
                progress_end(bar);
                return stop_interrupted(job, frame);
            }
            if (!stepped || !write_claimed(job, frame, &left_out)) {
                progress_end(bar);
                return stop_failed(job);
            }
        }
        show_frame(job, bar, left_out);
    }
    progress_end(bar);
    return step_to_last_checkpoint(job) ? end_frames(job) : stop_failed(job);
}

static int render_frames(render_job *job)
{
    progress bar;
    const bool any = render_count_missing(job) > 0;
    if (any && !start_from_checkpoint(job, render_first_missing(job)))
        return stop_failed(job);
    if (any && !step_preroll(job))
        return is_stopped(job) ? stop_interrupted(job, job->frames[0]) : stop_failed(job);
    if (render_is_worker(job))
        workers_drawing(&job->workers);
    progress_begin(&bar, "frame", job->frames[1] - job->frames[0] + 1);
    return draw_frames(job, &bar);
}

static void note_written(void *user, uint32_t frame)
{
    render_job *job = user;
    if (render_is_worker(job))
        workers_wrote(&job->workers, frame);
}

/* What draws: this process alone, or one of several. */
int render_here(render_job *job)
{
    char processes[64] = "";
    if (!shot_open(&job->shot, job->scene, &job->how, job->error, sizeof job->error))
        return render_stop_early(job, job->shot.input_wrong ? EXIT_USAGE : EXIT_FAILED);
    file_clean(job->directory);
    int code;
    if ((!job->simulate && !frame_writer_open(&job->writer, &job->shot, job->directory, job->layers, job->preview,
                                              job->picture, job->error, sizeof job->error)) ||
        !render_open_stats(job)) {
        code = render_stop_early(job, EXIT_FAILED);
    } else {
        job->writer.on_written = note_written;
        job->writer.user = job;
        if (render_is_worker(job))
            snprintf(processes, sizeof processes, "%u processes, ", job->workers.count);
        fprintf(stderr, "%s, %sframes %u to %u, %u x %u, %u sample%s\n", job->shot.info.name, processes, job->frames[0],
                job->frames[1], job->how.width, job->how.height, job->how.samples, job->how.samples == 1 ? "" : "s");
        code = render_frames(job);
    }
    frame_writer_close(&job->writer);
    shot_close(&job->shot);
    return code;
}
