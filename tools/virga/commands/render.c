/* render.c - `virga render`: a scene's frames to disk. Reads the command line, and makes the film. */
#include "commands/render_job.h"
#include "effect.h"
#include "file.h"
#include "frame/claims.h"
#include "frame/files.h"
#include "frame/layers.h"
#include "frame/resume.h"
#include "shot/plate.h"
#include "volume.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const option_row rows[] = {
    {"--output", 'o', "DIR", "folder for the files, created where it is missing (required)", false},
    {"--frames", 0, "A-B",
     "frames to render. Frames before A are simulated, but not drawn. After the scene's last frame, camera and "
     "weather stay at their last keys. The scene's frames.preroll_s are simulated before its first frame. "
     "Default: the scene's frames",
     false},
    {"--size", 0, "WxH|plate", "picture size in pixels, or that of the plate. Default: the scene's", false},
    {"--samples", 0, "N",
     "jittered sub-frames over the shutter time, averaged: anti-aliasing and true motion blur. "
     "Default 1; 16 for film",
     false},
    {"--layers", 0, "A,B",
     "layers of the frames, see below. Frames of only depth, velocity, normal, id and wetness are quicker, most of all "
     "those of depth alone. Default: all that the scene has",
     false},
    {"--water-velocity", 0, "PERCENT",
     "velocity.X/Y are those of the water where it covers at least this share of a pixel, 1 to 100. Default: those "
     "of the plate everywhere",
     false},
    {"--points", 0, NULL, "also write point caches, see below", false},
    {"--meshes", 0, NULL, "also write triangle meshes, see below", false},
    {"--volumes", 0, NULL, "also write volumes, see below", false},
    {"--stats", 0, NULL, "also write stats.jsonl, one object per frame: counts, water, milliseconds", false},
    {"--preview", 0, NULL, "also write preview.%04d.png and, where ffmpeg is installed, preview.mp4", false},
    {"--plate", 0, "PATTERN",
     "footage that replaces the drawn scene: EXR, PNG, JPEG or TIFF pictures numbered by frame, as plate.%04d.exr, a "
     "folder with one picture per frame of the scene, sorted by name, one picture for all frames, or a video (MOV, "
     "MP4, "
     "MKV, AVI, MXF, WebM). Any size. footage.curve of the scene is their transfer curve",
     false},
    {"--depth", 0, "PATTERN",
     "depth of the plate, so that rain falls before and behind what it shows: EXR (channel Z), PNG of 16 bits, TIFF or "
     "NumPy (.npy), named as --plate is. footage.depth_kind of the scene says what its values are. Default: the "
     "distance footage.depth_m, or all rain is before the plate",
     false},
    {"--ground-mask", 0, "PATTERN",
     "what of the plate is ground, for footage.ground of the scene: pictures, white where it is, named as --plate is. "
     "Default: all that lies on the ground's plane or has a depth",
     false},
    {"--picture", 0, "KIND",
     "also write the beauty as picture.%04d.png, .jpg or .tif, with that curve. KIND is same (as the plate), png, "
     "png16, jpg, tif, tif16, tif32 or none. 8 bits are dithered. Default: same, where there is a plate that is no EXR",
     false},
    {"--resume", 0, NULL,
     "render only the frames that are missing. A folder is refused where its frames have another scene, seed, "
     "size, samples, layers, velocities, plate, depth or mask",
     false},
    {"--checkpoint-every", 0, "N",
     "also save the simulation after every N frames, and after the pre-roll: DIR/checkpoint.%04d.virga. A later "
     "render of the same scene into the folder starts from the nearest one, and gives the same bytes",
     false},
    {"--simulate", 0, NULL, "only simulate, and write checkpoints (with --checkpoint-every); nothing is drawn", false},
    {"--claim", 0, "TASK",
     "for tasks that draw into one folder at the same time, see virga help farm: like --resume, but a frame that "
     "another task is drawing is left to it, and one that has failed three times is left out. TASK is a name, under "
     "which statistics go to DIR/farm/stats.TASK.jsonl",
     false},
    {"--jobs", 0, "N",
     "processes that draw frames at the same time, 1 to 64: the same files, in less time but with N times the memory. "
     "Default on software Vulkan, for more than a few small frames: as many as there are processors, 8 at most, where "
     "memory is free for them; else 1",
     false},
    {"--seed", 0, "N", "seed of all that is random. Default: the scene's", false},
    {"--device", 0, "N|cpu|gpu|NAME", "the Vulkan device, see virga info. Default: the best", false},
    {"--set", 0, "KEY=VALUE", "override a key of the scene, e.g. rain.rate_mm_h=50. May be repeated", true},
};

#define ROW_COUNT (sizeof rows / sizeof rows[0])

void render_help(void)
{
    printf("virga render SCENE.yaml -o DIR [options]\n\n"
           "Renders a scene to DIR/frame.%%04d.exr: the beauty, and the layers that it is made of.\n"
           "The same scene, seed and frame give the same file, however many frames are rendered before it.\n\n");
    options_print(rows, ROW_COUNT);
    printf("\nLayers, and their channels:\n");
    frame_layers_help();
    printf("\nPoint caches, with --points:\n");
    frame_points_help();
    printf("\nTriangle meshes, with --meshes:\n");
    frame_meshes_help();
    printf("\nVolumes, with --volumes%s:\n", volume_is_there() ? "" : " (this program was built without OpenVDB)");
    frame_volumes_help();
    printf("\nExamples:\n"
           "  virga render assets/scenes/street.yaml -o out --frames 1 --size 640x360 --preview\n"
           "  virga render assets/scenes/storm.yaml -o out --samples 16 --points --stats\n"
           "  virga render assets/scenes/street.yaml -o out --set rain.rate_mm_h=80 \\\n"
           "      --set 'rain.wind_m_s=[6, 0, 0]'\n"
           "  virga render assets/scenes/window.yaml -o out --set frames.preroll_s=60\n"
           "  virga render assets/scenes/windshield.yaml -o out --plate footage/drive.%%04d.exr \\\n"
           "      --layers glass,refraction\n\n"
           "Ctrl-C finishes the current frame; `--resume` continues later. Exit codes: 0 done, 1 failed (disk\n"
           "full, device lost; finished frames are kept), 2 wrong command line or scene, or a file that it\n"
           "names, 3 (--claim) frames that failed three times are missing, 130 interrupted.\n");
}

/* Each process reads the scene. */
static bool read_jobs(render_job *job)
{
    struct stat info;
    const char *path = job->parsed.arguments[0];
    if (!options_uint(&job->parsed, "--jobs", 1, WORKERS_MAX, &job->jobs))
        return false;
    if (job->jobs && (job->task || job->simulate))
        return options_complain("render", "--jobs: expected no %s with it", job->task ? "--claim" : "--simulate");
    const bool once = !stat(path, &info) && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
    if (once && job->jobs > 1)
        return options_complain("render", "--jobs: expected a scene in a file, as each process reads it; got %s", path);
    if (once)
        job->jobs = 1;
    return true;
}

static bool read_options(render_job *job, int argc, char **argv)
{
    if (!options_parse(&job->parsed, "render", rows, ROW_COUNT, argc, argv))
        return false;
    if (job->parsed.argument_count != 1)
        return options_complain("render", "expected one scene file, got %zu; see virga help render",
                                job->parsed.argument_count);
    job->directory = options_value(&job->parsed, "--output");
    if (!job->directory)
        return options_complain("render", "expected -o DIR, the folder for the files");
    job->points = options_value(&job->parsed, "--points");
    job->meshes = options_value(&job->parsed, "--meshes");
    job->volumes = options_value(&job->parsed, "--volumes");
    if (job->volumes && !volume_is_there())
        return options_complain("render", "--volumes: this program was built without OpenVDB");
    job->stats = options_value(&job->parsed, "--stats");
    job->preview = options_value(&job->parsed, "--preview");
    job->task = options_value(&job->parsed, "--claim");
    if (job->task && (!job->task[0] || strchr(job->task, '/')))
        return options_complain("render", "--claim: expected a name without '/', got '%s'", job->task);
    job->resume = options_value(&job->parsed, "--resume") || job->task;
    job->simulate = options_value(&job->parsed, "--simulate");
    if (job->simulate && !options_value(&job->parsed, "--checkpoint-every"))
        return options_complain("render",
                                "--simulate: expected --checkpoint-every with it, as nothing else is written");
    if (job->simulate && (job->points || job->meshes || job->volumes || job->stats || job->preview))
        return options_complain("render",
                                "--simulate: expected no --points, --meshes, --volumes, --stats or --preview with it");
    return read_jobs(job) && frame_layers_parse(options_value(&job->parsed, "--layers"), &job->layers);
}

/* Loads the scene with what the command line overrides. --seed is one more override, so it is in the hash. */
static bool load_scene(render_job *job)
{
    const char *overrides[258];
    char seed[64];
    uint32_t seed_value = 0;
    size_t count = job->parsed.repeated_count;
    memcpy(overrides, job->parsed.repeated, count * sizeof overrides[0]);
    if (options_value(&job->parsed, "--seed")) {
        if (!options_uint(&job->parsed, "--seed", 0, UINT32_MAX, &seed_value))
            return false;
        snprintf(seed, sizeof seed, "%s=%u", tool_seed_key(), seed_value);
        overrides[count++] = seed;
    }
    if (!scene_file_load(job->parsed.arguments[0], tool_effect_sections, overrides, count, &job->scene, job->error,
                         sizeof job->error)) {
        fprintf(stderr, "%s\n", job->error);
        return false;
    }
    return frame_layers_narrow(job->scene, &job->layers);
}

static bool fail(render_job *job)
{
    return options_complain("render", "%s", job->error);
}

/* The plate, and what follows from it: the pictures' size and format. */
static bool read_plate(render_job *job, uint32_t size[2])
{
    picture_format format;
    uint32_t plate_size[2];
    const char *plate = options_value(&job->parsed, "--plate"), *word = options_value(&job->parsed, "--size");
    const bool of_plate = word && !strcmp(word, "plate");
    job->how.plate = plate;
    job->how.depth = options_value(&job->parsed, "--depth");
    job->how.ground_mask = options_value(&job->parsed, "--ground-mask");
    if (job->how.depth && !plate)
        return options_complain("render", "--depth: expected a --plate");
    if (job->how.ground_mask && !plate)
        return options_complain("render", "--ground-mask: expected a --plate");
    if (of_plate && !plate)
        return options_complain("render", "--size plate: expected a --plate");
    if (!of_plate && !options_pair(&job->parsed, "--size", 'x', false, 1, 16384, size))
        return false;
    if (plate &&
        !plate_peek(plate, job->scene->frames.first, job->frames, &format, plate_size, job->error, sizeof job->error))
        return fail(job);
    if (plate)
        memcpy(job->scene->footage.plate_px, plate_size, sizeof plate_size);
    if (of_plate)
        memcpy(size, plate_size, sizeof plate_size);
    return frame_picture_parse(options_value(&job->parsed, "--picture"), plate ? &format : NULL, &job->picture);
}

static bool read_ranges(render_job *job)
{
    const scene_frames *frames = &job->scene->frames;
    uint32_t size[2] = {frames->size[0], frames->size[1]};
    job->frames[0] = frames->first;
    job->frames[1] = frames->last;
    job->how.samples = 1;
    if (!options_pair(&job->parsed, "--frames", '-', true, frames->first, 999999, job->frames) ||
        !read_plate(job, size) || !options_uint(&job->parsed, "--samples", 1, 4096, &job->how.samples) ||
        !options_uint(&job->parsed, "--water-velocity", 1, 100, &job->how.water_velocity) ||
        !options_uint(&job->parsed, "--checkpoint-every", 1, 999999, &job->how.checkpoint_every))
        return false;
    if (job->frames[1] < job->frames[0])
        return options_complain("render", "--frames: expected A-B with A before B, got %u-%u", job->frames[0],
                                job->frames[1]);
    job->how.width = size[0];
    job->how.height = size[1];
    job->how.draw = !job->simulate;
    if (!job->preview && !job->picture.bits && !job->how.water_velocity)
        job->how.parts = frame_layers_parts(job->layers);
    job->how.checkpoints = job->directory;
    job->how.points = job->points;
    job->how.stats = job->stats;
    memcpy(job->how.frames, job->frames, sizeof job->frames);
    job->how.device = options_value(&job->parsed, "--device");
    return true;
}

/* A folder that can not exist is a wrong command line. A full disk is not. */
static int make_directory(render_job *job)
{
    struct stat about = {0};
    if (!file_make_folder(job->directory)) {
        const int code = errno == ENOSPC || errno == EDQUOT || errno == EIO ? EXIT_FAILED : EXIT_USAGE;
        options_complain("render", "cannot make the folder %s: %s", job->directory, strerror(errno));
        return code;
    }
    if (!stat(job->directory, &about) && S_ISDIR(about.st_mode) && !access(job->directory, W_OK))
        return EXIT_OK;
    if (S_ISDIR(about.st_mode))
        options_complain("render", "cannot write into %s: %s", job->directory, strerror(errno));
    else
        options_complain("render", "%s is not a folder", job->directory);
    return EXIT_USAGE;
}

static resume_request request_of(const render_job *job)
{
    return (resume_request){.scene = job->scene,
                            .directory = job->directory,
                            .first = job->frames[0],
                            .last = job->frames[1],
                            .width = job->how.width,
                            .height = job->how.height,
                            .samples = job->how.samples,
                            .layers = job->layers,
                            .plate = job->how.plate,
                            .depth = job->how.depth,
                            .ground_mask = job->how.ground_mask,
                            .water_velocity = job->how.water_velocity,
                            .picture = job->picture,
                            .points = job->points,
                            .meshes = job->meshes,
                            .volumes = job->volumes,
                            .preview = job->preview,
                            .stats = job->stats};
}

/* ---- the film */

/* In the folder, as ffmpeg would take a '%' in the folder's name for a number. */
static void run_ffmpeg(const render_job *job, const char *output)
{
    char fps[32], first[32], count[32];
    snprintf(fps, sizeof fps, "%g", job->scene->frames.fps);
    snprintf(first, sizeof first, "%u", job->frames[0]);
    snprintf(count, sizeof count, "%u", job->frames[1] - job->frames[0] + 1);
    if (chdir(job->directory))
        _exit(126);
    execlp("ffmpeg", "ffmpeg", "-loglevel", "error", "-y", "-nostdin", "-framerate", fps, "-start_number", first, "-i",
           "preview.%04d.png", "-frames:v", count, "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p",
           "-crf", "16", "-f", "mp4", output, (char *)NULL);
    _exit(127);
}

static int wait_for(pid_t child)
{
    int status = -1;
    while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR)
        ;
    return status;
}

/* The previews as a film, where ffmpeg is installed. A film that can not be made is said, but is no failure. */
static void make_film(render_job *job)
{
    char path[4096];
    file_writer film;
    snprintf(path, sizeof path, "%s/preview.mp4", job->directory);
    if (!file_start(&film, path, job->error, sizeof job->error)) {
        fail(job);
        return;
    }
    const char *written_to = film.temporary ? film.temporary : film.path, *slash = strrchr(written_to, '/');
    const pid_t child = fork();
    if (child == 0)
        run_ffmpeg(job, slash ? slash + 1 : written_to);
    const int status = wait_for(child);
    if (status == 0 && !file_finish(&film, job->error, sizeof job->error))
        fail(job);
    if (status == 0)
        return;
    file_abandon(&film);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        fprintf(stderr, "no ffmpeg: previews stay single pictures\n");
    else
        fprintf(stderr, "ffmpeg could not make %s\n", path);
}

/* ---- the command */

/* What can be known to be wrong is said before a device is opened, and nothing is overwritten before all is loaded. */
static int render_scene(render_job *job)
{
    const resume_request request = request_of(job);
    if (render_is_worker(job))
        return render_as_worker(job);
    int code = make_directory(job);
    if (code != EXIT_OK)
        return code;
    if (job->task && !claims_open(job->directory, job->error, sizeof job->error))
        return render_stop_early(job, EXIT_FAILED);
    if (job->resume && !resume_find(&request, &job->there, job->error, sizeof job->error))
        return render_stop_early(job, EXIT_USAGE);
    if (job->resume && !job->task && !resume_trim_stats(&request, job->there, job->error, sizeof job->error))
        return render_stop_early(job, EXIT_FAILED);
    const uint32_t jobs = render_choose_jobs(job);
    code = jobs > 1 ? render_by_workers(job, jobs) : render_here(job);
    if (code == EXIT_OK && job->preview && !job->task && job->frames[1] > job->frames[0])
        make_film(job);
    return code;
}

int render_run(int argc, char **argv)
{
    render_job *job = calloc(1, sizeof *job);
    if (!job)
        return EXIT_FAILED;
    int code = EXIT_USAGE;
    job->argument_count = argc;
    job->arguments = argv;
    job->worker = workers_join(&job->workers);
    if (read_options(job, argc, argv) && load_scene(job) && read_ranges(job))
        code = render_scene(job);
    if (job->stats_open)
        jsonl_close(&job->stats_file);
    workers_close(&job->workers);
    free(job->there);
    scene_file_free(job->scene);
    free(job);
    return code;
}
