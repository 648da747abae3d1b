// torn.glsl - the light of torn water: its faces have all directions, and half of them show the sky. That is close to a
// horizontal white surface, whose lobe is the cosine (moments 2/3 and 1/4).
#define TORN_PUFF 0.8
#define TORN_PILE 0.5
#define TORN_DROPLET 0.25

// How torn the water of a kind of sprite is.
float torn_of(uint kind)
{
    return kind == VIRGA_SPRITE_PUFF ? TORN_PUFF : kind == VIRGA_SPRITE_PILE ? TORN_PILE : TORN_DROPLET;
}

vec3 torn_light(vec3 whole, float torn)
{
    return mix(whole, environment(vec3(0.0, 1.0, 0.0), vec2(0.667, 0.25)), torn);
}
