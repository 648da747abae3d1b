// view_compact.comp - compaction of a view's sprites and sheets, third pass: writes both lists.
// One invocation per word of 32 slots. Reads: selection. Writes: the lists.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "splash/state.glsl"
#include "view.glsl"
#include "compact.glsl"
#include "gpu/compact_write.glsl"
#include "view_lists.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

void main()
{
    const uint word = gl_GlobalInvocationID.x, kind = word < word_range_of(SPRITES).count ? SPRITES : SHEETS;
    const WordRange words = word_range_of(kind);
    if (word < words.first + words.count)
        write_word(word, 32u * (word - words.first), words.entry, lists[kind]);
}
