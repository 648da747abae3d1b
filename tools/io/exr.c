/* exr.c - writes layered frames through OpenEXR's C core.
 *
 * Chunks of lines are packed by up to two threads, each with its own encode pipeline, and written in order. */
#include "exr.h"

#include "file.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#include <half.h>
#pragma GCC diagnostic pop
#include <openexr.h>

#include <libdeflate.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ZIP_LEVEL   4     /* of libdeflate: half the time of zlib's level 4, and a little smaller */
#define MAX_THREADS 2     /* leaves processors to the renderer */
#define FEW_PIXELS  65536 /* below this a second thread costs more time than it saves */

typedef struct job {
    const exr_frame *frame;
    const exr_channel **order; /* the frame's channels sorted by name, as OpenEXR requires */
    exr_context_t file;
    int32_t lines_per_chunk, chunk_count;
    pthread_mutex_t mutex;
    pthread_cond_t chunk_written;
    int32_t next, written; /* chunks: the next one to pack, and how many are in the file */
    exr_result_t result;   /* of the first chunk that failed */
} job;

/* The state of one thread. */
typedef struct worker {
    job *job;
    exr_encode_pipeline_t pipeline;
    uint8_t *samples;                     /* the chunk's channels in the stored format, one after another */
    uint8_t *reordered, *zipped;          /* (ZIP) the chunk on its way into the file */
    struct libdeflate_compressor *zipper; /* (ZIP) */
    int32_t chunk;
    bool started;
} worker;

exr_attribute exr_attribute_uint(const char *name, uint32_t value, char digits[EXR_UINT_DIGITS])
{
    if (value <= INT32_MAX)
        return (exr_attribute){.name = name, .kind = EXR_ATTRIBUTE_INT, .integer = (int32_t)value};
    snprintf(digits, EXR_UINT_DIGITS, "%u", value);
    return (exr_attribute){.name = name, .kind = EXR_ATTRIBUTE_STRING, .string = digits};
}

/* ---- what a frame may be ---- */

static bool check_name(const char *path, const char *what, const char *name, char *error, size_t error_size)
{
    if (!name || !*name)
        return file_fail(error, error_size, "cannot write %s: %s has no name", path, what);
    if (strlen(name) > EXR_MAX_NAME)
        return file_fail(error, error_size, "cannot write %s: %s '%s' has a name of %zu bytes, at most %d are allowed",
                         path, what, name, strlen(name), EXR_MAX_NAME);
    return true;
}

/* Attributes that OpenEXR sets itself. */
static bool reserved(const char *name)
{
    static const char *const names[] = {
        "channels",           "compression",       "dataWindow", "displayWindow", "lineOrder", "pixelAspectRatio",
        "screenWindowCenter", "screenWindowWidth", "tiles",      "type",          "name",      "version",
        "chunkCount",         "maxSamplesPerPixel"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!strcmp(name, names[i]))
            return true;
    return false;
}

static bool check_attributes(const char *path, const exr_frame *frame, char *error, size_t error_size)
{
    for (uint32_t i = 0; i < frame->attribute_count; i++) {
        const exr_attribute *attribute = &frame->attributes[i];
        if (!check_name(path, "attribute", attribute->name, error, error_size))
            return false;
        if (reserved(attribute->name))
            return file_fail(error, error_size, "cannot write %s: attribute '%s' is set by the format", path,
                             attribute->name);
        if (attribute->kind == EXR_ATTRIBUTE_STRING && !attribute->string)
            return file_fail(error, error_size, "cannot write %s: attribute '%s' has no text", path, attribute->name);
        for (uint32_t j = 0; j < i; j++)
            if (!strcmp(attribute->name, frame->attributes[j].name))
                return file_fail(error, error_size, "cannot write %s: attribute '%s' is given twice", path,
                                 attribute->name);
    }
    return true;
}

static bool check_frame(const char *path, const exr_frame *frame, char *error, size_t error_size)
{
    if (!frame->width || !frame->height || frame->width > EXR_MAX_SIDE || frame->height > EXR_MAX_SIDE)
        return file_fail(error, error_size, "cannot write %s: %u x %u pixels, expected 1 to %d on each side", path,
                         frame->width, frame->height, EXR_MAX_SIDE);
    if (!frame->channel_count)
        return file_fail(error, error_size, "cannot write %s: the frame has no channels", path);
    for (uint32_t i = 0; i < frame->channel_count; i++) {
        const exr_channel *channel = &frame->channels[i];
        if (!check_name(path, "channel", channel->name, error, error_size))
            return false;
        if (!channel->data)
            return file_fail(error, error_size, "cannot write %s: channel '%s' has no samples", path, channel->name);
    }
    return check_attributes(path, frame, error, error_size);
}

static int by_name(const void *a, const void *b)
{
    const exr_channel *const *one = a, *const *other = b;
    return strcmp((*one)->name, (*other)->name);
}

/* Sorted channels, to be freed; NULL after an error. */
static const exr_channel **sort_channels(const char *path, const exr_frame *frame, char *error, size_t error_size)
{
    const exr_channel **order = malloc(frame->channel_count * sizeof *order);
    if (!order) {
        file_fail(error, error_size, "cannot write %s: no memory", path);
        return NULL;
    }
    for (uint32_t i = 0; i < frame->channel_count; i++)
        order[i] = &frame->channels[i];
    qsort(order, frame->channel_count, sizeof *order, by_name);
    for (uint32_t i = 1; i < frame->channel_count; i++) {
        if (!strcmp(order[i - 1]->name, order[i]->name)) {
            file_fail(error, error_size, "cannot write %s: channel '%s' is given twice", path, order[i]->name);
            free(order);
            return NULL;
        }
    }
    return order;
}

/* ---- header ---- */

static exr_compression_t compression_of(exr_packing packing)
{
    switch (packing) {
    case EXR_PACKING_ZIPS: return EXR_COMPRESSION_ZIPS;
    case EXR_PACKING_RLE: return EXR_COMPRESSION_RLE;
    case EXR_PACKING_PIZ: return EXR_COMPRESSION_PIZ;
    case EXR_PACKING_NONE: return EXR_COMPRESSION_NONE;
    case EXR_PACKING_ZIP: break;
    }
    return EXR_COMPRESSION_ZIP;
}

static exr_pixel_type_t pixel_type_of(exr_sample type)
{
    return type == EXR_SAMPLE_HALF ? EXR_PIXEL_HALF : type == EXR_SAMPLE_FLOAT ? EXR_PIXEL_FLOAT : EXR_PIXEL_UINT;
}

static exr_result_t add_attribute(exr_context_t file, const exr_attribute *attribute)
{
    const char *name = attribute->name;
    switch (attribute->kind) {
    case EXR_ATTRIBUTE_STRING: return exr_attr_set_string(file, 0, name, attribute->string);
    case EXR_ATTRIBUTE_INT: return exr_attr_set_int(file, 0, name, attribute->integer);
    case EXR_ATTRIBUTE_FLOAT: return exr_attr_set_float(file, 0, name, attribute->real);
    case EXR_ATTRIBUTE_DOUBLE: return exr_attr_set_double(file, 0, name, attribute->real64);
    case EXR_ATTRIBUTE_M44F: {
        exr_attr_m44f_t matrix;
        memcpy(matrix.m, attribute->m44f, sizeof matrix.m);
        return exr_attr_set_m44f(file, 0, name, &matrix);
    }
    case EXR_ATTRIBUTE_RATIONAL: {
        exr_attr_rational_t ratio = {attribute->rational.numerator, attribute->rational.denominator};
        return exr_attr_set_rational(file, 0, name, &ratio);
    }
    }
    return EXR_ERR_INVALID_ARGUMENT;
}

static exr_result_t write_header(const job *job)
{
    const exr_frame *frame = job->frame;
    exr_context_t file = job->file;
    int part = 0;
    exr_result_t result = exr_add_part(file, NULL, EXR_STORAGE_SCANLINE, &part);
    if (result == EXR_ERR_SUCCESS)
        result = exr_initialize_required_attr_simple(file, 0, (int32_t)frame->width, (int32_t)frame->height,
                                                     compression_of(frame->packing));
    for (uint32_t i = 0; i < frame->channel_count && result == EXR_ERR_SUCCESS; i++)
        result = exr_add_channel(file, 0, job->order[i]->name, pixel_type_of(job->order[i]->type),
                                 EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    for (uint32_t i = 0; i < frame->attribute_count && result == EXR_ERR_SUCCESS; i++)
        result = add_attribute(file, &frame->attributes[i]);
    return result == EXR_ERR_SUCCESS ? exr_write_header(file) : result;
}

/* ---- chunks ---- */

static uint16_t half_of(float value)
{
    if (value != value)
        return 0;
    if (value > 65504.0f)
        value = 65504.0f;
    if (value < -65504.0f)
        value = -65504.0f;
    return imath_float_to_half(value);
}

/* Samples may be unaligned, so they are read by memcpy. */
static void gather_row(const exr_channel *channel, uint32_t width, const uint8_t *from, uint8_t *to)
{
    size_t stride = channel->stride ? channel->stride : 4;
    if (channel->type != EXR_SAMPLE_HALF) {
        for (uint32_t x = 0; x < width; x++)
            memcpy(to + (size_t)x * 4, from + x * stride, 4);
        return;
    }
    for (uint32_t x = 0; x < width; x++) {
        float value;
        memcpy(&value, from + x * stride, 4);
        uint16_t half = half_of(value);
        memcpy(to + (size_t)x * 2, &half, 2);
    }
}

/* Converts a chunk's channels to the stored format and sets them as the pipeline's input. */
static void gather_chunk(worker *worker, int32_t first_line, int32_t lines)
{
    const exr_frame *frame = worker->job->frame;
    uint8_t *to = worker->samples;
    for (uint32_t c = 0; c < frame->channel_count; c++) {
        const exr_channel *channel = worker->job->order[c];
        exr_coding_channel_info_t *coded = &worker->pipeline.channels[c];
        size_t bytes = channel->type == EXR_SAMPLE_HALF ? 2 : 4;
        size_t row = bytes * frame->width;
        size_t from_row =
            channel->row_stride ? channel->row_stride : frame->width * (channel->stride ? channel->stride : 4);
        const uint8_t *from = (const uint8_t *)channel->data + (size_t)first_line * from_row;
        coded->encode_from_ptr = to;
        coded->user_pixel_stride = (int32_t)bytes;
        coded->user_line_stride = (int32_t)row;
        coded->user_bytes_per_element = (int16_t)bytes;
        coded->user_data_type = (uint16_t)pixel_type_of(channel->type);
        for (int32_t line = 0; line < lines; line++, to += row, from += from_row)
            gather_row(channel, frame->width, from, to);
    }
}

/* What the format has before ZIP: bytes at even places, then those at odd places, each as its difference from the one
 * before plus 128. */
static void reorder(const uint8_t *from, size_t size, uint8_t *to)
{
    const size_t half = (size + 1) / 2;
    for (size_t i = 0; i < size; i++)
        to[i % 2 ? half + i / 2 : i / 2] = from[i];
    uint8_t before = size ? to[0] : 0;
    for (size_t i = 1; i < size; i++) {
        const uint8_t here = to[i];
        to[i] = (uint8_t)(here - before + 128);
        before = here;
    }
}

/* Called by the pipeline to compress. Readers treat a chunk of exactly the raw size as uncompressed. */
static exr_result_t zip_chunk(exr_encode_pipeline_t *pipeline)
{
    worker *worker = pipeline->encoding_user_data;
    const size_t size = pipeline->packed_bytes;
    reorder(pipeline->packed_buffer, size, worker->reordered);
    size_t zipped =
        size ? libdeflate_zlib_compress(worker->zipper, worker->reordered, size, worker->zipped, size - 1) : 0;
    if (!zipped) { /* it would be no smaller */
        memcpy(worker->zipped, pipeline->packed_buffer, size);
        zipped = size;
    }
    pipeline->compressed_buffer = worker->zipped; /* it stays ours, as its size of allocation is 0 */
    pipeline->compressed_bytes = zipped;
    return EXR_ERR_SUCCESS;
}

static bool is_zipped(const exr_frame *frame)
{
    return frame->packing == EXR_PACKING_ZIP || frame->packing == EXR_PACKING_ZIPS;
}

/* Called by the pipeline between compressing and writing. */
static exr_result_t wait_for_earlier_chunks(exr_encode_pipeline_t *pipeline)
{
    worker *worker = pipeline->encoding_user_data;
    job *job = worker->job;
    pthread_mutex_lock(&job->mutex);
    while (job->written != worker->chunk && job->result == EXR_ERR_SUCCESS)
        pthread_cond_wait(&job->chunk_written, &job->mutex);
    exr_result_t result = job->result;
    pthread_mutex_unlock(&job->mutex);
    return result;
}

static exr_result_t encode_chunk(worker *worker)
{
    job *job = worker->job;
    exr_encode_pipeline_t *pipeline = &worker->pipeline;
    exr_chunk_info_t chunk;
    int32_t line = worker->chunk * job->lines_per_chunk;
    exr_result_t result = exr_write_scanline_chunk_info(job->file, 0, line, &chunk);
    if (result == EXR_ERR_SUCCESS)
        result = worker->started ? exr_encoding_update(job->file, 0, &chunk, pipeline)
                                 : exr_encoding_initialize(job->file, 0, &chunk, pipeline);
    if (result != EXR_ERR_SUCCESS)
        return result;
    gather_chunk(worker, line, chunk.height);
    if (!worker->started) {
        worker->started = true;
        result = exr_encoding_choose_default_routines(job->file, 0, pipeline);
        pipeline->encoding_user_data = worker;
        pipeline->yield_until_ready_fn = wait_for_earlier_chunks;
        if (is_zipped(job->frame))
            pipeline->compress_fn = zip_chunk;
    }
    return result == EXR_ERR_SUCCESS ? exr_encoding_run(job->file, 0, pipeline) : result;
}

static void *work(void *data)
{
    worker *worker = data;
    job *job = worker->job;
    pthread_mutex_lock(&job->mutex);
    while (job->result == EXR_ERR_SUCCESS && job->next < job->chunk_count) {
        worker->chunk = job->next++;
        pthread_mutex_unlock(&job->mutex);
        exr_result_t result = encode_chunk(worker);
        pthread_mutex_lock(&job->mutex);
        if (result == EXR_ERR_SUCCESS)
            job->written++;
        else if (job->result == EXR_ERR_SUCCESS)
            job->result = result;
        pthread_cond_broadcast(&job->chunk_written);
    }
    pthread_mutex_unlock(&job->mutex);
    return NULL;
}

static size_t chunk_bytes(const job *job)
{
    size_t pixel = 0;
    for (uint32_t i = 0; i < job->frame->channel_count; i++)
        pixel += job->frame->channels[i].type == EXR_SAMPLE_HALF ? 2 : 4;
    return pixel * job->frame->width * (size_t)job->lines_per_chunk;
}

static bool open_worker(worker *worker, job *job)
{
    const bool zips = is_zipped(job->frame);
    const size_t bytes = chunk_bytes(job);
    worker->job = job;
    worker->samples = malloc(bytes);
    worker->reordered = zips ? malloc(bytes) : NULL;
    worker->zipped = zips ? malloc(bytes) : NULL;
    worker->zipper = zips ? libdeflate_alloc_compressor(ZIP_LEVEL) : NULL;
    return worker->samples && (!zips || (worker->reordered && worker->zipped && worker->zipper));
}

static void close_worker(worker *worker)
{
    if (worker->started) {
        if (worker->zipped)
            worker->pipeline.compressed_buffer = NULL;
        exr_encoding_destroy(worker->job->file, &worker->pipeline);
    }
    libdeflate_free_compressor(worker->zipper);
    free(worker->zipped);
    free(worker->reordered);
    free(worker->samples);
}

/* The calling thread is one of the workers, so that writing works if no second thread can be created. */
static exr_result_t write_chunks(job *job)
{
    worker workers[MAX_THREADS] = {0};
    pthread_t threads[MAX_THREADS];
    int count = job->chunk_count > 1 && job->frame->width * job->frame->height > FEW_PIXELS ? MAX_THREADS : 1;
    int begun = 1;
    bool opened[MAX_THREADS];
    for (int i = 0; i < count; i++)
        opened[i] = open_worker(&workers[i], job);
    if (!opened[0])
        job->result = EXR_ERR_OUT_OF_MEMORY;
    while (job->result == EXR_ERR_SUCCESS && begun < count && opened[begun] &&
           pthread_create(&threads[begun], NULL, work, &workers[begun]) == 0)
        begun++;
    work(&workers[0]);
    for (int i = 1; i < begun; i++)
        pthread_join(threads[i], NULL);
    for (int i = 0; i < count; i++)
        close_worker(&workers[i]);
    return job->result;
}

/* ---- the file ---- */

/* Our own output keeps errno of a failed write; OpenEXR's result codes do not have it. */
static int64_t write_bytes(exr_const_context_t context, void *user, const void *data, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t report)
{
    (void)context;
    (void)report;
    return file_write_at(user, data, size, offset) ? (int64_t)size : -1;
}

static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context;
    (void)code;
    (void)message;
}

static exr_result_t write_picture(job *job, const char *path, file_writer *output)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = keep_quiet;
    setup.user_data = output;
    setup.write_fn = write_bytes;
    exr_result_t result = exr_start_write(&job->file, path, EXR_WRITE_FILE_DIRECTLY, &setup);
    if (result != EXR_ERR_SUCCESS)
        return result;
    result = write_header(job);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_scanlines_per_chunk(job->file, 0, &job->lines_per_chunk);
    if (result == EXR_ERR_SUCCESS)
        result = exr_get_chunk_count(job->file, 0, &job->chunk_count);
    if (result == EXR_ERR_SUCCESS)
        result = write_chunks(job);
    /* The table of chunk offsets is written here. */
    exr_result_t finished = exr_finish(&job->file);
    return result == EXR_ERR_SUCCESS ? finished : result;
}

bool exr_write(const char *path, const exr_frame *frame, char *error, size_t error_size)
{
    if (!check_frame(path, frame, error, error_size))
        return false;
    job job = {.frame = frame, .order = sort_channels(path, frame, error, error_size)};
    file_writer output;
    if (!job.order)
        return false;
    if (!file_start(&output, path, error, error_size)) {
        free(job.order);
        return false;
    }
    pthread_mutex_init(&job.mutex, NULL);
    pthread_cond_init(&job.chunk_written, NULL);
    exr_result_t result = write_picture(&job, path, &output);
    pthread_cond_destroy(&job.chunk_written);
    pthread_mutex_destroy(&job.mutex);
    free(job.order);
    if (result == EXR_ERR_SUCCESS || output.failure)
        return file_finish(&output, error, error_size);
    file_abandon(&output);
    return file_fail(error, error_size, "cannot write %s: %s", path, exr_get_default_error_message(result));
}
