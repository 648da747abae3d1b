// panel_settings.cpp - the settings of the scene's schema as controls, in trees by their paths.
#include "view/panel_parts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace view_panel
{

/* ---- one setting */

/* The tooltip of a setting: path, description, range, default. */
static void describe(viewer *v, const scene_setting &s)
{
    if (!ImGui::IsItemHovered())
        return;
    char text[700], range[120] = "", value[200];
    scene_setting_print(&s, value, sizeof value);
    if (s.low < s.high)
        std::snprintf(range, sizeof range, "\n%.6g to %.6g%s%s", s.low, s.high, *s.unit ? " " : "", s.unit);
    std::snprintf(text, sizeof text, "%s\n%s%s%s%s%s%s", s.path, s.help, range, s.initial ? "\ndefault " : "",
                  s.initial ? s.initial : "",
                  s.initial || s.kind >= SCENE_SETTING_MAYBE_NUMBER ? "\nright click: back to the default" : "",
                  s.restarts ? "\ncounts from the next start of the rain on" : "");
    tooltip(text);
    if (ImGui::IsMouseReleased(ImGuiMouseButton_Right) && !v->camera.looking) {
        scene_setting &own = const_cast<scene_setting &>(s);
        if (scene_setting_reset(&own, v->settings, v->setting_count))
            v->needs_restart = v->needs_restart || s.restarts;
    }
}

/* A range over many powers of ten gets a logarithmic slider. A range with a very distant end gets a drag field. */
static bool is_wide(const scene_setting &s)
{
    return s.high - s.low > 2000;
}

static ImGuiSliderFlags slider_flags(const scene_setting &s)
{
    const bool powers = s.low >= 0 && s.high - s.low >= 20;
    return ImGuiSliderFlags_AlwaysClamp | (powers ? ImGuiSliderFlags_Logarithmic : 0);
}

/* A format with enough digits for the range. */
static const char *format_of(const scene_setting &s)
{
    const double width = s.high - s.low;
    return width <= 0.5 ? "%.4f" : width <= 5 ? "%.3f" : width <= 500 ? "%.2f" : "%.4g";
}

static bool edit_numbers(scene_setting &s, double *values, int count)
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

static bool edit_whole(scene_setting &s)
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

static bool edit_choice(scene_setting &s)
{
    uint32_t *value = (uint32_t *)s.value, of_word;
    const char *shown = "?";
    bool changed = false;
    for (uint32_t i = 0; scene_setting_keyword(&s, i, &of_word); i++)
        shown = of_word == *value ? scene_setting_keyword(&s, i, nullptr) : shown;
    if (!ImGui::BeginCombo("##value", shown))
        return false;
    for (uint32_t i = 0; const char *word = scene_setting_keyword(&s, i, &of_word); i++)
        if (ImGui::Selectable(word, of_word == *value)) {
            *value = of_word;
            changed = true;
        }
    ImGui::EndCombo();
    return changed;
}

/* An optional value: unset, or a value. */
static bool edit_maybe(scene_setting &s)
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

static bool is_color(const scene_setting &s)
{
    const char *key = std::strrchr(s.path, '.');
    return s.count == 3 && key && (!std::strcmp(key, ".color") || !std::strcmp(key, ".tint"));
}

static bool edit_color(scene_setting &s)
{
    double *values = (double *)s.value;
    float color[3] = {(float)values[0], (float)values[1], (float)values[2]};
    if (!ImGui::ColorEdit3("##value", color, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR))
        return false;
    for (int i = 0; i < 3; i++)
        values[i] = std::min(std::max((double)color[i], s.low), s.high);
    return true;
}

static bool edit_value(scene_setting &s)
{
    switch (s.kind) {
    case SCENE_SETTING_NUMBER: return is_color(s) ? edit_color(s) : edit_numbers(s, (double *)s.value, (int)s.count);
    case SCENE_SETTING_WHOLE: return edit_whole(s);
    case SCENE_SETTING_SWITCH: return ImGui::Checkbox("##value", (bool *)s.value);
    case SCENE_SETTING_CHOICE: return edit_choice(s);
    case SCENE_SETTING_MAYBE_NUMBER:
    case SCENE_SETTING_MAYBE_SWITCH: return edit_maybe(s);
    default: ImGui::TextColored(COLOR_HINT, "%s", *(char **)s.value ? *(char **)s.value : "none"); return false;
    }
}

/* A keyword or a switch may conflict with other settings. Then it keeps its value, and the status line says why.
 * Numbers that depend on each other (near and far, ...) are handled where they are used, as a user changes both. */
static void change(viewer *v, scene_setting &s)
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

/* Index after the settings whose paths begin with `prefix`. */
static size_t end_of(const viewer *v, size_t first, const char *prefix)
{
    const size_t length = std::strlen(prefix);
    while (first < v->setting_count && !std::strncmp(v->settings[first].path, prefix, length))
        first++;
    return first;
}

static size_t begin_of(const viewer *v, const char *prefix)
{
    const size_t length = std::strlen(prefix);
    size_t first = 0;
    while (first < v->setting_count && std::strncmp(v->settings[first].path, prefix, length))
        first++;
    return first;
}

/* Title of a branch: "wipers 1" for "wipers.0"; "lights 1" for "0" behind "lights.". */
static std::string title_of(const std::string &prefix, const std::string &branch)
{
    const bool number = std::isdigit((unsigned char)branch[0]);
    const std::string name = number ? prefix.substr(0, prefix.size() - 1) + "." + branch : branch;
    const size_t dot = name.rfind('.');
    if (dot == std::string::npos)
        return name;
    return name.substr(0, dot) + " " + std::to_string(std::atoi(name.c_str() + dot + 1) + 1);
}

/* The branch of a path after a prefix: "wipers.0" of "wipers.0.sweep_s"; empty for a leaf. */
static std::string branch_of(const char *path, size_t prefix)
{
    const std::string rest(path + prefix);
    const size_t dot = rest.find('.');
    if (dot == std::string::npos)
        return "";
    const size_t second = rest.find('.', dot + 1);
    const bool list = second != std::string::npos && std::isdigit((unsigned char)rest[dot + 1]);
    return rest.substr(0, list ? second : dot);
}

/* The lists that can grow, and the changes requested in this frame. They are applied after all controls, because they
 * move the settings of the controls. */
struct growing {
    scene_list *lists;
    size_t count;
    std::string add, drop;
};

static bool is_list(const growing &g, const std::string &prefix)
{
    return std::any_of(g.lists, g.lists + g.count,
                       [&](const scene_list &l) { return l.path + std::string(".") == prefix; });
}

static void edit_length(growing *g, const scene_list &list)
{
    const char *dot = std::strrchr(list.path, '.');
    ImGui::PushID(list.path);
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(COLOR_HINT, "%s: %u", dot ? dot + 1 : list.path, list.count);
    ImGui::SameLine();
    ImGui::BeginDisabled(list.count >= list.max_entries);
    if (ImGui::Button("add"))
        g->add = list.path;
    ImGui::EndDisabled();
    tooltip("one more, like the last");
    ImGui::SameLine();
    ImGui::BeginDisabled(list.count <= list.min_entries);
    if (ImGui::Button("remove the last"))
        g->drop = list.path;
    ImGui::EndDisabled();
    ImGui::PopID();
}

/* Buttons for the lengths of the lists under a prefix, or of the list at the prefix. */
static void edit_lengths(growing *g, const std::string &prefix)
{
    for (size_t i = 0; i < g->count; i++) {
        const std::string path(g->lists[i].path), above = path.substr(0, path.rfind('.') + 1);
        if (path + "." == prefix || (path.find('.') != std::string::npos && above == prefix))
            edit_length(g, g->lists[i]);
    }
}

static void edit_branch(viewer *v, growing *g, const std::string &prefix)
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
        if (ImGui::TreeNode(inner.c_str(), "%s", title_of(prefix, branch).c_str())) {
            edit_branch(v, g, inner);
            ImGui::TreePop();
        }
        at = end_of(v, at, inner.c_str());
    }
    edit_lengths(g, prefix);
}

static bool has_any(const viewer *v, const char *prefix)
{
    return begin_of(v, prefix) < v->setting_count;
}

static void section(viewer *v, growing *g, const char *title, const char *prefix)
{
    if ((has_any(v, prefix) || is_list(*g, prefix)) && part(v, title, false))
        edit_branch(v, g, prefix);
}

/* The section of an effect, or one for each entry of its list. */
static void effect_sections(viewer *v, growing *g, const tool_effect *effect)
{
    char title[80];
    const std::string prefix = std::string(effect->name) + ".";
    for (uint32_t i = 0; effect->print_entry && effect->print_entry(v->scene, i, title, sizeof title); i++)
        section(v, g, title, (prefix + std::to_string(i) + ".").c_str());
    if (effect->title && !effect->print_entry)
        section(v, g, effect->title, prefix.c_str());
}

void sections(viewer *v)
{
    growing g = {};
    g.lists = scene_lists(v->scene, &g.count);
    if (!g.lists)
        g.count = 0;
    for (uint32_t i = 0; tool_effects[i]; i++)
        effect_sections(v, &g, tool_effects[i]);
    section(v, &g, "Lamps", "lights.");
    section(v, &g, "Sky", "environment.");
    section(v, &g, "Camera", "camera.");
    section(v, &g, "Frames", "frames.");
    section(v, &g, "Preview", "preview.");
    section(v, &g, "Meshes", "meshes.");
    std::free(g.lists);
    if (!g.add.empty())
        view_list_add(v, g.add.c_str());
    if (!g.drop.empty())
        view_list_drop(v, g.drop.c_str());
}

} // namespace view_panel
