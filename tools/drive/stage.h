/* stage.h - the sample's small renderer: a window's swapchain or a picture for a file, the passes, one material. It
 * makes no call of Virga. What is drawn goes through stations of a frame:
 *
 *     stage_begin            a command buffer, and an image to show
 *     stage_shelter          now and then: what driving rain meets first
 *     stage_world_begin/end  sky and meshes into `color` and `depth`; then `behind` is a copy of `color`
 *     stage_over_begin/end   what is blended over `color`, while `depth` and `behind` may be sampled
 *     (stage_sampled, and stage_over_begin/end: what samples `color` and is then blended over it, as a lens)
 *     stage_through          `through` is a copy of `color` now
 *     stage_over_begin/end   what shows `through`
 *     stage_end              `color` to the window or to the picture; submitted
 */
#ifndef DRIVE_STAGE_H
#define DRIVE_STAGE_H

#include <virga/ground.h>
#include <virga/light.h>
#include <virga/walls.h>

#include "descriptors.h"
#include "environment.h"
#include "mesh.h"
#include "passes.h"
#include "shaders/drive_gpu.h"
#include "shelter.h"

#define STAGE_IMAGES 8 /* of a swapchain, at most */
#define STAGE_MESHES 16
#define STAGE_SETS   256 /* materials of all meshes */

struct GLFWwindow;

typedef struct stage_camera {
    double position_m[3];
    double forward[3], up[3];                      /* unit length, at right angles */
    double fov_deg;                                /* of the picture's height */
    float view_from_world[16], clip_from_view[16]; /* made by stage_camera_set */
} stage_camera;

/* A mesh to draw, its position, and how much of the sky it sees. Its glass is drawn after the rest of it. */
typedef struct stage_draw {
    const host_mesh *mesh;
    double position_m[3];
    float axes[9];      /* columns: the mesh's axes in the world */
    float sky;          /* share of the sky that it sees, [0; 1]: 0.3 inside a car */
    const float *skies; /* (optional) instead of `sky`, one per primitive; below 0: it is not drawn */
} stage_draw;

/* An object on the ground that shades it: a car. All 0: none. */
typedef struct stage_shade {
    double position_m[3]; /* on the ground, in the middle */
    float axes[9];
    float half_m[2]; /* along the first and the third axis */
} stage_shade;

typedef struct stage {
    host_device *device;
    struct GLFWwindow *window; /* NULL: no window, a picture */
    VkSurfaceKHR surface;
    VkSwapchainKHR swapchain;
    VkFormat show_format;
    uint32_t width, height;      /* 0: minimised, nothing can be drawn */
    uint32_t image_count, image; /* number in the swapchain; index of this frame's image */
    VkImage images[STAGE_IMAGES];
    host_slice slices[STAGE_IMAGES]; /* of the swapchain's images, or of the picture */
    VkSemaphore acquired[HOST_FRAMES], finished[STAGE_IMAGES];
    host_image picture; /* instead of a swapchain */
    host_buffer copy;   /* its bytes, after the last frame */

    host_image color, depth, behind; /* RGBA16F with 1 / distance in alpha of `behind`; D32 */
    host_image through;              /* what is behind the windshield: `color` with rain and splashes */
    host_shelter shelter;            /* where walls stay dry */

    VkRenderPass world_pass, over_pass, show_pass, shelter_pass;
    VkFramebuffer world_framebuffer, over_framebuffer;

    host_bindings world, show;             /* a set for each frame in flight; one set */
    VkDescriptorSetLayout material_layout; /* set 1 of `world` */
    VkDescriptorPool material_pool;
    VkPipeline world_pipeline, glass_pipeline, sky_pipeline, show_pipeline, shelter_pipeline;
    VkSampler samplers[HOST_SAMPLINGS];
    host_buffer uniforms[HOST_FRAMES]; /* drive_frame_gpu */
    host_image white;
    struct {
        const host_mesh *mesh;
        VkDescriptorSet sets[64];
    } meshes[STAGE_MESHES];
    uint32_t mesh_count;
    stage_shade shade;
    stage_camera last; /* camera of the frame before */
    bool has_last;
} stage;

/* Renders to a window, for which the caller created a surface, or, if it is NULL, to a picture of that size. */
bool stage_create(stage *s, host_device *device, struct GLFWwindow *window, VkSurfaceKHR surface, uint32_t width,
                  uint32_t height, char *error, size_t error_size);
void stage_destroy(stage *s);

/* Computes the matrices of a camera for the current size of the picture. */
void stage_camera_set(const stage *s, stage_camera *camera);

/* Creates descriptor sets for the mesh's materials. */
bool stage_add(stage *s, const host_mesh *mesh, char *error, size_t error_size);

/* Sets the maps and the panorama that the material samples. Needed after stage_create, and when stage_begin sets
 * *resized. */
void stage_bind(stage *s, const virga_ground_maps *maps, const host_environment *environment);

/* Begins a frame. *cmd is NULL if none can be drawn now: the window is minimised, or it was resized. Then *resized is
 * set, and the size, `depth` and `behind` have changed. */
bool stage_begin(stage *s, VkCommandBuffer *cmd, bool *resized, char *error, size_t error_size);

/* Draws the map of shelter again if the camera or the rain's slant has moved on: what keeps rain off walls is in a
 * mesh that does not move. */
void stage_shelter(stage *s, VkCommandBuffer cmd, const stage_camera *camera, const virga_walls *walls,
                   const host_mesh *mesh);
void stage_world_begin(stage *s, VkCommandBuffer cmd, const stage_camera *camera, const virga_ground_maps *maps,
                       const virga_walls *walls, const virga_lighting *lighting);
void stage_draw_mesh(stage *s, VkCommandBuffer cmd, const stage_camera *camera, const stage_draw *draw);
void stage_world_end(stage *s, VkCommandBuffer cmd);
void stage_through(stage *s, VkCommandBuffer cmd);
void stage_sampled(stage *s, VkCommandBuffer cmd); /* after `color` was sampled, before it is drawn over again */
void stage_over_begin(stage *s, VkCommandBuffer cmd);
void stage_over_end(stage *s, VkCommandBuffer cmd);
bool stage_end(stage *s, VkCommandBuffer cmd, const stage_camera *camera, bool keep, char *error, size_t error_size);

/* RGBA bytes of the picture of the newest frame with `keep`, which must have completed. */
const uint8_t *stage_picture(stage *s);

#endif
