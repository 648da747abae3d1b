/* farm.h - runs a plan, and says how far it is. */
#ifndef VIRGA_TOOL_FARM_H
#define VIRGA_TOOL_FARM_H

#include "farm/plan.h"

/* Runs all tasks as processes of this machine, so many at once; waits. The exit code of finish.sh. */
int farm_run_local(const farm_plan *plan, uint32_t jobs, char *error, size_t error_size);

typedef struct farm_queue {
    const char *partition, *time, *memory, *cpus; /* options of sbatch; NULL: those of the cluster */
    uint32_t retries;                             /* of killed tasks */
} farm_queue;

/* Hands the tasks to Slurm: job arrays with dependencies. Prints the numbers of the jobs. */
bool farm_submit_slurm(const farm_plan *plan, const farm_queue *queue, char *error, size_t error_size);

/* Frames of a plan. */
typedef struct farm_state {
    uint32_t done, running, failed, waiting;
    double left_s; /* estimate of the time that is left; < 0: unknown */
} farm_state;

void farm_state_read(const farm_plan *plan, farm_state *state);

/* Prints the state, and failed frames with the end of their log. */
void farm_state_print(const farm_plan *plan);

/* Whether all frames are there; prints those that are not. Joins statistics of tasks into DIR/stats.jsonl. */
bool farm_finish(const farm_plan *plan, char *error, size_t error_size);

#endif
