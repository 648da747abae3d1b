/* gpu/effect_rows.h - the words in which an effect writes its tables. Internal.
 *
 * A file with tables defines EFFECT, the name of its effect, and then includes this. The words then mean this effect:
 * AT(state) is the member `state` of virga_<EFFECT>, and PASS(soak) is the row of the shader <EFFECT>_soak_comp. */
#ifndef VIRGA_GPU_EFFECT_ROWS_H
#define VIRGA_GPU_EFFECT_ROWS_H

#include "gpu/effect.h"

#ifndef EFFECT
#error "expected EFFECT, the name of the effect"
#endif

/* clang-format off */

/* Calls a macro that joins its arguments, after they are expanded: EFFECT is a macro itself. */
#define ROW(macro, ...) macro(__VA_ARGS__)

/* The offset of a member of the object. */
#define AT(member) ROW(ROW_AT, EFFECT, member)
#define ROW_AT(effect, member) offsetof(virga_##effect, member)

/* ---- definition and settings */

/* Type, member, minimum, maximum, default. */
#define DEF(...) ROW(ROW_DEF, EFFECT, __VA_ARGS__)
#define SETTING(...) ROW(ROW_SETTING, EFFECT, __VA_ARGS__)
#define ROW_DEF(effect, ...) VIRGA_SETTING_ROW(effect##_def, virga_##effect##_def, __VA_ARGS__)
#define ROW_SETTING(effect, ...) VIRGA_SETTING_ROW(effect##_settings, virga_##effect##_settings, __VA_ARGS__)

/* A size in the definition that may be reduced: member, minimum, unit. */
#define POOL(member, ...) ROW(ROW_POOL, EFFECT, member, __VA_ARGS__)
#define ROW_POOL(effect, member, ...) {#member, offsetof(virga_##effect##_def, member), __VA_ARGS__}

/* ---- state: a member of the object that belongs to it */

#define STATE(member) ROW(ROW_STATE, EFFECT, member)
#define ROW_STATE(effect, member) \
    {#effect "." #member, offsetof(virga_##effect, member), sizeof(((virga_##effect *)0)->member), \
     .kind = STATE_KIND(((virga_##effect *)0)->member)}
#define STATE_KIND(value) _Generic((value), \
    bool: VIRGA_STATE_BOOLS, bool *: VIRGA_STATE_BOOLS, \
    double: VIRGA_STATE_DOUBLES, double *: VIRGA_STATE_DOUBLES, double (*)[2]: VIRGA_STATE_DOUBLES, \
    default: VIRGA_STATE_BYTES)

/* ---- buffers and images */

#define DEVICE VIRGA_HEAP_DEVICE
#define FILL   VIRGA_FIRST_FILL
#define COLOR  VK_IMAGE_ASPECT_COLOR_BIT

/* An image of one texel, which is bound if the host gave none. */
#define BLANK_COLOR(name, member) \
    {name, AT(member), VK_FORMAT_R8G8B8A8_UNORM, COLOR, VK_IMAGE_USAGE_SAMPLED_BIT, \
     VIRGA_COUNT_ONE, VIRGA_COUNT_ONE, 1, VIRGA_FIRST_SAMPLED}
#define BLANK_DEPTH(name, member) \
    {name, AT(member), VK_FORMAT_D32_SFLOAT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_USAGE_SAMPLED_BIT, \
     VIRGA_COUNT_ONE, VIRGA_COUNT_ONE, 1, VIRGA_FIRST_SAMPLED}

/* ---- bindings */

#define COMPUTE  VK_SHADER_STAGE_COMPUTE_BIT
#define VERTEX   VK_SHADER_STAGE_VERTEX_BIT
#define FRAGMENT VK_SHADER_STAGE_FRAGMENT_BIT

#define STORAGE VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
#define UNIFORM VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER
#define TEXELS  VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
#define IMAGE   VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
#define SAMPLED VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
/* Of rings, whose block of the moment is at a dynamic offset. */
#define DYNAMIC         VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC
#define DYNAMIC_STORAGE VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC

/* Members of the object. BUFFER and the like: for compute shaders alone; *_IN: for these stages. */
#define BUFFER(member)                  BUFFER_IN(COMPUTE, member)
#define BUFFER_IN(stages, member)       {STORAGE, stages, VIRGA_SOURCE_BUFFER, AT(member)}
#define TEXEL_BUFFER(member)            TEXEL_BUFFER_IN(COMPUTE, member)
#define TEXEL_BUFFER_IN(stages, member) {TEXELS, stages, VIRGA_SOURCE_TEXELS, AT(member)}
#define STORAGE_IMAGE(member)           {IMAGE, COMPUTE, VIRGA_SOURCE_IMAGE, AT(member)}
#define SAMPLED_IMAGE(stages, member)   {SAMPLED, stages, VIRGA_SOURCE_IMAGE, AT(member)}
/* A ring, whose block of this type is at a dynamic offset. */
#define RING(stages, member, type)      {DYNAMIC, stages, VIRGA_SOURCE_RING, AT(member), sizeof(type)}

/* ---- passes: what follows the name are fields of virga_effect_pass, by name */

#define PASS(pass, ...) ROW(ROW_PASS, EFFECT, , pass, pass, __VA_ARGS__)
/* In shaders/<EFFECT>/step and draw. */
#define STEP(pass, ...) ROW(ROW_PASS, EFFECT, step_, pass, pass, __VA_ARGS__)
#define DRAW(pass, ...) ROW(ROW_PASS, EFFECT, draw_, pass, pass, __VA_ARGS__)
/* In another folder, or with a member that is not called like the pass. */
#define PASS_AT(folder, pass, member, ...) ROW(ROW_PASS, EFFECT, folder##_, pass, member, __VA_ARGS__)
/* The form of a pass for subgroups of whole units of eight lanes; before the row of the pass itself. */
#define PASS_SHUFFLE(pass, ...) ROW(ROW_PASS, EFFECT, , pass##_shuffle, pass, .shuffles = true, __VA_ARGS__)
#define ROW_PASS(effect, folder, pass, member, ...) \
    {#effect "." #pass, offsetof(virga_##effect, member), VIRGA_SPIRV(effect##_##folder##pass##_comp), __VA_ARGS__}

/* clang-format on */

#endif
