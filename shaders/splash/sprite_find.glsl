// sprite_find.glsl - which kind of sprite one is on the picture. Droplets and splashes have a dispatch each, as software Vulkan
// runs every lane through all branches; an invocation looks at all that its droplet or its splash may show.
#define COMPACT_SETS 2
#include "sprite.glsl"
#include "compact.glsl"
#include "gpu/compact_find.glsl"

layout(local_size_x = VIRGA_SPLASH_GROUP) in;

// In the film's style the second kind shows what is behind it; in the paper's it is a pyramid.
uint kind_of(Sprite sprite)
{
    const Projected p = project_sprite(sprite);
    const bool pile = sprite.kind == VIRGA_SPRITE_PILE;
    const bool second = is_film() ? p.width_px >= WIDE_PX && sprite.kind != VIRGA_SPRITE_PUFF : pile;
    return p.coverage <= 0.0 ? NOT_PICKED : second ? SECOND_KIND : FIRST_KIND;
}
