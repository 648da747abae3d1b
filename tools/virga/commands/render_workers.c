/* render_workers.c - has several processes draw the frames of `virga render`, and follows them. */
#include "commands/render_job.h"
#include "effect.h"
#include "progress.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Without --jobs one process draws fewer frames, fewer pixels of sub-frames, or after more steps for a frame. A second
 * process takes ten seconds of a processor to begin, and saves half a second for each 640 x 360 frame of 4 samples. */
#define MIN_DEFAULT_FRAMES 4
#define MIN_DEFAULT_PIXELS 16e6
#define MAX_DEFAULT_STEPS  4.0

static bool has_slow_steps(const scene_file *scene)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->has_slow_steps && tool_effects[i]->has_slow_steps(scene))
            return true;
    return false;
}

/* Each process loads the scene, and steps the simulation through all frames: that is lost where little is drawn. */
uint32_t render_choose_jobs(const render_job *job)
{
    const uint32_t missing = render_count_missing(job);
    const scene_frames *frames = &job->scene->frames;
    const uint64_t pixels = (uint64_t)job->how.width * job->how.height;
    if (job->jobs || !missing)
        return missing && job->jobs < missing ? job->jobs : missing ? missing : 1;
    const double steps = frames->preroll_s * frames->fps + render_first_missing(job) - frames->first;
    const double drawn = (double)missing * (double)pixels * job->how.samples;
    if (job->task || job->simulate || getenv("LP_NUM_THREADS") || missing < MIN_DEFAULT_FRAMES ||
        drawn < MIN_DEFAULT_PIXELS || steps > MAX_DEFAULT_STEPS * missing || has_slow_steps(job->scene) ||
        !workers_on_software(job->how.device))
        return 1;
    const uint32_t jobs = workers_default(pixels);
    return jobs < missing ? jobs : missing;
}

/* The parent's own error ends the workers, and is said instead of theirs. */
static void end_by_parent(render_job *job, bool *failed)
{
    if (!*failed)
        workers_stop(&job->workers);
    *failed = true;
}

/* Statistics and the bar, as far as the workers are. */
static void follow_frames(render_job *job, progress *bar, bool all, bool *failed)
{
    workers *w = &job->workers;
    const uint32_t there = job->frames[1] - job->frames[0] + 1 - render_count_missing(job);
    if (!bar->what) {
        progress_begin(bar, "frame", job->frames[1] - job->frames[0] + 1);
        for (uint32_t i = 0; i < there; i++)
            progress_step(bar, "(there already)");
        if (job->stats && !render_open_stats(job))
            end_by_parent(job, failed);
    }
    while (bar->done < there + workers_written(w))
        progress_step(bar, NULL);
    if (job->stats_open && !*failed && !workers_collect(w, all, &job->stats_file, job->error, sizeof job->error))
        end_by_parent(job, failed);
}

static int follow_workers(render_job *job)
{
    workers *w = &job->workers;
    progress bar = {0};
    bool failed = false, keeps = true;
    const char *reason = job->error;
    while (workers_wait(w)) {
        if (interrupt_requested())
            workers_stop(w);
        if (workers_are_drawing(w))
            follow_frames(job, &bar, false, &failed);
    }
    if (workers_are_drawing(w))
        follow_frames(job, &bar, true, &failed);
    progress_end(&bar);
    const int code = failed ? EXIT_FAILED : workers_failed(w, &keeps, &reason);
    if (code && keeps)
        options_complain("render", "%s; %u finished frames are kept in %s", reason, workers_written(w), job->directory);
    else if (code)
        options_complain("render", "%s", reason);
    if (code || workers_first_missing(w) > job->frames[1])
        return code;
    options_complain("render", "interrupted: %u frames are in %s; --resume goes on with frame %u", workers_written(w),
                     job->directory, workers_first_missing(w));
    return EXIT_INTERRUPTED;
}

/* They have the same arguments. */
int render_by_workers(render_job *job, uint32_t count)
{
    workers *w = &job->workers;
    char **argv = calloc((size_t)job->argument_count + 3, sizeof *argv);
    if (!argv)
        return EXIT_FAILED;
    argv[0] = "virga";
    argv[1] = "render";
    memcpy(argv + 2, job->arguments, (size_t)job->argument_count * sizeof *argv);
    int code = EXIT_FAILED;
    if (workers_open(w, count, job->frames[0], job->frames[1], job->there, scene_file_hash(job->scene), job->error,
                     sizeof job->error)) {
        workers_begin(w, argv);
        code = follow_workers(job);
    } else {
        options_complain("render", "%s", job->error);
    }
    free(argv);
    return code;
}

int render_as_worker(render_job *job)
{
    if (!workers_agree(&job->workers, job->worker, scene_file_hash(job->scene), job->error, sizeof job->error))
        return render_stop_early(job, EXIT_FAILED);
    if (job->worker > 0)
        job->how.checkpoint_every = 0;
    return render_here(job);
}
