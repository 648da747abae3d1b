/* slurm.c - tasks as job arrays of Slurm. Order, retry and placement are Slurm's. */
#include "farm/farm.h"
#include "file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#define MAX_WORDS 24

typedef struct submission {
    const char *words[MAX_WORDS];
    uint32_t count;
} submission;

static void add(submission *s, const char *word)
{
    if (s->count < MAX_WORDS - 1)
        s->words[s->count++] = word;
}

static void add_option(submission *s, const char *name, const char *value)
{
    if (!value)
        return;
    add(s, name);
    add(s, value);
}

/* Runs sbatch, and reads the number of the job that it prints. */
static bool run(const submission *s, char *job, size_t job_size, char *error, size_t error_size)
{
    int ends[2], status = -1;
    if (pipe(ends))
        return file_fail(error, error_size, "cannot run sbatch: %s", strerror(errno));
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], 1);
        close(ends[0]);
        close(ends[1]);
        execvp("sbatch", (char *const *)(uintptr_t)s->words);
        _exit(127);
    }
    close(ends[1]);
    FILE *output = fdopen(ends[0], "r");
    const bool read = output && fgets(job, (int)job_size, output);
    if (output)
        fclose(output);
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    if (child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 127)
        return file_fail(error, error_size, "sbatch is not installed; --local runs the tasks on this machine");
    if (!read || status)
        return file_fail(error, error_size, "sbatch has refused a job; its line is above");
    job[strcspn(job, ";\n")] = 0; /* a cluster's name may follow */
    return true;
}

/* One job array of a script. `rule`: its dependency, or NULL. */
static bool submit(const farm_plan *plan, const farm_queue *queue, const char *name, const char *array,
                   const char *rule, char *job, size_t job_size, char *error, size_t error_size)
{
    char path[4096], log[4096], file[64], title[64];
    submission s = {.count = 0};
    snprintf(file, sizeof file, "%s.sh", name);
    farm_path(plan, file, path, sizeof path);
    snprintf(file, sizeof file, "%s.%%a.log", name);
    farm_path(plan, file, log, sizeof log);
    snprintf(title, sizeof title, "virga-%s", name);
    add(&s, "sbatch");
    add(&s, "--parsable");
    add(&s, "--requeue");
    add_option(&s, "--open-mode", "append");
    add_option(&s, "--job-name", title);
    add_option(&s, "--array", array);
    add_option(&s, "--output", log);
    add_option(&s, "--dependency", rule);
    add_option(&s, "--partition", queue->partition);
    add_option(&s, "--time", queue->time);
    add_option(&s, "--mem", queue->memory);
    add_option(&s, "--cpus-per-task", queue->cpus);
    add(&s, rule ? "--kill-on-invalid-dep=yes" : "--kill-on-invalid-dep=no");
    add(&s, path);
    return run(&s, job, job_size, error, error_size);
}

/* A job array again, for the case that tasks of it were killed: it runs if any has failed, and is cancelled if not. */
static bool submit_retries(const farm_plan *plan, const farm_queue *queue, const char *name, const char *array,
                           char job[64], char *error, size_t error_size)
{
    char rule[96];
    for (uint32_t i = 0; i < queue->retries; i++) {
        snprintf(rule, sizeof rule, "afternotok:%s", job);
        if (!submit(plan, queue, name, array, rule, job, 64, error, error_size))
            return false;
    }
    return true;
}

bool farm_submit_slurm(const farm_plan *plan, const farm_queue *queue, char *error, size_t error_size)
{
    char array[64], rule[96], simulate[64], draw[64], finish[64];
    snprintf(array, sizeof array, "0-%u%%1", plan->tasks - 1);
    if (!submit(plan, queue, "simulate", array, NULL, simulate, sizeof simulate, error, error_size))
        return false;
    snprintf(array, sizeof array, "0-%u", plan->tasks - 1);
    snprintf(rule, sizeof rule, "aftercorr:%s", simulate);
    if (!submit(plan, queue, "draw", array, rule, draw, sizeof draw, error, error_size))
        return false;
    printf("jobs %s (simulates), %s (draws)", simulate, draw);
    if (!submit_retries(plan, queue, "draw", array, draw, error, error_size))
        return false;
    snprintf(rule, sizeof rule, "afterany:%s", draw);
    if (!submit(plan, queue, "finish", "0-0", rule, finish, sizeof finish, error, error_size))
        return false;
    printf(", %s (checks and joins); virga farm --status %s\n", finish, plan->directory);
    return submit_retries(plan, queue, "finish", "0-0", finish, error, error_size);
}
