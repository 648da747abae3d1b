/* status.c - how far a farm is, from the files in its folder: no queue has to be asked. */
#include "farm/farm.h"
#include "file.h"
#include "frame/claims.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOG_END_LINES 5

void farm_state_read(const farm_plan *plan, farm_state *state)
{
    double oldest = 0, newest = 0, written;
    memset(state, 0, sizeof *state);
    for (uint32_t frame = plan->first; frame <= plan->last; frame++)
        if (claim_is_drawn(plan->directory, frame, &written)) {
            oldest = !state->done || written < oldest ? written : oldest;
            newest = written > newest ? written : newest;
            state->done++;
        } else if (claim_is_busy(plan->directory, frame))
            state->running++;
        else if (claim_failures(plan->directory, frame) >= CLAIM_MAX_FAILURES)
            state->failed++;
        else
            state->waiting++;
    const uint32_t left = state->running + state->waiting;
    state->left_s = state->done > 1 ? (newest - oldest) / (state->done - 1) * left : left ? -1 : 0;
}

/* The end of the log of the task whose share the frame is in. */
static void print_log_end(const farm_plan *plan, uint32_t frame)
{
    char path[4096], name[64], lines[LOG_END_LINES][512];
    uint32_t count = 0;
    snprintf(name, sizeof name, "draw.%u.log", (frame - plan->first) / plan->share);
    farm_path(plan, name, path, sizeof path);
    FILE *file = fopen(path, "r");
    if (!file)
        return;
    while (fgets(lines[count % LOG_END_LINES], sizeof lines[0], file))
        count++;
    fclose(file);
    printf("  the end of %s:\n", path);
    for (uint32_t i = count > LOG_END_LINES ? count - LOG_END_LINES : 0; i < count; i++)
        printf("    %s", lines[i % LOG_END_LINES]);
}

static void print_failed(const farm_plan *plan)
{
    for (uint32_t frame = plan->first; frame <= plan->last; frame++)
        if (!claim_is_drawn(plan->directory, frame, NULL) &&
            claim_failures(plan->directory, frame) >= CLAIM_MAX_FAILURES) {
            printf("frame %u has failed %u times\n", frame, claim_failures(plan->directory, frame));
            print_log_end(plan, frame);
        }
}

void farm_state_print(const farm_plan *plan)
{
    farm_state state;
    farm_state_read(plan, &state);
    printf("%u of %u frames are done, %u are being drawn, %u have failed, %u wait", state.done,
           plan->last - plan->first + 1, state.running, state.failed, state.waiting);
    if (state.left_s > 0)
        printf("; about %.0f min %02.0f s left", (double)(long)(state.left_s / 60),
               state.left_s - 60 * (double)(long)(state.left_s / 60));
    printf("\n");
    print_failed(plan);
}

/* ---- the end */

typedef struct line_list {
    char **of_frame; /* by frame, from the first on; NULL: none */
    const farm_plan *plan;
} line_list;

/* Of two lines of a frame, the later one is of the file that is there. */
static void read_lines(const char *path, line_list *list)
{
    char *line = NULL;
    size_t room = 0;
    unsigned frame;
    FILE *file = fopen(path, "r");
    while (file && getline(&line, &room, file) > 0)
        if (sscanf(line, "{\"frame\":%u,", &frame) == 1 && strchr(line, '\n') && frame >= list->plan->first &&
            frame <= list->plan->last) {
            char **at = &list->of_frame[frame - list->plan->first];
            free(*at);
            *at = strdup(line);
        }
    free(line);
    if (file)
        fclose(file);
}

static bool write_lines(const line_list *list, char *error, size_t error_size)
{
    char path[4096];
    file_writer file;
    snprintf(path, sizeof path, "%s/stats.jsonl", list->plan->directory);
    if (!file_start(&file, path, error, error_size))
        return false;
    for (uint32_t i = 0; i <= list->plan->last - list->plan->first; i++)
        if (list->of_frame[i])
            file_write(&file, list->of_frame[i], strlen(list->of_frame[i]));
    return file_finish(&file, error, error_size);
}

static bool join_statistics(const farm_plan *plan, char *error, size_t error_size)
{
    const uint32_t count = plan->last - plan->first + 1;
    line_list list = {calloc(count, sizeof(char *)), plan};
    char folder[4096], path[8192];
    bool any = false, right = list.of_frame || file_fail(error, error_size, "no memory for %u frames", count);
    snprintf(folder, sizeof folder, "%s/farm", plan->directory);
    DIR *files = right ? opendir(folder) : NULL;
    for (struct dirent *entry; files && (entry = readdir(files));)
        if (!strncmp(entry->d_name, "stats.", 6)) {
            any = true;
            snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
            read_lines(path, &list);
        }
    if (files)
        closedir(files);
    right = right && (!any || write_lines(&list, error, error_size));
    for (uint32_t i = 0; list.of_frame && i < count; i++)
        free(list.of_frame[i]);
    free(list.of_frame);
    return right;
}

bool farm_finish(const farm_plan *plan, char *error, size_t error_size)
{
    uint32_t missing = 0;
    for (uint32_t frame = plan->first; frame <= plan->last; frame++)
        missing += !claim_is_drawn(plan->directory, frame, NULL);
    print_failed(plan);
    if (!join_statistics(plan, error, error_size))
        return false;
    return !missing ||
           file_fail(error, error_size, "%u of %u frames are missing", missing, plan->last - plan->first + 1);
}
