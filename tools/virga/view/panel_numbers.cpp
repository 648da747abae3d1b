// panel_numbers.cpp - measurements: graphs of times and counts, and the budget of water.
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
    uint32_t graph = 0;
    for (uint32_t i = 0; tool_effects[i]; i++)
        for (uint32_t k = 0; k < tool_effects[i]->count_count && graph < VIEW_MAX_COUNTS; k++, graph++)
            if (tool_effect_is_used(tool_effects[i], v->scene)) {
                ImGui::PushID((int)graph);
                plot_count("##count", n.counts[graph], tool_effects[i]->counts[k].what);
                ImGui::PopID();
            }
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

static void budget_table(const tool_budget &budget)
{
    if (!ImGui::BeginTable(budget.title, 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp))
        return;
    ImGui::TableSetupColumn(budget.title, 0, 1.5f);
    ImGui::TableSetupColumn("litres", 0, 1);
    ImGui::TableSetupColumn("share", 0, 0.7f);
    ImGui::TableHeadersRow();
    for (uint32_t i = 0; i < budget.row_count; i++)
        litres(budget.rows[i].what, budget.rows[i].nl, budget.rows[i].of_nl);
    ImGui::EndTable();
}

void part_water(viewer *v)
{
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->water_text)
            ImGui::Text("%s: %.6f l", tool_effects[i]->water_text,
                        (double)tool_effects[i]->water_nl(v->shot.states[i]) * 1e-9);
    for (uint32_t i = 0; tool_effects[i]; i++) {
        tool_budget budget;
        for (uint32_t k = 0;
             tool_effects[i]->fill_budget && tool_effects[i]->fill_budget(v->shot.states[i], k, &budget); k++)
            budget_table(budget);
    }
}

} // namespace view_panel
