/* claims.c - see claims.h. */
#include "frame/claims.h"

#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void print_path(const char *directory, uint32_t frame, const char *kind, char *path, size_t size)
{
    snprintf(path, size, "%s/farm/frame.%04u.%s", directory, frame, kind);
}

static uint64_t size_of(const char *path)
{
    struct stat info;
    return stat(path, &info) ? 0 : (uint64_t)info.st_size;
}

bool claims_open(const char *directory, char *error, size_t error_size)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/farm", directory);
    return !mkdir(path, 0777) || errno == EEXIST ||
           file_error(error, error_size, "cannot make the folder", path, errno);
}

bool claim_is_drawn(const char *directory, uint32_t frame, double *written_s)
{
    char path[4096];
    struct stat info;
    snprintf(path, sizeof path, "%s/frame.%04u.exr", directory, frame);
    if (stat(path, &info) || !S_ISREG(info.st_mode) || !info.st_size)
        return false;
    if (written_s)
        *written_s = (double)info.st_mtim.tv_sec + 1e-9 * (double)info.st_mtim.tv_nsec;
    return true;
}

uint32_t claim_failures(const char *directory, uint32_t frame)
{
    char path[4096];
    print_path(directory, frame, "failed", path, sizeof path);
    return (uint32_t)size_of(path);
}

/* Locks of fcntl work on shared folders, and end with the process. */
static bool lock(int descriptor)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    return !fcntl(descriptor, F_SETLK, &whole);
}

bool claim_is_busy(const char *directory, uint32_t frame)
{
    char path[4096];
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    print_path(directory, frame, "claim", path, sizeof path);
    const int descriptor = open(path, O_RDWR | O_CLOEXEC);
    if (descriptor < 0)
        return false;
    const bool busy = !fcntl(descriptor, F_GETLK, &whole) && whole.l_type != F_UNLCK;
    close(descriptor);
    return busy;
}

/* Which frame a task is at, for the script around it. It is no loss if that cannot be written. */
static void note_task(const char *directory, const char *task, uint32_t frame)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/farm/task.%s", directory, task);
    FILE *file = fopen(path, "w");
    if (!file)
        return;
    fprintf(file, "%04u\n", frame);
    fclose(file);
}

claim_result claim_take(const char *directory, const char *task, uint32_t frame, claim *taken, char *error,
                        size_t error_size)
{
    if (claim_is_drawn(directory, frame, NULL))
        return CLAIM_THERE;
    if (claim_failures(directory, frame) >= CLAIM_MAX_FAILURES)
        return CLAIM_FAILED;
    print_path(directory, frame, "claim", taken->path, sizeof taken->path);
    taken->descriptor = open(taken->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (taken->descriptor < 0) {
        file_error(error, error_size, "cannot write", taken->path, errno);
        return CLAIM_ERROR;
    }
    const bool locked = lock(taken->descriptor);
    /* Another task may have drawn the frame between the first look and the lock. */
    if (!locked || claim_is_drawn(directory, frame, NULL)) {
        close(taken->descriptor);
        return locked ? CLAIM_THERE : CLAIM_BUSY;
    }
    note_task(directory, task, frame);
    return CLAIM_TAKEN;
}

void claim_release(const char *directory, uint32_t frame, claim *taken, bool failed)
{
    char path[4096];
    print_path(directory, frame, "failed", path, sizeof path);
    if (failed) {
        const int file = open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
        if (file >= 0) {
            (void)!write(file, "x", 1);
            close(file);
        }
    } else
        unlink(path);
    unlink(taken->path);
    close(taken->descriptor);
}
