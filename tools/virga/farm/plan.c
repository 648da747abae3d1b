/* plan.c - see plan.h.
 *
 * Task T draws share T of the frames, and begins at a checkpoint. The simulation leaves these, one after another:
 * simulation task T goes on from the checkpoint of share T - 1 to the frame before share T. So a queue needs three
 * rules and no program that watches: simulation tasks run one at a time, in their order; a drawing task runs after the
 * simulation task of its number; the end runs after all drawing tasks. */
#include "farm/plan.h"

#include "file.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

void farm_plan_split(farm_plan *plan, uint32_t tasks)
{
    const uint32_t count = plan->last - plan->first + 1;
    plan->share = (count + tasks - 1) / tasks;
    plan->tasks = (count + plan->share - 1) / plan->share;
}

void farm_plan_share(const farm_plan *plan, uint32_t task, uint32_t frames[2])
{
    frames[0] = plan->first + task * plan->share;
    frames[1] = frames[0] + plan->share - 1 < plan->last ? frames[0] + plan->share - 1 : plan->last;
}

void farm_path(const farm_plan *plan, const char *name, char *path, size_t size)
{
    snprintf(path, size, "%s/farm/%s", plan->directory, name);
}

/* ---- scripts */

typedef struct script {
    char path[4096];
    file_writer file;
    char *error;
    size_t error_size;
} script;

static void add(script *out, const char *text)
{
    file_write(&out->file, text, strlen(text));
}

/* A word in quotes of the shell. */
static void add_word(script *out, const char *word)
{
    add(out, "'");
    for (; *word; word++)
        if (*word == '\'')
            add(out, "'\\''");
        else
            file_write(&out->file, word, 1);
    add(out, "'");
}

static bool begin(script *out, const farm_plan *plan, const char *name, const char *about)
{
    farm_path(plan, name, out->path, sizeof out->path);
    if (!file_start(&out->file, out->path, out->error, out->error_size))
        return false;
    add(out, "#!/usr/bin/env bash\n# ");
    add(out, about);
    add(out, "\n# Usage: ");
    add(out, name);
    add(out, " TASK. On Slurm the task is that of the job array.\n");
    return true;
}

static bool end(script *out)
{
    return file_finish(&out->file, out->error, out->error_size) && !chmod(out->path, 0755);
}

static void add_variables(script *out, const farm_plan *plan, const char *program, char *const *arguments, int count)
{
    char text[256];
    /* Files that options name are relative to the folder of the command line. */
    add(out, "cd ");
    add_word(out, plan->origin);
    add(out, " || exit 2\nvirga=");
    add_word(out, program);
    add(out, "\ndir=");
    add_word(out, plan->directory);
    add(out, "\nrender=(\"$virga\" render");
    for (int i = 0; i < count; i++) {
        add(out, " ");
        add_word(out, arguments[i]);
    }
    snprintf(
        text, sizeof text,
        " -o \"$dir\")\ntask=${SLURM_ARRAY_TASK_ID:-${1:-0}}\nfrom=$((%u + task * %u)) to=$((%u + task * %u + %u))\n",
        plan->first, plan->share, plan->first, plan->share, plan->share - 1);
    add(out, text);
    snprintf(text, sizeof text, "[ $to -le %u ] || to=%u\n", plan->last, plan->last);
    add(out, text);
}

/* Of --points, --stats and the like, simulations need none. */
static bool is_for_simulation(char *const *arguments, int i)
{
    static const char *const with_value[] = {"--set",   "--seed", "--device",     "--plate",
                                             "--depth", "--size", "--ground-mask"};
    for (size_t k = 0; k < sizeof with_value / sizeof with_value[0]; k++) {
        const size_t length = strlen(with_value[k]);
        if (!strncmp(arguments[i], with_value[k], length) && strchr("=", arguments[i][length]))
            return true;
        if (i > 0 && !strcmp(arguments[i - 1], with_value[k]))
            return true;
    }
    return i == 0;
}

static bool write_simulate(script *out, const farm_plan *plan, const char *program, char *const *arguments, int count)
{
    char text[512], *kept[512];
    int kept_count = 0;
    for (int i = 0; i < count && kept_count < 512; i++)
        if (is_for_simulation(arguments, i))
            kept[kept_count++] = arguments[i];
    if (!begin(out, plan, "simulate.sh",
               "Simulates up to the frame before the share of a task, and leaves a checkpoint there."))
        return false;
    add_variables(out, plan, program, kept, kept_count);
    snprintf(text, sizeof text,
             "[ $from -gt %u ] || exit 0 # the scene begins there\n"
             "\"${render[@]}\" --simulate --checkpoint-every $((from - %u)) --frames $((from - 1))-$((from - 1))\n",
             plan->scene_first, plan->scene_first);
    add(out, text);
    return end(out);
}

static bool write_draw(script *out, const farm_plan *plan, const char *program, char *const *arguments, int count)
{
    if (!begin(out, plan, "draw.sh", "Draws the share of a task. A frame that fails is tried again, three times."))
        return false;
    add_variables(out, plan, program, arguments, count);
    add(out,
        "for try in 1 2 3 4 5 6 7 8 9; do\n"
        "    \"${render[@]}\" --frames $from-$to --claim \"$task\"\n"
        "    code=$?\n"
        "    case $code in\n"
        "    0 | 2 | 3 | 130) exit $code ;;\n"
        "    # a crash, and no signal from outside: it counts against the frame that was drawn\n"
        "    132 | 134 | 135 | 136 | 139) printf x >>\"$dir/farm/frame.$(cat \"$dir/farm/task.$task\").failed\" ;;\n"
        "    esac\n"
        "done\n"
        "exit 1\n");
    return end(out);
}

static bool write_finish(script *out, const farm_plan *plan, const char *program, char *const *arguments, int count)
{
    char text[256];
    if (!begin(out, plan, "finish.sh",
               "Draws what tasks have left, checks all frames, and joins previews and statistics."))
        return false;
    add_variables(out, plan, program, arguments, count);
    snprintf(text, sizeof text, "from=%u to=%u task=finish\n", plan->first, plan->last);
    add(out, text);
    add(out, "\"${render[@]}\" --frames $from-$to --claim finish\n"
             "\"$virga\" farm --finish \"$dir\" || exit 1\n");
    bool preview = false;
    for (int i = 0; i < count; i++)
        preview = preview || !strcmp(arguments[i], "--preview");
    if (preview)
        add(out, "\"${render[@]}\" --frames $from-$to --resume # all are there: it makes the film\n");
    return end(out);
}

static bool write_plan(script *out, const farm_plan *plan)
{
    char text[256];
    farm_path(plan, "plan", out->path, sizeof out->path);
    if (!file_start(&out->file, out->path, out->error, out->error_size))
        return false;
    snprintf(text, sizeof text, "frames %u-%u\nscene_first %u\nshare %u\ntasks %u\n", plan->first, plan->last,
             plan->scene_first, plan->share, plan->tasks);
    add(out, text);
    return file_finish(&out->file, out->error, out->error_size);
}

bool farm_plan_write(const farm_plan *plan, const char *program, char *const *arguments, int count, char *error,
                     size_t error_size)
{
    script out = {.error = error, .error_size = error_size};
    return write_simulate(&out, plan, program, arguments, count) && write_draw(&out, plan, program, arguments, count) &&
           write_finish(&out, plan, program, arguments, count) && write_plan(&out, plan);
}

bool farm_plan_read(const char *directory, farm_plan *plan, char *error, size_t error_size)
{
    char path[4096];
    snprintf(plan->directory, sizeof plan->directory, "%s", directory);
    farm_path(plan, "plan", path, sizeof path);
    FILE *file = fopen(path, "r");
    if (!file)
        return file_fail(error, error_size, "%s is not there: expected a folder of virga farm", path);
    const bool read = fscanf(file, "frames %u-%u scene_first %u share %u tasks %u", &plan->first, &plan->last,
                             &plan->scene_first, &plan->share, &plan->tasks) == 5;
    fclose(file);
    const bool right = read && plan->first <= plan->last && plan->last <= 999999 && plan->share && plan->tasks &&
                       plan->tasks <= FARM_MAX_TASKS;
    return right || file_fail(error, error_size, "%s is damaged", path);
}
