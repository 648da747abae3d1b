/* shot_state.c - functions on a shot for the effects: errors, cameras, and points that are read back. */
#include "shot_state.h"

#include "ground.h"

#include <math.h>
#include <stdlib.h>

bool shot_ok(const shot *s, virga_result result, const char *what, char *error, size_t error_size)
{
    if (result >= 0)
        return true;
    return host_fail(error, error_size, "%s: %s%s%s", what, virga_result_name(result), s->warning[0] ? ": " : "",
                     s->warning);
}

bool shot_blame_input(shot *s, bool right)
{
    s->input_wrong = !right;
    return right;
}

double shot_time(const shot *s, uint32_t frame)
{
    return (double)(frame - s->scene->frames.first) / s->scene->frames.fps;
}

#define WARM_S 1.0 /* an impact's last splash comes half a second after it, and takes 0.15 s */

double shot_preroll_s(const shot *s)
{
    const scene_frames *frames = &s->scene->frames;
    const scene_ground *ground = scene_ground_of(s->scene);
    const bool warm = frames->warm_start && ground->on && (ground->start_wetness > 0 || ground->start_water_mm > 0);
    return round(fmax(frames->preroll_s, warm ? WARM_S : 0) * frames->fps) / frames->fps;
}

host_camera_path shot_eye(const shot *s)
{
    host_camera_path path = s->path;
    if (s->eye_free) {
        path.keys = s->eye_keys;
        path.count = 2;
    }
    return path;
}

/* Rotation about X, then Y, then Z of the world, scaled and moved. */
void shot_mesh_transform(const scene_mesh *mesh, float out[12])
{
    double m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int axis = 0; axis < 3; axis++) {
        const double angle = mesh->rotation_deg[axis] * M_PI / 180, c = cos(angle), sn = sin(angle);
        const int a = (axis + 1) % 3, b = (axis + 2) % 3;
        for (int column = 0; column < 3; column++) {
            const double x = m[a][column], y = m[b][column];
            m[a][column] = c * x - sn * y;
            m[b][column] = sn * x + c * y;
        }
    }
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            out[row * 4 + column] = (float)(m[row][column] * mesh->scale);
        out[row * 4 + 3] = (float)mesh->position_m[row];
    }
}

/* ---- points */

bool shot_record_read(shot *s, VkCommandBuffer cmd, VkBuffer from, VkDeviceSize offset, VkDeviceSize size,
                      shot_read *read, char *error, size_t error_size)
{
    if (!read->buffer.buffer &&
        !host_buffer_create(&s->device, size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, HOST_BUFFER_READBACK, "points read",
                            &read->buffer, error, error_size))
        return false;
    const VkBufferCopy copy = {offset, 0, size};
    const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
    const VkAccessFlags written = VK_ACCESS_TRANSFER_WRITE_BIT;
    host_memory_barrier(cmd, copying, written, copying, written);
    vkCmdCopyBuffer(cmd, from, read->buffer.buffer, 1, &copy);
    host_memory_barrier(cmd, copying, written, VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT);
    return true;
}

const void *shot_finish_read(shot *s, shot_read *read, char *error, size_t error_size)
{
    if (!read->buffer.buffer) {
        host_fail(error, error_size, "no points were read back");
        return NULL;
    }
    if (!host_wait(&s->device, error, error_size))
        return NULL;
    host_buffer_invalidate(&s->device, &read->buffer);
    return read->buffer.mapped;
}

void *shot_finish_rows(shot *s, shot_read *read, size_t stride, char *error, size_t error_size)
{
    if (!shot_finish_read(s, read, error, error_size))
        return NULL;
    void *rows = malloc(read->count * stride + 1);
    if (!rows)
        host_fail(error, error_size, "no memory for %u points", read->count);
    return rows;
}

void shot_read_position(const shot_read *read, const float position[3], float out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = (float)((double)position[axis] + read->origin_m[axis]);
}
