/* core/log.c - see log.h. */
#include "core/log.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void virga_log_write(const virga_log *log, virga_log_level level, virga_log_id id, const char *format, ...)
{
    if (log == NULL || log->fn == NULL) {
        return;
    }
    char text[VIRGA_LOG_LINE];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (length < 0) {
        return;
    }
    if ((size_t)length >= sizeof text) {
        memcpy(text + sizeof text - 4, "...", 4);
    }
    log->fn(log->user, level, id, text);
}
