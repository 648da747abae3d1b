/* farm.c - `virga farm`: a shot by many tasks, on Slurm or as processes of this machine. */
#include "farm/farm.h"

#include "commands/commands.h"
#include "effect.h"
#include "frame/claims.h"
#include "options.h"
#include "scene_file.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const option_row rows[] = {
    {"--output", 'o', "DIR", "folder for the files (required). Tasks on other machines must see it by the same path",
     false},
    {"--tasks", 0, "N", "drawing tasks; each draws a share of the frames. Default 4", false},
    {"--frames", 0, "A-B", "frames of the shot. Default: the scene's", false},
    {"--local", 0, NULL, "run the tasks as processes of this machine, and wait for them", false},
    {"--jobs", 0, "N", "(--local) tasks that run at once. Default 2", false},
    {"--slurm", 0, NULL, "hand the tasks to Slurm by sbatch, as job arrays with dependencies", false},
    {"--partition", 0, "NAME", "(--slurm) partition of the cluster", false},
    {"--time", 0, "LIMIT", "(--slurm) time limit of a task, as sbatch takes it, e.g. 2:00:00", false},
    {"--memory", 0, "SIZE", "(--slurm) memory of a task, e.g. 8G", false},
    {"--cpus", 0, "N", "(--slurm) processors of a task", false},
    {"--retries", 0, "N",
     "(--slurm) how often tasks that were killed or have failed are run again. Slurm itself runs a task again if its "
     "machine fails. Default 2",
     false},
    {"--dry-run", 0, NULL, "only write the scripts", false},
    {"--status", 0, "DIR", "how far the farm in a folder is: done, drawn now, failed, time left", false},
    {"--finish", 0, "DIR", "check that all frames are there, and join the statistics. The last script does this",
     false},
};

#define ROW_COUNT (sizeof rows / sizeof rows[0])

void farm_help(void)
{
    printf("virga farm SCENE.yaml -o DIR [options] [-- options of virga render]\n"
           "virga farm --status DIR\n\n"
           "Renders a shot by many tasks. A simulation without drawing leaves checkpoints. Each task draws a\n"
           "share of the frames, from its checkpoint on. Whatever is killed, requeued or run twice, the files\n"
           "are the same bytes as those of one virga render. A frame that fails three times is named with\n"
           "the end of its log, and the rest is finished.\n\n");
    options_print(rows, ROW_COUNT);
    printf("\nScripts, to be read and edited: DIR/farm/simulate.sh, draw.sh and finish.sh. Each is run with the\n"
           "number of a task. Logs, claims of frames and statistics of tasks are beside them.\n\n"
           "Examples:\n"
           "  virga farm assets/scenes/storm.yaml -o out --local --tasks 4 -- --size 640x360 --preview\n"
           "  virga farm shot.yaml -o /shared/shot --slurm --tasks 100 --time 2:00:00 -- --samples 16 --stats\n\n"
           "Exit codes: 0 done, 1 failed, 2 wrong command line or scene, 130 interrupted.\n");
}

static int wrong(const char *text)
{
    options_complain("farm", "%s", text);
    return EXIT_USAGE;
}

/* ---- a farm that is there */

static int show_status(const char *directory, bool finish)
{
    farm_plan plan;
    char error[1024];
    if (!farm_plan_read(directory, &plan, error, sizeof error))
        return wrong(error);
    if (!finish) {
        farm_state_print(&plan);
        return EXIT_OK;
    }
    if (farm_finish(&plan, error, sizeof error))
        return EXIT_OK;
    options_complain("farm", "%s", error);
    return EXIT_FAILED;
}

/* ---- a new one */

typedef struct farm_job {
    options parsed;
    farm_plan plan;
    farm_queue queue;
    uint32_t tasks, jobs;
    char program[PATH_MAX], scene[PATH_MAX];
    char *arguments[512]; /* of virga render */
    int argument_count;
    char error[1024];
} farm_job;

/* Options that the farm sets itself. */
static bool check_passed_on(const farm_job *job)
{
    static const char *const own[] = {"-o",      "--output",   "--frames",          "--resume",
                                      "--claim", "--simulate", "--checkpoint-every"};
    for (int i = 1; i < job->argument_count; i++)
        for (size_t k = 0; k < sizeof own / sizeof own[0]; k++)
            if (!strcmp(job->arguments[i], own[k]))
                return options_complain("farm", "%s: expected before --, or not at all: the farm sets it for each task",
                                        own[k]);
    return true;
}

static bool read_options(farm_job *job, char **passed_on, int passed_on_count)
{
    const options *parsed = &job->parsed;
    const bool local = options_value(parsed, "--local"), slurm = options_value(parsed, "--slurm");
    job->tasks = 4;
    job->jobs = 2;
    job->queue.retries = 2;
    if (parsed->argument_count != 1)
        return options_complain("farm", "expected one scene file, got %zu; see virga help farm",
                                parsed->argument_count);
    if (!options_value(parsed, "--output"))
        return options_complain("farm", "expected -o DIR, the folder for the files");
    if (local + slurm != 1 && !options_value(parsed, "--dry-run"))
        return options_complain("farm", "expected one of --local and --slurm");
    if (!options_uint(parsed, "--tasks", 1, FARM_MAX_TASKS, &job->tasks) ||
        !options_uint(parsed, "--jobs", 1, 1024, &job->jobs) ||
        !options_uint(parsed, "--retries", 0, 20, &job->queue.retries))
        return false;
    if (passed_on_count > 510)
        return options_complain("farm", "expected up to 510 options behind --");
    job->arguments[job->argument_count++] = job->scene;
    for (int i = 0; i < passed_on_count; i++)
        job->arguments[job->argument_count++] = passed_on[i];
    job->queue.partition = options_value(parsed, "--partition");
    job->queue.time = options_value(parsed, "--time");
    job->queue.memory = options_value(parsed, "--memory");
    job->queue.cpus = options_value(parsed, "--cpus");
    return check_passed_on(job);
}

/* Scripts are run from any folder, so all paths in them are absolute. */
static bool find_paths(farm_job *job)
{
    const ssize_t length = readlink("/proc/self/exe", job->program, sizeof job->program - 1);
    const char *directory = options_value(&job->parsed, "--output");
    char path[PATH_MAX];
    if (length < 0)
        return options_complain("farm", "cannot find the program's own path: %s", strerror(errno));
    job->program[length] = 0;
    if (!realpath(job->parsed.arguments[0], job->scene))
        return options_complain("farm", "cannot read %s: %s", job->parsed.arguments[0], strerror(errno));
    if (mkdir(directory, 0777) && errno != EEXIST)
        return options_complain("farm", "cannot make the folder %s: %s", directory, strerror(errno));
    if (!realpath(directory, path) || strlen(path) >= sizeof job->plan.directory)
        return options_complain("farm", "cannot use the folder %s: %s", directory, strerror(errno));
    strcpy(job->plan.directory, path);
    if (!getcwd(job->plan.origin, sizeof job->plan.origin))
        return options_complain("farm", "cannot find the current folder: %s", strerror(errno));
    return claims_open(path, job->error, sizeof job->error) || options_complain("farm", "%s", job->error);
}

static bool read_scene(farm_job *job)
{
    scene_file *scene;
    uint32_t frames[2];
    if (!scene_file_load(job->scene, tool_effect_sections, NULL, 0, &scene, job->error, sizeof job->error)) {
        fprintf(stderr, "%s\n", job->error);
        return false;
    }
    frames[0] = job->plan.scene_first = scene->frames.first;
    frames[1] = scene->frames.last;
    const uint32_t first = scene->frames.first;
    scene_file_free(scene);
    if (!options_pair(&job->parsed, "--frames", '-', true, first, 999999, frames))
        return false;
    job->plan.first = frames[0];
    job->plan.last = frames[1];
    if (frames[1] < frames[0])
        return options_complain("farm", "--frames: expected A-B with A before B, got %u-%u", frames[0], frames[1]);
    farm_plan_split(&job->plan, job->tasks);
    return true;
}

static int run_farm(farm_job *job)
{
    char *error = job->error;
    const size_t size = sizeof job->error;
    if (!farm_plan_write(&job->plan, job->program, job->arguments, job->argument_count, error, size)) {
        options_complain("farm", "%s", error);
        return EXIT_FAILED;
    }
    printf("%u tasks of up to %u frames; scripts in %s/farm\n", job->plan.tasks, job->plan.share, job->plan.directory);
    fflush(stdout);
    if (options_value(&job->parsed, "--dry-run"))
        return EXIT_OK;
    error[0] = 0;
    const int code = options_value(&job->parsed, "--slurm")
                         ? (farm_submit_slurm(&job->plan, &job->queue, error, size) ? EXIT_OK : EXIT_FAILED)
                         : farm_run_local(&job->plan, job->jobs, error, size);
    if (error[0])
        options_complain("farm", "%s", error);
    return code < 0 ? EXIT_FAILED : code;
}

int farm_run(int argc, char **argv)
{
    int own = 0;
    while (own < argc && strcmp(argv[own], "--"))
        own++;
    farm_job *job = calloc(1, sizeof *job);
    if (!job)
        return EXIT_FAILED;
    int code = EXIT_USAGE;
    if (options_parse(&job->parsed, "farm", rows, ROW_COUNT, own, argv)) {
        const char *status = options_value(&job->parsed, "--status"), *finish = options_value(&job->parsed, "--finish");
        if (status || finish)
            code = show_status(status ? status : finish, !status);
        else if (read_options(job, argv + own + 1, argc > own ? argc - own - 1 : 0) && find_paths(job) &&
                 read_scene(job))
            code = run_farm(job);
    }
    free(job);
    return code;
}
