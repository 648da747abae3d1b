/* render_job.h - what the files of `virga render` share: render.c reads the command line, render_frames.c draws,
 * render_workers.c has several processes draw. */
#ifndef VIRGA_TOOL_RENDER_JOB_H
#define VIRGA_TOOL_RENDER_JOB_H

#include "commands/commands.h"
#include "frame/workers.h"
#include "frame/writer.h"
#include "jsonl.h"
#include "options.h"
#include "shot/shot.h"

typedef struct render_job {
    options parsed;
    scene_file *scene;
    shot shot;
    shot_options how;
    const char *directory, *task; /* task: of --claim, or NULL */
    uint32_t frames[2], layers;
    picture_format picture; /* bits 0: none */
    bool points, meshes, volumes, stats, preview, resume, simulate;
    jsonl stats_file;
    bool stats_open;
    bool *there; /* (resume) of each frame from frames[0] on: it need not be rendered */
    frame_writer writer;
    uint32_t gave_up;
    uint32_t jobs; /* of --jobs; 0: not given */
    workers workers;
    int worker;       /* the number of this process; -1: it is the parent, or draws alone */
    char **arguments; /* of the command */
    int argument_count;
    char error[1024];
} render_job;

/* One of several processes draws what is asked of it. */
static inline bool render_is_worker(const render_job *job)
{
    return job->worker >= 0;
}

/* Draws, in this process. Returns the exit code, and has said why. */
int render_here(render_job *job);

/* The number of processes to draw with. */
uint32_t render_choose_jobs(const render_job *job);

/* Has that many processes draw. */
int render_by_workers(render_job *job, uint32_t count);

/* Draws as one of them. */
int render_as_worker(render_job *job);

/* ---- of render_frames.c */

/* Whether a frame need not be drawn. */
bool render_is_there(const render_job *job, uint32_t frame);
uint32_t render_count_missing(const render_job *job);
uint32_t render_first_missing(const render_job *job);

/* Opens the file for statistics, if they are asked for. False: job->error says why not. */
bool render_open_stats(render_job *job);

/* Says job->error, or has the parent say it. Nothing was drawn. Returns the code. */
int render_stop_early(render_job *job, int code);

#endif
