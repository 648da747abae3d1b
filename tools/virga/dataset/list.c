/* list.c - walks folders. */
#include "dataset/list.h"

#include "host.h"
#include "picture.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define MAX_DEPTH 16 /* folders in folders; links may go around in circles */

typedef struct walk {
    const dataset_list_def *def;
    dataset_list *list;
    struct stat output;
    bool has_output;
    char *error;
    size_t error_size;
} walk;

static bool no_memory(const walk *w)
{
    return host_fail(w->error, w->error_size, "no memory for a list of pictures");
}

static void free_picture(dataset_picture *p)
{
    free(p->path);
    free(p->name);
    free(p->depth);
    free(p->place);
}

static bool add(const walk *w, const char *path, const char *name)
{
    dataset_list *list = w->list;
    if (list->count == list->room) {
        const size_t room = list->room ? 2 * list->room : 256;
        dataset_picture *more = realloc(list->pictures, room * sizeof *more);
        if (!more)
            return no_memory(w);
        list->pictures = more;
        list->room = room;
    }
    dataset_picture *p = &list->pictures[list->count];
    *p = (dataset_picture){.path = strdup(path), .name = strdup(name), .speed_m_s = NAN};
    list->count++;
    return (p->path && p->name) || no_memory(w);
}

static bool add_folder(const walk *w, const char *path, const char *name, uint32_t depth);

static bool add_entry(const walk *w, const char *path, const char *name, const char *entry, uint32_t depth)
{
    char whole[4096], below[4096];
    struct stat about;
    picture_kind kind;
    if (snprintf(whole, sizeof whole, "%s/%s", path, entry) >= (int)sizeof whole ||
        snprintf(below, sizeof below, "%s%s%s", name, *name ? "/" : "", entry) >= (int)sizeof below)
        return host_fail(w->error, w->error_size, "the name of a file in %.200s is too long", path);
    if (entry[0] == '.' || stat(whole, &about))
        return true;
    if (S_ISDIR(about.st_mode)) {
        const bool own = w->has_output && about.st_dev == w->output.st_dev && about.st_ino == w->output.st_ino;
        return own || add_folder(w, whole, below, depth + 1);
    }
    return !S_ISREG(about.st_mode) || !picture_kind_of(entry, &kind) || !dataset_layout_takes(w->def->layout, whole) ||
           add(w, whole, below);
}

static bool add_folder(const walk *w, const char *path, const char *name, uint32_t depth)
{
    if (depth > MAX_DEPTH)
        return host_fail(w->error, w->error_size, "more than %d folders in each other: %s", MAX_DEPTH, path);
    DIR *folder = opendir(path);
    if (!folder)
        return host_fail(w->error, w->error_size, "cannot list the folder %s", path);
    bool added = true;
    for (struct dirent *entry; added && (entry = readdir(folder));)
        added = add_entry(w, path, name, entry->d_name, depth);
    closedir(folder);
    return added;
}

/* ---- depth of a folder of its own */

static bool find_depth(const walk *w, dataset_picture *p)
{
    static const char *const endings[] = {"npy", "png", "exr", "tif", "tiff"};
    const size_t stem = (size_t)(strrchr(p->name, '.') - p->name);
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        char path[4096];
        struct stat about;
        if (snprintf(path, sizeof path, "%s/%.*s.%s", w->def->depths, (int)stem, p->name, endings[i]) <
                (int)sizeof path &&
            !stat(path, &about)) {
            p->depth = strdup(path);
            return p->depth || no_memory(w);
        }
    }
    return host_fail(w->error, w->error_size, "--depth: no %s/%.*s.npy, .png, .exr or .tif, for %s", w->def->depths,
                     (int)stem, p->name, p->path);
}

/* ---- all */

/* Without the ending first, so that those that differ in it alone are beside each other. */
static int by_name(const void *a, const void *b)
{
    const char *one = ((const dataset_picture *)a)->name, *other = ((const dataset_picture *)b)->name;
    const size_t stems[2] = {(size_t)(strrchr(one, '.') - one), (size_t)(strrchr(other, '.') - other)};
    const int order = strncmp(one, other, stems[0] < stems[1] ? stems[0] : stems[1]);
    if (order || stems[0] != stems[1])
        return order ? order : stems[0] < stems[1] ? -1 : 1;
    return strcmp(one + stems[0], other + stems[1]);
}

/* Two pictures with the same name but for the ending would have the same files of masks and boxes. */
static bool check_names(const walk *w)
{
    const dataset_list *list = w->list;
    for (uint32_t i = 1; i < list->count; i++) {
        const char *a = list->pictures[i - 1].name, *b = list->pictures[i].name;
        const size_t stem = (size_t)(strrchr(a, '.') - a);
        if (stem == (size_t)(strrchr(b, '.') - b) && !strncmp(a, b, stem))
            return host_fail(w->error, w->error_size, "%s and %s: expected names that differ before the ending",
                             list->pictures[i - 1].path, list->pictures[i].path);
    }
    return true;
}

static bool add_folders(const walk *w)
{
    for (size_t i = 0; i < w->def->folder_count; i++) {
        char path[4096];
        snprintf(path, sizeof path, "%s", w->def->folders[i]);
        for (size_t end = strlen(path); end > 1 && path[end - 1] == '/'; end--)
            path[end - 1] = 0;
        const char *slash = strrchr(path, '/'), *last = slash && slash[1] ? slash + 1 : path;
        if (!add_folder(w, path, w->def->folder_count > 1 ? last : "", 0))
            return false;
    }
    return true;
}

bool dataset_list_open(dataset_list *list, const dataset_list_def *def, char *error, size_t error_size)
{
    walk w = {.def = def, .list = list, .error = error, .error_size = error_size};
    *list = (dataset_list){.pictures = NULL};
    w.has_output = !stat(def->output, &w.output);
    if (!add_folders(&w))
        return false;
    if (!list->count)
        return host_fail(error, error_size, "no %s in %s%s",
                         def->layout == DATASET_FOLDER      ? "EXR, PNG, JPEG or TIFF pictures"
                         : def->layout == DATASET_KITTI_RAW ? "image_0N/data/NUMBER.png of KITTI's raw data"
                                                            : "leftImg8bit/.../NAME_leftImg8bit.png of Cityscapes",
                         def->folders[0], def->folder_count > 1 ? " and the others" : "");
    qsort(list->pictures, list->count, sizeof *list->pictures, by_name);
    if (!check_names(&w))
        return false;
    for (uint32_t i = 0; i < list->count; i++) {
        dataset_picture *p = &list->pictures[i];
        if (def->depths && def->layout == DATASET_FOLDER ? !find_depth(&w, p)
                                                         : !dataset_layout_fill(def, p, error, error_size))
            return false;
        if (!p->place && !(p->place = strdup(p->name)))
            return no_memory(&w);
    }
    return true;
}

void dataset_list_close(dataset_list *list)
{
    for (uint32_t i = 0; i < list->count; i++)
        free_picture(&list->pictures[i]);
    free(list->pictures);
    *list = (dataset_list){.pictures = NULL};
}
