/* test_rain_cpp.cpp - the C++ of the page runs: two frames, an error that is thrown, and nothing is left. */
#include "rain.cpp"

#include <cstdio>

extern "C" {
#include "stand_in.h"
}

static int failed;
#define EXPECT(condition) (condition) ? void() : (void)(failed++, std::printf("not so: %s\n", #condition))

static virga_context_def context_def()
{
    virga_context_def def = virga_default_context_def();
    def.instance = stand_in_instance();
    def.physical_device = stand_in_physical();
    def.device = stand_in_device(0);
    def.get_instance_proc_addr = stand_in_get;
    return def;
}

static void run_frames(virga_target_def target)
{
    Rain rain(context_def(), target, virga_default_scene_def());
    virga_scene_frame frame{};
    frame.dt_s = 1.0 / 30;
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    for (uint64_t index = 1; index <= 2; index++) {
        cmd = stand_in_begin(cmd);
        rain.step(cmd, index, index - 1, frame);
        EXPECT(stand_in_count(cmd).dispatches > 0);
        rain.draw(cmd); /* no view was prepared: a remark, and nothing to throw for */
        stand_in_submit(cmd);
        stand_in_done(stand_in_submitted());
    }
}

int main()
{
    stand_in_open();
    virga_target_def target = virga_default_target_def();
    std::string said;
    try {
        run_frames(target); /* without a render pass */
    } catch (const std::runtime_error &error) {
        said = error.what();
    }
    EXPECT(said == "target: VIRGA_ERROR_INVALID");
    EXPECT(stand_in.live == 0);
    target.kind = VIRGA_TARGET_DYNAMIC;
    target.color_formats[0] = VK_FORMAT_R16G16B16A16_SFLOAT;
    target.depth_format = VK_FORMAT_D32_SFLOAT;
    run_frames(target);
    EXPECT(stand_in_close());
    return failed != 0;
}
