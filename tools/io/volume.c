/* volume.c - loads the module of OpenVDB with the first volume: the library is large, and few runs need it. */
#include "volume_module.h"

#include "file.h"

#include <dlfcn.h>
#include <stdlib.h>

#define TEXT_OF(name) #name
#define SYMBOL(name)  TEXT_OF(name)

bool volume_is_there(void)
{
    return true;
}

/* The module stays loaded until the program ends. */
static volume_encoder *load(char *error, size_t error_size)
{
    void *module = dlopen(VOLUME_MODULE, RTLD_NOW | RTLD_LOCAL);
    void *symbol = module ? dlsym(module, SYMBOL(VOLUME_ENCODE)) : NULL;
    if (!symbol)
        file_fail(error, error_size, "volumes need OpenVDB, which cannot be loaded: %s", dlerror());
    return (volume_encoder *)symbol;
}

bool volume_write(const char *path, const volume *v, char *error, size_t error_size)
{
    char reason[512];
    void *data = NULL;
    size_t size = 0;
    file_writer file;
    volume_encoder *encode = load(error, error_size);
    if (!encode)
        return false;
    if (!encode(v, &data, &size, reason, sizeof reason))
        return file_fail(error, error_size, "cannot write %s: %s", path, reason);
    bool ok = file_start(&file, path, error, error_size);
    if (ok) {
        file_write(&file, data, size);
        ok = file_finish(&file, error, error_size);
    }
    free(data);
    return ok;
}
