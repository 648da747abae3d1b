/* effects_alone.c - a frame of rain, ground and splashes without a scene, as engine/README.md shows it. It is compiled
 * and not run. */
#include <virga/virga.h>

void record_frame(virga_context *context, virga_rain *rain, virga_ground *ground, virga_splash *splash,
                  VkCommandBuffer cmd, uint64_t frame_index, uint64_t completed_index, double dt,
                  const double camera_m[3], const virga_occluder *occluders, uint32_t occluder_count,
                  const virga_view *view);
void draw_frame(virga_rain *rain, virga_splash *splash, VkCommandBuffer cmd, const virga_target *target);

void record_frame(virga_context *context, virga_rain *rain, virga_ground *ground, virga_splash *splash,
                  VkCommandBuffer cmd, uint64_t frame_index, uint64_t completed_index, double dt,
                  const double camera_m[3], const virga_occluder *occluders, uint32_t occluder_count,
                  const virga_view *view)
{
    virga_rain_step_info step = {.dt_s = dt};
    virga_rain_buffer impacts;
    virga_splash_buffer rules, returned_droplets;
    virga_ground_step_info ground_info = {.meshes = occluders, .mesh_count = occluder_count};
    virga_splash_step_info splash_info = {.wind_m_s = {0, 0, 0}};
    for (int axis = 0; axis < 3; axis++)
        step.camera_m[axis] = ground_info.camera_m[axis] = splash_info.camera_m[axis] = camera_m[axis];

    virga_frame_begin(context, frame_index, completed_index);
    virga_rain_draw_occlusion(rain, cmd, camera_m, occluders, occluder_count); /* draws your meshes from above */
    virga_rain_step(rain, cmd, &step);

    virga_rain_impacts(rain, &impacts); /* the ground reads what landed */
    virga_rain_ticks(rain, &ground_info.first_tick, &ground_info.ticks);
    ground_info.impacts = impacts.buffer;
    ground_info.impacts_offset = impacts.offset;
    ground_info.impacts_size = impacts.size;
    virga_splash_rules(splash, &rules); /* which drops splash */
    ground_info.splash_rules = rules.buffer;
    ground_info.splash_rules_offset = rules.offset;
    virga_splash_returned_droplets(splash, &returned_droplets); /* and the droplets that fell back in the step before */
    ground_info.returned_droplets = returned_droplets.buffer;
    ground_info.returned_droplets_offset = returned_droplets.offset;
    ground_info.returned_droplets_size = returned_droplets.size;
    virga_ground_step(ground, cmd, &ground_info);

    virga_ground_spawns(ground, &splash_info.spawns, &splash_info.spawns_size); /* splashes begin where drops landed */
    splash_info.first_tick = ground_info.first_tick;
    splash_info.ticks = ground_info.ticks;
    virga_splash_step(splash, cmd, &splash_info);

    virga_splash_prepare(splash, cmd, view, virga_rain_time(rain));
    virga_rain_prepare(rain, cmd, view, virga_rain_time(rain));
}

void draw_frame(virga_rain *rain, virga_splash *splash, VkCommandBuffer cmd, const virga_target *target)
{
    virga_splash_draw(splash, cmd, target);
    virga_rain_draw(rain, cmd, target);
}
