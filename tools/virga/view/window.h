/* window.h - a window of the desktop with a swapchain: FIFO, resized with the window, skipped while minimised. */
#ifndef VIRGA_VIEW_WINDOW_H
#define VIRGA_VIEW_WINDOW_H

#include "host.h"

#define VIEW_MAX_IMAGES 16

struct GLFWwindow;

typedef struct view_window {
    struct GLFWwindow *glfw;
    host_device *device;
    VkInstance instance;
    VkSurfaceKHR surface;
    VkSwapchainKHR swapchain;
    VkSurfaceFormatKHR format; /* 8 bits, without conversion */
    uint32_t width, height;    /* of the swapchain; 0: there is none */
    VkRenderPass pass;         /* clears nothing; ends in the layout for presents */
    uint32_t image_count, image;
    VkImage images[VIEW_MAX_IMAGES];
    host_slice slices[VIEW_MAX_IMAGES];
    VkSemaphore acquired[HOST_FRAMES], drawn[VIEW_MAX_IMAGES];
    bool stale;       /* the swapchain must be created again */
    bool copyable;    /* its images can be copied */
    host_buffer copy; /* see view_window_copy */
} view_window;

/* Opens a window, without a device yet. One line in `error` where there is no display. */
bool view_window_open(view_window *window, const char *title, uint32_t width, uint32_t height, char *error,
                      size_t error_size);

/* The instance extensions it needs; static data. */
const char *const *view_window_extensions(uint32_t *count);

/* Sets the device, which was created with these extensions. */
bool view_window_attach(view_window *window, const host_instance *instance, host_device *device, char *error,
                        size_t error_size);

/* Waits for the device, destroys its objects, then closes the window. */
void view_window_detach(view_window *window);
void view_window_close(view_window *window);

/* Acquires the next image to draw into. `*ready` is false if there is none now (minimised, just resized); then nothing
 * may be drawn. Waits until the screen has shown earlier images. */
bool view_window_acquire(view_window *window, bool *ready, char *error, size_t error_size);

/* Begins and ends drawing into it, at the end of a frame's command buffer. */
void view_window_begin(const view_window *window, VkCommandBuffer cmd);
void view_window_end(const view_window *window, VkCommandBuffer cmd);

/* Submits the frame and shows it. */
bool view_window_present(view_window *window, char *error, size_t error_size);

/* Records a copy of the image, between its end and the present; once the device has completed it, writes it as PNG. */
bool view_window_copy(view_window *window, VkCommandBuffer cmd, char *error, size_t error_size);
bool view_window_write(view_window *window, const char *path, char *error, size_t error_size);

#endif
