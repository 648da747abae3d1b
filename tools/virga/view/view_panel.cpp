// view_panel.cpp - the panel: what is in the scene's schema, as controls; and graphs. C++ as Dear ImGui is.
#include "view.h"

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace {

VkDescriptorPool pool;
VkDevice device;
bool opened;

const ImVec4 COLOR_HINT(0.62f, 0.66f, 0.72f, 1), COLOR_WARN(1.0f, 0.72f, 0.3f, 1), COLOR_GOOD(0.45f, 0.8f, 1.0f, 1);

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
    io.IniFilename = nullptr; /* nothing is left behind on disk */
    if (font)
        io.Fonts->AddFontFromFileTTF(font, 14);
}

void tooltip(const char *text)
{
    if (!ImGui::IsItemHovered() || !*text)
        return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ImGui::GetFontSize() * 26);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

/* ---- one setting */

/* Path, description, range, default: what the schema says. */
void describe(viewer *v, const scene_setting &s)
{
    if (!ImGui::IsItemHovered())
        return;
    char text[700], range[120] = "", value[200];
    scene_setting_print(&s, value, sizeof value);
    if (s.low < s.high)
        std::snprintf(range, sizeof range, "\n%.6g to %.6g%s%s", s.low, s.high, *s.unit ? " " : "", s.unit);
    std::snprintf(text, sizeof text, "%s\n%s%s%s%s%s%s", s.path, s.help, range, s.initial ? "\ndefault " : "",
                  s.initial ? s.initial : "", s.initial || s.kind >= SCENE_SETTING_MAYBE_NUMBER
                                                  ? "\nright click: back to the default" : "",
                  s.restarts ? "\ncounts from the next start of the rain on" : "");
    tooltip(text);
    if (ImGui::IsMouseReleased(ImGuiMouseButton_Right) && !v->camera.looking) {
        scene_setting &own = const_cast<scene_setting &>(s);
        if (scene_setting_reset(&own, v->settings, v->setting_count))
            v->needs_restart = v->needs_restart || s.restarts;
    }
}

/* Ranges of many powers of ten get a slider by powers; those without an end that one would reach, a field to drag. */
bool is_wide(const scene_setting &s)
{
    return s.high - s.low > 2000;
}

ImGuiSliderFlags slider_flags(const scene_setting &s)
{
    const bool powers = s.low >= 0 && s.high - s.low >= 20;
    return ImGuiSliderFlags_AlwaysClamp | (powers ? ImGuiSliderFlags_Logarithmic : 0);
}

/* As many digits as the range deserves. */
const char *format_of(const scene_setting &s)
{
    const double width = s.high - s.low;
    return width <= 0.5 ? "%.4f" : width <= 5 ? "%.3f" : width <= 500 ? "%.2f" : "%.4g";
}

bool edit_numbers(scene_setting &s, double *values, int count)
{
    bool changed = false;
    if (is_wide(s)) {
        const float step = (float)std::max(0.01, 0.004 * std::fabs(values[0]));
        changed = ImGui::DragScalarN("##value", ImGuiDataType_Double, values, count, step, &s.low, &s.high, "%.5g",
                                     ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat);
    } else {
        changed = ImGui::SliderScalarN("##value", ImGuiDataType_Double, values, count, &s.low, &s.high, format_of(s),
                                       slider_flags(s));
    }
    for (int i = 0; i < count; i++)
        values[i] = std::min(std::max(values[i], s.low), s.high);
    return changed;
}

bool edit_whole(scene_setting &s)
{
    const uint32_t low = (uint32_t)s.low, high = (uint32_t)s.high;
    uint32_t *values = (uint32_t *)s.value;
    const float step = std::max(0.2f, 0.005f * (float)values[0]);
    const bool changed = ImGui::DragScalarN("##value", ImGuiDataType_U32, values, (int)s.count, step, &low, &high, "%u",
                                            ImGuiSliderFlags_AlwaysClamp);
    for (uint32_t i = 0; i < s.count; i++)
        values[i] = std::min(std::max(values[i], low), high);
    return changed;
}

bool edit_choice(scene_setting &s)
{
    uint32_t *value = (uint32_t *)s.value, of_word;
    const char *shown = "?";
    bool changed = false;
    for (uint32_t i = 0; scene_setting_word(&s, i, &of_word); i++)
        shown = of_word == *value ? scene_setting_word(&s, i, nullptr) : shown;
    if (!ImGui::BeginCombo("##value", shown))
        return false;
    for (uint32_t i = 0; const char *word = scene_setting_word(&s, i, &of_word); i++)
        if (ImGui::Selectable(word, of_word == *value)) {
            *value = of_word;
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

/* Left to something else, or a number of its own. */
bool edit_maybe(scene_setting &s)
{
    void **value = (void **)s.value;
    char text[40], ignored[200];
    bool own = *value != nullptr, changed = false;
    if (ImGui::Checkbox("##own", &own)) {
        std::snprintf(text, sizeof text, "%s", !own ? "null" : s.kind == SCENE_SETTING_MAYBE_SWITCH ? "true" : "");
        if (own && s.kind == SCENE_SETTING_MAYBE_NUMBER)
            std::snprintf(text, sizeof text, "%.6g", s.low + 0.25 * (s.high - s.low));
        changed = scene_setting_parse(&s, text, ignored, sizeof ignored);
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    if (!*value)
        ImGui::TextColored(COLOR_HINT, "as the kind has it");
    else if (s.kind == SCENE_SETTING_MAYBE_NUMBER)
        changed |= edit_numbers(s, (double *)*value, 1);
    else
        changed |= ImGui::Checkbox("##switch", (bool *)*value);
    return changed;
}

bool is_color(const scene_setting &s)
{
    const char *key = std::strrchr(s.path, '.');
    return s.count == 3 && key && (!std::strcmp(key, ".color") || !std::strcmp(key, ".tint"));
}

bool edit_color(scene_setting &s)
{
    double *values = (double *)s.value;
    float color[3] = {(float)values[0], (float)values[1], (float)values[2]};
    if (!ImGui::ColorEdit3("##value", color, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR))
        return false;
    for (int i = 0; i < 3; i++)
        values[i] = std::min(std::max((double)color[i], s.low), s.high);
    return true;
}

bool edit_value(scene_setting &s)
{
    switch (s.kind) {
    case SCENE_SETTING_NUMBER:
        return is_color(s) ? edit_color(s) : edit_numbers(s, (double *)s.value, (int)s.count);
    case SCENE_SETTING_WHOLE: return edit_whole(s);
    case SCENE_SETTING_SWITCH: return ImGui::Checkbox("##value", (bool *)s.value);
    case SCENE_SETTING_CHOICE: return edit_choice(s);
    case SCENE_SETTING_MAYBE_NUMBER:
    case SCENE_SETTING_MAYBE_SWITCH: return edit_maybe(s);
    default: ImGui::TextColored(COLOR_HINT, "%s", *(char **)s.value ? *(char **)s.value : "none"); return false;
    }
}

/* Words and switches may not go together with others: then they stay as they were, and the foot says why. Numbers that
 * need one another (near and far, ...) are cared for where they are used, as both have to be changed. */
void change(viewer *v, scene_setting &s)
{
    char before[520], ignored[256];
    const bool bound = s.kind != SCENE_SETTING_NUMBER && s.kind != SCENE_SETTING_WHOLE;
    scene_setting_print(&s, before, sizeof before);
    if (!edit_value(s))
        return;
    if (bound && !view_check(v))
        scene_setting_parse(&s, before, ignored, sizeof ignored);
    else if (s.restarts)
        v->needs_restart = true;
}

/* A row: the name with its unit, and the value. */
void edit_setting(viewer *v, scene_setting &s)
{
    const float width = ImGui::GetContentRegionAvail().x;
    char label[120];
    ImGui::PushID(s.path);
    ImGui::BeginGroup();
    ImGui::AlignTextToFramePadding();
    std::snprintf(label, sizeof label, *s.unit ? "%s (%s)" : "%s", s.name, s.unit);
    if (s.restarts)
        ImGui::TextColored(COLOR_HINT, "%s *", label);
    else
        ImGui::TextUnformatted(label);
    ImGui::SameLine(width * 0.44f + ImGui::GetCursorStartPos().x);
    ImGui::SetNextItemWidth(-1);
    change(v, s);
    ImGui::EndGroup();
    describe(v, s);
    ImGui::PopID();
}

/* ---- trees of settings */

/* Settings from `first` on whose paths begin with `prefix`. */
size_t end_of(const viewer *v, size_t first, const char *prefix)
{
    const size_t length = std::strlen(prefix);
    while (first < v->setting_count && !std::strncmp(v->settings[first].path, prefix, length))
        first++;
    return first;
}

size_t begin_of(const viewer *v, const char *prefix)
{
    const size_t length = std::strlen(prefix);
    size_t first = 0;
    while (first < v->setting_count && std::strncmp(v->settings[first].path, prefix, length))
        first++;
    return first;
}

/* Title of a branch: "wipers 1" for "wipers.0". */
std::string title_of(const std::string &branch)
{
    const size_t dot = branch.find('.');
    if (dot == std::string::npos)
        return branch;
    return branch.substr(0, dot) + " " + std::to_string(std::atoi(branch.c_str() + dot + 1) + 1);
}

/* What of a path behind a prefix leads to a branch: "wipers.0" of "wipers.0.sweep_s"; empty for a leaf. */
std::string branch_of(const char *path, size_t prefix)
{
    const std::string rest(path + prefix);
    const size_t dot = rest.find('.');
    if (dot == std::string::npos)
        return "";
    const size_t second = rest.find('.', dot + 1);
    const bool list = second != std::string::npos && std::isdigit((unsigned char)rest[dot + 1]);
    return rest.substr(0, list ? second : dot);
}

void edit_branch(viewer *v, const std::string &prefix)
{
    size_t at = begin_of(v, prefix.c_str());
    const size_t end = end_of(v, at, prefix.c_str());
    while (at < end) {
        scene_setting &s = v->settings[at];
        const std::string branch = branch_of(s.path, prefix.size());
        if (branch.empty()) {
            edit_setting(v, s);
            at++;
            continue;
        }
        const std::string inner = prefix + branch + ".";
        if (ImGui::TreeNode(inner.c_str(), "%s", title_of(branch).c_str())) {
            edit_branch(v, inner);
            ImGui::TreePop();
        }
        at = end_of(v, at, inner.c_str());
    }
}

bool has_any(const viewer *v, const char *prefix)
{
    return begin_of(v, prefix) < v->setting_count;
}

/* A part of the panel: whether it is open. Scripts open and close them too. */
bool part(viewer *v, const char *title, bool open)
{
    const size_t length = std::strlen(v->unfold);
    if (length && !std::strncmp(title, v->unfold, length)) {
        ImGui::SetNextItemOpen(v->unfold_open);
        v->unfold[0] = 0;
    }
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

void section(viewer *v, const char *title, const char *prefix)
{
    if (has_any(v, prefix) && part(v, title, false))
        edit_branch(v, prefix);
}

void sections(viewer *v)
{
    section(v, "Rain", "rain.");
    section(v, "Ground", "ground.");
    section(v, "Splashes", "splash.");
    for (uint32_t i = 0; i < v->scene->pane_count; i++) {
        char title[80], prefix[24];
        std::snprintf(title, sizeof title, "Pane: %.40s", v->scene->panes[i].name);
        std::snprintf(prefix, sizeof prefix, "glass.%u.", i);
        section(v, title, prefix);
    }
    section(v, "Lamps", "lights.");
    section(v, "Sky", "environment.");
    section(v, "Camera", "camera.");
    section(v, "Frames", "frames.");
    section(v, "Preview", "preview.");
    section(v, "Meshes", "meshes.");
}

/* ---- the parts that are more than a list */

void part_time(viewer *v)
{
    if (ImGui::Button(v->paused ? "Play" : "Pause", ImVec2(64, 0)))
        v->paused = !v->paused;
    tooltip("Space");
    ImGui::SameLine();
    if (ImGui::Button("Step", ImVec2(54, 0))) {
        v->paused = true;
        v->steps++;
    }
    tooltip("one frame of the scene on (N)");
    ImGui::SameLine();
    if (ImGui::Button("Restart", ImVec2(70, 0)))
        v->restart = true;
    tooltip("the rain from the start, with all settings (R)");
    ImGui::SameLine();
    ImGui::TextColored(COLOR_HINT, "%.2f s, frame %u", v->shot.camera_time_s, v->shot.frame_index);
    float speed = (float)v->speed;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##speed", &speed, 0.05f, 1, "speed of time x %.2f", ImGuiSliderFlags_AlwaysClamp))
        v->speed = speed;
    tooltip("slow motion ( [ and ] )");
}

void part_presets(viewer *v)
{
    size_t count;
    const view_preset *presets = view_presets(&count);
    for (size_t i = 0; i < count; i++) {
        if (i && ImGui::GetItemRectMax().x + 8 + ImGui::CalcTextSize(presets[i].title).x + 10 <
                     ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x)
            ImGui::SameLine();
        if (ImGui::Button(presets[i].title))
            view_preset_take(v, presets[i].name);
        tooltip(presets[i].help);
    }
}

void scrub(viewer *v, const char *path)
{
    scene_setting *s = scene_settings_find(v->settings, v->setting_count, path);
    if (s)
        edit_setting(v, *s);
}

/* Rate and wind, and how the wipers go: what one reaches for first. */
void part_weather(viewer *v)
{
    if (v->scene->rain.key_count) {
        ImGui::PushTextWrapPos();
        ImGui::TextColored(COLOR_WARN, "The scene's keys say rate and wind at every time.");
        ImGui::PopTextWrapPos();
        if (ImGui::Button("Take over from the keys")) {
            double wind[3], rate;
            scene_file_weather(v->scene, v->shot.camera_time_s, &rate, wind);
            v->scene->rain.rate_mm_h = rate;
            std::memcpy(v->scene->rain.wind_m_s, wind, sizeof wind);
            v->scene->rain.key_count = 0;
            view_list_settings(v);
        }
        return;
    }
    scrub(v, "rain.rate_mm_h");
    scrub(v, "rain.wind_m_s");
    scrub(v, "rain.gust_m_s");
    for (uint32_t p = 0; p < v->scene->pane_count; p++)
        for (uint32_t w = 0; w < v->scene->panes[p].wiper_count; w++) {
            char path[96];
            ImGui::TextColored(COLOR_HINT, "%s, wiper %u", v->scene->panes[p].name, w + 1);
            for (const char *key : {"drive", "sweep_s", "pause_s"}) {
                std::snprintf(path, sizeof path, "glass.%u.wipers.%u.%s", p, w, key);
                scrub(v, path);
            }
        }
    scrub(v, "preview.exposure_ev");
}

void legend(const viewer *v)
{
    float color[3];
    for (uint32_t i = 0; const char *name = view_mode_legend(v->mode, i, color); i++) {
        ImGui::PushID((int)i);
        ImGui::ColorButton("##color", ImVec4(color[0], color[1], color[2], 1),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker, ImVec2(14, 14));
        ImGui::SameLine();
        ImGui::TextUnformatted(name);
        if (v->mode == VIEW_MATERIAL && i % 2 == 0 && view_mode_legend(v->mode, i + 1, color))
            ImGui::SameLine(200);
        ImGui::PopID();
    }
}

void choose_layer(viewer *v)
{
    const uint32_t layers = view_mode_layers(&v->shot, v->mode);
    int layer = (int)v->layer;
    char format[80];
    if (layers < 2)
        return;
    if (v->mode == VIEW_OCCLUSION) {
        virga_rain_occlusion_map map;
        virga_rain_occlusion_map_get(v->shot.rain, &map);
        std::snprintf(format, sizeof format, "map %%d: %.0f m wide, slant %u of %u",
                      2 * (double)map.half_m[std::min(v->layer / map.slants, 3u)], v->layer % map.slants + 1,
                      map.slants);
    } else {
        std::snprintf(format, sizeof format, "pane %%d: %.40s", v->scene->panes[std::min(v->layer, layers - 1)].name);
    }
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##layer", &layer, 0, (int)layers - 1, format, ImGuiSliderFlags_AlwaysClamp))
        v->layer = (uint32_t)layer;
}

void part_views(viewer *v)
{
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##view", view_mode(v->mode)->title, ImGuiComboFlags_HeightLarge)) {
        for (uint32_t mode = 0; mode < VIEW_MODES; mode++) {
            if (!view_mode_layers(&v->shot, mode))
                continue;
            if (ImGui::Selectable(view_mode(mode)->title, mode == v->mode))
                view_show(v, view_mode(mode)->name, 0);
            tooltip(view_mode(mode)->help);
        }
        ImGui::EndCombo();
    }
    tooltip("V, Shift V; B: the picture");
    choose_layer(v);
    if (v->mode != VIEW_PICTURE) {
        ImGui::PushTextWrapPos();
        ImGui::TextColored(COLOR_HINT, "%s", view_mode(v->mode)->help);
        ImGui::PopTextWrapPos();
    }
    legend(v);
    int finer = v->divide == 4 ? 0 : v->divide == 2 ? 1 : 2;
    ImGui::TextUnformatted("pixels");
    for (int i = 2; i >= 0; i--) {
        static const char *const names[] = {"quarter", "half", "all"};
        ImGui::SameLine();
        if (ImGui::RadioButton(names[i], &finer, i))
            v->divide = 4u >> i;
        tooltip("along each side of the picture");
    }
}

void part_camera(viewer *v)
{
    const double *at = v->seen.position_m;
    ImGui::TextColored(COLOR_HINT, "%s   %.2f, %.2f, %.2f m", v->camera.free ? "flying" : "on its path", at[0], at[1],
                       at[2]);
    if (!v->camera.free)
        return;
    float speed = (float)v->camera.speed_m_s;
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##fly", &speed, 0.1f, 50, "flies at %.1f m/s", ImGuiSliderFlags_Logarithmic))
        v->camera.speed_m_s = speed;
    if (ImGui::Button("Back to the camera's path"))
        view_camera_to_path(v);
    tooltip("C");
}

void part_files(viewer *v)
{
    static char picture[256] = "virga.exr", scene[256] = "tuned.yaml";
    int samples = (int)v->samples;
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::SetNextItemWidth(width * 0.6f);
    ImGui::InputText("##picture", picture, sizeof picture);
    ImGui::SameLine();
    if (ImGui::Button("Screenshot", ImVec2(-1, 0)))
        view_shoot(v, picture);
    tooltip("the scene as it stands, .exr with all layers or .png, as virga render writes them (P)");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##samples", &samples, 1, 64, "%d sub-frames", ImGuiSliderFlags_AlwaysClamp))
        v->samples = (uint32_t)samples;
    tooltip("of screenshots: anti-aliasing and motion blur");
    ImGui::SetNextItemWidth(width * 0.6f);
    ImGui::InputText("##scene", scene, sizeof scene);
    ImGui::SameLine();
    if (ImGui::Button("Save scene", ImVec2(-1, 0)))
        view_save(v, scene);
    tooltip("the scene file with what was changed; its comments are lost (F2)");
}

/* ---- numbers */

void plot(const char *id, const view_graph &graph, const char *text, float height)
{
    float top = 1e-3f;
    for (float value : graph.values)
        top = std::max(top, value);
    ImGui::SetNextItemWidth(-1);
    ImGui::PlotLines(id, graph.values, VIEW_HISTORY, (int)graph.next, text, 0, top * 1.25f, ImVec2(0, height));
}

void plot_count(const char *id, const view_graph &graph, const char *what)
{
    char text[80];
    const float newest = graph.values[(graph.next + VIEW_HISTORY - 1) % VIEW_HISTORY];
    std::snprintf(text, sizeof text, "%.0f %s", (double)newest, what);
    plot(id, graph, text, 34);
}

void part_times(viewer *v)
{
    char text[80];
    view_numbers &n = v->numbers;
    std::snprintf(text, sizeof text, "frame %.1f ms", n.frame_now_ms);
    plot("##frame", n.frame_ms, text, 40);
    std::snprintf(text, sizeof text, "Virga %.2f ms on the device", n.device_now_ms);
    plot("##device", n.device_ms, text, 40);
    for (uint32_t i = 0; i < n.pass_count; i++) {
        char label[80];
        const double share = n.device_now_ms > 0 ? n.passes[i].newest / n.device_now_ms : 0;
        std::snprintf(label, sizeof label, "%s  %.2f ms", n.passes[i].name, n.passes[i].newest);
        ImGui::PushID((int)i);
        ImGui::PushStyleColor(ImGuiCol_PlotHistogram, ImVec4(0.16f, 0.36f, 0.52f, 1));
        ImGui::ProgressBar((float)share, ImVec2(-1, 17), label);
        ImGui::PopStyleColor();
        if (ImGui::IsItemHovered()) {
            ImGui::BeginTooltip();
            ImGui::PlotLines("##pass", n.passes[i].milliseconds.values, VIEW_HISTORY,
                             (int)n.passes[i].milliseconds.next, label, 0, FLT_MAX, ImVec2(280, 60));
            ImGui::EndTooltip();
        }
        ImGui::PopID();
    }
}

void part_counts(viewer *v)
{
    view_numbers &n = v->numbers;
    char text[80];
    plot_count("##drops", n.drops, "streaks in the picture");
    plot_count("##impacts", n.impacts, "impacts a frame");
    if (v->shot.splash)
        plot_count("##droplets", n.droplets, "droplets in the air");
    if (v->scene->pane_count)
        plot_count("##glass", n.on_glass, "drops and particles on panes");
    std::snprintf(text, sizeof text, "%.1f MiB of the device", (double)n.memory.device_bytes / (1 << 20));
    plot("##memory", n.memory_mib, text, 34);
    ImGui::TextColored(COLOR_HINT, "in use %.1f MiB, %u blocks, %u objects; host %.1f MiB",
                       (double)n.memory.device_used / (1 << 20), n.memory.device_allocations, n.memory.objects,
                       (double)n.memory.host_bytes / (1 << 20));
}

/* A line of the budget: litres, and the share of the whole. */
void litres(const char *what, uint64_t nl, uint64_t of_nl)
{
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(what);
    ImGui::TableNextColumn();
    ImGui::Text("%.6f", (double)nl * 1e-9);
    ImGui::TableNextColumn();
    if (of_nl)
        ImGui::TextColored(COLOR_HINT, "%.1f %%", 100 * (double)nl / (double)of_nl);
}

bool begin_budget(const char *id, const char *title)
{
    if (!ImGui::BeginTable(id, 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp))
        return false;
    ImGui::TableSetupColumn(title, 0, 1.5f);
    ImGui::TableSetupColumn("litres", 0, 1);
    ImGui::TableSetupColumn("share", 0, 0.7f);
    ImGui::TableHeadersRow();
    return true;
}

void budget_of_ground(const virga_ground_stats &g)
{
    const uint64_t all = g.start_nl + g.landed_nl;
    if (!begin_budget("##ground", "Ground"))
        return;
    litres("there at the start", g.start_nl, all);
    litres("landed", g.landed_nl, all);
    litres("film", g.film_nl, all);
    litres("puddles", g.puddles_nl, all);
    litres("in pores", g.held_nl, all);
    litres("kept outside", g.kept_nl, all);
    litres("sunk in", g.infiltrated_nl, all);
    litres("run off", g.run_off_nl, all);
    litres("evaporated", g.evaporated_nl, all);
    litres("forgotten", g.forgotten_nl, all);
    const uint64_t found = g.film_nl + g.puddles_nl + g.held_nl + g.kept_nl + g.infiltrated_nl + g.run_off_nl +
                           g.evaporated_nl + g.forgotten_nl;
    litres("not accounted for", all > found ? all - found : found - all, 0);
    ImGui::EndTable();
}

void budget_of_pane(const char *name, virga_glass *glass)
{
    virga_glass_stats s;
    virga_glass_stats_get(glass, &s);
    if (!begin_budget(name, name))
        return;
    litres("landed", s.landed_nl, s.landed_nl);
    litres("in drops", s.drops_nl, s.landed_nl);
    litres("in particles", s.particles_nl, s.landed_nl);
    litres("film", s.film_nl, s.landed_nl);
    litres("run off", s.run_off_nl, s.landed_nl);
    litres("wiped off", s.wiped_nl, s.landed_nl);
    litres("evaporated", s.evaporated_nl, s.landed_nl);
    ImGui::EndTable();
}

void part_water(viewer *v)
{
    view_numbers &n = v->numbers;
    ImGui::Text("rained, where drops landed: %.6f l", (double)n.rain.total_water_nl * 1e-9);
    ImGui::Text("in the air as splashes: %.6f l", (double)(n.splash.flown_nl - n.splash.returned_nl) * 1e-9);
    if (v->shot.ground)
        budget_of_ground(n.ground);
    for (uint32_t i = 0; i < v->scene->pane_count; i++)
        budget_of_pane(v->scene->panes[i].name, v->shot.panes[i].glass);
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

/* What was just done, and the keys, at the lower edge of the picture. */
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

/* Takes the font to the device, by a command buffer of its own. */
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
    info.ImageCount = VIEW_MAX_IMAGES; /* of vertex buffers that it keeps: more than frames in flight */
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

bool view_panel_has_mouse(void)
{
    return opened && ImGui::GetIO().WantCaptureMouse;
}

bool view_panel_has_keys(void)
{
    return opened && ImGui::GetIO().WantTextInput;
}
}
