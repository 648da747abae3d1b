/* types.h - the layer that lets C and GLSL read the same header.
 *
 * A shared header uses only uint, int, float and arrays of them. Blocks use scalar alignment
 * (VK_EXT_scalar_block_layout, Vulkan 1.2's scalarBlockLayout), so both languages have the same layout byte for byte. C
 * asserts sizes and offsets at compile time. For GLSL a test reads the offsets from the SPIR-V. */
#ifndef VIRGA_SHARED_TYPES_H
#define VIRGA_SHARED_TYPES_H

#ifdef VIRGA_GLSL
#define VIRGA_STRUCT(name) struct name
#define VIRGA_ASSERT_SIZE(name, bytes)
#define VIRGA_ASSERT_OFFSET(name, member, bytes)
#define VIRGA_INLINE
#else
#include <stddef.h>
#include <stdint.h>
typedef uint32_t virga_uint;
#ifndef __cplusplus
#define VIRGA_STATIC_ASSERT _Static_assert
#else
#define VIRGA_STATIC_ASSERT static_assert
#endif
#define VIRGA_ASSERT_SIZE(name, bytes) VIRGA_STATIC_ASSERT(sizeof(name) == (bytes), #name " has another size in C")
#define VIRGA_ASSERT_OFFSET(name, member, bytes) \
    VIRGA_STATIC_ASSERT(offsetof(name, member) == (bytes), #name "." #member " is elsewhere in C")
#endif

#endif
