/* version.c - `virga --version`: what a bug report needs first. */
#include "commands/commands.h"

#include "commit.h"
#include "host.h"
#include "options.h"

#include <virga/base.h>

#include <stdio.h>

static void print_device(void)
{
    host_instance instance;
    host_device_info infos[HOST_MAX_DEVICES];
    char error[512];
    uint32_t chosen;
    if (!host_instance_create(&instance, false, error, sizeof error)) {
        printf("device: none, %s\n", error);
        return;
    }
    const uint32_t count = host_devices_list(&instance, infos, HOST_MAX_DEVICES);
    if (host_device_pick(infos, count, NULL, &chosen, error, sizeof error))
        printf("device: %s (%s), Vulkan %u.%u\ndriver: %s\n", infos[chosen].name,
               host_device_type_name(infos[chosen].type), VK_API_VERSION_MAJOR(infos[chosen].api_version),
               VK_API_VERSION_MINOR(infos[chosen].api_version), infos[chosen].driver);
    else
        printf("device: none, %s\n", error);
    host_instance_destroy(&instance);
}

int version_print(void)
{
    printf("virga %s\ncommit: %s\n", virga_version(), VIRGA_COMMIT);
    print_device();
    return EXIT_OK;
}
