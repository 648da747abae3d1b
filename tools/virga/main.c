/* main.c - the program: finds the command and hands over. */
#include "commands/commands.h"
#include "options.h"
#include "progress.h"
#include "suggest.h"

#include <virga/base.h>

#include <stdio.h>
#include <string.h>

static const command commands[] = {
    {"render", "render a scene to layered EXR frames", render_run, render_help},
    {"farm", "render a shot by many tasks: on Slurm, or as processes on this machine", farm_run, farm_help},
    {"dataset", "rain over folders of photographs, with masks and boxes of streaks", dataset_run, dataset_help},
    {"view", "a scene in a window, with every setting on a panel", view_run, view_help},
    {"check", "validate a scene file", check_run, check_help},
    {"info", "list Vulkan devices and why each is or is not usable; what is in files of particles", info_run,
     info_help},
    {"bench", "measure the passes against the machine's own limits", bench_run, bench_help},
};

#define COMMAND_COUNT (sizeof commands / sizeof commands[0])

static void print_overview(void)
{
    printf("virga %s - rain, rendered\n\n"
           "  virga COMMAND [options]\n\n",
           virga_version());
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        printf("  %-10s %s\n", commands[i].name, commands[i].summary);
    printf("  %-10s %s\n\n", "help", "this, or `virga help COMMAND` for all of a command's options");
    printf("A first frame:\n\n"
           "  virga render assets/scenes/street.yaml -o out --frames 1 --size 640x360 --preview\n\n"
           "Exit codes: 0 done, 1 failed, 2 wrong command line or input, 130 interrupted (what was finished is\n"
           "kept).\n");
}

static const command *find_command(const char *name)
{
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (!strcmp(commands[i].name, name))
            return &commands[i];
    const char *names[COMMAND_COUNT];
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        names[i] = commands[i].name;
    const char *near = suggest_nearest(name, names, COMMAND_COUNT);
    fprintf(stderr, near ? "virga: no command '%s'; did you mean '%s'?\n" : "virga: no command '%s'; see virga help\n",
            name, near);
    return NULL;
}

static int print_help(const char *name)
{
    if (!name) {
        print_overview();
        return EXIT_OK;
    }
    const command *found = find_command(name);
    if (found)
        found->help();
    return found ? EXIT_OK : EXIT_USAGE;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        print_overview();
        return EXIT_USAGE;
    }
    if (!strcmp(argv[1], "--version"))
        return version_print();
    if (!strcmp(argv[1], "help") || !strcmp(argv[1], "--help") || !strcmp(argv[1], "-h"))
        return print_help(argc > 2 ? argv[2] : NULL);
    const command *found = find_command(argv[1]);
    if (!found)
        return EXIT_USAGE;
    for (int i = 2; i < argc; i++)
        if (!strcmp(argv[i], "--help") || !strcmp(argv[i], "-h"))
            return print_help(argv[1]);
    interrupt_install();
    return found->run(argc - 2, argv + 2);
}
