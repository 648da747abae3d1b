/* machine.h - how many processors and how much memory this process may use: of the machine, and of the control groups
 * (cgroups, version 1 or 2) that a container, a farm or a service manager has put it into. */
#ifndef VIRGA_TOOL_MACHINE_H
#define VIRGA_TOOL_MACHINE_H

#include <stdint.h>

/* `root` is before the paths of /proc and /sys: "", but for tests. */

/* At least 1. A quota of two and a half processors counts as two. */
uint32_t machine_processors(const char *root);

/* Bytes that can be taken without swapping, caches of files included; 0: none, or it is not known. */
uint64_t machine_free_bytes(const char *root);

#endif
