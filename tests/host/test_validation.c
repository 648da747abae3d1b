/* test_validation.c - proves that validation and synchronization validation are on: a hazard made on purpose must be
 * reported. Without this, silence in the other tests would mean nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>

#include "plate_fixture.h"

static void hazard_is_reported(void **state)
{
    fixture *f = *state;
    host_buffer a = {0}, b = {0};
    VkCommandBuffer cmd;
    const VkBufferUsageFlags usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    assert_true(host_buffer_create(&f->device, 256, usage, HOST_BUFFER_DEVICE, "a", &a, f->error, sizeof f->error));
    assert_true(host_buffer_create(&f->device, 256, usage, HOST_BUFFER_DEVICE, "b", &b, f->error, sizeof f->error));
    assert_true(host_begin_frame(&f->device, &cmd, f->error, sizeof f->error));
    VkBufferCopy all = {.size = 256};
    vkCmdFillBuffer(cmd, a.buffer, 0, 256, 7);
    vkCmdCopyBuffer(cmd, a.buffer, b.buffer, 1, &all); /* reads what the fill may not have written yet */
    assert_true(host_submit(&f->device, f->error, sizeof f->error));
    assert_true(host_wait(&f->device, f->error, sizeof f->error));
    assert_true(f->instance.messages > 0);
    assert_non_null(strstr(f->instance.first_message, "SYNC-HAZARD"));
    host_buffer_destroy(&f->device, &a);
    host_buffer_destroy(&f->device, &b);
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    bool there = fixture_begin(f);
    if (there && f->instance.validation)
        return 0;
    fprintf(stderr, "no device, or the validation layer is not installed %s\n", f->error);
    exit(77);
}

static int tear_down(void **state)
{
    fixture *f = *state;
    uint32_t live = host_device_destroy(&f->device);
    host_instance_destroy(&f->instance);
    free(f);
    fixture_wrong += live;
    return live ? -1 : 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(hazard_is_reported)};
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
