// view_scan.comp - compaction of a view's sprites and sheets, second pass: prefix sums, and the arguments of the draws.
// For a small selection it also writes the lists, which saves a dispatch.
// One workgroup for sprites and one for sheets. Reads: selection. Writes: selection, lists, draw arguments.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "view.glsl"
#include "compact.glsl"
#define COMPACT_ACCESS coherent // invocation 0 reads what others wrote, see first_of_set
#define SOFTWARE_LANES VIRGA_SPLASH_LANES
#include "gpu/long_scan.glsl"
#include "gpu/compact_scan.glsl"
#include "gpu/compact_write.glsl"
#include "view_lists.glsl"

layout(scalar, set = 0, binding = 14) buffer Prepared { virga_splash_prepared_gpu prepared; };

#define FEW_WORDS 512u // up to this many words are written here: a dispatch costs software Vulkan as much

// Index of the first entry of the first kind from a set (see droplet_sets and splash_sets).
uint first_of_set(uint groups_before, virga_list_gpu head)
{
    const bool is_past = groups_before >= state.sprite_groups[0];
    return is_past ? head.count : min(selection[groups_before * GROUP_WORDS].z, head.count);
}

// The same, of the second kind.
uint second_of_set(uint groups_before, virga_list_gpu head)
{
    const bool is_past = groups_before >= state.sprite_groups[0];
    return is_past ? head.second_kind : min(selection[groups_before * GROUP_WORDS].w, head.second_kind);
}

// Six indices per sprite, two per line, twelve per pyramid. The second kind comes first in the list, then lines. Of the
// second kind, splashes are puffs whose crowns are drawn one by one: an instance each.
void draw_sprites(virga_list_gpu head)
{
    const uint each = is_film() ? 6u : 12u, second = head.second_kind;
    const uint quads = first_of_set(state.view_groups[0], head), puffs = first_of_set(3u * state.view_groups[0], head);
    const uint first_line = 18u * look.max_sprites + VIRGA_CROWN_INDICES;
    const uint wide = second_of_set(3u * state.view_groups[0], head);
    prepared.wide_quads = virga_splash_draw_gpu(each * wide, 1u, is_film() ? 0u : 6u * look.max_sprites, 0, 0u);
    prepared.lines = virga_splash_draw_gpu(2u * (quads - second), 1u, first_line + 2u * second, 0, 0u);
    prepared.thin_quads = virga_splash_draw_gpu(6u * (puffs - quads), 1u, 6u * quads, 0, 0u);
    prepared.puffs = virga_splash_draw_gpu(6u * (head.count - puffs), 1u, 6u * puffs, 0, 0u);
    prepared.puff_crowns = virga_splash_draw_gpu(6u * VIRGA_SPLASH_MAX_CROWNS, second - wide, 0u,
                                                 VIRGA_SPLASH_CROWN_VERTEX +
                                                     4 * VIRGA_SPLASH_MAX_CROWNS * int(wide), 0u);
    prepared.sprites = head.count;
}

void draw_sheets(virga_list_gpu head)
{
    const uint quads = 6u * look.max_sprites, pyramids = 12u * look.max_sprites; // indices before those of the sheet
    if (is_film())                                                               // one instance each
        prepared.crowns = virga_splash_draw_gpu(VIRGA_CROWN_INDICES, head.count, quads + pyramids, 0, 0u);
    else
        prepared.crowns = virga_splash_draw_gpu(12u * VIRGA_CROWN_PYRAMIDS * head.count, 1u, quads, 0, 0u);
}

void main()
{
    const uint kind = gl_WorkGroupID.x, all = word_range_of(SPRITES).count + word_range_of(SHEETS).count;
    const WordRange words = word_range_of(kind);
    const uvec2 found = scan_words(words.first, words.count, words.capacity);
    const virga_list_gpu head = list_head(found, words.capacity);
    const bool listed_here = all <= FEW_WORDS;
    const uvec2 own = listed_here ? lane_words(words.first, words.count) : uvec2(0u);
    memoryBarrierBuffer();
    barrier();
    for (uint i = own.x; i < own.y; i++)
        write_word(i, 32u * (i - words.first), words.entry, head);
    if (gl_LocalInvocationIndex != 0u)
        return;
    lists[kind].count = head.count;
    lists[kind].second_kind = head.second_kind;
    const uint written = head.count - unwritten(head);
    lists[kind].group_count = uint[3]((written + VIRGA_SPLASH_GROUP - 1u) / VIRGA_SPLASH_GROUP, 1u, 1u);
    prepared.cut[kind] = found.x + found.y - head.count;
    if (kind == SPRITES) {
        const uint groups = (all + VIRGA_SPLASH_GROUP - 1u) / VIRGA_SPLASH_GROUP;
        draw_sprites(head);
        prepared.list_groups = uint[3](listed_here ? 0u : groups, 1u, 1u);
    } else {
        draw_sheets(head);
    }
}
