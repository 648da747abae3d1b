/* workers.c - see workers.h. */
#include "frame/workers.h"

#include "file.h"
#include "frame/machine.h"
#include "host.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define MAX_DEFAULT     8
#define SCENE_BYTES     (1200.0 * 1048576) /* in one process, without pictures; street.yaml takes 770 MiB */
#define BYTES_PER_PIXEL 640.0 /* of all layers, their sums, and frames on their way to the disk; measured */
#define WAIT_NS         20000000

enum { FRAME_FREE, FRAME_BEGUN, FRAME_WRITTEN, FRAME_THERE };

/* How a worker has ended. */
typedef struct worker_end {
    atomic_int code; /* set last */
    bool keeps;
    char reason[1024];
} worker_end;

typedef struct worker_frame {
    atomic_int state;
    int worker; /* that has taken it */
} worker_frame;

/* What a worker is told by the environment: the board's descriptor and its number, "5,0"; or, of a process that is only
 * to find a device, "device" or "device=NAME". */
#define TOLD "VIRGA_RENDER_WORKER"

struct workers_board {
    uint32_t count, first, last;
    uint64_t scene_hash;
    pid_t parent;
    int parent_stderr;         /* descriptors are the same in all processes */
    int lines[WORKERS_MAX];    /* of each worker: a file in memory with its lines of statistics */
    int messages[WORKERS_MAX]; /* of each: a file in memory with what it writes to standard error */
    atomic_bool stop, drawing;
    worker_end ends[]; /* of each worker; behind them the frames */
};

static worker_frame *frame_of(const workers *w, uint32_t frame)
{
    return (worker_frame *)(w->board->ends + w->count) + (frame - w->first);
}

/* ---- how many */

uint32_t workers_default(uint64_t pixels)
{
    const double processors = machine_processors("");
    const double fit = (double)machine_free_bytes("") / (SCENE_BYTES + BYTES_PER_PIXEL * (double)pixels);
    const double count = fit < processors ? fit : processors;
    return count < 1 ? 1 : count > MAX_DEFAULT ? MAX_DEFAULT : (uint32_t)count;
}

void workers_share_processors(uint32_t count)
{
    char text[32];
    const uint32_t share = machine_processors("") / count;
    snprintf(text, sizeof text, "%u", share > 1 ? share : 0);
    setenv("LP_NUM_THREADS", text, false);
}

/* ---- processes */

/* Begins this program again, with an environment that tells it what it is. Standard error goes to a descriptor, -1: to
 * nowhere. Ctrl-C reaches all processes of a terminal, and some farms send SIGTERM to all of a job: the parent hears
 * them, and the board tells the workers. Returns 0, or the reason why not. */
static int begin_process(const char *told, char *const *argv, int to, pid_t *child)
{
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGINT);
    sigaddset(&blocked, SIGTERM);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setsigmask(&attributes, &blocked);
    if (to >= 0)
        posix_spawn_file_actions_adddup2(&actions, to, STDERR_FILENO);
    else
        posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    setenv(TOLD, told, true);
    const int code = posix_spawn(child, "/proc/self/exe", &actions, &attributes, argv, environ);
    unsetenv(TOLD);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return code;
}

bool workers_on_software(const char *device)
{
    int status = -1;
    pid_t child = 0;
    char told[600];
    char *const argv[] = {"virga", "render", NULL};
    snprintf(told, sizeof told, "device%s%s", device ? "=" : "", device ? device : "");
    if (begin_process(told, argv, -1, &child))
        return false;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    return status == 0;
}

static bool is_software(const char *device)
{
    host_instance instance;
    host_device_info infos[HOST_MAX_DEVICES];
    uint32_t index;
    char ignored[512];
    if (!host_instance_create(&instance, false, ignored, sizeof ignored))
        return false;
    const uint32_t count = host_devices_list(&instance, infos, HOST_MAX_DEVICES);
    const bool picked = host_device_pick(infos, count, device, &index, ignored, sizeof ignored);
    host_instance_destroy(&instance);
    return picked && infos[index].type == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

/* ---- opening and closing */

/* Not closed in the processes that begin later. */
static int memory_file(const char *name)
{
    return memfd_create(name, 0);
}

static bool open_files(struct workers_board *board)
{
    memset(board->lines, -1, sizeof board->lines);
    memset(board->messages, -1, sizeof board->messages);
    board->parent_stderr = dup(STDERR_FILENO);
    for (uint32_t i = 0; i < board->count; i++) {
        board->lines[i] = memory_file("virga-lines");
        board->messages[i] = memory_file("virga-messages");
        if (board->lines[i] < 0 || board->messages[i] < 0)
            return false;
    }
    return true;
}

static bool map_board(workers *w, size_t bytes)
{
    w->board_bytes = bytes;
    void *memory = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, w->board_file, 0);
    w->board = memory == MAP_FAILED ? NULL : memory;
    return w->board;
}

/* All zero: every frame is free. */
static bool make_board(workers *w)
{
    const size_t frames = (size_t)w->last - w->first + 1;
    const size_t bytes = sizeof *w->board + w->count * sizeof(worker_end) + frames * sizeof(worker_frame);
    w->board_file = memory_file("virga-board");
    return w->board_file >= 0 && !ftruncate(w->board_file, (off_t)bytes) && map_board(w, bytes);
}

bool workers_open(workers *w, uint32_t count, uint32_t first, uint32_t last, const bool *there, uint64_t scene_hash,
                  char *error, size_t error_size)
{
    *w = (workers){.count = count, .first = first, .last = last, .next_line = first};
    if (!make_board(w)) {
        file_error(error, error_size, "cannot share memory between", "the processes of --jobs", errno);
        workers_close(w);
        return false;
    }
    w->board->count = count;
    w->board->first = first;
    w->board->last = last;
    w->board->scene_hash = scene_hash;
    w->board->parent = getpid();
    for (uint32_t frame = first; there && frame <= last; frame++)
        if (there[frame - first])
            frame_of(w, frame)->state = FRAME_THERE;
    if (open_files(w->board))
        return true;
    file_error(error, error_size, "cannot share files between", "the processes of --jobs", errno);
    workers_close(w);
    return false;
}

static void close_file(int descriptor)
{
    if (descriptor >= 0)
        close(descriptor);
}

void workers_close(workers *w)
{
    for (uint32_t i = 0; w->board && i < w->count; i++) {
        close_file(w->board->lines[i]);
        close_file(w->board->messages[i]);
    }
    if (w->board) {
        close_file(w->board->parent_stderr);
        munmap(w->board, w->board_bytes);
        close_file(w->board_file);
    }
    *w = (workers){0};
}

void workers_begin(workers *w, char *const *argv)
{
    char told[64], reason[256];
    for (uint32_t i = 0; i < w->count; i++) {
        snprintf(told, sizeof told, "%d,%u", w->board_file, i);
        const int code = begin_process(told, argv, w->board->messages[i], &w->pids[i]);
        if (!code)
            continue;
        w->pids[i] = 0;
        file_error(reason, sizeof reason, "cannot begin", "a process of --jobs", code);
        workers_fail(w, (int)i, 1, false, reason);
        return;
    }
}

/* ---- in a worker */

int workers_join(workers *w)
{
    int number;
    struct stat info;
    const char *told = getenv(TOLD);
    if (!told)
        return -1;
    if (!strncmp(told, "device", 6))
        exit(is_software(told[6] ? told + 7 : NULL) ? 0 : 1);
    if (sscanf(told, "%d,%d", &w->board_file, &number) != 2 || number < 0 || number >= WORKERS_MAX ||
        fstat(w->board_file, &info) || (size_t)info.st_size < sizeof *w->board || !map_board(w, (size_t)info.st_size))
        exit(1);
    unsetenv(TOLD);
    w->count = w->board->count;
    w->first = w->board->first;
    w->last = w->board->last;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != w->board->parent)
        exit(1);
    workers_share_processors(w->count);
    return number;
}

bool workers_agree(workers *w, int worker, uint64_t scene_hash, char *error, size_t error_size)
{
    if (scene_hash != w->board->scene_hash) {
        snprintf(error, error_size, "the scene has changed since the render began");
        return false;
    }
    /* What all say is said once. */
    if (!worker)
        dup2(w->board->parent_stderr, STDERR_FILENO);
    return true;
}

bool workers_was_there(const workers *w, uint32_t frame)
{
    return frame_of(w, frame)->state == FRAME_THERE;
}

bool workers_stopped(const workers *w)
{
    return w->board->stop;
}

void workers_drawing(workers *w)
{
    w->board->drawing = true;
}

bool workers_take(workers *w, int worker, uint32_t frame)
{
    int expected = FRAME_FREE;
    worker_frame *taken = frame_of(w, frame);
    if (!atomic_compare_exchange_strong(&taken->state, &expected, FRAME_BEGUN))
        return false;
    taken->worker = worker; /* read once the frame is whole */
    return true;
}

void workers_wrote(workers *w, uint32_t frame)
{
    frame_of(w, frame)->state = FRAME_WRITTEN;
}

void workers_lines_path(const workers *w, int worker, char *path, size_t size)
{
    snprintf(path, size, "/proc/self/fd/%d", w->board->lines[worker]);
}

void workers_fail(workers *w, int worker, int code, bool keeps, const char *reason)
{
    worker_end *end = &w->board->ends[worker];
    end->keeps = keeps;
    snprintf(end->reason, sizeof end->reason, "%s", reason);
    end->code = code;
    workers_stop(w);
}

/* ---- in the parent */

void workers_stop(workers *w)
{
    w->board->stop = true;
}

/* What a worker said that was killed. */
static void print_messages(const workers *w, uint32_t worker)
{
    char block[4096];
    off_t at = 0;
    for (ssize_t got; (got = pread(w->board->messages[worker], block, sizeof block, at)) > 0; at += got)
        fwrite(block, 1, (size_t)got, stderr);
}

static void note_end(workers *w, uint32_t worker, int status)
{
    char reason[256];
    w->pids[worker] = 0;
    if (WIFEXITED(status) && (WEXITSTATUS(status) == 0 || w->board->ends[worker].code))
        return;
    print_messages(w, worker);
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL)
        snprintf(reason, sizeof reason,
                 "one of %u processes was killed, as the system does where memory is full; "
                 "expected a smaller --jobs",
                 w->count);
    else if (WIFSIGNALED(status))
        snprintf(reason, sizeof reason, "one of %u processes ended by signal %d (%s)", w->count, WTERMSIG(status),
                 strsignal(WTERMSIG(status)));
    else
        snprintf(reason, sizeof reason, "one of %u processes ended with code %d", w->count, WEXITSTATUS(status));
    workers_fail(w, (int)worker, 1, true, reason);
}

bool workers_wait(workers *w)
{
    bool any = false;
    const struct timespec moment = {.tv_nsec = WAIT_NS};
    for (uint32_t i = 0; i < w->count; i++) {
        int status = 0;
        if (w->pids[i] && waitpid(w->pids[i], &status, WNOHANG) == w->pids[i])
            note_end(w, i, status);
        any = any || w->pids[i];
    }
    if (any)
        nanosleep(&moment, NULL);
    return any;
}

bool workers_are_drawing(const workers *w)
{
    return w->board->drawing;
}

static int state_of(const workers *w, uint32_t frame)
{
    return frame_of(w, frame)->state;
}

uint32_t workers_written(const workers *w)
{
    uint32_t count = 0;
    for (uint32_t frame = w->first; frame <= w->last; frame++)
        count += state_of(w, frame) == FRAME_WRITTEN;
    return count;
}

uint32_t workers_first_missing(const workers *w)
{
    uint32_t frame = w->first;
    while (frame <= w->last && state_of(w, frame) >= FRAME_WRITTEN)
        frame++;
    return frame;
}

/* The next line of a worker's file, without its end; NULL: there is none. */
static char *next_line(workers *w, int worker, size_t *length)
{
    size_t used = 0, room = 0;
    char *line = NULL;
    for (;;) {
        if (room - used < 4096) {
            char *longer = realloc(line, room += 16384);
            if (!longer)
                break;
            line = longer;
        }
        const ssize_t got = pread(w->board->lines[worker], line + used, 4096, w->read[worker] + (off_t)used);
        if (got <= 0)
            break;
        char *end = memchr(line + used, '\n', (size_t)got);
        if (end) {
            *length = (size_t)(end - line);
            w->read[worker] += (off_t)*length + 1;
            return line;
        }
        used += (size_t)got;
    }
    free(line);
    return NULL;
}

bool workers_collect(workers *w, bool all, jsonl *to, char *error, size_t error_size)
{
    for (; w->next_line <= w->last; w->next_line++) {
        const worker_frame *frame = frame_of(w, w->next_line);
        if (frame->state < FRAME_WRITTEN && !all)
            return true;
        if (frame->state != FRAME_WRITTEN)
            continue;
        size_t length = 0;
        char *line = next_line(w, frame->worker, &length);
        if (!line)
            return file_error(error, error_size, "cannot read", "the statistics of a process of --jobs", ENODATA);
        const bool added = jsonl_add_line(to, line, length, error, error_size);
        free(line);
        if (!added)
            return false;
    }
    return true;
}

int workers_failed(const workers *w, bool *keeps, const char **reason)
{
    for (uint32_t i = 0; i < w->count; i++) {
        const worker_end *end = &w->board->ends[i];
        if (!end->code)
            continue;
        *keeps = end->keeps;
        *reason = end->reason;
        return end->code;
    }
    return 0;
}
