/* test_builds.c - pipelines that are built later: in steps, or by a host's jobs on other threads. */
#include "gpu_fixture.h"

#include <pthread.h>
#include <stdatomic.h>
#include <unistd.h>

enum { MAX_JOBS = 256 };

/* A host's job system. Its jobs run when the test runs them. */
typedef struct job_list {
    struct {
        void (*job)(void *data);
        void *data;
    } jobs[MAX_JOBS];
    uint32_t count;
} job_list;

static void store_job(void *user, void (*job)(void *data), void *data)
{
    job_list *list = user;
    REQUIRE(list->count < MAX_JOBS);
    list->jobs[list->count].job = job;
    list->jobs[list->count++].data = data;
}

static void *run_jobs(void *user)
{
    job_list *list = user;
    for (uint32_t i = 0; i < list->count; i++)
        list->jobs[i].job(list->jobs[i].data);
    list->count = 0;
    return NULL;
}

static virga_context *make_context(gpu_fixture *f, virga_pipeline_build_mode when, job_list *jobs)
{
    virga_context_def def = gpu_context_def(f);
    virga_context *context = NULL;
    def.pipeline_build_mode = when;
    if (jobs)
        def.pipeline_jobs = (virga_pipeline_jobs){jobs, store_job};
    REQUIRE(virga_context_create(&def, &context) == VIRGA_OK);
    return context;
}

/* What the rain says to a step in a new frame, with nothing in the frame where it says no. */
static virga_result try_step(gpu_fixture *f, virga_context *context, virga_rain *rain)
{
    const virga_rain_step_info step = {.dt_s = 1.0 / 30, .camera_m = {0, 1.7, 0}};
    VkCommandBuffer cmd = gpu_begin_frame(f, context);
    const virga_result result = virga_rain_step(rain, cmd, &step);
    gpu_submit(f);
    gpu_wait(f);
    return result;
}

static void steps_build_as_many_as_requested(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = make_context(f, VIRGA_PIPELINES_DEFERRED, NULL);
    virga_rain *rain = gpu_rain(context);
    uint32_t before, left;
    assert_int_equal(watch.made[WATCH_Pipeline], 0);
    assert_int_equal(virga_pipelines_build(context, 0, &before), VIRGA_NOT_READY);
    assert_int_equal(watch.made[WATCH_Pipeline], 0);
    assert_true(before > 10);
    assert_int_equal(virga_pipelines_build(context, 3, &left), VIRGA_NOT_READY);
    assert_int_equal(watch.made[WATCH_Pipeline], 3);
    assert_int_equal(left, before - 3);
    assert_int_equal(virga_rain_ready(rain), VIRGA_NOT_READY);
    assert_int_equal(try_step(f, context, rain), VIRGA_NOT_READY);
    assert_true(virga_rain_time(rain) == 0);
    assert_int_equal(virga_pipelines_build(context, UINT32_MAX, &left), VIRGA_OK);
    assert_int_equal(left, 0);
    assert_int_equal(virga_rain_ready(rain), VIRGA_OK);
    assert_int_equal(try_step(f, context, rain), VIRGA_OK);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

static void draws_wait_for_their_target(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = make_context(f, VIRGA_PIPELINES_DEFERRED, NULL);
    virga_rain *rain = gpu_rain(context);
    gpu_picture picture;
    const virga_rain_step_info step = {.dt_s = 1.0 / 30, .camera_m = {0, 1.7, 0}};
    REQUIRE(virga_pipelines_build(context, UINT32_MAX, NULL) == VIRGA_OK);
    gpu_picture_open(f, context, &picture);
    REQUIRE(virga_rain_attach(rain, picture.target) == VIRGA_OK);
    VkCommandBuffer cmd = gpu_begin_frame(f, context);
    const virga_view view = gpu_view(&picture);
    REQUIRE(virga_rain_step(rain, cmd, &step) == VIRGA_OK);
    REQUIRE(virga_rain_prepare(rain, cmd, &view, virga_rain_time(rain)) == VIRGA_OK);
    host_target_begin_layer(&picture.images, cmd);
    assert_int_equal(virga_rain_draw(rain, cmd, picture.target), VIRGA_NOT_READY);
    REQUIRE(virga_pipelines_build(context, UINT32_MAX, NULL) == VIRGA_OK);
    assert_int_equal(virga_rain_draw(rain, cmd, picture.target), VIRGA_OK);
    host_target_end_layer(&picture.images, cmd);
    gpu_submit(f);
    gpu_wait(f);
    virga_rain_destroy(&rain);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
}

static void jobs_build_on_another_thread(void **state)
{
    gpu_fixture *f = *state;
    job_list jobs = {.count = 0};
    pthread_t thread;
    virga_context *context = make_context(f, VIRGA_PIPELINES_AS_JOBS, &jobs);
    virga_rain *rain = gpu_rain(context);
    assert_true(jobs.count > 10);
    assert_int_equal(try_step(f, context, rain), VIRGA_NOT_READY);
    REQUIRE(!pthread_create(&thread, NULL, run_jobs, &jobs));
    REQUIRE(!pthread_join(thread, NULL));
    assert_int_equal(virga_rain_ready(rain), VIRGA_NOT_READY); /* nobody has looked yet */
    assert_int_equal(try_step(f, context, rain), VIRGA_OK);    /* its frame begin does */
    virga_rain_destroy(&rain);
    virga_context_destroy(&context);
}

/* The usual thing on a quick way out of a loading screen. */
static void jobs_of_a_dead_effect_do_nothing(void **state)
{
    gpu_fixture *f = *state;
    job_list jobs = {.count = 0};
    virga_context *context = make_context(f, VIRGA_PIPELINES_AS_JOBS, &jobs);
    virga_rain *rain = gpu_rain(context);
    virga_memory_stats stats;
    uint32_t left;
    virga_rain_destroy(&rain);
    assert_int_equal(watch.live[WATCH_PipelineLayout], 0);
    run_jobs(&jobs);
    assert_int_equal(watch.made[WATCH_Pipeline], 0);
    assert_int_equal(virga_pipelines_build(context, 0, &left), VIRGA_OK);
    assert_int_equal(left, 0);
    virga_memory_get(context, &stats);
    assert_int_equal(stats.host_allocations, 1); /* the context's own */
    virga_context_destroy(&context);
}

static void jobs_may_be_forgotten(void **state)
{
    gpu_fixture *f = *state;
    job_list jobs = {.count = 0};
    virga_context *context = make_context(f, VIRGA_PIPELINES_AS_JOBS, &jobs);
    virga_rain *rain = gpu_rain(context);
    virga_rain_destroy(&rain);
    virga_context_destroy(&context); /* tear_down sees to it that nothing is left; ASan to the host's memory */
}

static atomic_int at_the_gate, gate_open;

static void wait_at_gate(void)
{
    atomic_store(&at_the_gate, 1);
    while (!atomic_load(&gate_open))
        usleep(1000);
}

/* What a running job reads stays until it has returned. */
static void layouts_outlive_a_running_job(void **state)
{
    gpu_fixture *f = *state;
    job_list jobs = {.count = 0};
    pthread_t thread;
    virga_context *context = make_context(f, VIRGA_PIPELINES_AS_JOBS, &jobs);
    virga_rain *rain = gpu_rain(context);
    atomic_store(&at_the_gate, 0);
    atomic_store(&gate_open, 0);
    watch.before_pipeline = wait_at_gate;
    REQUIRE(!pthread_create(&thread, NULL, run_jobs, &jobs));
    while (!atomic_load(&at_the_gate))
        usleep(1000);
    virga_rain_destroy(&rain);
    assert_true(watch.live[WATCH_PipelineLayout] > 0);
    atomic_store(&gate_open, 1);
    REQUIRE(!pthread_join(thread, NULL));
    assert_int_equal(watch.made[WATCH_Pipeline], 1); /* that of the job that ran already */
    REQUIRE(virga_frame_begin(context, 1, 0) == VIRGA_OK);
    assert_int_equal(watch.live[WATCH_PipelineLayout], 0);
    assert_int_equal(watch.live[WATCH_Pipeline], 0);
    virga_context_destroy(&context);
    watch.before_pipeline = NULL;
}

static void only_what_is_used_is_built(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = make_context(f, VIRGA_PIPELINES_ON_USE, NULL);
    virga_rain *rain = gpu_rain(context);
    gpu_picture picture;
    const virga_rain_step_info step = {.dt_s = 1.0 / 30, .camera_m = {0, 1.7, 0}};
    uint32_t left;
    gpu_picture_open(f, context, &picture);
    REQUIRE(virga_rain_attach(rain, picture.target) == VIRGA_OK);
    assert_int_equal(watch.made[WATCH_Pipeline], 0);
    assert_int_equal(virga_rain_ready(rain), VIRGA_OK);
    VkCommandBuffer cmd = gpu_begin_frame(f, context);
    const virga_view view = gpu_view(&picture);
    assert_int_equal(virga_rain_step(rain, cmd, &step), VIRGA_OK);
    const uint32_t stepped = watch.made[WATCH_Pipeline];
    assert_true(stepped > 0);
    assert_int_equal(virga_rain_prepare(rain, cmd, &view, virga_rain_time(rain)), VIRGA_OK);
    host_target_begin_layer(&picture.images, cmd);
    assert_int_equal(virga_rain_draw(rain, cmd, picture.target), VIRGA_OK);
    host_target_end_layer(&picture.images, cmd);
    gpu_submit(f);
    gpu_wait(f);
    const uint32_t used = watch.made[WATCH_Pipeline];
    assert_true(used > stepped);
    assert_int_equal(try_step(f, context, rain), VIRGA_OK);
    assert_int_equal(watch.made[WATCH_Pipeline], used);
    assert_int_equal(virga_pipelines_build(context, 1, &left), VIRGA_NOT_READY);
    assert_int_equal(watch.made[WATCH_Pipeline], used + 1);
    assert_true(left > 0);
    assert_int_equal(virga_pipelines_build(context, UINT32_MAX, &left), VIRGA_OK);
    assert_int_equal(left, 0);
    virga_rain_destroy(&rain);
    gpu_picture_close(f, &picture);
    virga_context_destroy(&context);
}

/* The first pass of a step can not be built. */
static void a_failed_build_on_use_is_told_by_its_call(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = make_context(f, VIRGA_PIPELINES_ON_USE, NULL);
    virga_rain *broken = gpu_rain(context);
    gpu_forget_log(f);
    watch_fail(1, VK_ERROR_INITIALIZATION_FAILED);
    assert_int_equal(try_step(f, context, broken), VIRGA_ERROR_VULKAN);
    watch_fail(0, VK_SUCCESS);
    assert_one_error(f, VIRGA_LOG_VULKAN_CALL);
    assert_int_equal(virga_rain_ready(broken), VIRGA_ERROR_VULKAN);
    assert_int_equal(try_step(f, context, broken), VIRGA_ERROR_VULKAN);
    virga_rain *whole = gpu_rain(context);
    assert_int_equal(try_step(f, context, whole), VIRGA_OK);
    assert_int_equal(f->errors, 1); /* said once */
    virga_rain_destroy(&broken);
    virga_rain_destroy(&whole);
    virga_context_destroy(&context);
}

static void failure_stays_with_its_effect(void **state)
{
    gpu_fixture *f = *state;
    virga_context *context = make_context(f, VIRGA_PIPELINES_DEFERRED, NULL);
    virga_rain *broken = gpu_rain(context);
    gpu_forget_log(f);
    watch_fail(4, VK_ERROR_INITIALIZATION_FAILED);
    assert_int_equal(virga_pipelines_build(context, UINT32_MAX, NULL), VIRGA_ERROR_VULKAN);
    watch_fail(0, VK_SUCCESS);
    assert_one_error(f, VIRGA_LOG_VULKAN_CALL);
    virga_rain *whole = gpu_rain(context);
    assert_int_equal(virga_pipelines_build(context, UINT32_MAX, NULL), VIRGA_OK);
    assert_int_equal(virga_rain_ready(broken), VIRGA_ERROR_VULKAN);
    assert_int_equal(try_step(f, context, broken), VIRGA_ERROR_VULKAN);
    assert_int_equal(try_step(f, context, whole), VIRGA_OK);
    assert_int_equal(f->errors, 1); /* said once */
    virga_rain_destroy(&broken);
    virga_rain_destroy(&whole);
    virga_context_destroy(&context);
}

static void definitions_are_checked(void **state)
{
    gpu_fixture *f = *state;
    virga_context_def def = gpu_context_def(f);
    virga_context *context = (virga_context *)f;
    def.pipeline_build_mode = (virga_pipeline_build_mode)4;
    gpu_forget_log(f);
    assert_int_equal(virga_context_create(&def, &context), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_ARGUMENT);
    def.pipeline_build_mode = VIRGA_PIPELINES_AS_JOBS;
    gpu_forget_log(f);
    assert_int_equal(virga_context_create(&def, &context), VIRGA_ERROR_INVALID);
    assert_one_error(f, VIRGA_LOG_ARGUMENT);
    assert_null(context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        gpu_test(steps_build_as_many_as_requested),
        gpu_test(draws_wait_for_their_target),
        gpu_test(jobs_build_on_another_thread),
        gpu_test(jobs_of_a_dead_effect_do_nothing),
        gpu_test(jobs_may_be_forgotten),
        gpu_test(layouts_outlive_a_running_job),
        gpu_test(only_what_is_used_is_built),
        gpu_test(a_failed_build_on_use_is_told_by_its_call),
        gpu_test(failure_stays_with_its_effect),
        gpu_test(definitions_are_checked),
    };
    return effect_fixture_close(cmocka_run_group_tests_name("builds", tests, NULL, NULL));
}
