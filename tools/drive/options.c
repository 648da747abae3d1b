/* options.c - the command line. */
#include "game.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool complain(const char *what, const char *expected)
{
    fprintf(stderr, "drive: %s: expected %s\n", what, expected);
    return false;
}

static bool number(const char *text, double low, double high, double *value)
{
    char *end;
    *value = strtod(text, &end);
    return end != text && !*end && *value >= low && *value <= high;
}

static bool parse_wipers(drive *d, const char *name)
{
    for (d->wiper_speed = 0; d->wiper_speed < WIPER_SPEEDS; d->wiper_speed++)
        if (strcmp(name, wiper_names[d->wiper_speed]) == 0)
            return true;
    return complain("--wipers", "off, intermittent, slow or fast");
}

static bool parse_quality(drive *d, const char *name)
{
    d->chosen.has_quality = true;
    for (int quality = VIRGA_QUALITY_LOW; quality <= VIRGA_QUALITY_FILM; quality++)
        if (strcmp(name, virga_quality_name((virga_quality)quality)) == 0) {
            d->quality = (virga_quality)quality;
            return true;
        }
    return complain("--quality", "low, medium, high or film");
}

static bool parse_option(drive *d, int option, const char *value)
{
    double n = 0, m = 0;
    char *x = value ? strchr(value, 'x') : NULL;
    switch (option) {
    case 't': d->chosen.track = value; return true;
    case 'd': d->chosen.device = value; return true;
    case 'o': d->chosen.out = value; return true;
    case 'p': d->chosen.pipelines = value; return true;
    case 'O': d->outside = true; return true;
    case 'F': d->focused = true; return true;
    case 'R': d->chosen.real_time = true; return true;
    case 'w': return parse_wipers(d, value);
    case 'q': return parse_quality(d, value);
    case 'b':
        d->budget_ms = number(value, 0, 1000, &n) ? (float)n : -1;
        return d->budget_ms >= 0 || complain("--budget", "0 to 1000 ms");
    case 'r':
        d->rate_mm_h = number(value, 0, 200, &n) ? (float)n : -1;
        return d->rate_mm_h >= 0 || complain("--rain", "0 to 200 mm/h");
    case 's': return number(value, 0, 1e5, &d->chosen.start_m) || complain("--start", "0 to 100000 metres");
    case 'n':
        d->chosen.frames = number(value, 1, 1e6, &n) ? (uint32_t)n : 0;
        return d->chosen.frames || complain("--frames", "1 to 1000000");
    case 'f':
        d->chosen.fps = number(value, 10, 1000, &n) ? (uint32_t)n : 0;
        return d->chosen.fps || complain("--fps", "10 to 1000");
    case 'S':
        if (x && number(x + 1, 16, 8192, &m)) {
            *x = 0;
            if (number(value, 16, 8192, &n)) {
                d->chosen.width = (uint32_t)n;
                d->chosen.height = (uint32_t)m;
                return true;
            }
        }
        return complain("--size", "WxH, 16 to 8192 pixels a side");
    default: return false; /* getopt has printed the error */
    }
}

bool read_command_line(drive *d, int argc, char **argv)
{
    static const struct option options[] = {
        {"track", required_argument, NULL, 't'},   {"device", required_argument, NULL, 'd'},
        {"out", required_argument, NULL, 'o'},     {"pipelines", required_argument, NULL, 'p'},
        {"outside", no_argument, NULL, 'O'},       {"focus", no_argument, NULL, 'F'},
        {"wipers", required_argument, NULL, 'w'},  {"rain", required_argument, NULL, 'r'},
        {"start", required_argument, NULL, 's'},   {"frames", required_argument, NULL, 'n'},
        {"fps", required_argument, NULL, 'f'},     {"size", required_argument, NULL, 'S'},
        {"quality", required_argument, NULL, 'q'}, {"budget", required_argument, NULL, 'b'},
        {"real-time", no_argument, NULL, 'R'},     {0}};
    static char track_path[4096];
    d->chosen = (choices){.model = DRIVE_ASSETS "/scenes/street.glb", .fps = 30, .width = 1280, .height = 720};
    d->rate_mm_h = 30;
    d->budget_ms = -1;
    d->wiper_speed = SLOW;
    for (int option; (option = getopt_long(argc, argv, "", options, NULL)) != -1;)
        if (!parse_option(d, option, optarg))
            return false;
    if (argc - optind > 1)
        return complain(argv[optind + 1], "one model");
    if (argc > optind)
        d->chosen.model = argv[optind];
    if (d->chosen.out && !d->chosen.frames)
        return complain("--out", "--frames N with it");
    if (d->budget_ms < 0) /* files are the same whenever they are made */
        d->budget_ms = d->chosen.out && !d->chosen.real_time ? 0 : 8;
    if (!d->chosen.track) { /* the model's name, among our scenes */
        const char *name = strrchr(d->chosen.model, '/') ? strrchr(d->chosen.model, '/') + 1 : d->chosen.model;
        snprintf(track_path, sizeof track_path, "%s/scenes/%.*s.track", DRIVE_ASSETS, (int)strcspn(name, "."), name);
        d->chosen.track = track_path;
    }
    return true;
}

void print_help(void)
{
    printf("drive [MODEL.glb] [options]: a car in the rain, in our own street or in another model\n\n"
           "      --track FILE         where it drives. Default: assets/scenes/MODEL.track\n"
           "      --start M            how far along it begins\n"
           "      --outside            seen from outside\n"
           "      --focus              on the windshield: the street is soft. Default: all is sharp\n"
           "      --rain MM_H          0 to 200. Default 30\n"
           "      --wipers SPEED       off, intermittent, slow or fast. Default slow\n"
           "      --frames N           ends after so many\n"
           "      --out FILE.png       the last of them as a picture, and no window\n"
           "      --fps N              frames a second of --out. Default 30\n"
           "      --real-time          with --out: a frame has the time that the one before took, as in a window\n"
           "      --size WxH           Default 1280x720\n"
           "      --quality NAME       low, medium, high or film. Default by the kind of device\n"
           "      --budget MS          device time for ticks in a frame. 0: no limit. Default 8, and 0 with --out\n"
           "      --device N|gpu|cpu|NAME\n"
           "      --pipelines FILE     keeps compiled pipelines for the next start\n\n"
           "Keys: C camera, F focus, W wipers, arrows drive (A: it drives itself again), + and - rain, Esc ends.\n");
}
