#include "amd_table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_ROWS = 1024, KEY = 80, LINE = 256 };

typedef struct row {
    char pass[KEY], stage[16];
    uint32_t variants;
    double figures[AMD_FIGURES];
} row;

struct amd_table {
    uint32_t count;
    row rows[MAX_ROWS];
};

amd_table *amd_table_open(void)
{
    amd_table *table = calloc(1, sizeof *table);
    if (!table)
        abort();
    return table;
}

void amd_table_close(amd_table *table)
{
    free(table);
}

uint32_t amd_table_count(const amd_table *table)
{
    return table->count;
}

static const row *find(const amd_table *table, const char *pass, const char *stage)
{
    for (uint32_t i = 0; i < table->count; i++)
        if (!strcmp(table->rows[i].pass, pass) && !strcmp(table->rows[i].stage, stage))
            return &table->rows[i];
    return NULL;
}

/* More is worse, except for waves. */
static bool is_worse(amd_figure figure, double value, double than)
{
    return figure == AMD_WAVES_PER_SIMD ? value < than : value > than;
}

void amd_table_add(amd_table *table, const char *pass, const char *stage, const double figures[AMD_FIGURES])
{
    row *at = (row *)find(table, pass, stage);
    if (!at) {
        if (table->count == MAX_ROWS)
            abort();
        at = &table->rows[table->count++];
        snprintf(at->pass, sizeof at->pass, "%s", pass);
        snprintf(at->stage, sizeof at->stage, "%s", stage);
        memcpy(at->figures, figures, sizeof at->figures);
    }
    at->variants++;
    for (int i = 0; i < AMD_FIGURES; i++)
        if (is_worse(i, figures[i], at->figures[i]))
            at->figures[i] = figures[i];
}

uint32_t amd_table_print_spills(const amd_table *table)
{
    uint32_t wrong = 0;
    for (uint32_t i = 0; i < table->count; i++) {
        const row *at = &table->rows[i];
        if (!at->figures[AMD_SPILLED_REGISTERS] && !at->figures[AMD_SCRATCH_BYTES])
            continue;
        fprintf(stderr, "%s %s: %g spilled registers, %g bytes of scratch memory; expected none\n", at->pass, at->stage,
                at->figures[AMD_SPILLED_REGISTERS], at->figures[AMD_SCRATCH_BYTES]);
        wrong++;
    }
    return wrong;
}

/* ---- the file: a head, then a row per line */

static const char head[] = "# driver: ";
static const char columns[] =
    "# pass                           stage     variants  vgprs  sgprs    lds  waves  latency  "
    "inverse_throughput\n";

static void print_row(FILE *file, const row *at)
{
    fprintf(file, "%-32s %-9s %8u %6g %6g %6g %6g %8g %8g\n", at->pass, at->stage, at->variants, at->figures[AMD_VGPRS],
            at->figures[AMD_SGPRS], at->figures[AMD_LDS_BYTES], at->figures[AMD_WAVES_PER_SIMD],
            at->figures[AMD_LATENCY], at->figures[AMD_INVERSE_THROUGHPUT]);
}

static int compare_rows(const void *a, const void *b)
{
    const row *x = a, *y = b;
    const int order = strcmp(x->pass, y->pass);
    return order ? order : strcmp(x->stage, y->stage);
}

bool amd_table_write(amd_table *table, const char *path, const char *driver)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    qsort(table->rows, table->count, sizeof table->rows[0], compare_rows);
    fprintf(file, "%s%s\n%s", head, driver, columns);
    for (uint32_t i = 0; i < table->count; i++)
        print_row(file, &table->rows[i]);
    return !fclose(file);
}

/* False: the file is missing, damaged, or of another driver; a line says so. */
static bool read_table(amd_table *table, const char *path, const char *driver, bool *damaged)
{
    char line[LINE];
    FILE *file = fopen(path, "r");
    *damaged = true;
    if (!file || !fgets(line, sizeof line, file) || strncmp(line, head, sizeof head - 1)) {
        fprintf(stderr, "%s: missing, or without a driver in line 1\n", path);
        if (file)
            fclose(file);
        return false;
    }
    *damaged = false;
    line[strcspn(line, "\n")] = 0;
    const bool same = !strcmp(line + sizeof head - 1, driver);
    if (!same)
        printf("%s has figures of %s; here is %s, so only spills were tested\n", path, line + sizeof head - 1, driver);
    while (same && fgets(line, sizeof line, file)) {
        row *at = &table->rows[table->count];
        double *f = at->figures;
        if (line[0] != '#' && table->count < MAX_ROWS &&
            sscanf(line, "%79s %15s %u %lf %lf %lf %lf %lf %lf", at->pass, at->stage, &at->variants, &f[AMD_VGPRS],
                   &f[AMD_SGPRS], &f[AMD_LDS_BYTES], &f[AMD_WAVES_PER_SIMD], &f[AMD_LATENCY],
                   &f[AMD_INVERSE_THROUGHPUT]) == 9)
            table->count++;
    }
    fclose(file);
    return same;
}

/* What a row is held to. Registers and cycles may grow by a tenth, which is less than what makes a wave less. */
static bool is_loss(const row *now, const row *kept)
{
    return now->figures[AMD_WAVES_PER_SIMD] < kept->figures[AMD_WAVES_PER_SIMD] ||
           now->figures[AMD_LDS_BYTES] > kept->figures[AMD_LDS_BYTES] ||
           now->figures[AMD_VGPRS] > 1.1 * kept->figures[AMD_VGPRS] ||
           now->figures[AMD_INVERSE_THROUGHPUT] > 1.1 * kept->figures[AMD_INVERSE_THROUGHPUT];
}

uint32_t amd_table_print_losses(const amd_table *table, const char *path, const char *driver)
{
    amd_table *kept = amd_table_open();
    uint32_t wrong = 0;
    bool damaged;
    const bool same = read_table(kept, path, driver, &damaged);
    for (uint32_t i = 0; same && i < table->count; i++) {
        const row *now = &table->rows[i], *before = find(kept, now->pass, now->stage);
        if (before && !is_loss(now, before))
            continue;
        wrong++;
        fprintf(stderr, before ? "worse than in %s:\n" : "not in %s:\n", path);
        print_row(stderr, now);
        if (before)
            print_row(stderr, before);
    }
    for (uint32_t i = 0; same && i < kept->count; i++)
        if (!find(table, kept->rows[i].pass, kept->rows[i].stage)) {
            wrong++;
            fprintf(stderr, "only in %s: %s %s\n", path, kept->rows[i].pass, kept->rows[i].stage);
        }
    if (wrong)
        fprintf(stderr, "If this is as it must be, write the table anew; see tests/bench/README.md.\n");
    amd_table_close(kept);
    return wrong + damaged;
}
