/* virga/water.h - water from simulated particles: a surface of surfels that reflects and refracts.
 *
 * The method is that of Iwasaki et al. 2006, "Point-based Rendering of Water Surfaces with Splashes Simulated by
 * Particle-based Simulation". Each particle adds a density around it; the surface is where the density has a certain
 * value. It is sampled on the edges of a grid, and every sample is a surfel: a small disk with the surface's normal.
 *
 * The particles come from the host, in a buffer, in each step: from files, from a simulation of the host, or from the
 * one of virga/fluid.h.
 *
 * A frame, outside rendering:
 *
 *     virga_water_step(water, cmd, &info);
 *     virga_water_prepare(water, cmd, &view);
 *
 * and inside rendering, after the opaque scene:
 *
 *     virga_water_draw(water, cmd, target);
 *     virga_water_draw_foam(water, cmd, target);
 *
 * Drawing: each surfel is drawn as an ellipse into images of the effect's own. Overlapping ellipses are added up with
 * weights (surface splatting, Zwicker et al. 2001). This gives each pixel a depth and a normal, smooth also where few
 * surfels are. The draw then computes Fresnel's reflection of the environment and of lamps, and what is seen through
 * the water: the ray is refracted and meets the host's scene where the host's depth says so. Absorption follows Beer
 * and Lambert's law, over the thickness that the volumes of all particles along the ray add up to. Droplets of less
 * than about a pixel lie over the surface with the coverage that their discs have, and are lit as rain is.
 *
 * Deterministic: the same particles give the same bits, in any order if their ids differ.
 * Thread-safety: as virga/vulkan.h says. */
#ifndef VIRGA_WATER_H
#define VIRGA_WATER_H

#include <virga/light.h>
#include <virga/shared/body_near.h>
#include <virga/shared/foam.h>
#include <virga/shared/handed_droplet.h>
#include <virga/shared/leaver.h>
#include <virga/shared/particle.h>
#include <virga/shared/spray.h>
#include <virga/shared/surfel.h>
#include <virga/vulkan.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct virga_water virga_water; /* opaque */

typedef struct virga_water_def {
    uint32_t size, cookie;

    /* [64; 8388608] particles of a step; further ones are left out, and the log says so. 128 bytes each. Default
     * 65536. */
    uint32_t max_particles;

    /* [4096; 16777216] cells of the neighbour grid, 17 bytes each. A cell is as wide as the kernel's radius. If the box
     * around all particles has more cells, the grid is a smaller box around their median, and particles outside it are
     * not part of the surface. Default 262144. */
    uint32_t max_cells;

    /* [64; 1048576] cells that the surface runs through, with their neighbours; 280 bytes each. Further ones have no
     * surface: the water has a hole there, and the log says so. Default 32768. */
    uint32_t max_blocks;

    /* [256; 8388608] surfels; 32 bytes each. Further ones are left out, and the log says so. Default 262144. */
    uint32_t max_surfels;

    /* [64; 262144] splash particles in a frame; 2 kilobytes each. The water of further ones is missing from the
     * picture, and the statistics say how many. Default 4096. */
    uint32_t max_spray;

    /* [256; 4194304] droplets that splash particles become; 32 bytes each. Further ones are left out, and the
     * statistics say how many. Default 65536. */
    uint32_t max_droplets;

    /* [0; 1048576] particles of foam: 64 bytes each, 32 more for each view, and 36 for each of max_particles. While all
     * are in use no new ones are made, and the statistics say how many are missing. 0: no foam. Default 65536. */
    uint32_t max_foam;

    /* [0; 16384] size in pixels of the images that water is drawn from; 34 bytes for each pixel, and 53 bytes for each
     * surfel. Larger views are drawn at this resolution. Default 1920 x 1080. If one is 0, the water can not be drawn,
     * and nothing is allocated for it. */
    uint32_t max_width, max_height;

    /* [0; 4194304] (VIRGA_WATER_SHADING_SURFELS) parts that all divisions of surfels may add in a picture: 64 bytes
     * each, 72 more for each surfel, and 20 for each pixel and view. The surfels for whose parts there is no room stay
     * whole. 0: there is no such shading. Default 0. */
    uint32_t max_parts;

    /* [1; VIRGA_MAX_VIEWS] views that live in a frame at the same time, see virga_prepared. Each further one costs 28
     * bytes per pixel of max_width x max_height. Default 1. */
    uint32_t max_views;
} virga_water_def;

VIRGA_API virga_water_def virga_default_water_def(void);

/* What becomes of particles that leave the water. */
typedef enum virga_water_style {
    /* As in the paper: droplets of one size, in a pattern that moves with the particle. Their number follows the
     * largest speed that the particle has reached. A particle is either water or spray. */
    VIRGA_WATER_STYLE_PAPER = 0,

    /* Droplets of many sizes that fly apart, are slowed by the air, each as its size says, and break again where the
     * Weber number of the air stream exceeds 12. Particles go over from water into spray by degrees. */
    VIRGA_WATER_STYLE_PHYSICAL = 1,
} virga_water_style;

/* The shape of the kernels that the surface is made of. */
typedef enum virga_water_kernel {
    /* A ball around each particle, as in the paper. */
    VIRGA_WATER_KERNEL_ISOTROPIC = 0,

    /* An ellipsoid along the neighbours of each particle (Yu and Turk 2013): a disk on flat water and in thin
     * sheets. Edges are sharper, and sheets of one layer of particles stay whole with wide kernels, where balls lose
     * them above kernel_spacings 2.46. Flat water is not flatter than with balls of the same radius: what counts
     * there is how many particles a kernel sees. Yu and Turk take the mean and the covariance of neighbours within two
     * radii of the kernel, and their centers stay in that mean; that is where their flat water comes from, and it costs
     * water. On particles out of order by 0.115 spacings, heights of the surface have an RMS of 0.075 spacings with
     * balls and 0.078 with ellipsoids; 0.072 if centers stay in the mean, but the surface is 0.3 spacings too low;
     * 0.053 with neighbours within two radii, 0.2 too low; and 0.042 with both, 0.9 too low. Here neighbours are those
     * within one radius, as the grid has them. With a larger kernel_spacings water is flatter and keeps its volume:
     * around its own large shape, such a surface has an RMS of 0.052 spacings (balls) and 0.069 (ellipsoids) with a
     * radius of 2 spacings, and of 0.033 and 0.036 with 3. On software Vulkan a step takes 1.6 to 2.7 times as long. */
    VIRGA_WATER_KERNEL_ANISOTROPIC = 1,
} virga_water_kernel;

/* What a share below 1 of particles does to the surface, see virga_particle_gpu. */
typedef enum virga_water_fading {
    /* The share of the water around a particle, which is the largest among its neighbours, is how much of the surface
     * covers what is behind it; a particle that has less than they have makes the surface lower. Particles that appear
     * and vanish do not pop, whether alone or in a whole body of water. In steps with such particles the pass
     * water.density takes twice as long: on software Vulkan the surface of 7,000 particles then takes 13 % longer, and
     * that of 200,000 takes 30 %. */
    VIRGA_WATER_FADING_COVERAGE = 0,

    /* The share is a factor of the particle's density, and no more. It is for two sets of particles that fill the same
     * space, with shares that add up to 1, as for a time between two files whose particles have no ids. A body of water
     * whose particles vanish is there down to the share virga_water_settings.level, and then gone at once. */
    VIRGA_WATER_FADING_VOLUME = 1,
} virga_water_fading;

/* Where the light of the surface is computed. */
typedef enum virga_water_shading {
    /* In each pixel, with the normal that the surfels there add up to. */
    VIRGA_WATER_SHADING_PIXELS = 0,

    /* As in the paper (section 5): in four points of each surfel, with its own normal. Where the four colors differ by
     * more than surfel_difference, the surfel is divided into four of half its radius, down to the size of a pixel. One
     * that is not divided has the mean of its four colors. Pictures are softer, and glitter is lost; cost grows with
     * the surfels in view instead of the pixels. It is for comparisons, and needs virga_water_def.max_parts.
     *
     * virga_water_prepare then reads virga_view.color and depth: the opaque scene must be drawn before it. */
    VIRGA_WATER_SHADING_SURFELS = 1,
} virga_water_shading;

/* Whether the surface meets solids at a contact line, see virga_water_draw. It needs virga_view.depth. */
typedef enum virga_water_contact {
    /* It ends where its particles do, half a spacing before a solid. */
    VIRGA_WATER_CONTACT_OFF = 0,

    /* The draw looks for contact lines in each pixel. A GPU takes the branch only near solids; software Vulkan executes
     * it everywhere, so that the draw takes about twice as long. */
    VIRGA_WATER_CONTACT_DRAW = 1,

    /* virga_water_prepare reads virga_view.depth: the opaque scene must be drawn before it. The picture is the same. On
     * software Vulkan, if the view is not larger than max_width x max_height, the draw then leaves out tiles of 16 x 16
     * pixels without water, and looks for contact lines only in those that may have them. On a GPU it is as
     * VIRGA_WATER_CONTACT_DRAW. */
    VIRGA_WATER_CONTACT_PREPARE = 2,
} virga_water_contact;

typedef struct virga_water_settings {
    uint32_t size, cookie;

    /* [0.0001; 10] distance d of particles at rest (m): the side of the cube of water that a particle stands for. Use
     * the simulation's own value. Default 0.02. */
    float spacing_m;

    /* [0; 1000] volume of a particle (m^3). 0: spacing_m^3, as in the paper. Programs differ: SPlisHSPlasH uses 0.8
     * spacing_m^3. Default 0. */
    float volume_m3;

    /* [1; 4] radius of the kernel in spacings: n of equation 2. Larger is smoother and slower: the cost grows as its
     * cube. Default 2. */
    float kernel_spacings;

    /* [0.05; 0.95] density of the surface, where 1 is inside the water. At 0.5 the volume inside the surface is that of
     * the particles. Default 0.5. */
    float level;

    /* Default coverage. */
    virga_water_fading fading;

    /* Default isotropic. */
    virga_water_kernel kernel;

    /* [0; 1] (anisotropic) how far the centers of kernels move towards the mean of their neighbours: lambda of
     * equation 6 of Yu and Turk 2013. Default 0.9. */
    float smoothing;

    /* [1; 4] (anisotropic) largest ratio of two axes of a kernel. Default 2: the square root of the paper's k_r = 4, as
     * the paper compares squares of axes. */
    float stretch;

    /* How spray is made. Default physical. */
    virga_water_style style;

    /* [0; 0.9] particles with less density than this are splash particles: they leave the surface and become droplets;
     * in the physical style by degrees, from 1.15 to 0.85 of it. 0: there are none. With kernel_spacings 2 and
     * volume_m3 0, a particle all alone has the density 0.196, and those of a flat surface have 0.7. Default 0.35. */
    float spray_density;

    /* [1; 32] droplets that a splash particle becomes at most: V of equation 3. Default 25, as in the paper. */
    uint32_t spray_pieces;

    /* (paper) [0.01; 1000] speed at which a particle becomes that many (m/s); their number grows linearly with the
     * largest speed since it left the water. Default 4. */
    float spray_speed_m_s;

    /* (paper) [0; 4] radius of the ball in which the droplets of a particle are, in spacings. Default 1.25. */
    float spray_pattern;

    /* (physical) [0; 1] part of a particle's speed with which its droplets fly apart when it leaves the water. They are
     * as large as surface tension holds together against that motion: their diameter is 12 sigma / (rho u^2) with this
     * speed u (the critical Weber number of Hinze 1955). At 0 the particle becomes one drop. Default 0.1. */
    float spray_turbulence;

    /* true: the droplets of a particle that has left the water are handed over: they fly on as droplets of splashes,
     * wet what they hit, and are drawn there. This needs a list for them (virga_water_step_info.handed), which a scene
     * with splashes has. false: they are drawn by the water, follow the particles, and wet nothing. Default true. */
    bool hand_over;

    /* [0; 10] time since a particle has left the water (s) from which on its droplets are handed over, once for each
     * particle that leaves. Until then it may fall back as it was. Default 0.03. */
    float hand_over_s;

    /* ---- foam: spray, foam on the surface and bubbles, after Ihmsen et al. 2012, "Unified spray, foam and air bubbles
     * for particle-based fluids". It follows the water and does not move it, and no water is taken for it. See
     * virga_water_def.max_foam.
     *
     * In a second, a particle of water makes I_k (foam_air_hz I_ta + foam_crest_hz I_wc) particles of foam. The
     * potentials I go from 0 at the first value of a range to 1 at the second. */

    /* [0; 1e6] particles of foam that a particle of water makes in a second where it traps air: k_ta (1/s). 0: none.
     * Default 600. Finer simulations need fewer. */
    float foam_air_hz;

    /* [0; 1e6] the same at the crests of waves: k_wc (1/s). Default 600. */
    float foam_crest_hz;

    /* [0; 1000] range of the speed (m/s) of water. I_k grows with its square, as the kinetic energy. Default 0.6, 2.
     */
    float foam_speed_m_s[2];

    /* [0; 1000] range of trapped air: how fast neighbours of a particle come nearer, as the mean over them (m/s).
     * Default 0.25, 0.8. */
    float foam_air_m_s[2];

    /* [-10000; 10000] two opposite corners of a box around the water (m), in the axes and from the origin of the
     * particles. Its walls trap air as particles at rest behind them would: with the speed of the water into the wall.
     * Water that slides along a wall makes no foam there. Bodies: virga_water_step_info.bodies. The same corner twice
     * (default): no walls. */
    float foam_walls_low_m[3], foam_walls_high_m[3];

    /* [0; 10] range of a crest's curvature: the mean of 1 - cos of the angles between the normals of a particle and of
     * its neighbours, where the surface is convex and moves along its normal. Default 0.25, 0.6. */
    float foam_crest[2];

    /* [0.01; 1000] life time of foam from the smallest and from the largest potential (s); each particle has 0.75 to
     * 1.25 of it. Foam on the surface and spray age, bubbles do not. Default 1, 4. */
    float foam_life_s[2];

    /* [1e-5; 1] mean radius of a particle of foam (m): a cluster of bubbles, or of fine drops. Default 0.002. */
    float foam_radius_m;

    /* [0; 10] speed at which bubbles rise in water at rest (m/s). Default 0.25. */
    float foam_rise_m_s;

    /* [0.01; 1000] rate at which bubbles take on the velocity of the water: k_d (1/s). Default 40. */
    float foam_drag_hz;

    /* ---- how it is drawn */

    /* [0; 1000] absorption of light (1/m; red, green, blue). Water of a path of x m lets exp(-x absorption) through.
     * Default 0.29, 0.056, 0.0103: pure water at 620, 549 and 455 nm, the mean wavelengths of linear sRGB (Pope and
     * Fry 1997, table 3). Lakes and rivers: ten times that and more in the blue. */
    float absorption_1_m[3];

    /* [0; 1000] scattering of light out of the path (1/m; red, green, blue). It is replaced by light of the mean
     * radiance of the environment, so water becomes milky. Clear water has 0.002 to 0.1, water with much air in it
     * 1 to 10. Default 0. */
    float scattering_1_m[3];

    /* [0; 4] factor of the light that is mirrored by the surface; 1: Fresnel's equations with a refractive index of
     * 1.333. Default 1. */
    float reflection;

    /* [0; 4] factor of the distance in the picture by which what is seen through water is shifted. Default 1. */
    float refraction;

    /* [0.5; 4] factor of the radius of surfels. Larger ones make a smoother surface, lose small waves, and cost as
     * their square. Default 1.25. */
    float surfel_radius;

    /* Where light is computed. Surfels without virga_water_def.max_parts: VIRGA_DEGRADED, logged, and pixels are used.
     * Default pixels. */
    virga_water_shading shading;

    /* (surfels) [0; 1000] difference of four colors from which on a surfel is divided: C_a of section 5. It is that of
     * the channel where they are farthest apart, in parts of the mean of the brightest channel, so it is the same in
     * bright and dark scenes. 0: each surfel that is larger than a pixel is divided, if its colors differ at all.
     * Default 0.1. */
    float surfel_difference;

    /* (surfels) [0; 3] how often a surfel and its parts are divided at most; 0: never. Each time costs up to four times
     * as many colors. Default 3. */
    uint32_t surfel_divisions;

    /* [0; 10] range of depth over which the water fades where it meets the scene (m). Needs virga_view.depth. At a
     * contact line (see virga_water_draw) it is at most half a pixel. Default 0.002. */
    float soft_m;

    /* Default VIRGA_WATER_CONTACT_DRAW. */
    virga_water_contact contact;

    /* [0; 1] how much of what is behind it a particle of foam covers in its middle. Default 0.3. */
    float foam_coverage;

    /* [0; 1000] factor of the light from lamps. Default 1. */
    float light_gain;

    /* The environment and lamps. A panorama replaces the environment's spherical harmonics in what is mirrored, see
     * virga_water_environment. */
    virga_lighting lighting;
} virga_water_settings;

VIRGA_API virga_water_settings virga_default_water_settings(void);

/* Allocates, and builds pipelines when virga_context_def.pipeline_build_mode says so. VIRGA_DEGRADED: pools were made
 * smaller to fit the context's memory_budget; the log says how small. Errors as virga_context_create; *water is NULL
 * then. */
VIRGA_API virga_result virga_water_create(virga_context *context, const virga_water_def *def, virga_water **water);

/* Destroys it and sets *water to NULL. Accepts NULL. Frames in flight may still use it: its resources are freed when
 * they have completed. */
VIRGA_API void virga_water_destroy(virga_water **water);

/* Returns VIRGA_OK if its pipelines for stepping and preparing are built, VIRGA_NOT_READY if some are missing, or the
 * error of one that could not be built. See virga_pipelines_build. Costs nothing. */
VIRGA_API virga_result virga_water_ready(const virga_water *water);

/* Applies new settings from the next step on. Out of range: clamped, logged, VIRGA_DEGRADED. NaN, infinity or a wrong
 * cookie: VIRGA_ERROR_INVALID, and nothing changes. */
VIRGA_API virga_result virga_water_set(virga_water *water, const virga_water_settings *settings);

/* Reads the current settings. */
VIRGA_API void virga_water_get(const virga_water *water, virga_water_settings *settings);

/* Returns the device memory in bytes that virga_water_create will allocate at most, with eight frames in flight. */
VIRGA_API VkDeviceSize virga_water_estimate(const virga_water_def *def);

/* Arguments of one step. */
typedef struct virga_water_step_info {
    /* `count` virga_particle_gpu from `offset` on; a storage buffer, ready to be read by compute shaders. The offset is
     * a multiple of the device's minStorageBufferOffsetAlignment. VK_NULL_HANDLE is allowed if count is 0. */
    VkBuffer particles;
    VkDeviceSize offset;
    uint32_t count;

    /* [-1e9; 1e9] position in the world (m) that the particles' positions are relative to. */
    double origin_m[3];

    /* [-1e9; 1e9] time that the particles are at (s), in the time of virga_water_prepare. Splash particles are followed
     * from step to step if it grows by 0.25 s at most; otherwise they begin anew. So does foam. */
    double time_s;

    /* true: another time of a frame that was stepped already, e.g. for motion blur. Splash particles are what they were
     * in the last step without it, foam is drawn where it was on its way, and later steps do not see this one. Default
     * false. */
    bool sub_frame;

    /* (optional) The list of droplets that are handed over: a virga_handed_droplets_gpu and the droplets after it, as
     * virga_splash_handed returns it; a storage buffer, ready to be read and written by compute shaders. NULL: none are
     * handed over. Not used with `sub_frame`. */
    VkBuffer handed;

    /* A multiple of the device's minStorageBufferOffsetAlignment and of 4; and bytes from there, 0: all of the buffer.
     */
    VkDeviceSize handed_offset, handed_size;

    /* (optional) Solid bodies in the water, for its foam: `count` virga_body_near_gpu from `bodies_offset` on, one for
     * each particle in their order; a storage buffer, ready to be read by compute shaders. virga_fluid_bodies_near has
     * them; a host with bodies of its own writes them in a pass over its particles. Water beside a body then has no
     * surface there, so that the body's side is no crest, and water that meets a body traps air as at a wall, with the
     * speed of one to the other. VK_NULL_HANDLE: there are none. The offset is as that of the particles. */
    VkBuffer bodies;
    VkDeviceSize bodies_offset;
} virga_water_step_info;

/* Builds the surface of the particles. Outside rendering, at most once per frame. The buffer is read when the device
 * executes the step, and not afterwards.
 *
 * Cost on two cores of software Vulkan, with anisotropic kernels of two spacings: 15 to 25 ms for 7,290 particles, and
 * 170 ms for 208,125 (tests/water/water_look.c prints each pass). */
VIRGA_API virga_result virga_water_step(virga_water *water, VkCommandBuffer cmd, const virga_water_step_info *info);

/* Builds the pipelines for a target, any number of targets. Does nothing without max_width. Errors as
 * virga_context_create. */
VIRGA_API virga_result virga_water_attach(virga_water *water, const virga_target *target);

/* Sets the panorama that the surface mirrors, from the next prepare on: linear radiance, equirectangular; row 0 is
 * straight up (+Y), the middle column looks along -Z, columns run towards +X. `panorama` NULL or without a view: the
 * environment of the lighting is mirrored. The image must live until the frames that draw with it have completed, in
 * the layout of `before`, readable by fragment shaders. An image without its view, a view without its image, or the
 * layout UNDEFINED: VIRGA_ERROR_INVALID. */
VIRGA_API virga_result virga_water_environment(virga_water *water, const virga_image *panorama);

/* Draws the surface of this frame's step into images of the effect, for one view. Outside rendering, after the step,
 * at most eight times per frame. The draw of a view comes before the prepare of the next, or def.max_views is larger.
 * The water is drawn where the particles of the step are.
 *
 * VIRGA_NOT_READY: no step in this frame, no max_width, or pipelines are missing; nothing is recorded.
 * Costs two draws of each surfel that faces the camera, a third of those that lie over gaps in what is in front of
 * them, and nine atomic additions for each particle. With VIRGA_WATER_CONTACT_PREPARE, see there. With
 * VIRGA_WATER_SHADING_SURFELS, also a draw of each surfel and of each part, and four to eight colors for each part. */
VIRGA_API virga_result virga_water_prepare(virga_water *water, VkCommandBuffer cmd, const virga_view *view);

/* The same, and *prepared (may be NULL) gets the view's handle for virga_water_draw_view; 0 if nothing was prepared. Up
 * to def.max_views of them live at the same time. */
VIRGA_API virga_result virga_water_prepare_view(virga_water *water, VkCommandBuffer cmd, const virga_view *view,
                                                virga_prepared *prepared);

/* Draws the water into the target, inside rendering, after the opaque scene. With virga_view.color, what is seen
 * through the water is refracted; without it, the environment is seen through the water. With virga_view.depth, the ray
 * in the water ends at the scene. The camera must be outside the water: its surface seen from below is not drawn.
 *
 * Contact line (virga_water_settings.contact): particles end half a spacing before a solid. With virga_view.depth the
 * surface goes on to the solid that the depth shows, with the meniscus of a contact angle of 20 degrees, and a thin
 * layer ends in a wedge. Not where a spacing is smaller than two pixels, nor with VIRGA_WATER_SHADING_SURFELS. A gap
 * behind a surface that is seen at less than 15 to 30 degrees stays: little of it is seen.
 *
 * A transparent solid, e.g. a windshield, that the depth does not contain has no contact line: the water ends half a
 * spacing before it. Where the water is on the eye's side of it, draw it into a copy of the depth, and give this as
 * virga_view.depth, with the color as it is: the surface goes on to it, and what is seen through the water is refracted
 * as if it lay on it. Where the water is behind it, it would hide the water from such a copy. There let the simulation
 * have it half a spacing nearer to the eye than it is: particles then end where their surface touches the real one.
 *
 * VIRGA_NOT_READY, logged once: the target is not attached, or nothing was prepared in this frame. */
VIRGA_API virga_result virga_water_draw(virga_water *water, VkCommandBuffer cmd, const virga_target *target);

/* The same for any view that was prepared in this frame, see virga_prepared. VIRGA_ERROR_INVALID for one that was not,
 * or that a later prepare or step has replaced. */
VIRGA_API virga_result virga_water_draw_view(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                                             virga_prepared prepared);

/* Draws the foam of the view that was prepared, inside rendering, after virga_water_draw. Scenes draw both. Foam under
 * the surface is seen through the water. Foam that moves in the picture is a streak, as long as its way while the
 * shutter is open (virga_view.shutter_s); it covers as much as at rest, and lies around the middle of its way.
 * VIRGA_OK without max_foam; otherwise as virga_water_draw. */
VIRGA_API virga_result virga_water_draw_foam(virga_water *water, VkCommandBuffer cmd, const virga_target *target);

/* The same for any view that was prepared in this frame, as virga_water_draw_view. */
VIRGA_API virga_result virga_water_draw_foam_view(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                                                  virga_prepared prepared);

/* What virga_water_draw_data writes. */
typedef enum virga_water_data {
    VIRGA_WATER_DATA_THICKNESS = 0, /* red: metres of water along the direction of view */
    VIRGA_WATER_DATA_NORMAL = 1,    /* red, green, blue: the surface's normal in the world, out of the water */
    VIRGA_WATER_DATA_MOTION = 2,    /* red, green: motion vector, scaled by virga_temporal.motion_scale */
} virga_water_data;

/* Writes data of the view that was prepared into a target with a format of floats, inside rendering, e.g. for
 * compositing. Pixels that water covers by half or more get the value and the alpha 1; the others are left as they are.
 * Otherwise as virga_water_draw. VIRGA_ERROR_INVALID for another value of `what`. */
VIRGA_API virga_result virga_water_draw_data(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                                             virga_water_data what);

/* The same for any view that was prepared in this frame, as virga_water_draw_view. */
VIRGA_API virga_result virga_water_draw_data_view(virga_water *water, VkCommandBuffer cmd, const virga_target *target,
                                                  virga_prepared prepared, virga_water_data what);

/* A range of a buffer, in bytes. */
typedef struct virga_water_buffer {
    VkBuffer buffer;
    VkDeviceSize offset, size;
} virga_water_buffer;

/* Reads where the surfels of the newest step are: virga_surfel_gpu, as many as virga_water_stats.surfels says for that
 * frame, relative to `origin_m`. Ready to be read by transfers and compute shaders. */
VIRGA_API void virga_water_surfels(const virga_water *water, virga_water_buffer *surfels, double origin_m[3]);

/* Reads where the spray of the newest step is: virga_spray_gpu, as many as virga_water_stats.droplets says for that
 * frame, relative to `origin_m`. The volumes of a particle's droplets add up to its volume times its share. The surface
 * has surfels of them as well, after all others. Ready to be read by transfers and compute shaders. */
VIRGA_API void virga_water_spray(const virga_water *water, virga_water_buffer *droplets, double origin_m[3]);

/* Reads where the foam of the newest step is: the slots of a pool of virga_foam_gpu, relative to `origin_m`. Slots with
 * life_s 0 are free. Of size 0 without max_foam. Ready to be read by transfers and compute shaders. */
VIRGA_API void virga_water_foam(const virga_water *water, virga_water_buffer *foam, double origin_m[3]);

/* Reads the density at each particle of the newest step: a float for each, in the order of the particles. 1 is inside
 * the water, 0 stands for particles outside the grid. Ready to be read by transfers and compute shaders. */
VIRGA_API void virga_water_densities(const virga_water *water, virga_water_buffer *densities);

/* The particles that have left the water, for virga_splash_step_info and for simulations. */
typedef struct virga_water_leavers {
    VkBuffer leavers;              /* a virga_leavers_gpu, and twice def.max_spray x virga_leaver_gpu */
    VkBuffer table;                /* words, see virga/shared/leaver.h */
    VkDeviceSize size, table_size; /* bytes of the two, from their start */
} virga_water_leavers;

/* Reads where they are, as the newest step without `sub_frame` left them. Ready to be read and written by compute
 * shaders. All zero before the first step. */
VIRGA_API void virga_water_leavers_get(const virga_water *water, virga_water_leavers *leavers);

/* The newest statistics of completed frames. */
typedef struct virga_water_stats {
    /* 0: none yet. */
    uint64_t frame_index;

    /* Particles of the step; those with positions that are not finite, or too far from the origin; those in the grid.
     */
    uint32_t particles, invalid, in_grid;

    /* Surfels that were made, and those for which there was no room. */
    uint32_t surfels, surfels_dropped;

    /* Splash particles, and those for which there was no room; the same of their droplets. */
    uint32_t splashes, splashes_dropped, droplets, droplets_dropped;

    /* Particles of foam, and new ones in this step for which there was no room. Of those that are older than the step,
     * how many are spray, foam on the surface, and bubbles. */
    uint32_t foam, foam_dropped, foam_spray, foam_surface, foam_bubbles;

    /* Cells that the surface may run through, and those of them for which there was no room. */
    uint32_t blocks, blocks_dropped;

    /* Water that was handed over since creation, and the part of it that is the particles' again: they fell back into
     * the water while their droplets were in the air (nl). */
    uint64_t handed_nl, taken_back_nl;
} virga_water_stats;

VIRGA_API void virga_water_stats_get(virga_water *water, virga_water_stats *stats);

#ifdef __cplusplus
}
#endif
#endif
