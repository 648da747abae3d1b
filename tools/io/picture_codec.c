/* picture_codec.c - loads the module of OpenImageIO with the first picture that needs it. OpenImageIO needs some 250
 * other libraries, which take ten times as long to load as the rest of the program. */
#include "picture_codec.h"

#include "picture_codec_table.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>

#define TEXT_OF(name) #name
#define SYMBOL(name)  TEXT_OF(name)

static pthread_once_t once = PTHREAD_ONCE_INIT;
static const picture_codec_table *codec; /* NULL: `problem` says why */
static char problem[512];

/* The module stays loaded until the program ends. */
static void load(void)
{
    void *module = dlopen(PICTURE_CODEC_MODULE, RTLD_NOW | RTLD_LOCAL);
    codec = module ? dlsym(module, SYMBOL(PICTURE_CODEC_TABLE)) : NULL;
    if (!codec)
        snprintf(problem, sizeof problem, "PNG, JPEG and TIFF need a library that cannot be loaded: %s", dlerror());
}

static const picture_codec_table *loaded(char *reason, size_t reason_size)
{
    pthread_once(&once, load);
    if (!codec)
        snprintf(reason, reason_size, "%s", problem);
    return codec;
}

bool picture_codec_is_there(void)
{
    return true;
}

bool picture_decode(const void *data, size_t size, picture *p, char *reason, size_t reason_size)
{
    const picture_codec_table *with = loaded(reason, reason_size);
    return with && with->decode(data, size, p, reason, reason_size);
}

bool picture_encode(picture_format format, uint32_t width, uint32_t height, const void *samples, void **data,
                    size_t *size, char *reason, size_t reason_size)
{
    const picture_codec_table *with = loaded(reason, reason_size);
    return with && with->encode(format, width, height, samples, data, size, reason, reason_size);
}
