/* core/log.h - writes one line to the host's log callback. Internal. */
#ifndef VIRGA_CORE_LOG_H
#define VIRGA_CORE_LOG_H

#include <virga/base.h>

/* The longest line in bytes, with its zero. A longer line is cut and ends in "...". */
#define VIRGA_LOG_LINE 512

typedef struct virga_log {
    virga_log_fn fn; /* NULL: silent */
    void *user;
} virga_log;

#if defined(__GNUC__)
#define VIRGA_PRINTF(text, arguments) __attribute__((format(printf, text, arguments)))
#else
#define VIRGA_PRINTF(text, arguments)
#endif

/* Formats into a buffer on the stack, so it also works when memory has run out. `log` may be NULL. */
void virga_log_write(const virga_log *log, virga_log_level level, virga_log_id id, const char *format, ...)
    VIRGA_PRINTF(4, 5);

#endif
