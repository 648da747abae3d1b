/* amd_table.h - what each stage of each pass needs on a GPU, as its compiler says; kept in a text file. */
#ifndef VIRGA_TESTS_AMD_TABLE_H
#define VIRGA_TESTS_AMD_TABLE_H

#include <stdbool.h>
#include <stdint.h>

typedef enum amd_figure {
    AMD_VGPRS,
    AMD_SGPRS,
    AMD_LDS_BYTES,
    AMD_WAVES_PER_SIMD,
    AMD_LATENCY,            /* cycles of one wave */
    AMD_INVERSE_THROUGHPUT, /* cycles from one wave to the next */
    AMD_SPILLED_REGISTERS,
    AMD_SCRATCH_BYTES,
    AMD_FIGURES
} amd_figure;

/* Variants of a pass have one row: of each figure, the worst of them. */
typedef struct amd_table amd_table;

amd_table *amd_table_open(void);
void amd_table_close(amd_table *table);

void amd_table_add(amd_table *table, const char *pass, const char *stage, const double figures[AMD_FIGURES]);
uint32_t amd_table_count(const amd_table *table);

/* Each prints a line per row that is wrong, and returns their number. */
uint32_t amd_table_print_spills(const amd_table *table);

/* Rows that are worse than in the file, or not in it, and those that only the file has. Figures of another driver than
 * the file's can not be compared; then nothing is, and a line says so. */
uint32_t amd_table_print_losses(const amd_table *table, const char *path, const char *driver);

bool amd_table_write(amd_table *table, const char *path, const char *driver);

#endif
