/* resolve.h - a simple temporal anti-aliasing (TAA) on the CPU, and its error with and without Virga's temporal
 * outputs. The picture shows moving water in front of a wall with a pattern.
 *
 * Each frame is drawn with a jitter (Halton 2, 3). The history is read with a Catmull-Rom spline at the position that
 * the motion vector leads to, and has a weight of 0.9. With the neighbourhood clamp it is first clamped to the range of
 * the 3 x 3 pixels around. Without Virga's outputs the motion vectors are the wall's. With them, pixels that draws have
 * written have their own vectors, and the reactive mask reduces the weight of the history: the maximum of this frame's
 * mask and the last one's at the position of the history, as virga_temporal says. The reference is the mean of 16
 * jittered frames of the same moment. */
#ifndef VIRGA_TESTS_RESOLVE_H
#define VIRGA_TESTS_RESOLVE_H

#include "camera.h"
#include "png.h"
#include "temporal_picture.h"

enum { RESOLVE_FRAMES = 24, RESOLVE_WARM = 8, RESOLVE_TRUTH = 16, RESOLVES = 4 };

#define WALL_Z -6.0 /* the wall's plane, m */

/* Input of a test: `advance` steps to a frame, `draw` draws it with a jitter into `picture` and returns the cameras of
 * this and the previous frame. */
typedef struct resolve_scene {
    temporal_picture *picture;
    host_camera now, before;
    const char *name;
    void (*advance)(struct resolve_scene *scene, uint32_t frame);
    void (*draw)(struct resolve_scene *scene, const float jitter_px[2]);
    const float *wall_motion; /* (optional) replaces the motion of a static wall, x and y of each pixel */
} resolve_scene;

/* Root mean square errors, by clamp (0: without, 1: with) and outputs (0: without, 1: with). */
typedef struct resolve_errors {
    double rms[2][2];
} resolve_errors;

/* ---- the wall */

/* Waves of 0.4 to 1 m, as smooth as filtered textures, at dusk; every 3 m a post with hard edges. */
static inline double wall_light(double x, double y)
{
    const double post = x / 3 - floor(x / 3);
    return post < 0.05 ? 0.02 : 0.06 + 0.02 * sin(14 * x + 2 * sin(6 * y)) + 0.02 * sin(11 * y - 5 * x);
}

/* Intersection of the wall with the ray through a position of the picture. */
static inline void wall_position(const host_camera *camera, double x_px, double y_px, double position[3])
{
    const float *p = camera->clip_from_view, *m = camera->view_from_world;
    const double ndc[2] = {2 * x_px / camera->width - 1, 2 * y_px / camera->height - 1};
    const double v[3] = {(ndc[0] + (double)p[8]) / (double)p[0], (ndc[1] + (double)p[9]) / (double)p[5], -1};
    double d[3];
    for (int i = 0; i < 3; i++)
        d[i] = (double)m[4 * i] * v[0] + (double)m[4 * i + 1] * v[1] + (double)m[4 * i + 2] * v[2];
    const double way = (WALL_Z - camera->position_m[2]) / d[2];
    for (int i = 0; i < 3; i++)
        position[i] = camera->position_m[i] + way * d[i];
}

/* Pixels right and down, of a position in the world. Returns the depth along the camera's axis. */
static inline double camera_pixel(const host_camera *camera, const double position[3], double pixel[2])
{
    const float *p = camera->clip_from_view, *m = camera->view_from_world;
    double v[3];
    for (int row = 0; row < 3; row++) {
        v[row] = 0;
        for (int i = 0; i < 3; i++)
            v[row] += (double)m[4 * i + row] * (position[i] - camera->position_m[i]);
    }
    pixel[0] = (0.5 + 0.5 * ((double)p[0] * v[0] + (double)p[8] * v[2]) / -v[2]) * camera->width;
    pixel[1] = (0.5 + 0.5 * ((double)p[5] * v[1] + (double)p[9] * v[2]) / -v[2]) * camera->height;
    return -v[2];
}

static inline void wall_picture(const host_camera *camera, float *light)
{
    for (uint32_t y = 0; y < camera->height; y++)
        for (uint32_t x = 0; x < camera->width; x++) {
            double position[3];
            wall_position(camera, x + 0.5, y + 0.5, position);
            light[y * camera->width + x] = (float)wall_light(position[0], position[1]);
        }
}

/* Motion vector of the wall at a pixel: to the position of the same point in the previous frame. */
static inline void wall_motion(const resolve_scene *scene, size_t pixel, double motion[2])
{
    const double x = (double)(pixel % scene->now.width) + 0.5, y = (double)(pixel / scene->now.width) + 0.5;
    double position[3], before[2];
    wall_position(&scene->now, x, y, position);
    camera_pixel(&scene->before, position, before);
    motion[0] = before[0] - x;
    motion[1] = before[1] - y;
}

/* ---- frames: one channel, because everything is grey */

static inline void resolve_compose(const resolve_scene *scene, float *light)
{
    wall_picture(&scene->now, light);
    for (size_t i = 0; i < (size_t)scene->now.width * scene->now.height; i++) {
        const float *layer = &scene->picture->color[4 * i];
        light[i] = layer[1] + (1 - layer[3]) * light[i];
    }
}

static inline float bilinear(const float *image, uint32_t width, uint32_t height, double x, double y)
{
    const double fx = fmin(fmax(x - 0.5, 0), width - 1.001), fy = fmin(fmax(y - 0.5, 0), height - 1.001);
    const size_t at = (size_t)fy * width + (size_t)fx;
    const float tx = (float)(fx - floor(fx)), ty = (float)(fy - floor(fy));
    return (1 - ty) * ((1 - tx) * image[at] + tx * image[at + 1]) +
           ty * ((1 - tx) * image[at + width] + tx * image[at + width + 1]);
}

/* Weights of the Catmull-Rom spline, which blurs the history less than linear interpolation. */
static inline void spline_weights(double t, double w[4])
{
    w[0] = ((-0.5 * t + 1) * t - 0.5) * t;
    w[1] = (1.5 * t - 2.5) * t * t + 1;
    w[2] = ((-1.5 * t + 2) * t + 0.5) * t;
    w[3] = (0.5 * t - 0.5) * t * t;
}

static inline float spline(const float *image, uint32_t width, uint32_t height, double x, double y)
{
    const int ix = (int)floor(x - 0.5), iy = (int)floor(y - 0.5);
    double wx[4], wy[4], sum = 0;
    spline_weights(x - 0.5 - ix, wx);
    spline_weights(y - 0.5 - iy, wy);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            const int column = ix + i - 1, row = iy + j - 1;
            const int c = column < 0 ? 0 : column < (int)width ? column : (int)width - 1;
            const int r = row < 0 ? 0 : row < (int)height ? row : (int)height - 1;
            sum += wx[i] * wy[j] * (double)image[(size_t)r * width + (size_t)c];
        }
    return (float)fmax(sum, 0);
}

static inline float clamp_to_neighbours(const float *image, uint32_t width, uint32_t height, size_t pixel, float value)
{
    const int x = (int)(pixel % width), y = (int)(pixel / width);
    float low = INFINITY, high = -INFINITY;
    for (int j = y - 1; j <= y + 1; j++)
        for (int i = x - 1; i <= x + 1; i++) {
            if (i < 0 || j < 0 || i >= (int)width || j >= (int)height)
                continue;
            low = fminf(low, image[(size_t)j * width + (size_t)i]);
            high = fmaxf(high, image[(size_t)j * width + (size_t)i]);
        }
    return fminf(fmaxf(value, low), high);
}

/* `history` is replaced by this frame's. `mask` is the last frame's reactive mask. */
static inline void resolve_frame(const resolve_scene *scene, const float *light, const float *mask, bool clamped,
                                 bool outputs, float **history, float **spare)
{
    const uint32_t width = scene->now.width, height = scene->now.height;
    for (size_t i = 0; i < (size_t)width * height; i++) {
        double motion[2];
        wall_motion(scene, i, motion);
        if (outputs && picture_has_motion(scene->picture, i)) {
            motion[0] = (double)scene->picture->motion[2 * i];
            motion[1] = (double)scene->picture->motion[2 * i + 1];
        }
        const double x = (double)(i % width) + 0.5 + motion[0], y = (double)(i / width) + 0.5 + motion[1];
        const bool outside = x < 0 || y < 0 || x >= width || y >= height;
        float weight = outside ? 0 : 0.9f, old = spline(*history, width, height, x, y);
        if (outputs)
            weight = fminf(weight, 1 - fmaxf(scene->picture->reactive[i], bilinear(mask, width, height, x, y)));
        if (clamped)
            old = clamp_to_neighbours(light, width, height, i, old);
        (*spare)[i] = light[i] + weight * (old - light[i]);
    }
    float *swap = *history;
    *history = *spare;
    *spare = swap;
}

/* ---- pictures, if VIRGA_TEST_PICTURES names a folder: the reference, without outputs, with them, side by side */

static inline void resolve_save(const resolve_scene *scene, const char *kind, const float *const lights[], int count)
{
    const char *folder = getenv("VIRGA_TEST_PICTURES");
    const uint32_t width = scene->now.width, height = scene->now.height, zoom = 4, gap = 2;
    if (!folder)
        return;
    const uint32_t total_width = (uint32_t)count * (width * zoom + gap) - gap;
    uint8_t *rgb = malloc((size_t)total_width * height * zoom * 3);
    memset(rgb, 255, (size_t)total_width * height * zoom * 3);
    for (int part = 0; part < count; part++)
        for (uint32_t y = 0; y < height * zoom; y++)
            for (uint32_t x = 0; x < width * zoom; x++) {
                const float light = lights[part][y / zoom * width + x / zoom];
                const float rgba[4] = {light, light, light, 1};
                png_from_linear(rgba, 1, 0.5f, PNG_CURVE_SHOULDER,
                                &rgb[3 * ((size_t)y * total_width + (uint32_t)part * (width * zoom + gap) + x)]);
            }
    char path[1024], error[256];
    snprintf(path, sizeof path, "%s/%s_%s.png", folder, scene->name, kind);
    if (!png_write(path, total_width, height * zoom, 3, rgb, error, sizeof error))
        fail_msg("%s", error);
    free(rgb);
}

/* ---- all of it */

static inline void resolve_truth(resolve_scene *scene, float *light, float *truth)
{
    const size_t pixels = (size_t)scene->picture->width * scene->picture->height;
    memset(truth, 0, pixels * sizeof *truth);
    for (uint32_t k = 0; k < RESOLVE_TRUTH; k++) {
        float jitter[2];
        host_camera_jitter(k, RESOLVE_TRUTH, jitter);
        scene->draw(scene, jitter);
        resolve_compose(scene, light);
        for (size_t i = 0; i < pixels; i++)
            truth[i] += light[i] / RESOLVE_TRUTH;
    }
}

static inline double halton(uint32_t index, uint32_t base)
{
    double value = 0, part = 1;
    for (; index; index /= base)
        value += (part /= base) * (index % base);
    return value;
}

static inline resolve_errors resolve_run(resolve_scene *scene)
{
    const size_t pixels = (size_t)scene->picture->width * scene->picture->height;
    float *light = calloc(pixels, 4), *truth = calloc(pixels, 4), *mask = calloc(pixels, 4), *spare = calloc(pixels, 4);
    float *history[RESOLVES];
    double sums[RESOLVES] = {0};
    for (int k = 0; k < RESOLVES; k++)
        history[k] = calloc(pixels, 4);
    for (uint32_t frame = 0; frame < RESOLVE_FRAMES; frame++) {
        const float jitter[2] = {(float)halton(frame % 8 + 1, 2) - 0.5f, (float)halton(frame % 8 + 1, 3) - 0.5f};
        scene->advance(scene, frame);
        if (frame >= RESOLVE_WARM)
            resolve_truth(scene, light, truth);
        scene->draw(scene, jitter);
        resolve_compose(scene, light);
        for (int k = 0; k < RESOLVES; k++) {
            if (frame == 0)
                memcpy(history[k], light, pixels * 4);
            resolve_frame(scene, light, mask, k / 2, k % 2, &history[k], &spare);
            for (size_t i = 0; frame >= RESOLVE_WARM && i < pixels; i++)
                sums[k] += pow((double)history[k][i] - (double)truth[i], 2);
        }
        memcpy(mask, scene->picture->reactive, pixels * 4);
    }
    resolve_save(scene, "plain", (const float *const[]){truth, history[0], history[1]}, 3);
    resolve_save(scene, "clamped", (const float *const[]){truth, history[2], history[3]}, 3);
    resolve_errors errors;
    for (int k = 0; k < RESOLVES; k++) {
        errors.rms[k / 2][k % 2] = sqrt(sums[k] / (double)pixels / (RESOLVE_FRAMES - RESOLVE_WARM));
        free(history[k]);
    }
    free(light);
    free(truth);
    free(mask);
    free(spare);
    printf("%s: rms error without outputs %.5f, with %.5f; clamped %.5f, %.5f\n", scene->name, errors.rms[0][0],
           errors.rms[0][1], errors.rms[1][0], errors.rms[1][1]);
    return errors;
}

#endif
