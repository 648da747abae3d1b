/* dataset.c - `virga dataset`: rain over folders of photographs, with what a vision system learns it from. */
#include "commands/commands.h"
#include "dataset/output.h"
#include "effect.h"
#include "file.h"
#include "frame/files.h"
#include "options.h"
#include "progress.h"
#include "rain.h"
#include "shot/checkpoint.h"
#include "shot/still.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MAX_RATES 16

static const option_row rows[] = {
    {"--output", 'o', "DIR", "folder for the files, created where it is missing (required)", false},
    {"--rates", 0, "A,B", "rain rates in mm/h, up to 16: 2 drizzle, 10 shower, 50 storm. Default 5,25,50", false},
    {"--layout", 0, "NAME",
     "kitti-raw or cityscapes: depth, calibration and speed of each picture are found as these data sets have them. "
     "Default: any pictures in any folders",
     false},
    {"--depth", 0, "DIR",
     "depth of the pictures, in a folder with the same names: .npy, .png, .exr or .tif (footage.depth_kind of the "
     "scene says what their values are); for kitti-raw, the folder of the depth set",
     false},
    {"--scene", 0, "SCENE.yaml",
     "camera, weather and what the pictures mean. Default: DIR/scene.yaml, written where it is missing, to be "
     "edited",
     false},
    {"--shard", 0, "I/N", "only every Nth picture, from the Ith on; I counts from 0. For many machines", false},
    {"--min-coverage", 0, "X",
     "streaks that cover less of what is behind them have no box and are not in the mask. 0.001 to 1. Default 0.01",
     false},
    {"--seed", 0, "N", "seed of all that is random. Default: the scene's", false},
    {"--device", 0, "N|cpu|gpu|NAME", "the Vulkan device, see virga info. Default: the best", false},
    {"--set", 0, "KEY=VALUE", "override a key of the scene, e.g. rain.gust_m_s=3. May be repeated", true},
};

#define ROW_COUNT (sizeof rows / sizeof rows[0])

void dataset_help(void)
{
    printf("virga dataset DIR... -o OUT [options]\n\n"
           "Puts rain over all pictures of folders and of those inside (EXR, PNG, JPEG, TIFF), for those\n"
           "who train or test vision systems. Each picture has its own drops and its own wind; it has the same\n"
           "drops at all rates. The same picture, scene and seed give the same files, whatever else is made.\n\n");
    options_print(rows, ROW_COUNT);
    printf("\nFor each rate and picture, e.g. for photos/a/1.jpg at 25 mm/h:\n"
           "  OUT/25mm/rain/a/1.jpg    the picture in rain: format, size and transfer curve as before; 8 bits\n"
           "                           are dithered\n"
           "  OUT/25mm/layer/a/1.exr   rain and haze alone: linear light, premultiplied (rain.RGBA, haze.RGBA)\n"
           "  OUT/25mm/mask/a/1.png    white where a streak is\n"
           "  OUT/25mm/boxes/a/1.json  COCO: a box and an outline of each streak, its drop's number, size and\n"
           "                           distance; visibility in the haze (m), wind, camera\n"
           "  OUT/25mm/coco.json       all of these, when all are there; pictures are in OUT/25mm/rain\n"
           "  OUT/settings.json        what it was made with\n\n"
           "Run it again to go on: a picture with all its files is left out, unless settings, name or size of\n"
           "the photograph or its depth have changed. Files are whole or absent. A picture that cannot be read\n"
           "is named, and the rest is finished.\n\n"
           "Examples:\n"
           "  virga dataset photos -o rainy --rates 5,25 --set camera.fov_deg=45\n"
           "  virga dataset photos -o rainy --depth depths --set footage.depth_scale=0.001\n"
           "  virga dataset kitti --layout kitti-raw --depth kitti_depth -o rainy\n"
           "  virga dataset cityscapes --layout cityscapes -o rainy\n"
           "  sbatch --array=0-15 --requeue --wrap \\\n"
           "      'virga dataset photos -o rainy --shard $SLURM_ARRAY_TASK_ID/16'\n\n"
           "Exit codes: 0 done, 1 failed, 2 wrong command line, scene or folder, 3 pictures that cannot be read\n"
           "are missing, 130 interrupted (what was finished is kept).\n");
}

typedef struct dataset_job {
    options parsed;
    dataset_list list;
    dataset_output out;
    scene_file *scene;
    shot shot;
    shot_options how;
    bool open; /* the shot is */
    double rates[MAX_RATES];
    uint32_t rate_count, shard[2];
    dataset_layout layout;
    const char *directory;
    double wind_m_s[3], gust_m_s; /* of the scene */
    uint32_t unread;
    char error[1024];
} dataset_job;

static bool fail(dataset_job *job)
{
    return options_complain("dataset", "%s", job->error);
}

/* ---- the command line */

static bool read_number(const char *text, char end, double low, double high, double *value, const char **rest)
{
    char *after;
    if (!strchr("0123456789.", *text) || !*text)
        return false;
    *value = strtod(text, &after);
    *rest = *after ? after + 1 : after;
    return (*after == end || !*after) && *value >= low && *value <= high;
}

static bool read_rates(dataset_job *job)
{
    const char *text = options_value(&job->parsed, "--rates"), *rest = text ? text : "5,25,50";
    while (*rest && job->rate_count < MAX_RATES) {
        double *rate = &job->rates[job->rate_count];
        if (!read_number(rest, ',', 0.01, 200, rate, &rest))
            return options_complain("dataset", "--rates: expected numbers from 0.01 to 200 mm/h as in 5,25,50, got %s",
                                    text);
        for (uint32_t i = 0; i < job->rate_count; i++)
            if (job->rates[i] == *rate)
                return options_complain("dataset", "--rates: %g is there twice", *rate);
        job->rate_count++;
    }
    return (job->rate_count && !*rest) ||
           options_complain("dataset", "--rates: expected 1 to %d rates, got '%s'", MAX_RATES, text);
}

static bool read_shard(dataset_job *job)
{
    const char *text = options_value(&job->parsed, "--shard");
    job->shard[1] = 1;
    return options_pair(&job->parsed, "--shard", '/', false, 0, 1000000, job->shard) &&
           (job->shard[0] < job->shard[1] ||
            options_complain("dataset", "--shard: expected I/N with I from 0 to N - 1, got %s", text));
}

static bool read_options(dataset_job *job, int argc, char **argv)
{
    const options *parsed = &job->parsed;
    const char *least, *rest, *layout;
    if (!options_parse(&job->parsed, "dataset", rows, ROW_COUNT, argc, argv))
        return false;
    if (!parsed->argument_count)
        return options_complain("dataset", "expected folders with pictures; see virga help dataset");
    job->directory = options_value(parsed, "--output");
    if (!job->directory)
        return options_complain("dataset", "expected -o DIR, the folder for the files");
    layout = options_value(parsed, "--layout");
    if (!dataset_layout_parse(layout, &job->layout))
        return options_complain("dataset", "--layout: expected kitti-raw or cityscapes, got '%s'", layout);
    if (job->layout == DATASET_CITYSCAPES && options_value(parsed, "--depth"))
        return options_complain("dataset", "--depth: expected none with --layout cityscapes, whose disparity is used");
    least = options_value(parsed, "--min-coverage");
    job->out.min_coverage = 0.01;
    if (least && !read_number(least, 0, 0.001, 1, &job->out.min_coverage, &rest))
        return options_complain("dataset", "--min-coverage: expected a number from 0.001 to 1, got '%s'", least);
    return read_rates(job) && read_shard(job);
}

static bool make_directory(dataset_job *job)
{
    return (file_make_folder(job->directory) && !access(job->directory, W_OK)) ||
           options_complain("dataset", "cannot make the folder %s: %s", job->directory, strerror(errno));
}

/* ---- the scene */

static const char default_scene[] =
    "# Camera and weather of virga dataset. It was written where no --scene was given; change it as you like, and run\n"
    "# the same command again. All keys are in assets/README.md.\n"
    "virga: 1\n"
    "\n"
    "camera:\n"
    "  fov_deg: 40        # height of the picture; better: calibration: {focal_px: [FX, FY]} in pixels\n"
    "  height_m: 1.6\n"
    "  pitch_deg: 0       # looks up\n"
    "  speed_m_s: 0       # of a camera on a car, level and ahead\n"
    "  aperture_mm: 3     # of the lens: drops near to it are soft\n"
    "  focus_m: 10\n"
    "\n"
    "frames: {fps: 30, first: 1, last: 2, shutter_deg: 90, size: [640, 480]} # 1/120 s of light\n"
    "\n"
    "footage:\n"
    "  depth_m: 25        # how far away things are where no depth is known\n"
    "\n"
    "rain:\n"
    "  wind_m_s: [0, 0, 0]\n"
    "  gust_m_s: 1.5      # the wind differs by that from picture to picture\n"
    "  near_fade_m: 0.6   # no drops nearer than that\n"
    "  max_drops: 131072\n"
    "  transition_s: 0\n"
    "  occlusion_size: 0  # nothing keeps rain off\n";

static bool write_scene(dataset_job *job, const char *path)
{
    file_writer file;
    if (!access(path, F_OK))
        return true;
    if (!file_start(&file, path, job->error, sizeof job->error))
        return fail(job);
    file_write(&file, default_scene, sizeof default_scene - 1);
    return file_finish(&file, job->error, sizeof job->error) || fail(job);
}

/* What would be without effect, or wrong, for pictures that have nothing to do with each other. */
static bool check_scene(dataset_job *job)
{
    const scene_file *scene = job->scene;
    const struct {
        const char *key;
        bool is_there;
    } refused[] = {
        {"meshes", scene->mesh_count > 0},
        {"footage.ground", scene->footage.ground != SCENE_FOOTAGE_NO_GROUND},
        {"camera.poses", scene->camera.poses.file},
        {"camera.keys", scene->camera.key_count > 1},
        {"rain.keys", scene_rain_of(scene)->key_count > 0},
    };
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
        if (refused[i].is_there) {
            scene_file_refuse(scene, refused[i].key, job->error, sizeof job->error,
                              "expected none in the scene of virga dataset%s",
                              !strcmp(refused[i].key, "camera.keys") ? ", or one" : "");
            fprintf(stderr, "%s\n", job->error);
            return false;
        }
    return true;
}

static bool load_scene(dataset_job *job)
{
    const char *overrides[258], *given = options_value(&job->parsed, "--scene");
    char seed[64], path[4096];
    uint32_t seed_value = 0;
    size_t count = job->parsed.repeated_count;
    memcpy(overrides, job->parsed.repeated, count * sizeof overrides[0]);
    if (options_value(&job->parsed, "--seed")) {
        if (!options_uint(&job->parsed, "--seed", 0, UINT32_MAX, &seed_value))
            return false;
        snprintf(seed, sizeof seed, "%s=%u", tool_seed_key(), seed_value);
        overrides[count++] = seed;
    }
    snprintf(path, sizeof path, "%s/scene.yaml", job->directory);
    if (!given && !write_scene(job, path))
        return false;
    if (!scene_file_load(given ? given : path, tool_effect_sections, overrides, count, &job->scene, job->error,
                         sizeof job->error)) {
        fprintf(stderr, "%s\n", job->error);
        return false;
    }
    /* The wind of a picture is constant, so that it does not depend on a time. */
    scene_rain *rain = scene_rain_of(job->scene);
    job->out.scene_hash = scene_file_hash(job->scene);
    job->out.scene = job->scene;
    job->out.haze = rain->haze;
    memcpy(job->wind_m_s, rain->wind_m_s, sizeof job->wind_m_s);
    job->gust_m_s = rain->gust_m_s;
    rain->gust_m_s = 0;
    return check_scene(job);
}

static bool list_pictures(dataset_job *job)
{
    const dataset_list_def def = {.folders = job->parsed.arguments,
                                  .folder_count = job->parsed.argument_count,
                                  .output = job->directory,
                                  .depths = options_value(&job->parsed, "--depth"),
                                  .layout = job->layout};
    job->out.directory = job->directory;
    job->out.list = &job->list;
    return dataset_list_open(&job->list, &def, job->error, sizeof job->error) || fail(job);
}

/* What all files were made with, the same for every shard. */
static bool write_settings(dataset_job *job)
{
    const char *layout = options_value(&job->parsed, "--layout"), *scene = options_value(&job->parsed, "--scene");
    char path[4096], hash[32];
    file_writer file;
    json_t *folders = json_array(), *rates = json_array(), *overrides = json_array();
    for (size_t i = 0; i < job->parsed.argument_count; i++)
        json_array_append_new(folders, json_string(job->parsed.arguments[i]));
    for (uint32_t i = 0; i < job->rate_count; i++)
        json_array_append_new(rates, json_real(job->rates[i]));
    for (size_t i = 0; i < job->parsed.repeated_count; i++)
        json_array_append_new(overrides, json_string(job->parsed.repeated[i]));
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)job->out.scene_hash);
    json_t *root =
        json_pack("{s:s,s:o,s:s,s:s,s:s,s:o,s:I,s:o,s:f,s:I}", "version", virga_version(), "folders", folders, "layout",
                  layout ? layout : "folder", "scene", scene ? scene : "scene.yaml", "scene_hash", hash, "set",
                  overrides, "seed", (json_int_t)tool_seed(job->scene), "rates_mm_h", rates, "min_coverage",
                  job->out.min_coverage, "pictures", (json_int_t)job->list.count);
    char *text = root ? json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(9)) : NULL;
    json_decref(root);
    snprintf(path, sizeof path, "%s/settings.json", job->directory);
    bool written = text;
    if (!text)
        options_complain("dataset", "expected folders and keys in UTF-8");
    if (text && (written = file_start(&file, path, job->error, sizeof job->error))) {
        file_write(&file, text, strlen(text));
        file_write(&file, "\n", 1);
        written = file_finish(&file, job->error, sizeof job->error);
    }
    free(text);
    return written || (text && fail(job));
}

/* ---- pictures */

/* SplitMix64 (Steele, Lea and Flood 2014), from the seed and the place of a picture. */
static double random_next(uint64_t *state)
{
    uint64_t x = *state += UINT64_C(0x9e3779b97f4a7c15);
    x = (x ^ x >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ x >> 27) * UINT64_C(0x94d049bb133111eb);
    return (double)((x ^ x >> 31) >> 11) * 0x1p-53;
}

#define FIELD_M 2000.0 /* the camera is within so many metres; floats of drops are 0.1 mm there */

/* Drops follow from seed, position and time, so that another place is other rain. */
static dataset_weather weather_of(const dataset_job *job, const dataset_picture *p)
{
    dataset_weather weather = {.speed_m_s = p->speed_m_s};
    uint64_t state = tool_seed(job->scene);
    const double *speed = job->scene->camera.speed_m_s;
    for (const char *c = p->place; *c; c++)
        state = (state ^ (uint8_t)*c) * UINT64_C(0x100000001b3);
    for (int i = 0; i < 2; i++)
        weather.at_m[i] = FIELD_M * (2 * random_next(&state) - 1);
    /* Box and Muller 1958. */
    const double radius = sqrt(-2 * log(1 - random_next(&state))), turn = 2 * M_PI * random_next(&state);
    memcpy(weather.wind_m_s, job->wind_m_s, sizeof weather.wind_m_s);
    weather.wind_m_s[0] += job->gust_m_s * radius * cos(turn);
    weather.wind_m_s[2] += job->gust_m_s * radius * sin(turn);
    if (isnan(weather.speed_m_s))
        weather.speed_m_s = speed ? *speed : 0;
    return weather;
}

static void set_wind(dataset_job *job, const double wind_m_s[3])
{
    memcpy(scene_rain_of(job->scene)->wind_m_s, wind_m_s, sizeof job->wind_m_s);
}

/* One shot for all pictures of a rate. Each goes on from the state that is kept here. */
static bool open_shot(dataset_job *job, const dataset_picture *p, uint32_t width, uint32_t height)
{
    const uint32_t first = job->scene->frames.first;
    set_wind(job, job->wind_m_s);
    job->how = (shot_options){.device = options_value(&job->parsed, "--device"),
                              .width = width,
                              .height = height,
                              .samples = 1,
                              .draw = true,
                              .points = true,
                              .plate = p->path,
                              .stills = true,
                              .frames = {first, first + 1}};
    job->open = shot_open(&job->shot, job->scene, &job->how, job->error, sizeof job->error);
    return job->open && shot_step(&job->shot, first, job->error, sizeof job->error) &&
           checkpoint_keep(&job->shot, job->error, sizeof job->error);
}

static bool draw_picture(dataset_job *job, uint32_t index, picture *decoded, const dataset_weather *weather)
{
    const dataset_picture *p = &job->list.pictures[index];
    const uint32_t frame = job->scene->frames.first + 1;
    const picture_format format = decoded->format;
    host_camera camera;
    shot *s = &job->shot;
    char *error = job->error;
    const size_t size = sizeof job->error;
    shot_still still = {.picture = p->path,
                        .depth = p->depth,
                        .decoded = decoded,
                        .depth_def = p->depth_def,
                        .has_depth_def = p->has_depth_def,
                        .fills_depth = p->fills_depth,
                        .at_m = {weather->at_m[0], weather->at_m[1]},
                        .right_m = p->right_m,
                        .speed_m_s = weather->speed_m_s};
    if (p->calibration.focal_px[0] > 0) {
        host_camera_calibration *to = &still.calibration;
        to->size_px[0] = p->calibration.size_px[0] ? p->calibration.size_px[0] : decoded->width;
        to->size_px[1] = p->calibration.size_px[1] ? p->calibration.size_px[1] : decoded->height;
        for (int axis = 0; axis < 2; axis++) {
            to->focal_px[axis] = p->calibration.focal_px[axis];
            to->center_px[axis] = p->calibration.center_px[axis] + 0.5;
        }
    }
    set_wind(job, job->wind_m_s);
    if (!shot_show(s, &still, frame, error, size) || !checkpoint_return(s, error, size))
        return false;
    set_wind(job, weather->wind_m_s);
    return shot_draw(s, frame, &camera, error, size) &&
           dataset_write(&job->out, s, &camera, frame, index, format, weather, error, size);
}

/* A picture whose own fault it is, is named and left out. False: nothing more can be made. */
static bool make_picture(dataset_job *job, uint32_t index)
{
    const dataset_picture *p = &job->list.pictures[index];
    const dataset_weather weather = weather_of(job, p);
    picture decoded;
    bool read = picture_read(p->path, &decoded, job->error, sizeof job->error), input_wrong = !read;
    if (read) {
        job->shot.input_wrong = false;
        const bool opened = job->open || open_shot(job, p, decoded.width, decoded.height);
        read = opened && draw_picture(job, index, &decoded, &weather);
        input_wrong = opened && job->shot.input_wrong;
        free(decoded.rgb);
    }
    if (!read && input_wrong) {
        job->unread++;
        return options_complain("dataset", "left out: %s", job->error) || true;
    }
    return read;
}

static uint32_t count_all(const dataset_job *job)
{
    const uint32_t count = job->list.count, own = count > job->shard[0] ? count - job->shard[0] : 0;
    return (own + job->shard[1] - 1) / job->shard[1];
}

static int make_rate(dataset_job *job, progress *bar)
{
    int code = EXIT_OK;
    for (uint32_t i = job->shard[0]; i < job->list.count && code == EXIT_OK; i += job->shard[1]) {
        if (interrupt_requested()) {
            code = EXIT_INTERRUPTED;
        } else if (dataset_is_done(&job->out, i)) {
            progress_step(bar, "(there already)");
        } else if (make_picture(job, i)) {
            progress_step(bar, NULL);
        } else {
            code = job->shot.input_wrong && !job->open ? EXIT_USAGE : EXIT_FAILED;
        }
    }
    if (job->open)
        shot_close(&job->shot);
    job->open = false;
    return code;
}

static int make_all(dataset_job *job)
{
    progress bar;
    int code = EXIT_OK;
    fprintf(stderr, "%u pictures, %u rate%s\n", count_all(job), job->rate_count, job->rate_count == 1 ? "" : "s");
    progress_begin(&bar, "picture", count_all(job) * job->rate_count);
    for (uint32_t i = 0; i < job->rate_count && code == EXIT_OK; i++) {
        job->out.rate_mm_h = scene_rain_of(job->scene)->rate_mm_h = job->rates[i];
        code = make_rate(job, &bar);
        if (code == EXIT_OK && !dataset_join(&job->out, job->error, sizeof job->error))
            code = EXIT_FAILED;
    }
    progress_end(&bar);
    if (code == EXIT_INTERRUPTED)
        options_complain("dataset", "interrupted: the same command goes on");
    else if (code != EXIT_OK)
        fail(job);
    else if (job->unread)
        options_complain("dataset", "%u pictures that cannot be read are missing, so there is no coco.json of them",
                         job->unread);
    return code == EXIT_OK && job->unread ? EXIT_GAVE_UP : code;
}

int dataset_run(int argc, char **argv)
{
    dataset_job *job = calloc(1, sizeof *job);
    if (!job)
        return EXIT_FAILED;
    int code = EXIT_USAGE;
    if (read_options(job, argc, argv) && make_directory(job) && load_scene(job) && list_pictures(job) &&
        write_settings(job))
        code = make_all(job);
    dataset_list_close(&job->list);
    scene_file_free(job->scene);
    free(job);
    return code;
}
