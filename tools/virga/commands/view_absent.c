/* view_absent.c - `virga view` of a build without a window. */
#include "commands/commands.h"
#include "options.h"

#include <stdio.h>

#define HOW "this build has no window: install libglfw3-dev and libimgui-dev, then build again with -Dview=enabled"

void view_help(void)
{
    printf("virga view SCENE.yaml\n\n" HOW "\n");
}

int view_run(int argc, char **argv)
{
    (void)argc;
    (void)argv;
    options_complain("view", HOW);
    return EXIT_FAILED;
}
