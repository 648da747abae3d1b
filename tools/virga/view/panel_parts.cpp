// panel_parts.cpp - helpers for the controls of the panel, and which input it uses.
#include "view/panel_parts.h"

#include <cstring>

namespace view_panel
{

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

bool part(viewer *v, const char *title, bool open)
{
    const size_t length = std::strlen(v->unfold);
    if (length && !std::strncmp(title, v->unfold, length)) {
        ImGui::SetNextItemOpen(v->unfold_open);
        v->unfold[0] = 0;
    }
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

} // namespace view_panel

extern "C" {

bool view_panel_has_mouse(void)
{
    return ImGui::GetCurrentContext() && ImGui::GetIO().WantCaptureMouse;
}

bool view_panel_has_keys(void)
{
    return ImGui::GetCurrentContext() && ImGui::GetIO().WantTextInput;
}
}
