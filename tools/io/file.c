/* file.c - temporary name, write, rename. */
#include "file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

bool file_fail(char *error, size_t error_size, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (error && error_size)
        vsnprintf(error, error_size, format, arguments);
    va_end(arguments);
    return false;
}

bool file_error(char *error, size_t error_size, const char *what, const char *path, int code)
{
    char reason[128] = "";
    return file_fail(error, error_size, "%s %s: %s", what, path, strerror_r(code, reason, sizeof reason));
}

/* The name does not grow with the target's, so a target name of full length still has a temporary one. */
static char *temporary_name(const char *path)
{
    static atomic_uint count;
    const char *slash = strrchr(path, '/');
    int folder = slash ? (int)(slash - path) + 1 : 0;
    char *name = NULL;
    if (asprintf(&name, "%.*s.virga-%ld-%u.tmp", folder, path, (long)getpid(), atomic_fetch_add(&count, 1)) < 0)
        return NULL;
    return name;
}

static bool is_temporary_name(const char *name)
{
    long process;
    unsigned number;
    int length = 0;
    return sscanf(name, ".virga-%ld-%u.tmp%n", &process, &number, &length) == 2 && length && !name[length];
}

/* Locks a new file until it is closed. False if file_clean has removed it before that. */
static bool hold(int descriptor)
{
    struct stat info;
    while (flock(descriptor, LOCK_EX) != 0 && errno == EINTR)
        ; /* on a file system without locks, file_clean gets none either and keeps the file */
    return fstat(descriptor, &info) == 0 && info.st_nlink > 0;
}

/* A pipe or a device must not be replaced by a regular file. */
static bool written_in_place(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && !S_ISREG(info.st_mode);
}

static void release(file_writer *file)
{
    free(file->path);
    free(file->temporary);
    *file = (file_writer){.descriptor = -1};
}

bool file_start(file_writer *file, const char *path, char *error, size_t error_size)
{
    *file = (file_writer){.descriptor = -1, .path = strdup(path)};
    bool in_place = written_in_place(path);
    if (file->path && in_place) {
        file->descriptor = open(path, O_WRONLY | O_CLOEXEC);
    } else if (file->path) {
        /* A killed process with the same id may have left a file with this name. */
        for (int tries = 0; tries < 100 && file->descriptor < 0; tries++) {
            free(file->temporary);
            file->temporary = temporary_name(path);
            if (!file->temporary)
                break;
            file->descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
            if (file->descriptor < 0 && errno != EEXIST)
                break;
            if (file->descriptor >= 0 && !hold(file->descriptor)) {
                close(file->descriptor);
                file->descriptor = -1;
            }
        }
    }
    if (file->descriptor >= 0)
        return true;
    int code = file->path && (in_place || file->temporary) ? errno : ENOMEM;
    release(file);
    return file_error(error, error_size, "cannot write", path, code);
}

static bool fail(file_writer *file, int code)
{
    if (!file->failure)
        file->failure = code;
    return false;
}

/* Writes at an offset, or, if it is NULL, appends: a pipe has no offsets. */
static bool write_all(file_writer *file, const char *data, size_t size, const uint64_t *at)
{
    for (size_t done = 0; done < size;) {
        const ssize_t count = at ? pwrite(file->descriptor, data + done, size - done, (off_t)(*at + done))
                                 : write(file->descriptor, data + done, size - done);
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            return fail(file, count < 0 ? errno : ENOSPC);
        done += (size_t)count;
    }
    return true;
}

bool file_write(file_writer *file, const void *data, size_t size)
{
    return !file->failure && write_all(file, data, size, NULL);
}

bool file_write_at(file_writer *file, const void *data, size_t size, uint64_t offset)
{
    return write_all(file, data, size, &offset);
}

bool file_finish(file_writer *file, char *error, size_t error_size)
{
    /* Some file systems report a full disk only on close. The lock stays until the file has its name. */
    int lock = fcntl(file->descriptor, F_DUPFD_CLOEXEC, 0);
    if (close(file->descriptor) != 0)
        fail(file, errno);
    if (!file->failure && file->temporary && rename(file->temporary, file->path) != 0)
        fail(file, errno);
    if (file->failure) {
        file_error(error, error_size, "cannot write", file->path, file->failure);
        if (file->temporary)
            unlink(file->temporary);
    }
    if (lock >= 0)
        close(lock);
    bool ok = !file->failure;
    release(file);
    return ok;
}

void file_abandon(file_writer *file)
{
    close(file->descriptor);
    if (file->temporary)
        unlink(file->temporary);
    release(file);
}

/* The writer of a file holds its lock. The file is removed under the lock, so that no new writer can open it meanwhile.
 * */
static bool clean_one(int folder, const char *name)
{
    struct stat info;
    int descriptor = openat(folder, name, O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return false;
    bool removed = fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode) &&
                   flock(descriptor, LOCK_EX | LOCK_NB) == 0 && unlinkat(folder, name, 0) == 0;
    close(descriptor);
    return removed;
}

bool file_make_folder(const char *path)
{
    char part[4096];
    if (strlen(path) >= sizeof part) {
        errno = ENAMETOOLONG;
        return false;
    }
    strcpy(part, path);
    for (char *slash = strchr(part + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        if (mkdir(part, 0777) && errno != EEXIST)
            return false;
        *slash = '/';
    }
    return !mkdir(part, 0777) || errno == EEXIST;
}

uint32_t file_clean(const char *folder)
{
    uint32_t count = 0;
    DIR *list = opendir(folder);
    for (struct dirent *entry; list && (entry = readdir(list));)
        if (is_temporary_name(entry->d_name) && clean_one(dirfd(list), entry->d_name))
            count++;
    if (list)
        closedir(list);
    return count;
}

/* Reads until the end, because a pipe has no size. */
static bool read_all(int descriptor, size_t limit, char **data, size_t *size, int *code)
{
    size_t room = 0;
    *size = 0;
    for (;;) {
        if (room - *size < 2) {
            char *grown = realloc(*data, room = room ? room * 2 : 65536);
            if (!grown)
                return *code = ENOMEM, false;
            *data = grown;
        }
        ssize_t done = read(descriptor, *data + *size, room - *size - 1);
        if (done < 0 && errno == EINTR)
            continue;
        if (done < 0)
            return *code = errno, false;
        if (done == 0)
            break;
        *size += (size_t)done;
        if (*size > limit)
            return *code = EFBIG, false;
    }
    (*data)[*size] = 0;
    return true;
}

bool file_read(const char *path, size_t limit, void **data, size_t *size, char *error, size_t error_size)
{
    char *bytes = NULL;
    int code = 0;
    *data = NULL;
    *size = 0;
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return file_error(error, error_size, "cannot read", path, errno);
    bool ok = read_all(descriptor, limit, &bytes, size, &code);
    close(descriptor);
    if (!ok) {
        free(bytes);
        *size = 0;
        return file_error(error, error_size, "cannot read", path, code);
    }
    *data = bytes;
    return true;
}
