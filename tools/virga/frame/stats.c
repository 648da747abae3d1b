/* stats.c - a frame's line in stats.jsonl. */
#include "frame/files.h"

#include "effect.h"

#define MAX_TIMES 64

/* Of this frame's step, and of the last of its sub-frames. */
static void write_times(const shot *s, jsonl *stats)
{
    virga_pass_time times[MAX_TIMES];
    const uint32_t passes = virga_timings_get(s->context, times, MAX_TIMES);
    jsonl_begin_object(stats, "milliseconds");
    for (uint32_t i = 0; i < passes && i < MAX_TIMES; i++)
        if (times[i].frame_index >= s->step_frame)
            jsonl_number(stats, times[i].name, times[i].milliseconds);
    jsonl_end(stats);
}

bool frame_write_stats(shot *s, jsonl *stats, uint32_t frame, char *error, size_t error_size)
{
    virga_memory_stats memory;
    virga_memory_get(s->context, &memory);
    jsonl_begin(stats);
    jsonl_uint64(stats, "frame", frame);
    jsonl_number(stats, "time_s", shot_time(s, frame));
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->write_stats)
            tool_effects[i]->write_stats(s, s->states[i], stats);
    for (uint32_t i = 0; tool_effects[i]; i++)
        if (tool_effects[i]->write_totals)
            tool_effects[i]->write_totals(s, s->states[i], stats);
    write_times(s, stats);
    jsonl_uint64(stats, "device_bytes", memory.device_bytes);
    return jsonl_end_line(stats, error, error_size);
}
