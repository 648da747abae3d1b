/* plan.h - a shot as tasks: shares of its frames, and the scripts that draw them. */
#ifndef VIRGA_TOOL_FARM_PLAN_H
#define VIRGA_TOOL_FARM_PLAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define FARM_MAX_TASKS 9999

typedef struct farm_plan {
    char directory[3072]; /* absolute */
    char origin[1024];    /* folder in which the command was given */
    uint32_t first, last; /* frames of the shot */
    uint32_t scene_first; /* the first frame of the scene: simulation begins there */
    uint32_t share;       /* frames of a task; the last may have fewer */
    uint32_t tasks;
} farm_plan;

/* Splits the frames into `tasks` shares of the same length, or fewer tasks if frames do not suffice. */
void farm_plan_split(farm_plan *plan, uint32_t tasks);

void farm_plan_share(const farm_plan *plan, uint32_t task, uint32_t frames[2]);

/* Writes DIR/farm/simulate.sh, draw.sh, finish.sh and plan. `arguments`: those of `virga render`, the scene first. */
bool farm_plan_write(const farm_plan *plan, const char *program, char *const *arguments, int argument_count,
                     char *error, size_t error_size);

/* Reads DIR/farm/plan. */
bool farm_plan_read(const char *directory, farm_plan *plan, char *error, size_t error_size);

/* The path of a file in DIR/farm. */
void farm_path(const farm_plan *plan, const char *name, char *path, size_t size);

#endif
