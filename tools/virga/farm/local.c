/* local.c - tasks as processes of this machine. */
#include "farm/farm.h"
#include "file.h"
#include "frame/workers.h"
#include "progress.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

typedef struct local_run {
    const farm_plan *plan;
    pid_t simulating;          /* 0: none */
    uint32_t simulated, drawn; /* simulation tasks that have ended; drawing tasks that were started */
    uint32_t drawing;          /* drawing tasks that run */
} local_run;

/* With its output in DIR/farm/NAME.TASK.log. -1: failed. */
static pid_t start(const farm_plan *plan, const char *name, uint32_t task)
{
    char path[4096], log[4096], file[64], number[16];
    snprintf(file, sizeof file, "%s.sh", name);
    farm_path(plan, file, path, sizeof path);
    snprintf(file, sizeof file, "%s.%u.log", name, task);
    farm_path(plan, file, log, sizeof log);
    snprintf(number, sizeof number, "%u", task);
    const pid_t child = fork();
    if (child)
        return child;
    const int output = open(log, O_WRONLY | O_CREAT | O_APPEND, 0666), input = open("/dev/null", O_RDONLY);
    unsetenv("SLURM_ARRAY_TASK_ID");
    if (output < 0 || input < 0 || dup2(output, 1) < 0 || dup2(output, 2) < 0 || dup2(input, 0) < 0)
        _exit(126);
    execl("/bin/bash", "bash", path, number, (char *)NULL);
    _exit(127);
}

/* Starts what may run: one simulation, and drawing tasks whose checkpoint is there. */
static bool start_tasks(local_run *run, uint32_t jobs)
{
    const farm_plan *plan = run->plan;
    if (interrupt_requested())
        return true;
    if (!run->simulating && run->simulated < plan->tasks)
        run->simulating = start(plan, "simulate", run->simulated);
    if (run->simulating < 0)
        return false;
    while (run->drawn < run->simulated && run->drawing + (run->simulating > 0) < jobs) {
        if (start(plan, "draw", run->drawn) < 0)
            return false;
        run->drawn++;
        run->drawing++;
    }
    return true;
}

/* One simulation runs beside jobs - 1 drawing tasks, so with one job nothing would be drawn before all is simulated. */
static void collect(local_run *run)
{
    int status;
    for (pid_t ended; (ended = waitpid(-1, &status, WNOHANG)) > 0;)
        if (ended == run->simulating) {
            run->simulating = 0;
            run->simulated++;
        } else
            run->drawing--;
}

static bool is_running(const local_run *run)
{
    const bool more = run->drawn < run->plan->tasks && !interrupt_requested();
    return run->simulating || run->drawing || more;
}

static void show(const farm_plan *plan, progress *bar, uint32_t *shown)
{
    farm_state state;
    farm_state_read(plan, &state);
    for (; *shown < state.done; ++*shown)
        progress_step(bar, NULL);
}

int farm_run_local(const farm_plan *plan, uint32_t jobs, char *error, size_t error_size)
{
    local_run run = {.plan = plan};
    progress bar;
    uint32_t shown = 0;
    const struct timespec pause = {0, 200000000};
    workers_share_processors(jobs);
    progress_begin(&bar, "frame", plan->last - plan->first + 1);
    while (is_running(&run)) {
        if (!start_tasks(&run, jobs)) {
            file_error(error, error_size, "cannot start a task in", plan->directory, errno);
            progress_end(&bar);
            return -1;
        }
        nanosleep(&pause, NULL);
        collect(&run);
        show(plan, &bar, &shown);
    }
    progress_end(&bar);
    if (interrupt_requested())
        return 130;
    int status = -1;
    const pid_t last = start(plan, "finish", 0);
    while (last > 0 && waitpid(last, &status, 0) < 0 && errno == EINTR)
        ;
    farm_state_print(plan);
    return last > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}
