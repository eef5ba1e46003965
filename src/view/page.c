/* page.c: puts the data of a run between the two halves of page.html, as JSON with numbers in base 64.
 *
 * Positions are 16-bit integers within a box for each row: {left, bottom, size / 65535}. */
#include "view/page.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/arena.h"
#include "base/text.h"
#include "base/version.h"
#include "result/durable.h"
#include "result/result_reader.h"
#include "view/outline.h"
#include "wake/wake.h"

/* src/view/page.html; PAGE_DATA marks the place of the data */
extern const char page_template[];
__asm__(".pushsection .rodata\npage_template: .incbin \"page.html\"\n.byte 0\n.popsection");
static const char placeholder[] = "PAGE_DATA";

/* The maximum size of each part of the page, bytes of base 64. */
static const double body_bytes = 2.4e6, wake_bytes = 4e6, series_bytes = 0.8e6;

enum { MIN_WAKES = 240 /* rows of wakes are left out down to so many before vortices are */, POSITIONS = 65535 };

/* The rows of the result that a part of the page shows. */
struct chosen {
    size_t n, *row; /* (n) */
};

struct page {
    struct arena *arena;
    struct result_reader *reader;
    FILE *stream;
    size_t n_rows, n_fish, n_nodes /* of all fish */;
    struct school school; /* data for the strength of a vortex */
    size_t body_stride, wake_stride, series_stride, vortex_stride;
    struct chosen bodies, wakes, series;
};

// ---- JSON

/* Write a string; escape the characters with a meaning in HTML or JSON. */
static void write_string(FILE *stream, const char *name, const char *string, const char *after) {
    fprintf(stream, "\"%s\":\"", name);
    for (const char *c = string; *c; c++) {
        if (strchr("\"\\<>&", *c) || (unsigned char)*c < ' ') {
            fprintf(stream, "\\u%04x", (unsigned)*c);
        } else {
            fputc(*c, stream);
        }
    }

    fprintf(stream, "\"%s", after);
}

static void page_write_array(FILE *stream, const char *name, size_t bytes, const void *values, const char *after) {
    fprintf(stream, "\"%s\":\"", name);
    text_print_base64(stream, bytes, values);
    fprintf(stream, "\"%s", after);
}

// ---- how much of the run

/* Every stride-th of n rows, or of the numbers in row, and the last row. */
static struct chosen choose_rows(struct arena *arena, size_t n, const size_t *row, size_t stride) {
    struct chosen chosen = {.n = n > 0 ? (n - 1 + stride - 1) / stride + 1 : 0};
    NEW(arena, chosen.row, chosen.n);
    for (size_t i = 0; i < chosen.n; i++) {
        const size_t k = i * stride < n ? i * stride : n - 1;
        chosen.row[i] = row ? row[k] : k;
    }
    return chosen;
}

/* Choose which rows and vortices are left out. */
static enum status page_choose(struct page *page) {
    const double per_byte = 4.0 / 3, rows = (double)page->n_rows, fish = (double)page->n_fish;
    const double bodies = rows * ((double)page->n_nodes * 2 * sizeof(uint16_t) + 4 * sizeof(double)) * per_byte;
    const double series = rows * (3 * fish * sizeof(float) + sizeof(double)) * per_byte;
    page->body_stride = (size_t)fmax(1, ceil(bodies / body_bytes));
    page->series_stride = (size_t)fmax(1, ceil(series / series_bytes));
    if (page->n_rows > 1 && (page->body_stride >= page->n_rows || page->series_stride >= page->n_rows))
        return status_fail(STATUS_FILE, "%s: a school of %zu fish with %zu nodes is too large for a page of 8 MB",
                           page->reader->file.path, page->n_fish, page->n_nodes);

    // the rows with a wake, and the number of vortices in these rows
    double n_vortices = 0, *count;
    size_t n_wake_rows = 0, *wake_row;
    NEW(page->arena, count, page->n_fish);
    NEW(page->arena, wake_row, page->n_rows);
    for (size_t row = 0; row < page->n_rows; row++) {
        bool has_wake;
        TRY(result_reader_has_wake(page->reader, row, &has_wake));
        if (!has_wake) continue;
        TRY(result_reader_row(page->reader, "wake_count", row, count));
        for (size_t f = 0; f < page->n_fish; f++) n_vortices += count[f];
        wake_row[n_wake_rows++] = row;
    }

    const double wakes =
        (n_vortices * 3 * sizeof(uint16_t) + (double)n_wake_rows * (4 * sizeof(double) + 2 * fish * sizeof(int32_t))) *
        per_byte;
    const double fraction = ceil(wakes / wake_bytes);
    page->wake_stride = (size_t)fmax(1, fmin(fraction, floor((double)n_wake_rows / MIN_WAKES)));
    page->vortex_stride = (size_t)fmax(1, ceil(fraction / (double)page->wake_stride));
    page->bodies = choose_rows(page->arena, page->n_rows, NULL, page->body_stride);
    page->wakes = choose_rows(page->arena, n_wake_rows, wake_row, page->wake_stride);
    page->series = choose_rows(page->arena, page->n_rows, NULL, page->series_stride);
    return STATUS_OK;
}

// ---- the fish

/* Write each shape once, and the fish with the numbers of their shapes. */
static enum status write_fish(const struct page *page) {
    const struct result_reader *const reader = page->reader;
    double *thickness, *length;
    size_t *shape, *first, n_shapes = 0;
    NEW(page->arena, shape, page->n_fish);
    NEW(page->arena, first, page->n_fish);
    TRY(result_reader_new(page->arena, reader, "edge_thickness", 0, &thickness));
    TRY(result_reader_new(page->arena, reader, "body_length", 0, &length));
    fprintf(page->stream, "\"shapes\":[");

    for (size_t f = 0; f < page->n_fish; f++) {
        // the first fish of the same shape
        size_t s = 0;
        const double *const own = thickness + f * reader->length[EDGE];
        for (; s < n_shapes; s++) {
            const double *const other = thickness + first[s] * reader->length[EDGE];
            bool is_same = reader->n_nodes[f] == reader->n_nodes[first[s]] &&
                           reader->has_mean_section[f] == reader->has_mean_section[first[s]];
            for (int k = 0; is_same && k < reader->n_nodes[f] - 1; k++) is_same = !(fabs(own[k] - other[k]) > 0);
            if (is_same) break;
        }
        shape[f] = s;
        if (s < n_shapes) continue;
        first[n_shapes++] = f;

        // the weights of the nodes at each point of the outline, their slopes, and the half thickness
        const int n = reader->n_nodes[f];
        const size_t n_weights = (size_t)n * OUTLINE_POINTS;
        const struct outline outline = outline_create(page->arena, n, own, reader->has_mean_section[f]);
        float *values;
        NEW(page->arena, values, 2 * n_weights + OUTLINE_POINTS);
        for (size_t i = 0; i < n_weights; i++) {
            values[i] = (float)outline.weight[i];
            values[n_weights + i] = (float)outline.slope[i];
        }
        for (int i = 0; i < OUTLINE_POINTS; i++) values[2 * n_weights + (size_t)i] = (float)outline.half[i];
        fprintf(page->stream, "%s{\"nodes\":%d,\"points\":%d,", s > 0 ? "," : "", n, OUTLINE_POINTS);
        page_write_array(page->stream, "weight", n_weights * sizeof *values, values, ",");
        page_write_array(page->stream, "slope", n_weights * sizeof *values, values + n_weights, ",");
        page_write_array(page->stream, "half", OUTLINE_POINTS * sizeof *values, values + 2 * n_weights, "}");
    }

    fprintf(page->stream, "],\n\"fish\":[");
    for (size_t f = 0; f < page->n_fish; f++) {
        fprintf(page->stream, "%s{", f > 0 ? ",\n" : "");
        write_string(page->stream, "name", reader->name[f], ",");
        fprintf(page->stream, "\"length\":%.9g,\"shape\":%zu}", length[f], shape[f]);
    }

    fprintf(page->stream, "],\n");
    return STATUS_OK;
}

// ---- the rows

/* Some rows of bodies or wakes being collected: the parts that both have. */
struct rows {
    size_t n, n_places;
    double *time, *box; /* (n), (n, 3) */
    uint16_t *place;    /* (n_places, 2) */
};

static struct rows rows_create(const struct page *page, size_t n, size_t n_places) {
    struct rows rows = {.n = n};
    NEW(page->arena, rows.time, n + 1);
    NEW(page->arena, rows.box, 3 * (n + 1));
    NEW(page->arena, rows.place, 2 * (n_places + 1));
    return rows;
}

/* Add a row at number i of n positions. */
static enum status rows_add(const struct page *page, struct rows *rows, size_t i, size_t row, size_t n,
                            const double *xy) {
    double *const box = rows->box + 3 * i;
    TRY(result_reader_row(page->reader, "time", row, &rows->time[i]));

    // the smallest square box: left, bottom, size / POSITIONS
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t k = 0; k < 2 * n; k++) {
        low[k % 2] = fmin(low[k % 2], xy[k]);
        high[k % 2] = fmax(high[k % 2], xy[k]);
    }
    box[0] = n > 0 ? low[0] : 0;
    box[1] = n > 0 ? low[1] : 0;
    box[2] = n > 0 ? fmax(high[0] - low[0], high[1] - low[1]) / POSITIONS : 0;

    uint16_t *const place = rows->place + 2 * rows->n_places;
    for (size_t k = 0; k < 2 * n; k++) {
        const double steps = box[2] > 0 ? (xy[k] - box[k % 2]) / box[2] : 0;
        place[k] = (uint16_t)fmin(fmax(round(steps), 0), POSITIONS);
    }
    rows->n_places += n;
    return STATUS_OK;
}

static void rows_write(const struct page *page, const struct rows *rows) {
    fprintf(page->stream, "\"n\":%zu,", rows->n);
    page_write_array(page->stream, "time", rows->n * sizeof *rows->time, rows->time, ",\n");
    page_write_array(page->stream, "box", 3 * rows->n * sizeof *rows->box, rows->box, ",\n");
    page_write_array(page->stream, "place", 2 * rows->n_places * sizeof *rows->place, rows->place, "");
}

static enum status page_write_bodies(const struct page *page) {
    struct rows rows = rows_create(page, page->bodies.n, page->bodies.n * page->n_nodes);
    double *x;
    NEW(page->arena, x, result_reader_n(page->reader, "x") + 1);

    for (size_t i = 0; i < rows.n; i++) {
        const size_t row = page->bodies.row[i];
        TRY(result_reader_row(page->reader, "x", row, x));
        // the nodes of all fish one after the other
        size_t n = 0;
        for (size_t f = 0; f < page->n_fish; f++) {
            const size_t n_nodes = (size_t)page->reader->n_nodes[f];
            memmove(x + 2 * n, x + 2 * f * page->reader->length[NODE], 2 * n_nodes * sizeof *x);
            n += n_nodes;
        }
        TRY(rows_add(page, &rows, i, row, n, x));
    }

    fprintf(page->stream, "\"bodies\":{");
    rows_write(page, &rows);
    fprintf(page->stream, "},\n");
    return STATUS_OK;
}

// ---- wakes

/* The wakes being collected. A vortex has the number of the interval of release. Only vortices of every
 * vortex_stride-th number are kept, so that a vortex kept in one row is kept in the next row. */
struct wakes {
    struct rows rows;
    int32_t *number, *count;         /* of each place, in strides of events; of the vortices  (n_places; n, n_fish) */
    float *strength;                 /* circulation with decay, m2 s-1                          (n_places) */
    int16_t *integer;                /* the same in units of the largest over INT16_MAX         (n_places) */
    double *x, *circulation, *birth; /* of a row, as in the file */
    double *xy;                      /* those that are kept */
};

static enum status page_write_wakes(const struct page *page) {
    const struct result_reader *const reader = page->reader;
    const size_t n_rows = page->wakes.n;
    const size_t slots = page->n_fish * reader->length[VORTEX], most = n_rows * slots;
    struct wakes wakes = {.rows = rows_create(page, n_rows, most)};
    NEW(page->arena, wakes.number, most + 1);
    NEW(page->arena, wakes.count, n_rows * page->n_fish + 1);
    NEW(page->arena, wakes.strength, most + 1);
    NEW(page->arena, wakes.integer, most + 1);
    NEW(page->arena, wakes.x, 2 * (slots + 1));
    NEW(page->arena, wakes.circulation, slots + 1);
    NEW(page->arena, wakes.birth, slots + 1);
    NEW(page->arena, wakes.xy, 2 * (slots + 1));

    for (size_t i = 0; i < n_rows; i++) {
        const size_t row = page->wakes.row[i];
        TRY(result_reader_row(reader, "time", row, &wakes.rows.time[i]));
        TRY(result_reader_row(reader, "wake_x", row, wakes.x));
        TRY(result_reader_row(reader, "wake_circulation", row, wakes.circulation));
        TRY(result_reader_row(reader, "wake_birth", row, wakes.birth));

        // keep the vortices of every vortex_stride-th number
        const double t = wakes.rows.time[i];
        size_t n = 0;
        for (size_t v = 0; v < slots; v++) {
            const size_t f = v / reader->length[VORTEX], place = i * page->n_fish + f;
            if (!isfinite(wakes.circulation[v])) continue;
            const long number = lround(wakes.birth[v] / page->school.interval), stride = (long)page->vortex_stride;
            if (number % stride != 0) continue;
            wakes.count[place]++;
            wakes.number[wakes.rows.n_places + n] = (int32_t)(number / stride);
            memcpy(wakes.xy + 2 * n, wakes.x + 2 * v, 2 * sizeof *wakes.x);
            const double age = t - wakes.birth[v] + wake_aged(&page->school, reader->wake_part[f]);
            const double strength = wake_strength(&page->school, age);
            wakes.strength[wakes.rows.n_places + n++] = (float)(wakes.circulation[v] * strength);
        }
        TRY(rows_add(page, &wakes.rows, i, row, n, wakes.xy));
    }

    fprintf(page->stream, "\"wakes\":{\"interval\":%.9g,", page->school.interval * (double)page->vortex_stride);
    rows_write(page, &wakes.rows);
    fputs(",\n", page->stream);
    page_write_array(page->stream, "number", wakes.rows.n_places * sizeof *wakes.number, wakes.number, ",\n");
    page_write_array(page->stream, "count", n_rows * page->n_fish * sizeof *wakes.count, wakes.count, ",\n");

    // circulations as integers of 16 bits
    float max = 0;
    const size_t n = wakes.rows.n_places;
    for (size_t i = 0; i < n; i++) max = fmaxf(max, fabsf(wakes.strength[i]));
    const double unit = max > 0 ? max / INT16_MAX : 1;
    for (size_t i = 0; i < n; i++) wakes.integer[i] = (int16_t)lround(wakes.strength[i] / unit);
    fprintf(page->stream, "\"unit\":%.9g,", unit);
    page_write_array(page->stream, "strength", n * sizeof *wakes.integer, wakes.integer, "},\n");
    return STATUS_OK;
}

// ---- time series

static enum status write_series(const struct page *page) {
    static const char *const names[] = {"speed", "heading", "actuation_power"};
    const size_t n = page->series.n;
    double *time, *row;
    float *values;
    NEW(page->arena, time, n);
    NEW(page->arena, row, page->n_fish);
    NEW(page->arena, values, n * page->n_fish);

    for (size_t i = 0; i < n; i++) {
        TRY(result_reader_row(page->reader, "time", page->series.row[i], &time[i]));
    }
    fprintf(page->stream, "\"series\":{\"n\":%zu,", n);
    page_write_array(page->stream, "time", n * sizeof *time, time, "");

    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        for (size_t i = 0; i < n; i++) {
            TRY(result_reader_row(page->reader, names[k], page->series.row[i], row));
            for (size_t f = 0; f < page->n_fish; f++) values[f * n + i] = (float)row[f];
        }
        fputs(",\n", page->stream);
        page_write_array(page->stream, names[k], n * page->n_fish * sizeof *values, values, "");
    }

    fprintf(page->stream, "}");
    return STATUS_OK;
}

// ---- the page

static enum status write_data(const struct page *page) {
    FILE *const stream = page->stream;
    const struct result_reader *const reader = page->reader;
    const char *const slash = strrchr(reader->file.path, '/');
    fputs("{", stream);
    write_string(stream, "title", reader->title, ",");
    write_string(stream, "file", slash ? slash + 1 : reader->file.path, ",");
    write_string(stream, "status", reader->run_status, ",");
    write_string(stream, "program", version_short(), ",");
    fprintf(stream, "\"rows\":%zu,", page->n_rows);

    // the omitted rows and vortices; "" for a complete page
    const size_t strides[] = {page->body_stride, page->wake_stride, page->vortex_stride, page->series_stride};
    static const char *const what[] = {"bodies", "wakes", "vortices", "points of the traces"};
    static const char *const of[] = {"rows", "rows", "vortices", "rows"};
    char words[256] = "";
    for (size_t i = 0; i < sizeof strides / sizeof *strides; i++) {
        const size_t length = strlen(words);
        if (strides[i] < 2) continue;
        snprintf(words + length, sizeof words - length, "%s%s: one of %zu %s", length > 0 ? "; " : "", what[i],
                 strides[i], of[i]);
    }
    write_string(stream, "thinned", words, ",\n");

    // the walls, and the side with the fluid: the side of the first fish at the start
    double *x;
    TRY(result_reader_new(page->arena, reader, "x", 0, &x));
    fprintf(stream, "\"walls\":[");
    for (size_t i = 0; i < reader->length[WALL]; i++) {
        const double y = reader->wall_y[i];
        fprintf(stream, "%s{\"y\":%.9g,\"inward\":%d}", i > 0 ? "," : "", y, x[1] > y ? 1 : -1);
    }
    fprintf(stream, "],\n");

    TRY(write_fish(page));
    TRY(page_write_bodies(page));
    TRY(page_write_wakes(page));
    TRY(write_series(page));
    fputs("}", stream);
    return STATUS_OK;
}

static enum status fill_page(struct page *page) {
    page->n_rows = page->reader->length[TIME];
    page->n_fish = page->reader->length[FISH];
    for (size_t f = 0; f < page->n_fish; f++) page->n_nodes += (size_t)page->reader->n_nodes[f];
    TRY(result_reader_row(page->reader, "shedding_interval", 0, &page->school.interval));
    TRY(result_reader_row(page->reader, "wake_lifetime", 0, &page->school.lifetime));
    TRY(result_reader_row(page->reader, "wake_decay", 0, &page->school.decay));
    TRY(page_choose(page));
    const char *const place = strstr(page_template, placeholder);
    fwrite(page_template, 1, (size_t)(place - page_template), page->stream);
    TRY(write_data(page));
    fputs(place + strlen(placeholder), page->stream);
    return STATUS_OK;
}

enum status page_write(struct arena *arena, const char *from, const char *to, bool overwrite) {
    struct page page = {.arena = arena_create(arena, from)};
    struct plain_file file;
    TRY(result_reader_open(page.arena, &page.reader, from));
    TRY(plain_file_open(&file, to, TARGET_PAGE, overwrite, 0666));
    page.stream = file.stream;
    return plain_file_close(&file, fill_page(&page));
}
