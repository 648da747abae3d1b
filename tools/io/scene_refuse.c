/* scene_refuse.c - errors about values of a loaded scene. */
#include "scene_document.h"
#include "scene_file.h"

#include <stdarg.h>
#include <stdio.h>

bool scene_file_refuse(const scene_file *scene, const char *key, char *error, size_t error_size, const char *format,
                       ...)
{
    char text[1024];
    scene_document *source = scene->source;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    source->error = error;
    source->error_size = error_size;
    return scene_document_fail(source, scene_document_find(source, key), "%s: %s", key, text);
}
