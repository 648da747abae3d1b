/* info.c - `virga info`: lists the devices, which one Virga would choose, and why not the others; or says what is in
 * files of particles. */
#include "commands/commands.h"
#include "options.h"

#include "host.h"

#include <stdio.h>

static const option_row rows[] = {
    {"--device", 0, "N|cpu|gpu|NAME", "print which device this choice selects", false},
};

void info_help(void)
{
    printf("virga info [--device N|cpu|gpu|NAME]\n"
           "virga info FILE...\n\n"
           "Lists the Vulkan devices in the loader's order, marks the one that would be used, and says for\n"
           "each other one why it can not be.\n\n"
           "With files of simulated particles (PLY, legacy VTK, classic bgeo): how many, their attributes, where\n"
           "they are and how far apart, in the units of the file.\n\n");
    options_print(rows, sizeof rows / sizeof rows[0]);
}

static void print_features(void)
{
    uint32_t count;
    const virga_feature *features = virga_required_features(&count);
    printf("required: Vulkan 1.2");
    for (uint32_t i = 0; i < count; i++)
        printf(", %s", features[i].name);
    printf("\n");
}

static int print_files(const options *parsed)
{
    if (options_value(parsed, "--device")) {
        options_complain("info", "expected either --device or files, got both");
        return EXIT_USAGE;
    }
    for (size_t i = 0; i < parsed->argument_count; i++) {
        const int code = info_particles(parsed->arguments[i]);
        if (code != EXIT_OK)
            return code;
    }
    return EXIT_OK;
}

int info_run(int argc, char **argv)
{
    options parsed;
    host_instance instance;
    host_device_info infos[HOST_MAX_DEVICES];
    char error[512];
    uint32_t chosen = 0;
    if (!options_parse(&parsed, "info", rows, sizeof rows / sizeof rows[0], argc, argv))
        return EXIT_USAGE;
    if (parsed.argument_count)
        return print_files(&parsed);
    printf("virga %s\n", virga_version());
    print_features();
    if (!host_instance_create(&instance, false, error, sizeof error)) {
        options_complain("info", "%s", error);
        return EXIT_FAILED;
    }
    const uint32_t count = host_devices_list(&instance, infos, HOST_MAX_DEVICES);
    const bool found = host_device_pick(infos, count, options_value(&parsed, "--device"), &chosen, error, sizeof error);
    for (uint32_t i = 0; i < count; i++) {
        const host_device_info *info = &infos[i];
        printf("%c %u  %s (%s), Vulkan %u.%u, %s, %.1f GiB\n", found && i == chosen ? '*' : ' ', i, info->name,
               host_device_type_name(info->type), VK_API_VERSION_MAJOR(info->api_version),
               VK_API_VERSION_MINOR(info->api_version), info->driver, (double)info->memory_bytes / 1073741824.0);
        if (!info->usable)
            printf("     not usable: %s\n", info->reason);
    }
    host_instance_destroy(&instance);
    if (found)
        return EXIT_OK;
    options_complain("info", "%s", error);
    return count && options_value(&parsed, "--device") ? EXIT_USAGE : EXIT_FAILED;
}
