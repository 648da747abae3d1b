/* calls_lavapipe.c - the random calls on software Vulkan with validation. The library checks no handle of Vulkan's, no
 * layout and no size of a host's buffer: these are true here, and calls go where they belong. One context. */
#include "calls.h"

#include "../gpu/watch.h"
#include "../host/effect_fixture.h"
#include "target.h"

enum { INDICES = 90 };

static fixture gpu;
static bool there, is_inside_pass, lost_frame;
static host_target picture;
static host_buffer words;  /* random numbers, and indices of its first vertices */
static host_buffer states; /* only for states: the library's copies would need a barrier before draws with it */
static host_image color, depth, motion;

static void must(bool good, const char *what)
{
    if (good)
        return;
    fprintf(stderr, "%s: %s\n", what, gpu.error);
    abort();
}

static void make_image(host_image *image, VkFormat format, VkImageUsageFlags usage, const char *name)
{
    const host_image_def def = {.format = format,
                                .extent = {CALLS_SIZE, CALLS_SIZE, 1},
                                .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                .name = name};
    must(host_image_create(&gpu.device, &def, image, gpu.error, sizeof gpu.error), name);
}

/* Random positions and numbers, in which the first words are indices. */
static void make_buffers(void)
{
    static uint32_t data[CALLS_BUFFER_BYTES / 4], zeros[CALLS_STATE_BYTES / 4];
    for (uint32_t i = 0; i < CALLS_BUFFER_BYTES / 4; i++) {
        const float number = (float)((i * 2654435761u) >> 8) / 16777216.0f - 0.5f;
        memcpy(&data[i], &number, 4);
        if (i < INDICES)
            data[i] = 100 + i * 7 % 50;
    }
    must(host_buffer_create_with(&gpu.device, data, sizeof data,
                                 VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                     VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                 "words", &words, gpu.error, sizeof gpu.error),
         "words");
    must(host_buffer_create_with(&gpu.device, zeros, sizeof zeros,
                                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT, "states", &states,
                                 gpu.error, sizeof gpu.error),
         "states");
}

static void open_device(void)
{
    VkCommandBuffer cmd;
    if (there)
        return;
    there = true;
    effect_device_lend(&gpu);
    watch.keep_pipelines = true;
    must(host_target_create(&gpu.device, CALLS_SIZE, CALLS_SIZE, &picture, gpu.error, sizeof gpu.error), "picture");
    make_image(&color, VK_FORMAT_R16G16B16A16_SFLOAT, 0, "color");
    make_image(&motion, VK_FORMAT_R16G16_SFLOAT, 0, "motion");
    make_image(&depth, VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, "depth");
    make_buffers();
    must(host_begin_frame(&gpu.device, &cmd, gpu.error, sizeof gpu.error), "frame");
    const host_image *const images[] = {&color, &motion, &depth};
    for (int i = 0; i < 3; i++)
        host_image_barrier(cmd, images[i], VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                           VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, 0, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                           VK_ACCESS_SHADER_READ_BIT);
    must(host_submit(&gpu.device, gpu.error, sizeof gpu.error) && host_wait(&gpu.device, gpu.error, sizeof gpu.error),
         "frame");
}

static void define(calls *c, uint32_t index, virga_context_def *def)
{
    (void)index;
    open_device();
    def->instance = gpu.instance.instance;
    def->physical_device = gpu.device.physical;
    def->device = gpu.device.device;
    def->queue_family = gpu.device.queue_family;
    def->get_instance_proc_addr = watch_get_instance_proc_addr;
    def->wide_lines = gpu.device.wide_lines && calls_once_in(c, 2);
    def->memory_budget = (VkDeviceSize)256 << 20;
}

/* ---- frames */

static void render(calls *c, uint32_t index, bool inside)
{
    if (inside)
        host_target_begin_layer(&picture, c->frames[index].cmd);
    else
        host_target_end_layer(&picture, c->frames[index].cmd);
    is_inside_pass = inside;
}

/* Submits what was recorded; a frame that is lost goes out empty. */
static void submit(calls *c, uint32_t index)
{
    host_device *device = &gpu.device;
    c->thrown_away = lost_frame;
    if (is_inside_pass)
        render(c, index, false);
    if (!c->frames[index].open || lost_frame) {
        const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                                .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
        must(!vkEndCommandBuffer(c->frames[index].cmd) &&
                 !vkResetCommandPool(device->device, device->frames[device->frame % HOST_FRAMES].pool, 0) &&
                 !vkBeginCommandBuffer(c->frames[index].cmd, &begin),
             "empty frame");
    }
    must(host_submit(device, gpu.error, sizeof gpu.error), "submit");
}

static void begin(calls *c, uint32_t index)
{
    calls_frames *f = &c->frames[index];
    open_device();
    if (f->cmd)
        submit(c, index);
    must(host_begin_frame(&gpu.device, &f->cmd, gpu.error, sizeof gpu.error), "frame");
    f->open = true;
    lost_frame = calls_once_in(c, 12);
}

static void wait(calls *c, uint32_t index)
{
    (void)c;
    (void)index;
    must(host_wait(&gpu.device, gpu.error, sizeof gpu.error), "wait");
}

/* Commands are not counted here; the stand-in does. */
static uint64_t commands(const calls *c, uint32_t index)
{
    (void)index;
    return c->made;
}

static bool is_lost(void)
{
    return false;
}

static bool is_inside(const calls *c, uint32_t index)
{
    (void)c;
    (void)index;
    return is_inside_pass;
}

/* ---- handles of the host */

static void target(calls *c, virga_target_def *def)
{
    host_target_describe_layer(&picture, def);
    def->render_pass_class = calls_below(c, 2);
}

static VkBuffer buffer(calls *c)
{
    (void)c;
    open_device();
    return words.buffer;
}

static VkBuffer state_buffer(calls *c)
{
    (void)c;
    open_device();
    return states.buffer;
}

static void image(calls *c, VkFormat format, virga_image *out)
{
    const host_image *from = format == VK_FORMAT_D32_SFLOAT      ? &depth
                             : format == VK_FORMAT_R16G16_SFLOAT ? &motion
                                                                 : &color;
    (void)c;
    open_device();
    *out = (virga_image){.image = from->image,
                         .view = from->view,
                         .format = from->format,
                         .extent = from->extent,
                         .layers = 1,
                         .before.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
}

static void close_sequence(calls *c)
{
    if (!there)
        return;
    if (c->frames[0].cmd)
        submit(c, 0);
    wait(c, 0);
    if (c->bytes)
        calls_wrong(c, "the end", "host memory is left");
    if (watch_sum(watch.live))
        calls_wrong(c, "the end", watch_alive());
    if (gpu.instance.messages || effect_device.fixture.instance.messages)
        calls_wrong(c, "the end", effect_device.fixture.instance.first_message);
}

static void close_device(void)
{
    kept_forget();
    host_image_destroy(&gpu.device, &color);
    host_image_destroy(&gpu.device, &motion);
    host_image_destroy(&gpu.device, &depth);
    host_buffer_destroy(&gpu.device, &words);
    host_buffer_destroy(&gpu.device, &states);
    host_target_destroy(&gpu.device, &picture);
    must(!effect_device_give_back(&gpu), "the device");
    effect_device_destroy();
}

const calls_device calls_lavapipe = {.honest = true,
                                     .contexts = 1,
                                     .define = define,
                                     .begin = begin,
                                     .wait = wait,
                                     .commands = commands,
                                     .lost = is_lost,
                                     .target = target,
                                     .render = render,
                                     .inside = is_inside,
                                     .buffer = buffer,
                                     .state_buffer = state_buffer,
                                     .image = image,
                                     .close = close_sequence,
                                     .end = close_device};
