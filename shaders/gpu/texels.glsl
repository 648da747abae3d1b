// texels.glsl - records that are read four words at a time, as texels: of a view of their buffer, or of the buffer.
//
// Software Vulkan gathers texels of a view for eight lanes at once; through a storage buffer it goes lane by lane. A
// view need not hold more than 65,536 of them, though, and on phones it does not: devices whose views are smaller than
// our largest pools read the same texels from the storage buffer, which a GPU does as well. Which of the two is a
// specialisation constant of every pipeline, so that the other is not in it. There is no second set of shaders.
layout(constant_id = 1) const bool SMALL_VIEWS = false; // see virga_context.small_views

// A function `name` that reads a texel of the buffer that is bound twice: as a view and as a storage buffer.
#define TEXELS(name, view_binding, buffer_binding)                                                            \
    layout(set = 0, binding = view_binding) uniform usamplerBuffer name##_view;                               \
    layout(std430, set = 0, binding = buffer_binding) readonly buffer name##_block { uvec4 name##_words[]; }; \
    uvec4 name(uint texel)                                                                                    \
    {                                                                                                         \
        if (SMALL_VIEWS)                                                                                      \
            return name##_words[texel];                                                                       \
        return texelFetch(name##_view, int(texel));                                                           \
    }
