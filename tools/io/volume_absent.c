/* volume_absent.c - no volumes: for builds without OpenVDB. */
#include "volume.h"

#include "file.h"

bool volume_is_there(void)
{
    return false;
}

bool volume_write(const char *path, const volume *v, char *error, size_t error_size)
{
    (void)v;
    return file_fail(error, error_size, "cannot write %s: this program was built without OpenVDB", path);
}
