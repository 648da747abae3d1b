// panel.cpp - the whole panel: style, order of its parts, and drawing with Dear ImGui. C++ because Dear ImGui is.
#include "view/panel_parts.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace
{

using namespace view_panel;

VkDescriptorPool pool;
VkDevice device;
bool opened;

/* ---- look */

const char *find_font()
{
    static const char *const paths[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                                        "/usr/share/fonts/TTF/DejaVuSans.ttf"};
    for (const char *path : paths)
        if (FILE *file = std::fopen(path, "rb")) {
            std::fclose(file);
            return path;
        }
    return nullptr;
}

void set_look()
{
    ImGuiStyle &style = ImGui::GetStyle();
    ImGui::StyleColorsDark();
    style.WindowRounding = 0;
    style.WindowBorderSize = 0;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.WindowPadding = ImVec2(12, 10);
    style.ItemSpacing = ImVec2(8, 5);
    style.IndentSpacing = 14;
    style.ScrollbarSize = 12;
    style.Colors[ImGuiCol_WindowBg] = ImVec4(0.085f, 0.09f, 0.105f, 1);
    style.Colors[ImGuiCol_Header] = ImVec4(0.16f, 0.21f, 0.28f, 1);
    style.Colors[ImGuiCol_HeaderHovered] = ImVec4(0.20f, 0.28f, 0.38f, 1);
    style.Colors[ImGuiCol_FrameBg] = ImVec4(0.15f, 0.165f, 0.19f, 1);
    style.Colors[ImGuiCol_PlotLines] = COLOR_GOOD;
    style.Colors[ImGuiCol_PlotHistogram] = COLOR_GOOD;
    const char *font = find_font();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr; /* no file on disk */
    if (font)
        io.Fonts->AddFontFromFileTTF(font, 14);
}

/* ---- the whole */

void head(viewer *v)
{
    const char *slash = std::strrchr(v->path, '/');
    ImGui::TextColored(COLOR_GOOD, "%s", slash ? slash + 1 : v->path);
    ImGui::SameLine();
    ImGui::TextColored(COLOR_HINT, "%u x %u, %.1f frames/s", v->shot.target.width, v->shot.target.height,
                       v->numbers.frame_now_ms > 0 ? 1000 / v->numbers.frame_now_ms : 0.0);
    ImGui::TextColored(COLOR_HINT, "%.52s", v->shot.info.name);
    if (!v->needs_restart)
        return;
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.5f, 0.3f, 0.05f, 1));
    if (ImGui::Button("Apply the settings marked * (restarts the rain)", ImVec2(-1, 0)))
        v->restart = true;
    ImGui::PopStyleColor();
}

void heading(const char *text)
{
    ImGui::Spacing();
    ImGui::TextColored(COLOR_HINT, "%s", text);
}

void panel(viewer *v)
{
    const float width = std::min((float)VIEW_PANEL_PX, 0.5f * (float)v->window.width);
    ImGui::SetNextWindowPos(ImVec2((float)v->window.width - width, 0));
    ImGui::SetNextWindowSize(ImVec2(width, (float)v->window.height));
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                     ImGuiWindowFlags_AlwaysVerticalScrollbar);
    head(v);
    if (part(v, "Time", true))
        part_time(v);
    if (part(v, "Weather", true)) {
        part_presets(v);
        part_weather(v);
    }
    if (part(v, "View", true)) {
        part_views(v);
        part_camera(v);
    }
    if (part(v, "Screenshot and save", false))
        part_files(v);
    heading("Settings of the scene (* after a restart)");
    sections(v);
    heading("Measured");
    if (part(v, "Milliseconds", true))
        part_times(v);
    if (part(v, "Counts and memory", false))
        part_counts(v);
    if (part(v, "Water", false))
        part_water(v);
    ImGui::End();
}

/* The newest message and the keys, at the lower edge of the picture. */
void foot(viewer *v)
{
    const bool message = v->message[0] && glfwGetTime() < v->message_s;
    const float width =
        (float)v->window.width - (v->panel ? std::min((float)VIEW_PANEL_PX, 0.5f * (float)v->window.width) : 0);
    ImGui::SetNextWindowPos(ImVec2(0, (float)v->window.height), 0, ImVec2(0, 1));
    ImGui::SetNextWindowSize(ImVec2(width, 0));
    ImGui::SetNextWindowBgAlpha(0.55f);
    ImGui::Begin("foot", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PushTextWrapPos();
    if (message)
        ImGui::TextColored(COLOR_WARN, "%s", v->message);
    for (uint32_t line = 0; v->panel && !message && view_key_help(line); line++)
        ImGui::TextColored(COLOR_HINT, "%s", view_key_help(line));
    ImGui::PopTextWrapPos();
    ImGui::End();
}

bool create_pool(const viewer *v, char *error, size_t error_size)
{
    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 4};
    VkDescriptorPoolCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = 4;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    device = v->shot.device.device;
    const VkResult made = vkCreateDescriptorPool(device, &info, nullptr, &pool);
    return made == VK_SUCCESS || host_fail(error, error_size, "vkCreateDescriptorPool gave %s", host_result_name(made));
}

/* Uploads the font in its own command buffer. */
bool upload_font(viewer *v, char *error, size_t error_size)
{
    VkCommandBuffer cmd;
    if (!host_begin_frame(&v->shot.device, &cmd, error, error_size))
        return false;
    ImGui_ImplVulkan_CreateFontsTexture(cmd);
    if (!host_submit(&v->shot.device, error, error_size) || !host_wait(&v->shot.device, error, error_size))
        return false;
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return true;
}

} // namespace

extern "C" {

bool view_panel_open(viewer *v, char *error, size_t error_size)
{
    ImGui::CreateContext();
    opened = true;
    set_look();
    if (!create_pool(v, error, error_size))
        return false;
    ImGui_ImplGlfw_InitForVulkan(v->window.glfw, true);
    ImGui_ImplVulkan_InitInfo info = {};
    info.Instance = v->shot.instance.instance;
    info.PhysicalDevice = v->shot.device.physical;
    info.Device = device;
    info.QueueFamily = v->shot.device.queue_family;
    info.Queue = v->shot.device.queue;
    info.DescriptorPool = pool;
    info.MinImageCount = 2;
    info.ImageCount = VIEW_MAX_IMAGES; /* number of vertex buffers; more than frames in flight */
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    ImGui_ImplVulkan_Init(&info, v->window.pass);
    return upload_font(v, error, error_size);
}

void view_panel_close(viewer *v)
{
    (void)v;
    if (!opened)
        return;
    opened = false;
    if (ImGui::GetIO().BackendRendererUserData)
        ImGui_ImplVulkan_Shutdown();
    if (ImGui::GetIO().BackendPlatformUserData)
        ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    if (pool)
        vkDestroyDescriptorPool(device, pool, nullptr);
    pool = VK_NULL_HANDLE;
}

void view_panel_build(viewer *v)
{
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    if (v->panel)
        panel(v);
    foot(v);
    ImGui::Render();
}

void view_panel_draw(VkCommandBuffer cmd)
{
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), cmd);
}
}
