// panel_controls.cpp - the parts for time, presets, weather, views, camera and files.
#include "view/panel_parts.h"

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace view_panel
{

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
    int frame = (int)v->shot.frame_index;
    const int first = (int)v->scene->frames.first, last = (int)v->scene->frames.last;
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderInt("##frame", &frame, first, std::max(last, first + 1), "frame %d", ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActive())
        v->seek_to = (uint32_t)frame;
    if (ImGui::IsItemDeactivatedAfterEdit())
        v->paused = v->seeks = true;
    tooltip("go to a frame of the scene; far ahead and back it is quick with --checkpoints");
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
            view_preset_apply(v, presets[i].name);
        tooltip(presets[i].help);
    }
}

static void scrub(viewer *v, const char *path)
{
    scene_setting *s = scene_settings_find(v->settings, v->setting_count, path);
    if (s)
        edit_setting(v, *s);
}

/* The most important settings. */
void part_weather(viewer *v)
{
    const char *hint;
    if (view_is_animated(v, &hint)) {
        ImGui::PushTextWrapPos();
        ImGui::TextColored(COLOR_WARN, "%s", hint);
        ImGui::PopTextWrapPos();
        if (ImGui::Button("Take over from the keys")) {
            view_stop_animation(v);
            view_list_settings(v);
        }
        return;
    }
    for (uint32_t i = 0; tool_effects[i]; i++) {
        char path[96], caption[80];
        for (uint32_t k = 0; tool_effects[i]->main_setting &&
                             tool_effects[i]->main_setting(v->scene, k, path, sizeof path, caption, sizeof caption);
             k++) {
            if (*caption)
                ImGui::TextColored(COLOR_HINT, "%s", caption);
            scrub(v, path);
        }
    }
    scrub(v, "preview.exposure_ev");
    scrub(v, "preview.curve");
}

static void legend(const viewer *v)
{
    float color[3];
    for (uint32_t i = 0; const char *name = view_mode_legend(v->mode, i, color); i++) {
        ImGui::PushID((int)i);
        ImGui::ColorButton("##color", ImVec4(color[0], color[1], color[2], 1),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker, ImVec2(14, 14));
        ImGui::SameLine();
        ImGui::TextUnformatted(name);
        if (view_mode(v->mode)->view->wide_legend && i % 2 == 0 && view_mode_legend(v->mode, i + 1, color))
            ImGui::SameLine(200);
        ImGui::PopID();
    }
}

static void choose_item(viewer *v)
{
    const uint32_t items = view_mode_items(&v->shot, v->mode);
    int item = (int)v->item;
    char format[80];
    if (items < 2)
        return;
    view_mode_print_item(&v->shot, v->mode, std::min(v->item, items - 1), format, sizeof format);
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##layer", &item, 0, (int)items - 1, format, ImGuiSliderFlags_AlwaysClamp))
        v->item = (uint32_t)item;
}

void part_views(viewer *v)
{
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##view", view_mode(v->mode)->title, ImGuiComboFlags_HeightLarge)) {
        for (uint32_t mode = 0; view_mode(mode); mode++) {
            if (!view_mode_items(&v->shot, mode))
                continue;
            if (ImGui::Selectable(view_mode(mode)->title, mode == v->mode))
                view_show(v, view_mode(mode)->name, 0);
            tooltip(view_mode(mode)->help);
        }
        ImGui::EndCombo();
    }
    tooltip("V, Shift V; B: the picture");
    choose_item(v);
    if (v->mode) {
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

/* A name, and a button beside it. */
static bool name_and_button(const char *id, char *name, size_t size, const char *button)
{
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.6f);
    ImGui::InputText(id, name, size);
    ImGui::SameLine();
    return ImGui::Button(button, ImVec2(-1, 0));
}

void part_files(viewer *v)
{
    static char picture[256] = "virga.exr", scene[256] = "tuned.yaml";
    int samples = (int)v->samples;
    if (name_and_button("##picture", picture, sizeof picture, "Screenshot"))
        view_shoot(v, picture);
    tooltip("the scene as it stands, .exr with all layers or .png, as virga render writes them (P)");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderInt("##samples", &samples, 1, 64, "%d sub-frames", ImGuiSliderFlags_AlwaysClamp))
        v->samples = (uint32_t)samples;
    tooltip("of screenshots: anti-aliasing and motion blur");
    if (name_and_button("##scene", scene, sizeof scene, "Save scene"))
        view_save(v, scene);
    tooltip("the scene file with what was changed; its comments are lost (F2)");
}

} // namespace view_panel
