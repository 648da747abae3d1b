/* rain.cpp - the library in C++17: handles that destroy themselves, in the right order. engine/README.md shows it. */
#include <memory>
#include <stdexcept>
#include <string>

#include <virga/virga.h>

template <auto destroy> struct Destroyer { /* the library's functions take a pointer to the handle */
    template <class T> void operator()(T *handle) const
    {
        destroy(&handle);
    }
};
template <class T, auto destroy> using Handle = std::unique_ptr<T, Destroyer<destroy>>;
using Context = Handle<virga_context, virga_context_destroy>;
using Target = Handle<virga_target, virga_target_destroy>;
using Scene = Handle<virga_scene, virga_scene_destroy>;

inline void check(virga_result result, const char *what)
{
    if (result < 0) /* positive results are successes with a remark */
        throw std::runtime_error(std::string(what) + ": " + virga_result_name(result));
}

template <class H, class Create, class... Args> H make(Create create, const char *what, Args... args)
{
    typename H::pointer made = nullptr;
    check(create(args..., &made), what);
    return H(made);
}

struct Rain { /* members are destroyed in reverse order: the scene first, the context last */
    Context context;
    Target target;
    Scene scene;

    Rain(const virga_context_def &device, const virga_target_def &into, const virga_scene_def &effects)
        : context(make<Context>(virga_context_create, "context", &device)),
          target(make<Target>(virga_target_create, "target", context.get(), &into)),
          scene(make<Scene>(virga_scene_create, "scene", context.get(), &effects))
    {
        check(virga_scene_attach(scene.get(), target.get()), "attach");
    }
    void step(VkCommandBuffer cmd, uint64_t frame, uint64_t completed, const virga_scene_frame &what)
    {
        check(virga_frame_begin(context.get(), frame, completed), "frame");
        check(virga_scene_record(scene.get(), cmd, &what), "step");
    }
    void draw(VkCommandBuffer cmd)
    {
        check(virga_scene_draw(scene.get(), cmd, target.get()), "draw");
    }
};
