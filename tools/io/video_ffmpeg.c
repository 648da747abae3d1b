/* video_ffmpeg.c - video through FFmpeg's libraries: the module that video.c loads.
 *
 * The times of all packets are read first. In rising order they are the frames as they are shown. A frame is reached
 * from the last packet at or before its time that decoding can begin with. */
#include "video_table.h"

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct stream {
    AVFormatContext *file;
    AVCodecContext *decoder;
    AVPacket *packet;
    AVFrame *frame;
    struct SwsContext *scaler;
    int index;
    int64_t *times, *keys; /* of frames, rising; of those that decoding can begin with */
    uint32_t count, key_count;
    size_t room;
    int64_t at; /* time of the newest decoded frame; INT64_MIN: none since the newest seek */
    bool ended; /* the decoder was told that nothing follows */
} stream;

static bool refuse(char *reason, size_t size, const char *what, int code)
{
    char text[128] = "";
    if (code)
        av_strerror(code, text, sizeof text);
    snprintf(reason, size, "%s%s%s", what, code ? ": " : "", text);
    return false;
}

/* ---- opening */

static bool open_decoder(stream *s, const char *path, char *reason, size_t size)
{
    const AVCodec *codec = NULL;
    int code = avformat_open_input(&s->file, path, NULL, NULL);
    if (code < 0)
        return refuse(reason, size, "not a video", code);
    if ((code = avformat_find_stream_info(s->file, NULL)) < 0)
        return refuse(reason, size, "not a video", code);
    s->index = av_find_best_stream(s->file, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (s->index < 0)
        return refuse(reason, size, "no picture in it that FFmpeg can decode", 0);
    for (unsigned i = 0; i < s->file->nb_streams; i++)
        s->file->streams[i]->discard = (int)i == s->index ? AVDISCARD_DEFAULT : AVDISCARD_ALL;
    s->decoder = avcodec_alloc_context3(codec);
    s->packet = av_packet_alloc();
    s->frame = av_frame_alloc();
    if (!s->decoder || !s->packet || !s->frame)
        return refuse(reason, size, "no memory", 0);
    code = avcodec_parameters_to_context(s->decoder, s->file->streams[s->index]->codecpar);
    s->decoder->pkt_timebase = s->file->streams[s->index]->time_base;
    if (code >= 0)
        code = avcodec_open2(s->decoder, codec, NULL);
    return code >= 0 || refuse(reason, size, "cannot be decoded", code);
}

static int64_t time_of(const AVPacket *packet)
{
    return packet->pts != AV_NOPTS_VALUE ? packet->pts : packet->dts;
}

static bool add_time(stream *s, const AVPacket *packet)
{
    if (s->count == s->room) {
        const size_t room = s->room ? 2 * s->room : 1024;
        int64_t *times = realloc(s->times, room * sizeof *times);
        if (times)
            s->times = times;
        int64_t *keys = times ? realloc(s->keys, room * sizeof *keys) : NULL;
        if (!keys)
            return false;
        s->keys = keys;
        s->room = room;
    }
    s->times[s->count++] = time_of(packet);
    if (packet->flags & AV_PKT_FLAG_KEY)
        s->keys[s->key_count++] = time_of(packet);
    return true;
}

static int by_time(const void *a, const void *b)
{
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return (x > y) - (x < y);
}

/* Packets that an edit list leaves out are no frames. */
static bool find_frames(stream *s, char *reason, size_t size)
{
    int code;
    while ((code = av_read_frame(s->file, s->packet)) >= 0) {
        const bool counts = s->packet->stream_index == s->index && !(s->packet->flags & AV_PKT_FLAG_DISCARD) &&
                            time_of(s->packet) != AV_NOPTS_VALUE;
        const bool added = !counts || add_time(s, s->packet);
        av_packet_unref(s->packet);
        if (!added || s->count == UINT32_MAX / 2)
            return refuse(reason, size, "no memory", 0);
    }
    if (code != AVERROR_EOF)
        return refuse(reason, size, "it is damaged", code);
    if (!s->count || !s->key_count)
        return refuse(reason, size, "no frames in it", 0);
    qsort(s->times, s->count, sizeof *s->times, by_time);
    qsort(s->keys, s->key_count, sizeof *s->keys, by_time);
    return true;
}

static void close_stream(void *user)
{
    stream *s = user;
    sws_freeContext(s->scaler);
    av_frame_free(&s->frame);
    av_packet_free(&s->packet);
    avcodec_free_context(&s->decoder);
    avformat_close_input(&s->file);
    free(s->times);
    free(s->keys);
    free(s);
}

/* ---- finding a frame */

static int64_t key_before(const stream *s, int64_t time)
{
    uint32_t low = 0, high = s->key_count;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if (s->keys[middle] <= time)
            low = middle;
        else
            high = middle;
    }
    return s->keys[low];
}

static bool seek(stream *s, int64_t time, char *reason, size_t size)
{
    const int64_t key = key_before(s, time);
    const bool goes_on = s->at != INT64_MIN && s->at < time && s->at >= key;
    if (goes_on)
        return true;
    const int code = avformat_seek_file(s->file, s->index, INT64_MIN, key, key, 0);
    avcodec_flush_buffers(s->decoder);
    s->at = INT64_MIN;
    s->ended = false;
    return code >= 0 || refuse(reason, size, "cannot go to it", code);
}

/* The decoder's next frame into s->frame. */
static int decode_next(stream *s)
{
    for (;;) {
        int code = avcodec_receive_frame(s->decoder, s->frame);
        if (code != AVERROR(EAGAIN))
            return code;
        if (s->ended)
            return AVERROR_EOF;
        code = av_read_frame(s->file, s->packet);
        if (code == AVERROR_EOF) {
            s->ended = true;
            code = avcodec_send_packet(s->decoder, NULL);
        } else if (code >= 0 && s->packet->stream_index == s->index) {
            code = avcodec_send_packet(s->decoder, s->packet);
        }
        av_packet_unref(s->packet);
        if (code < 0)
            return code;
    }
}

static bool find(stream *s, int64_t time, char *reason, size_t size)
{
    if (!seek(s, time, reason, size))
        return false;
    for (;;) {
        const int code = decode_next(s);
        if (code < 0) {
            s->at = INT64_MIN;
            return refuse(reason, size, "it is damaged", code);
        }
        s->at = s->frame->best_effort_timestamp;
        if (s->at == time)
            return true;
        if (s->at > time) {
            s->at = INT64_MIN;
            return refuse(reason, size, "it is damaged: another frame is in its place", 0);
        }
    }
}

/* ---- codes */

/* RGB of any depth, packed or planar: each sample over the largest. */
static bool copy_rgb(const AVFrame *f, const AVPixFmtDescriptor *format, picture *p)
{
    uint16_t *line = malloc((size_t)f->width * sizeof *line);
    for (int c = 0; line && c < 3; c++)
        for (int y = 0; y < f->height; y++) {
            const float largest = (float)((1 << format->comp[c].depth) - 1);
            av_read_image_line(line, (const uint8_t **)(uintptr_t)f->data, f->linesize, format, 0, y, c, f->width, 0);
            for (int x = 0; x < f->width; x++)
                p->rgb[3 * ((size_t)y * (size_t)f->width + (size_t)x) + (size_t)c] = (float)line[x] / largest;
        }
    free(line);
    return line;
}

/* Which of FFmpeg's matrices, and whether black is 0. */
static bool set_matrix(struct SwsContext *scaler, const AVFrame *f)
{
    const int matrix = f->colorspace != AVCOL_SPC_UNSPECIFIED ? (int)f->colorspace
                       : f->height >= 720                     ? SWS_CS_ITU709
                                                              : SWS_CS_ITU601;
    const int full = f->color_range == AVCOL_RANGE_JPEG;
    return sws_setColorspaceDetails(scaler, sws_getCoefficients(matrix), full, sws_getCoefficients(SWS_CS_DEFAULT), 1,
                                    0, 1 << 16, 1 << 16) >= 0;
}

static bool convert(stream *s, const AVFrame *f, picture *p)
{
    const int flags = SWS_BICUBIC | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT | SWS_FULL_CHR_H_INP | SWS_BITEXACT;
    s->scaler = sws_getCachedContext(s->scaler, f->width, f->height, (enum AVPixelFormat)f->format, f->width, f->height,
                                     AV_PIX_FMT_RGB48, flags, NULL, NULL, NULL);
    const size_t values = 3 * (size_t)f->width * (size_t)f->height;
    uint16_t *codes = s->scaler && set_matrix(s->scaler, f) ? malloc(values * sizeof *codes) : NULL;
    uint8_t *const to[4] = {(uint8_t *)codes};
    const int strides[4] = {f->width * 6};
    const bool done =
        codes && sws_scale(s->scaler, (const uint8_t *const *)f->data, f->linesize, 0, f->height, to, strides) > 0;
    for (size_t i = 0; done && i < values; i++)
        p->rgb[i] = (float)codes[i] / 65535;
    free(codes);
    return done;
}

static bool read_codes(stream *s, picture *p, char *reason, size_t size)
{
    const AVFrame *f = s->frame;
    const AVPixFmtDescriptor *format = av_pix_fmt_desc_get((enum AVPixelFormat)f->format);
    const bool rgb = format && (format->flags & AV_PIX_FMT_FLAG_RGB) &&
                     !(format->flags & (AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_FLOAT | AV_PIX_FMT_FLAG_BAYER));
    if (!format || (format->flags & AV_PIX_FMT_FLAG_HWACCEL) || f->width < 1 || f->height < 1 ||
        f->width > PICTURE_MAX_SIDE || f->height > PICTURE_MAX_SIDE)
        return refuse(reason, size, "expected a picture of 1 to 16384 pixels on each side", 0);
    p->width = (uint32_t)f->width;
    p->height = (uint32_t)f->height;
    p->channels = 3;
    p->format = (picture_format){PICTURE_PNG, format->comp[0].depth > 8 ? 16 : 8};
    p->rgb = malloc(3 * (size_t)f->width * (size_t)f->height * sizeof *p->rgb);
    if (p->rgb && (rgb ? copy_rgb(f, format, p) : convert(s, f, p)))
        return true;
    free(p->rgb);
    p->rgb = NULL;
    return refuse(reason, size, "its pixels cannot be converted to RGB", 0);
}

/* ---- the table */

static void *open_stream(const char *path, uint32_t *count, char *reason, size_t size)
{
    av_log_set_level(AV_LOG_QUIET);
    stream *s = calloc(1, sizeof *s);
    if (!s) {
        refuse(reason, size, "no memory", 0);
        return NULL;
    }
    s->at = INT64_MIN;
    if (open_decoder(s, path, reason, size) && find_frames(s, reason, size)) {
        *count = s->count;
        return s;
    }
    close_stream(s);
    return NULL;
}

static bool read_frame(void *user, uint32_t index, picture *p, char *reason, size_t size)
{
    stream *s = user;
    /* The newest one again is decoded again: rare. */
    return find(s, s->times[index], reason, size) && read_codes(s, p, reason, size);
}

const video_table VIDEO_TABLE = {open_stream, close_stream, read_frame};
