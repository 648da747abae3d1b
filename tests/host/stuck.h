/* stuck.h - what each thread of a test was doing when the test's time was over. A test that hangs once in hundreds of
 * runs cannot be looked at afterwards.
 *
 * `meson test` sends SIGTERM at the end of a test's time. Then each thread, those of software Vulkan too, writes its
 * name, its state and its processor time to stderr, and its stack unless it blocks signals, as Mesa's own do. Then the
 * test exits. Nothing here is for use in signal handlers, but the process would be killed anyway.
 */
#ifndef VIRGA_TESTS_STUCK_H
#define VIRGA_TESTS_STUCK_H

#include <dirent.h>
#include <execinfo.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

#define STUCK_FRAMES 48

static volatile sig_atomic_t stuck_written;

static inline void stuck_write_stack(int number)
{
    void *frames[STUCK_FRAMES];
    (void)number;
    backtrace_symbols_fd(frames, backtrace(frames, STUCK_FRAMES), STDERR_FILENO);
    stuck_written = 1;
}

/* Name, state and times: fields 2, 3, 14 and 15 of the line, see proc(5). */
static inline void stuck_write_thread(const char *id)
{
    char path[64], line[512] = "";
    snprintf(path, sizeof path, "/proc/self/task/%.16s/stat", id);
    FILE *file = fopen(path, "r");
    const char *rest = file && fgets(line, sizeof line, file) ? strrchr(line, ')') : NULL;
    unsigned long user = 0, system = 0;
    char state = '?';
    if (rest)
        sscanf(rest, ") %c %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %lu %lu", &state, &user, &system);
    if (file)
        fclose(file);
    const double tick_s = 1 / (double)sysconf(_SC_CLK_TCK);
    fprintf(stderr, "thread %.*s: state %c, %.2f s of its own, %.2f s in the kernel\n",
            rest ? (int)(rest + 1 - line) : 1, rest ? line : "?", state, (double)user * tick_s,
            (double)system * tick_s);
}

static inline void stuck_write(int number)
{
    DIR *threads = opendir("/proc/self/task");
    (void)number;
    fprintf(stderr, "out of time; what each thread does:\n");
    for (const struct dirent *entry; threads && (entry = readdir(threads));) {
        if (entry->d_name[0] == '.')
            continue;
        stuck_write_thread(entry->d_name);
        stuck_written = 0;
        syscall(SYS_tgkill, getpid(), (pid_t)atoi(entry->d_name), SIGUSR2);
        for (int i = 0; i < 100 && !stuck_written; i++) /* a second at most */
            usleep(10000);
    }
    _exit(1);
}

static inline void stuck_watch(void)
{
    void *frames[1];
    backtrace(frames, 1); /* the first call loads a library */
    signal(SIGUSR2, stuck_write_stack);
    signal(SIGTERM, stuck_write);
}

#endif
