/* test_counting.c - passes that are counted (tools/bench/model): lanes, trips and bytes are those of the shader, its
 * results are the same with and without, and a modelled time is what a pen and paper give. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <stdlib.h>
#include <string.h>

#include "bench/model/block_cost.h"
#include "bench/model/here.h"
#include "bench/model/model.h"

#include "plate_fixture.h"

#include "branched_any_comp.spv.h"
#include "branched_constant_comp.spv.h"
#include "branched_known_comp.spv.h"
#include "counted_comp.spv.h"
#include "divided_10_comp.spv.h"
#include "divided_8_comp.spv.h"
#include "divided_any_comp.spv.h"
#include "fused_0_comp.spv.h"
#include "fused_1_comp.spv.h"
#include "fused_2_comp.spv.h"

#define LANES   1024
#define WORKING 1000
#define WORDS   2048

static const VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;

typedef struct pass {
    host_buffer data;
    VkBuffer counted; /* the same memory, made as a context makes its buffers */
    host_bindings bindings;
    VkPipelineLayout layout;
    VkPipeline pipeline;
} pass;

/* As a context finds them. */
#define COUNTED(f, name)                                                                                    \
    ((PFN_vk##name)((PFN_vkGetDeviceProcAddr)counting_get(NULL, "vkGetDeviceProcAddr"))((f)->device.device, \
                                                                                        "v"                 \
                                                                                        "k" #name))

static void open_data(fixture *f, pass *p)
{
    char *error = f->error;
    const size_t size = sizeof f->error;
    const host_bindings_def def = {.shape = {&type, 1, VK_SHADER_STAGE_COMPUTE_BIT}, .set_count = 1};
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = WORDS * 4, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    VkMemoryRequirements needs;
    assert_true(host_buffer_create(&f->device, WORDS * 4, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, HOST_BUFFER_READBACK,
                                   "data", &p->data, error, size));
    uint32_t *words = p->data.mapped;
    for (uint32_t i = 0; i < WORDS; i++)
        words[i] = i * 2654435761u;
    assert_true(host_bindings_create(&f->device, &def, &p->bindings, error, size));
    assert_int_equal(COUNTED(f, CreateBuffer)(f->device.device, &info, NULL, &p->counted), VK_SUCCESS);
    vkGetBufferMemoryRequirements(f->device.device, p->counted, &needs);
    vkBindBufferMemory(f->device.device, p->counted, p->data.memory, 0);
    const VkDescriptorBufferInfo whole = {p->counted, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                        .dstSet = p->bindings.sets[0],
                                        .descriptorCount = 1,
                                        .descriptorType = type,
                                        .pBufferInfo = &whole};
    COUNTED(f, UpdateDescriptorSets)(f->device.device, 1, &write, 0, NULL);
}

static void open_pass(fixture *f, pass *p)
{
    memset(p, 0, sizeof *p);
    assert_true(counting_open(&f->device, f->error, sizeof f->error));
    open_data(f, p);
    const VkPipelineLayoutCreateInfo layout = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                               .setLayoutCount = 1,
                                               .pSetLayouts = &p->bindings.set_layout};
    assert_int_equal(COUNTED(f, CreatePipelineLayout)(f->device.device, &layout, NULL, &p->layout), VK_SUCCESS);
    const VkShaderModuleCreateInfo code = {.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                           .codeSize = sizeof counted_comp_spv,
                                           .pCode = counted_comp_spv};
    VkShaderModule module;
    assert_int_equal(COUNTED(f, CreateShaderModule)(f->device.device, &code, NULL, &module), VK_SUCCESS);
    const VkComputePipelineCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                              .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                        .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                        .module = module,
                                                        .pName = "main"},
                                              .layout = p->layout};
    assert_int_equal(COUNTED(f, CreateComputePipelines)(f->device.device, VK_NULL_HANDLE, 1, &info, NULL, &p->pipeline),
                     VK_SUCCESS);
    vkDestroyShaderModule(f->device.device, module, NULL);
    const VkDebugUtilsObjectNameInfoEXT name = {.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                                .objectType = VK_OBJECT_TYPE_PIPELINE,
                                                .objectHandle = (uint64_t)p->pipeline,
                                                .pObjectName = "test.counted"};
    COUNTED(f, SetDebugUtilsObjectNameEXT)(f->device.device, &name);
}

static void close_pass(fixture *f, pass *p)
{
    COUNTED(f, DestroyPipeline)(f->device.device, p->pipeline, NULL);
    vkDestroyBuffer(f->device.device, p->counted, NULL);
    vkDestroyPipelineLayout(f->device.device, p->layout, NULL);
    host_bindings_destroy(&f->device, &p->bindings);
    host_buffer_destroy(&f->device, &p->data);
    counting_close(&f->device);
    assert_int_equal(f->instance.messages, 0);
}

static void run_pass(fixture *f, pass *p)
{
    VkCommandBuffer cmd;
    assert_true(host_begin_frame(&f->device, &cmd, f->error, sizeof f->error));
    COUNTED(f, CmdBindPipeline)(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p->pipeline);
    COUNTED(f, CmdBindDescriptorSets)
    (cmd, VK_PIPELINE_BIND_POINT_COMPUTE, p->layout, 0, 1, p->bindings.sets, 0, NULL);
    COUNTED(f, CmdDispatch)(cmd, LANES / 32, 1, 1);
    host_memory_barrier(cmd, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT,
                        VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    assert_true(host_submit(&f->device, f->error, sizeof f->error));
    assert_true(host_wait(&f->device, f->error, sizeof f->error));
    counting_end_frame();
}

/* Trips of all lanes, and of all subgroups of 8, each of which goes on as long as one of its lanes does. */
static void expect_trips(uint32_t *lanes, uint32_t *groups)
{
    *lanes = *groups = 0;
    for (uint32_t first = 0; first < WORKING; first += 8) {
        uint32_t most = 0;
        for (uint32_t i = first; i < first + 8 && i < WORKING; i++) {
            *lanes += i % 7;
            most = i % 7 > most ? i % 7 : most;
        }
        *groups += most;
    }
}

static void lanes_trips_and_bytes_are_the_shaders(void **state)
{
    fixture *f = *state;
    pass p;
    uint32_t lanes, groups, loop_groups = 0;
    double read = 0, written = 0;
    open_pass(f, &p);
    run_pass(f, &p);
    expect_trips(&lanes, &groups);
    assert_int_equal(counting_pass_count(), 1);
    const counted_pass *counted = counting_pass(0);
    const counted_stage *stage = &counted->stages[0];
    const uint32_t *numbers = counting_numbers() + stage->first;
    assert_string_equal(counted->name, "test.counted");
    assert_int_equal(counted->calls, 1);
    assert_int_equal(numbers[0], LANES);
    assert_int_equal(numbers[1], LANES / 8);
    assert_true(stage->sizes[0] == WORDS * 4.0);
    for (uint32_t i = 0; i < stage->costs.block_count; i++) {
        const block_cost *b = &stage->costs.blocks[i];
        read += (double)b->bytes_read[0] * numbers[2 * b->runs_as];
        written += (double)b->bytes_written[0] * numbers[2 * b->runs_as];
        if (b->bytes_read[0] > 0)
            loop_groups += numbers[2 * b->runs_as + 1];
    }
    assert_true(read == 4.0 * lanes);
    assert_true(written == 4.0 * WORKING);
    assert_int_equal(loop_groups, groups);
    close_pass(f, &p);
}

static void results_are_the_same_with_and_without(void **state)
{
    fixture *f = *state;
    pass p;
    open_pass(f, &p);
    for (int run = 0; run < 3; run++) { /* the third is not counted */
        uint32_t *words = p.data.mapped;
        memset(words + LANES, 0, LANES * 4);
        run_pass(f, &p);
        host_buffer_invalidate(&f->device, &p.data);
        for (uint32_t i = 0; i < LANES; i++) {
            uint32_t sum = 0;
            for (uint32_t k = 0; i < WORKING && k < i % 7; k++)
                sum += words[(i + k) & 1023];
            sum = i & 1 && i < WORKING ? sum * 3 + 1 : sum;
            assert_int_equal(words[LANES + i], sum);
        }
    }
    assert_int_equal(counting_pass(0)->frames, 3);
    close_pass(f, &p);
}

/* A card of 1 byte and 1 load a second, and no end of everything else. */
static void a_modelled_time_is_that_of_pen_and_paper(void **state)
{
    fixture *f = *state;
    pass p;
    model_pass passes[MODEL_MAX_PASSES];
    uint32_t lanes, groups;
    model_card card = {.lanes = 8,
                       .simds = 1,
                       .clock_hz = 1e30,
                       .waves_per_simd = 1e9,
                       .memory_bytes_s = 1,
                       .cache_bytes_s = 1e30,
                       .pixels_s = 1e30,
                       .latency_s = 1e-30};
    open_pass(f, &p);
    run_pass(f, &p);
    expect_trips(&lanes, &groups);
    assert_int_equal(model_passes(&card, passes), 1);
    assert_int_equal(passes[0].bound, MODEL_MEMORY);
    /* What is asked for is more than there is: each byte of the buffer once. */
    assert_true(4.0 * lanes + 4.0 * WORKING > WORDS * 4.0);
    assert_true(passes[0].total_s == WORDS * 4.0);
    card.memory_bytes_s = 1e30;
    card.latency_s = 1;
    model_passes(&card, passes);
    assert_int_equal(passes[0].bound, MODEL_LATENCY);
    assert_float_equal(passes[0].total_s, (double)groups / (LANES / 8), 1e-9); /* all waves at once, one load a trip */
    close_pass(f, &p);
}

/* Here the parts of a pass add up, and it is timed in the frames that do not count it: the third, fifth, ... */
static void a_pass_here_is_the_sum_of_its_work_and_is_timed(void **state)
{
    fixture *f = *state;
    pass p;
    model_pass passes[MODEL_MAX_PASSES];
    const model_card kept = model_here;
    uint32_t lanes, groups;
    double sum = 0;
    open_pass(f, &p);
    assert_true(counting_time_calls(f->error, sizeof f->error));
    for (int frame = 0; frame < 5; frame++)
        run_pass(f, &p);
    for (int i = 0; i < MODEL_WORKS; i++)
        model_here.issue[i] = 1 + i;
    model_here.memory_bytes_s = WORDS * 4;
    model_here.call_s = 3;
    assert_int_equal(model_passes(&model_here, passes), 1);
    for (int i = 0; i < MODEL_WORKS; i++)
        sum += passes[0].work[i] * (1 + i);
    expect_trips(&lanes, &groups);
    assert_true(passes[0].work[MODEL_LOADS] >= groups && passes[0].work[MODEL_START] == LANES / 8);
    assert_float_equal(passes[0].total_s, sum * 1e-9 + 1 + 3, 1e-9);
    assert_true(passes[0].measured_s > 1e-6 && passes[0].measured_s < 10);
    model_here = kept;
    close_pass(f, &p);
}

/* Kernels find what each kind of work takes: more than nothing for all, and less for a sum than for a root or load. */
static void what_this_device_takes_is_found_by_kernels(void **state)
{
    fixture *f = *state;
    const model_card kept = model_here;
    host_target target = {0};
    assert_true(host_target_create(&f->device, 640, 360, &target, f->error, sizeof f->error));
    assert_true(counting_open(&f->device, f->error, sizeof f->error));
    assert_true(counting_time_calls(f->error, sizeof f->error));
    assert_true(model_here_measure(&f->device, &target, f->error, sizeof f->error));
    assert_true(model_here.call_s > 0 && model_here.memory_bytes_s < 1e13);
    assert_true(model_here.issue[MODEL_LOADS] > model_here.issue[MODEL_FULL]);
    assert_true(model_here.issue[MODEL_SLOW] > model_here.issue[MODEL_FULL]);
    assert_true(model_here.issue[MODEL_FRAGMENT] > 0);
    model_here = kept;
    counting_close(&f->device);
    host_target_destroy(&f->device, &target);
}

static float operations(const uint32_t *code, size_t bytes, float *slow)
{
    block_costs costs;
    float sum = 0;
    *slow = 0;
    assert_true(block_costs_read(code, bytes / 4, &costs));
    for (uint32_t i = 0; i < costs.block_count; i++) {
        sum += costs.blocks[i].full;
        *slow += costs.blocks[i].slow;
    }
    block_costs_free(&costs);
    return sum;
}

static void a_product_and_a_sum_are_one_operation_unless_they_are_precise(void **state)
{
    (void)state;
    float slow;
    const float fused = operations(fused_0_comp_spv, sizeof fused_0_comp_spv, &slow);
    assert_float_equal(operations(fused_1_comp_spv, sizeof fused_1_comp_spv, &slow), fused + 4, 0);
    assert_float_equal(operations(fused_2_comp_spv, sizeof fused_2_comp_spv, &slow), fused + 4, 0);
}

/* Four quotients: over 8 they are shifts, over 10 each is a product's high word and a shift. */
static void a_quotient_by_a_constant_is_no_division(void **state)
{
    (void)state;
    float by_8, by_10, by_any;
    const float shifts = operations(divided_8_comp_spv, sizeof divided_8_comp_spv, &by_8);
    const float products = operations(divided_10_comp_spv, sizeof divided_10_comp_spv, &by_10);
    const float divisions = operations(divided_any_comp_spv, sizeof divided_any_comp_spv, &by_any);
    assert_float_equal(by_8, 0, 0);
    assert_float_equal(by_10, 4, 0);
    assert_float_equal(by_any, 20, 0);
    assert_float_equal(products, shifts, 0);
    assert_true(divisions >= shifts + 44); /* and the place of what it is divided by */
}

static float branches(const uint32_t *code, size_t bytes)
{
    block_costs costs;
    float sum = 0;
    assert_true(block_costs_read(code, bytes / 4, &costs));
    for (uint32_t i = 0; i < costs.block_count; i++)
        sum += costs.blocks[i].branch;
    block_costs_free(&costs);
    return sum;
}

/* A driver knows a pipeline's constants when it compiles, and keeps one side. */
static void a_branch_on_what_is_known_costs_nothing(void **state)
{
    (void)state;
    assert_float_equal(branches(branched_any_comp_spv, sizeof branched_any_comp_spv), 1, 0);
    assert_float_equal(branches(branched_constant_comp_spv, sizeof branched_constant_comp_spv), 0, 0);
    assert_float_equal(branches(branched_known_comp_spv, sizeof branched_known_comp_spv), 0, 0);
}

static void a_card_is_found_by_its_name(void **state)
{
    (void)state;
    assert_ptr_equal(model_card_find("desktop"), &model_desktop);
    assert_ptr_equal(model_card_find("handheld"), &model_handheld);
    assert_ptr_equal(model_card_find("here"), &model_here);
    assert_null(model_card_find("phone"));
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    counting_prepare();
    if (fixture_begin(f) && f->device.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU)
        return 0;
    fprintf(stderr, "no software device %s\n", f->error);
    exit(77);
}

static int tear_down(void **state)
{
    fixture *f = *state;
    const uint32_t wrong = fixture_end(f);
    free(f);
    return wrong ? -1 : 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lanes_trips_and_bytes_are_the_shaders),
        cmocka_unit_test(results_are_the_same_with_and_without),
        cmocka_unit_test(a_modelled_time_is_that_of_pen_and_paper),
        cmocka_unit_test(a_pass_here_is_the_sum_of_its_work_and_is_timed),
        cmocka_unit_test(what_this_device_takes_is_found_by_kernels),
        cmocka_unit_test(a_product_and_a_sum_are_one_operation_unless_they_are_precise),
        cmocka_unit_test(a_quotient_by_a_constant_is_no_division),
        cmocka_unit_test(a_branch_on_what_is_known_costs_nothing),
        cmocka_unit_test(a_card_is_found_by_its_name),
    };
    return fixture_result(cmocka_run_group_tests(tests, set_up, tear_down));
}
