/* commands.h - the commands of the program, one file each. Each gets what stands behind its name and returns the exit
 * code; each prints its own help. */
#ifndef VIRGA_TOOL_COMMANDS_H
#define VIRGA_TOOL_COMMANDS_H

typedef struct command {
    const char *name, *summary;
    int (*run)(int argc, char **argv);
    void (*help)(void);
} command;

int render_run(int argc, char **argv);
void render_help(void);
int farm_run(int argc, char **argv);
void farm_help(void);
int dataset_run(int argc, char **argv);
void dataset_help(void);
int view_run(int argc, char **argv);
void view_help(void);
int check_run(int argc, char **argv);
void check_help(void);
int info_run(int argc, char **argv);
void info_help(void);

/* Says what is in a file of particles; the exit code. */
int info_particles(const char *path);

int bench_run(int argc, char **argv);
void bench_help(void);

/* Version, commit, device and driver; the exit code. */
int version_print(void);

#endif
