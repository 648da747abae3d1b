/* workers.h - several processes draw the frames of one render, each with one thread of software Vulkan. Each steps the
 * whole simulation, and draws the frames that no other draws. Two such processes give more frames in a second than one
 * with two threads, because software Vulkan records commands and sorts triangles by one thread alone.
 *
 * The parent process opens no device. It begins the workers, shows progress, and collects the lines of statistics in
 * the order of frames. A worker is this program with the same arguments: a process that is a copy would lack the
 * threads of libraries, which some of them wait for. What all share is a piece of memory, the board. A worker ends with
 * its parent. */
#ifndef VIRGA_TOOL_WORKERS_H
#define VIRGA_TOOL_WORKERS_H

#include "jsonl.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/types.h>

#define WORKERS_MAX 64

struct workers_board;

typedef struct workers {
    uint32_t count;
    uint32_t first, last; /* frames */
    struct workers_board *board;
    size_t board_bytes;
    int board_file;          /* in memory */
    off_t read[WORKERS_MAX]; /* (parent) bytes that it has read of a worker's lines of statistics */
    pid_t pids[WORKERS_MAX]; /* (parent) 0: has ended */
    uint32_t next_line;      /* (parent) frame whose line is the next one for stats.jsonl */
} workers;

/* The number of processes that this machine's processors and free memory are good for, with pictures of that many
 * pixels: 1 to 8. */
uint32_t workers_default(uint64_t pixels);

/* Shares the processors out among `count` processes that begin after it, where the user has not: software Vulkan reads
 * LP_NUM_THREADS. With one processor it gets no thread of its own, which is quickest. */
void workers_share_processors(uint32_t count);

/* ---- in the parent, before any device is opened there */

/* Whether the device of that name (NULL: the best) is software Vulkan. False also where there is none. Asks this
 * program in a process of its own. */
bool workers_on_software(const char *device);

/* `there` (may be NULL): frames, from `first` on, that need not be drawn. `scene_hash`: what workers must have, too. */
bool workers_open(workers *w, uint32_t count, uint32_t first, uint32_t last, const bool *there, uint64_t scene_hash,
                  char *error, size_t error_size);

/* Begins the processes, with arguments as main has them. Where one can not be begun, that is as if it had failed. */
void workers_begin(workers *w, char *const *argv);

/* Accepts one that is all zero. */
void workers_close(workers *w);

/* ---- in a worker */

/* Called first by a program that may be a worker: its number from 0 on; -1: it is none. Ends the program where it was
 * only asked for its device. */
int workers_join(workers *w);

/* The worker has read what the parent has read. False, and a line in `error`: it has become another scene. Worker 0 is
 * heard from now on. */
bool workers_agree(workers *w, int worker, uint64_t scene_hash, char *error, size_t error_size);

/* Whether a frame was there before. */
bool workers_was_there(const workers *w, uint32_t frame);

/* Whether it shall end: the parent was interrupted, or another worker has failed. */
bool workers_stopped(const workers *w);

/* It has stepped through the pre-roll. */
void workers_drawing(workers *w);

/* Takes a frame, if no other has it. */
bool workers_take(workers *w, int worker, uint32_t frame);

/* The files of a frame that it took are whole. */
void workers_wrote(workers *w, uint32_t frame);

/* The path of its file with lines of statistics. */
void workers_lines_path(const workers *w, int worker, char *path, size_t size);

/* It ends with an exit code that is not 0; the parent prints why. The others are stopped. `keeps`: frames that are
 * whole stay in the folder, which the parent says too. */
void workers_fail(workers *w, int worker, int code, bool keeps, const char *reason);

/* ---- in the parent */

/* Asks all to end after their current frame. */
void workers_stop(workers *w);

/* Waits a moment. False: all have ended. */
bool workers_wait(workers *w);

/* Whether one has begun to draw. */
bool workers_are_drawing(const workers *w);

/* Frames that are whole, without those that were there before. */
uint32_t workers_written(const workers *w);

/* The first frame that is neither whole nor was there before; last + 1: none. */
uint32_t workers_first_missing(const workers *w);

/* Adds the lines of whole frames to a file, in the order of frames: up to the first frame that is not whole; with
 * `all`, those behind it too. */
bool workers_collect(workers *w, bool all, jsonl *to, char *error, size_t error_size);

/* The exit code of the first that has failed, with its reason; 0: none has. */
int workers_failed(const workers *w, bool *keeps, const char **reason);

#endif
