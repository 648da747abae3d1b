/* progress.h - progress of long work: a bar with the remaining time on a terminal, else plain lines; and Ctrl-C. */
#ifndef VIRGA_TOOL_PROGRESS_H
#define VIRGA_TOOL_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct progress {
    const char *what; /* "frame" */
    uint32_t total, done;
    double began_s, said_s;
    bool terminal;
} progress;

void progress_begin(progress *p, const char *what, uint32_t total);

/* One more is done. `note` (may be NULL) is shown after the bar. */
void progress_step(progress *p, const char *note);
void progress_end(progress *p);

/* Seconds of a monotonic clock. */
double progress_now(void);

/* Ctrl-C and SIGTERM: the first requests a stop after the current frame, the second ends the program at once. */
void interrupt_install(void);
bool interrupt_requested(void);

#endif
