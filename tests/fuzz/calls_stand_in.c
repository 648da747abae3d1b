/* calls_stand_in.c - the random calls on a device that a test answers: no driver, and nothing that it checks itself. */
#include "calls.h"

#include "stand_in.h"

enum { RING = 12 };

/* Command buffers of the newest frames of a context, and the submissions in which they went. */
static struct ring {
    VkCommandBuffer buffers[RING];
    uint64_t newest;
    bool inside;
} rings[CALLS_CONTEXTS + 1];

static VkDeviceMemory host_memory;
static VkBuffer host_buffer;

/* ---- memory of the host, if it has callbacks: not mapped but where it must be */

static VkResult host_alloc(void *user, const VkMemoryRequirements *need, uint32_t type, bool mapped,
                           virga_memory_block *block)
{
    (void)user;
    (void)type;
    if (stand_in.lost)
        return VK_ERROR_DEVICE_LOST;
    if (stand_in.fail_in == 1) {
        stand_in.fail_in = 0;
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    if (need->size > 1 << 30)
        return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    if (!host_memory)
        host_memory = (VkDeviceMemory)stand_in_object(VK_OBJECT_TYPE_DEVICE_MEMORY);
    *block = (virga_memory_block){.memory = host_memory, .mapped = mapped ? calloc(1, need->size) : NULL};
    block->host_handle = block->mapped;
    return mapped && !block->mapped ? VK_ERROR_OUT_OF_HOST_MEMORY : VK_SUCCESS;
}

static void host_free(void *user, const virga_memory_block *block)
{
    (void)user;
    free(block->host_handle);
}

static void define(calls *c, uint32_t index, virga_context_def *def)
{
    def->instance = stand_in_instance();
    def->physical_device = stand_in_physical();
    def->device = stand_in_device(index);
    def->get_instance_proc_addr = stand_in_get;
    def->queue_family = calls_slip(c, 20) ? 1 : 0;
    if (calls_once_in(c, 6))
        def->device_memory = (virga_device_memory){c, host_alloc, host_free};
    stand_in.properties.deviceType =
        calls_once_in(c, 2) ? VK_PHYSICAL_DEVICE_TYPE_CPU : VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    stand_in.properties.limits.strictLines = calls_once_in(c, 2);
    stand_in.properties.limits.maxTexelBufferElements = calls_once_in(c, 3) ? 65536 : 1 << 27;
}

/* ---- frames */

static void begin(calls *c, uint32_t index)
{
    struct ring *ring = &rings[index];
    calls_frames *f = &c->frames[index];
    if (f->open && !calls_once_in(c, 10)) /* else it is lost, and the library is not told */
        stand_in_submit(f->cmd);
    ring->newest++;
    ring->inside = false;
    VkCommandBuffer *next = &ring->buffers[ring->newest % RING];
    *next = stand_in_begin(*next);
    f->cmd = *next;
    f->open = true;
    /* Failures of the device and of the host's memory, and a lost device, at some call to come. */
    static const VkResult failures[] = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY,
                                        VK_ERROR_INITIALIZATION_FAILED, VK_ERROR_DEVICE_LOST};
    if (calls_slip(c, 8)) {
        stand_in.fail_in = 1 + calls_below(c, 300);
        stand_in.failure = failures[calls_below(c, !c->careful && calls_once_in(c, 3) ? 4 : 3)];
    }
    if (calls_slip(c, 8))
        c->fail_alloc = 1 + calls_below(c, 40);
}

static void wait(calls *c, uint32_t index)
{
    (void)c;
    (void)index;
    stand_in_done(stand_in_submitted());
}

static uint64_t commands(const calls *c, uint32_t index)
{
    return c->frames[index].cmd ? stand_in_count(c->frames[index].cmd).commands : 0;
}

static bool is_lost(void)
{
    return stand_in.lost;
}

static void render(calls *c, uint32_t index, bool inside)
{
    (void)c;
    rings[index].inside = inside;
}

static bool is_inside(const calls *c, uint32_t index)
{
    (void)c;
    return rings[index].inside;
}

/* ---- handles of the host */

static void target(calls *c, virga_target_def *def)
{
    static const VkFormat formats[] = {VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8_UINT,
                                       VK_FORMAT_D32_SFLOAT};
    def->kind = (virga_target_kind)calls_below(c, 2);
    if (def->kind == VIRGA_TARGET_RENDER_PASS && !calls_once_in(c, 10))
        def->render_pass = (VkRenderPass)stand_in_object(VK_OBJECT_TYPE_RENDER_PASS);
    if (def->kind == VIRGA_TARGET_DYNAMIC || calls_once_in(c, 2))
        def->color_formats[0] = formats[calls_slip(c, 6) ? calls_below(c, 4) : calls_below(c, 2)];
    def->depth_attached = calls_once_in(c, 2);
    def->depth_format = def->depth_attached ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;
    def->render_pass_class = calls_below(c, 3);
}

static VkBuffer buffer(calls *c)
{
    (void)c;
    if (!host_buffer)
        host_buffer = (VkBuffer)stand_in_object(VK_OBJECT_TYPE_BUFFER);
    return host_buffer;
}

static void image(calls *c, VkFormat format, virga_image *out)
{
    (void)c;
    out->image = (VkImage)stand_in_object(VK_OBJECT_TYPE_IMAGE);
    out->view = (VkImageView)stand_in_object(VK_OBJECT_TYPE_IMAGE_VIEW);
    out->format = format;
    out->extent = (VkExtent3D){CALLS_SIZE, CALLS_SIZE, 1};
    out->layers = 1;
    out->before.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
}

static void close_device(calls *c)
{
    if (c->bytes)
        calls_wrong(c, "the end", "host memory is left");
    if (!stand_in_close())
        calls_wrong(c, "the end", "objects are left");
    memset(rings, 0, sizeof rings);
    host_memory = VK_NULL_HANDLE;
    host_buffer = VK_NULL_HANDLE;
    const uint32_t garbage = (uint32_t)c->random | 1;
    stand_in_open();
    stand_in.garbage = garbage & 6 ? 0 : garbage;
}

const calls_device calls_stand_in = {.contexts = CALLS_CONTEXTS,
                                     .define = define,
                                     .begin = begin,
                                     .wait = wait,
                                     .commands = commands,
                                     .lost = is_lost,
                                     .target = target,
                                     .render = render,
                                     .inside = is_inside,
                                     .buffer = buffer,
                                     .state_buffer = buffer,
                                     .image = image,
                                     .close = close_device};
