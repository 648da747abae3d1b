// texels.glsl - records that are read as texels of four 32-bit words: from a buffer view, or from the storage buffer
// itself.
//
// Software Vulkan gathers texels of a view for eight lanes at once; it reads a storage buffer lane by lane. Vulkan
// guarantees a view only 65,536 texels, though, and phones have no more. Devices whose views are smaller than our
// largest pools read the same texels from the storage buffer, which is as fast on a GPU. A specialisation constant of
// every pipeline selects one of the two, so there is no second set of shaders.
layout(constant_id = 1) const bool SMALL_VIEWS = false; // see virga_context.small_views

// Defines a function `name` that reads a texel of a buffer. The buffer is bound twice: as a view and as a storage
// buffer.
#define TEXELS(name, view_binding, buffer_binding)                                                            \
    layout(set = 0, binding = view_binding) uniform usamplerBuffer name##_view;                               \
    layout(std430, set = 0, binding = buffer_binding) readonly buffer name##_block { uvec4 name##_words[]; }; \
    uvec4 name(uint texel)                                                                                    \
    {                                                                                                         \
        if (SMALL_VIEWS)                                                                                      \
            return name##_words[texel];                                                                       \
        return texelFetch(name##_view, int(texel));                                                           \
    }
