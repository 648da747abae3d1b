/* test_machine.c - processors and memory of a machine, of containers and of groups in groups. */
#include "frame/machine.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static char root[] = "/tmp/virga-machine-XXXXXX";

static void put(const char *path, const char *text)
{
    char full[512], command[600];
    snprintf(full, sizeof full, "%s/%s", root, path);
    snprintf(command, sizeof command, "mkdir -p \"$(dirname '%s')\"", full);
    assert_int_equal(system(command), 0);
    FILE *file = fopen(full, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static int open_root(void **state)
{
    (void)state;
    strcpy(root + sizeof root - 7, "XXXXXX");
    if (!mkdtemp(root))
        return -1;
    put("proc/meminfo", "MemTotal:       64000000 kB\nMemFree:        1000 kB\nMemAvailable:   32000000 kB\n");
    return 0;
}

static int close_root(void **state)
{
    char command[128];
    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", root);
    return system(command);
}

static void without_groups_all_of_the_machine_is_free(void **state)
{
    (void)state;
    assert_true(machine_processors(root) >= 1);
    assert_int_equal(machine_processors(root), machine_processors("/nowhere"));
    assert_int_equal(machine_free_bytes(root), 32000000ull * 1024);
    assert_int_equal(machine_free_bytes("/nowhere"), 0);
}

/* Caches of files can be given up. */
static void a_container_has_what_its_group_has(void **state)
{
    (void)state;
    put("proc/self/cgroup", "0::/\n");
    put("sys/fs/cgroup/memory.max", "4000000000\n");
    put("sys/fs/cgroup/memory.current", "1500000000\n");
    put("sys/fs/cgroup/memory.stat", "anon 900000000\ninactive_file 500000000\nactive_file 7\n");
    put("sys/fs/cgroup/cpu.max", "150000 100000\n");
    assert_int_equal(machine_free_bytes(root), 3000000000u);
    assert_int_equal(machine_processors(root), 1);
}

static void a_group_without_limits_takes_nothing(void **state)
{
    (void)state;
    put("proc/self/cgroup", "0::/a\n");
    put("sys/fs/cgroup/a/memory.max", "max\n");
    put("sys/fs/cgroup/a/memory.current", "1500000000\n");
    put("sys/fs/cgroup/a/cpu.max", "max 100000\n");
    assert_int_equal(machine_free_bytes(root), 32000000ull * 1024);
    assert_int_equal(machine_processors(root), machine_processors(""));
}

static void the_narrowest_of_nested_groups_counts(void **state)
{
    (void)state;
    put("proc/self/cgroup", "0::/slurm/job/step\n");
    put("sys/fs/cgroup/slurm/job/step/memory.max", "8000000000\n");
    put("sys/fs/cgroup/slurm/job/step/memory.current", "0\n");
    put("sys/fs/cgroup/slurm/job/memory.max", "6000000000\n");
    put("sys/fs/cgroup/slurm/job/memory.current", "5000000000\n");
    assert_int_equal(machine_free_bytes(root), 1000000000u);
    put("sys/fs/cgroup/slurm/memory.max", "10\n");
    put("sys/fs/cgroup/slurm/memory.current", "20\n");
    assert_int_equal(machine_free_bytes(root), 0);
}

/* The path is that outside of the container, and is not there. */
static void version_1_has_a_tree_for_each_kind(void **state)
{
    (void)state;
    put("proc/self/cgroup", "5:memory:/docker/1234\n4:cpu,cpuacct:/docker/1234\n1:name=systemd:/docker/1234\n");
    put("sys/fs/cgroup/memory/memory.limit_in_bytes", "2000000000\n");
    put("sys/fs/cgroup/memory/memory.usage_in_bytes", "500000000\n");
    put("sys/fs/cgroup/memory/memory.stat", "inactive_file 1\ntotal_inactive_file 100000000\n");
    put("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "100000\n");
    put("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
    assert_int_equal(machine_free_bytes(root), 1600000000u);
    assert_int_equal(machine_processors(root), 1);
    put("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
    assert_int_equal(machine_processors(root), machine_processors(""));
}

static void damaged_files_are_no_limits(void **state)
{
    (void)state;
    put("proc/self/cgroup", "\n::\nno colons\n0::/a\n");
    put("sys/fs/cgroup/a/memory.max", "many\n");
    put("sys/fs/cgroup/a/memory.current", "");
    put("sys/fs/cgroup/a/cpu.max", "100000 0\n");
    assert_int_equal(machine_free_bytes(root), 32000000ull * 1024);
    assert_int_equal(machine_processors(root), machine_processors(""));
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, open_root, close_root)
    const struct CMUnitTest tests[] = {
        TEST(without_groups_all_of_the_machine_is_free), TEST(a_container_has_what_its_group_has),
        TEST(a_group_without_limits_takes_nothing),      TEST(the_narrowest_of_nested_groups_counts),
        TEST(version_1_has_a_tree_for_each_kind),        TEST(damaged_files_are_no_limits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
