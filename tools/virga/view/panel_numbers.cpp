// panel_numbers.cpp - what is measured: graphs of times and counts, and the budget of water.
#include "view/panel_parts.h"

#include <algorithm>
#include <cstdio>

namespace view_panel
{

static void plot(const char *id, const view_graph &graph, const char *text, float height)
{
    float top = 1e-3f;
    for (float value : graph.values)
        top = std::max(top, value);
    ImGui::SetNextItemWidth(-1);
    ImGui::PlotLines(id, graph.values, VIEW_HISTORY, (int)graph.next, text, 0, top * 1.25f, ImVec2(0, height));
}

static void plot_count(const char *id, const view_graph &graph, const char *what)
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
    if (scene_glass_of(v->scene)->pane_count)
        plot_count("##glass", n.on_glass, "drops and particles on panes");
    std::snprintf(text, sizeof text, "%.1f MiB of the device", (double)n.memory.device_bytes / (1 << 20));
    plot("##memory", n.memory_mib, text, 34);
    ImGui::TextColored(COLOR_HINT, "in use %.1f MiB, %u blocks, %u objects; host %.1f MiB",
                       (double)n.memory.device_used / (1 << 20), n.memory.device_allocations, n.memory.objects,
                       (double)n.memory.host_bytes / (1 << 20));
}

/* A line of the budget: litres, and the share of the whole. */
static void litres(const char *what, uint64_t nl, uint64_t of_nl)
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

static bool begin_budget(const char *id, const char *title)
{
    if (!ImGui::BeginTable(id, 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp))
        return false;
    ImGui::TableSetupColumn(title, 0, 1.5f);
    ImGui::TableSetupColumn("litres", 0, 1);
    ImGui::TableSetupColumn("share", 0, 0.7f);
    ImGui::TableHeadersRow();
    return true;
}

static void budget_of_ground(const virga_ground_stats &g)
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

static void budget_of_pane(const char *name, virga_glass *glass)
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
    for (uint32_t i = 0; i < scene_glass_of(v->scene)->pane_count; i++)
        budget_of_pane(scene_glass_of(v->scene)->panes[i].name, v->shot.panes[i].glass);
}

} // namespace view_panel
