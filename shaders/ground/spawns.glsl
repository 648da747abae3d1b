// spawns.glsl - which drops splash, where, and with how much of their water.
#include "shared/splash_rule.h"
#include "shared/spawn.h"
#include "shared/splash_share.glsl"

layout(scalar, set = 0, binding = 18) uniform Rules { virga_splash_rules_gpu rules; };
layout(scalar, set = 0, binding = 19) buffer Spawns
{
    virga_spawns_gpu spawns_head;
    virga_spawn_gpu spawns[];
};

#define NO_SPAWN 0xffffffffu

struct Spawning {
    uint model;
    float distance2; // from the camera, squared
    uint water_nl;   // water that flies up
    uint hash;
    float keep;    // probability with which such a splash is spawned
    vec3 position; // relative to the impacts' (or returns') origin
};

uint state_at(uint cell_index)
{
    return cell_index == NO_CELL ? VIRGA_GROUND_NONE : cell_state(cell_of(cell_index), floor_of(cell_index).material);
}

uint material_at(uint cell_index, virga_impact_gpu impact)
{
    const uint given = min(impact.material & 255u, VIRGA_GROUND_MATERIALS - 1u);
    return cell_index == NO_CELL ? given : floor_of(cell_index).material;
}

// The first piece is where the drop hit the mesh, the others on the floors of their cells.
vec3 piece_position(virga_impact_gpu impact, Piece piece, uint i)
{
    const vec3 own = vec3(impact.position[0], impact.position[1], impact.position[2]);
    if (i == 0u || piece.cell_index == NO_CELL)
        return own;
    const vec2 moved = (piece.at - cells_in_window_of(impact)) * tick.cell_m;
    const float floor_m = float(floor_of(piece.cell_index).height_um) * 1e-6 - above_base(0.0);
    return vec3(own.x + moved.x, floor_m, own.z + moved.y);
}

#define FALLING_M 0.0025 // droplets of splashes are smaller, drops that fall from edges are larger

// A drop splashes by its rule, as does a large one that falls from an edge or is thrown; a droplet that falls back on
// wet ground makes a dot. As splashes have no large droplets, this ends.
uint model_of(virga_impact_gpu impact, virga_splash_rule_gpu rule, uint state, float depth_m)
{
    if (head.is_return != 0u && !(impact.diameter_m >= FALLING_M && impact.velocity[1] < -1.5))
        return state != VIRGA_GROUND_DRY && impact.diameter_m >= rules.dot_min_m ? VIRGA_SPLASH_DOT
                                                                                      : VIRGA_SPLASH_NONE;
    const bool splashes = impact.diameter_m >= rule.min_diameter_m && depth_m >= rule.min_depth_m;
    return splashes ? rule.model : VIRGA_SPLASH_NONE;
}

// Within the quota's radius all drops of SHOWN_M splash. Beyond it, each ring of that width has as many splashes as a
// disc of that radius. Crowns cover an area of D^2.75 on the picture (shape.glsl) and last longer the larger they are,
// so larger drops splash farther away and smaller ones only nearer. With equal probabilities heavy rain would spend its
// splashes on drops of half a millimetre at the camera's feet, and none would be seen along a street.
#define SHOWN_M 0.002

float spawn_probability(float distance2, float near_m, float diameter_m)
{
    const float size = diameter_m / SHOWN_M;
    return min(near_m * near_m * size * size * size / max(distance2, 1e-6), 1.0);
}

// Of a piece: its position, its hash, and the probability with which such a splash is spawned.
Spawning start_plan(virga_impact_gpu impact, Piece piece, uint i, float near_m)
{
    Spawning plan;
    plan.position = piece_position(impact, piece, i);
    plan.hash = piece_hash(impact, i);
    const vec3 to_piece = plan.position + (vec3(head.origin[0], head.origin[1], head.origin[2]) -
                                           vec3(tick.camera[0], tick.camera[1], tick.camera[2]));
    plan.distance2 = dot(to_piece, to_piece);
    plan.keep = spawn_probability(plan.distance2, near_m, impact.diameter_m);
    plan.water_nl = 0u;
    plan.model = VIRGA_SPLASH_NONE;
    return plan;
}

virga_splash_rule_gpu rule_at(virga_impact_gpu impact, Piece piece)
{
    return rules.rules[material_at(piece.cell_index, impact) * VIRGA_GROUND_STATES + state_at(piece.cell_index)];
}

// The decision, made once: by spawn_mark.comp.
bool is_splash(virga_impact_gpu impact, Piece piece, uint i)
{
    const uint model = model_of(impact, rule_at(impact, piece), state_at(piece.cell_index), depth_at(piece.cell_index));
    const Spawning plan = start_plan(impact, piece, i, spawns_head.near_m);
    return model != VIRGA_SPLASH_NONE && virga_unit(plan.hash) < plan.keep;
}

// What a piece that splashes makes.
Spawning plan_spawn(virga_impact_gpu impact, Piece piece, uint i)
{
    const uint state = state_at(piece.cell_index);
    const virga_splash_rule_gpu rule = rule_at(impact, piece);
    Spawning plan = start_plan(impact, piece, i, spawns_head.near_of_tick_m);
    plan.model = model_of(impact, rule, state, depth_at(piece.cell_index));
    if (plan.model == VIRGA_SPLASH_NONE)
        plan.model = VIRGA_SPLASH_DOT; // a threshold was decided differently in this shader
    const uint chance = virga_hash1(plan.hash);
    const float near = clamp(4.0 - 4.0 * sqrt(plan.distance2) / rules.droplet_range_m, 0.0, 1.0);
    // Droplets from a wall would fall past the surface that droplets are tracked to.
    const bool level = impact.normal[1] > 0.6;
    const bool flies = level && (plan.model == VIRGA_SPLASH_SCATTERING || plan.model == VIRGA_SPLASH_CROWN_CONE);
    if (flies && virga_unit(chance) < near) {
        const float speed = length(vec3(impact.velocity[0], impact.velocity[1], impact.velocity[2]));
        const bool wet = state != VIRGA_GROUND_DRY;
        const float share = splash_share(rule, rules.mode, impact.diameter_m, speed, wet, virga_hash1(chance));
        plan.water_nl = min(uint(share * float(piece.water_nl)), piece.water_nl);
    }
    return plan;
}
