/* progress.c - progress on standard error, and interruption. */
#include "progress.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define BAR_WIDTH    32
#define LINE_EVERY_S 5.0 /* if standard error is not a terminal */

double progress_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void progress_begin(progress *p, const char *what, uint32_t total)
{
    *p = (progress){.what = what, .total = total, .began_s = progress_now(), .terminal = isatty(STDERR_FILENO)};
    p->said_s = p->began_s;
}

static void write_time(double seconds, char *text, size_t size)
{
    const unsigned s = (unsigned)(seconds + 0.5);
    if (s >= 3600)
        snprintf(text, size, "%u:%02u:%02u", s / 3600, s / 60 % 60, s % 60);
    else
        snprintf(text, size, "%u:%02u", s / 60, s % 60);
}

void progress_step(progress *p, const char *note)
{
    p->done++;
    const double now = progress_now(), passed = now - p->began_s;
    const double left = passed / p->done * (p->total - p->done);
    char left_text[32];
    write_time(left, left_text, sizeof left_text);
    if (p->terminal) {
        char bar[BAR_WIDTH + 1];
        const uint32_t full = p->total ? p->done * BAR_WIDTH / p->total : BAR_WIDTH;
        memset(bar, '.', BAR_WIDTH);
        memset(bar, '#', full);
        bar[BAR_WIDTH] = 0;
        fprintf(stderr, "\r[%s] %s %u of %u, %s left %s\033[K", bar, p->what, p->done, p->total, left_text,
                note ? note : "");
        fflush(stderr);
    } else if (p->done == p->total || now - p->said_s >= LINE_EVERY_S) {
        fprintf(stderr, "%s %u of %u, %s left %s\n", p->what, p->done, p->total, left_text, note ? note : "");
        p->said_s = now;
    }
}

void progress_end(progress *p)
{
    if (p->terminal && p->done)
        fputc('\n', stderr);
}

static volatile sig_atomic_t requested;

static void on_signal(int signal_number)
{
    if (requested) {
        signal(signal_number, SIG_DFL);
        raise(signal_number);
        return;
    }
    requested = 1;
    static const char line[] = "\nvirga: stopping after the current frame; press again to stop at once\n";
    if (write(STDERR_FILENO, line, sizeof line - 1) < 0)
        return;
}

void interrupt_install(void)
{
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
    /* A file that reaches the size limit is an error of the write, as a full disk is. It should not kill the program.
     * */
    signal(SIGXFSZ, SIG_IGN);
}

bool interrupt_requested(void)
{
    return requested;
}
