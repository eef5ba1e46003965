/* vtk.c: VTK's XML files of lines, polygons and points, numbers in base 64. */
#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "base/text.h"
#include "result/durable.h"
#include "result/result_reader.h"
#include "view/export.h"
#include "view/outline.h"
#include "wake/wake.h"

struct export {
    struct result_reader reader;
    const char *folder;
    char stem[256]; /* of the names of all files */
    bool overwrite;
    struct school school;    /* data for the strength of a vortex */
    struct outline *outline; /* of each fish                                   (n_fish) */
    double *sheet_arc;       /* as in the file */
    double *control_arc;     /* as in the file; NULL: no fish has force: pressure */
    size_t n_points;         /* of all bodies */
};

// ---- XML

/* Write one array in base 64: the number of bytes, then the bytes. */
static void vtk_write_array(FILE *stream, const char *type, const char *name, int components, size_t bytes,
                            const void *values) {
    fprintf(stream, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">", type, name,
            components);

    // the number and the values are one sequence of bytes; 3 bytes make 4 letters, so groups of 24 need no padding
    const uint64_t n = bytes;
    unsigned char head[24];
    const size_t in_head = bytes < sizeof head - sizeof n ? bytes : sizeof head - sizeof n;
    memcpy(head, &n, sizeof n);
    if (in_head > 0) memcpy(head + sizeof n, values, in_head);
    text_print_base64(stream, sizeof n + in_head, head);
    text_print_base64(stream, bytes - in_head, (const char *)values + in_head);
    fputs("</DataArray>\n", stream);
}

static void write_doubles(FILE *stream, const char *name, size_t n, const double *values) {
    vtk_write_array(stream, "Float64", name, 1, n * sizeof *values, values);
}

static void write_integers(FILE *stream, const char *name, size_t n, const int64_t *values) {
    vtk_write_array(stream, "Int64", name, 1, n * sizeof *values, values);
}

static void begin_piece(FILE *stream, size_t n_points, size_t n_verts, size_t n_lines, size_t n_polys) {
    fprintf(stream,
            "<?xml version=\"1.0\"?>\n" TARGET_VTK_MARK
            "\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" "
            "NumberOfLines=\"%zu\" NumberOfStrips=\"0\" NumberOfPolys=\"%zu\">\n",
            n_points, n_verts, n_lines, n_polys);
}

static void end_piece(FILE *stream) {
    fputs("</Piece>\n</PolyData>\n</VTKFile>\n", stream);
}

/* Positions in the plane as points in space. */
static enum status write_points(const struct export *export, FILE *stream, size_t n, const double *xy) {
    double *points;
    TRY(MEMORY_NEW(points, 3 * (n + 1), export->reader.file.path));

    for (size_t i = 0; i < n; i++) {
        points[3 * i] = xy[2 * i];
        points[3 * i + 1] = xy[2 * i + 1];
    }

    fputs("<Points>\n", stream);
    vtk_write_array(stream, "Float64", "Points", 3, 3 * n * sizeof *points, points);
    fputs("</Points>\n", stream);
    free(points);
    return STATUS_OK;
}

/* Cells that take the points one after the other, from number first on: sizes[i] points each. */
static enum status write_cells(const struct export *export, FILE *stream, const char *kind, size_t n_cells,
                               const size_t *sizes, size_t first) {
    size_t n = 0;
    for (size_t i = 0; i < n_cells; i++) n += sizes[i];
    int64_t *numbers;
    TRY(MEMORY_NEW(numbers, n + n_cells + 1, export->reader.file.path));
    int64_t *const offsets = numbers + n;
    for (size_t i = 0; i < n; i++) numbers[i] = (int64_t)(first + i);
    int64_t end = 0;
    for (size_t i = 0; i < n_cells; i++) offsets[i] = end += (int64_t)sizes[i];
    fprintf(stream, "<%s>\n", kind);
    write_integers(stream, "connectivity", n, numbers);
    write_integers(stream, "offsets", n_cells, offsets);
    fprintf(stream, "</%s>\n", kind);
    free(numbers);
    return STATUS_OK;
}

// ---- bodies

/* The bodies of a row: first the points of all lines, then the points of all outlines. */
struct bodies {
    double *nodes, *sheet, *strength, *speed, *heading; /* as in the file */
    double *xy, *value;                                 /* points, and strengths there   (n_points, 2), (n_points) */
    double *pressure, *pressure_at;                     /* as in the file; at the points (n_points) */
    size_t *size;                                       /* of the cells                  (2 n_fish) */
    int64_t *fish, *is_outline;                         /* of the cells                  (2 n_fish) */
    double *cell;                                       /* a value of each cell          (2 n_fish) */
};

static void bodies_free(struct bodies *bodies) {
    void *const arrays[] = {bodies->nodes, bodies->sheet,    bodies->strength,   bodies->speed, bodies->heading,
                            bodies->xy,    bodies->value,    bodies->size,       bodies->fish,  bodies->is_outline,
                            bodies->cell,  bodies->pressure, bodies->pressure_at};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
}

static enum status bodies_read(const struct export *export, size_t row, struct bodies *bodies) {
    const size_t n_cells = 2 * export->reader.length[FISH];
    const char *const path = export->reader.file.path;
    *bodies = (struct bodies){0};
    TRY(MEMORY_NEW(bodies->xy, 2 * export->n_points, path));
    TRY(MEMORY_NEW(bodies->value, export->n_points, path));
    TRY(MEMORY_NEW(bodies->pressure_at, export->n_points, path));
    TRY(MEMORY_NEW(bodies->size, n_cells, path));
    TRY(MEMORY_NEW(bodies->fish, n_cells, path));
    TRY(MEMORY_NEW(bodies->is_outline, n_cells, path));
    TRY(MEMORY_NEW(bodies->cell, n_cells, path));
    if (export->control_arc) TRY(result_reader_new(&export->reader, "pressure", row, &bodies->pressure));
    TRY(result_reader_new(&export->reader, "x", row, &bodies->nodes));
    TRY(result_reader_new(&export->reader, "sheet_x", row, &bodies->sheet));
    TRY(result_reader_new(&export->reader, "sheet_strength", row, &bodies->strength));
    TRY(result_reader_new(&export->reader, "speed", row, &bodies->speed));
    return result_reader_new(&export->reader, "heading", row, &bodies->heading);
}

/* Interpolate a value at an arc coordinate between n points. */
static double value_at(const double *arc, const double *value, size_t n, double s) {
    size_t k = 0;
    while (k + 2 < n && s > arc[k + 1]) k++;
    const double q = fmin(1, fmax(0, (s - arc[k]) / (arc[k + 1] - arc[k])));
    return (1 - q) * value[k] + q * value[k + 1];
}

/* The arc coordinate of point i of the outline of a fish. */
static double outline_arc(const struct export *export, size_t f, int i) {
    const size_t last = f * export->reader.length[SHEET] + (size_t) export->reader.n_sheet[f] - 1;
    return (1 - cos(M_PI * outline_point(i) / (OUTLINE_POINTS - 1))) / 2 * export->sheet_arc[last];
}

/* The pressure jump at all points, from that at the control points; NaN for fish that have none. */
static void bodies_press(const struct export *export, struct bodies *bodies) {
    const struct result_reader *const reader = &export->reader;
    const size_t slots = reader->length[CONTROL], n_fish = reader->length[FISH];
    size_t line = 0, side = export->n_points - n_fish * OUTLINE_SIDES;

    for (size_t f = 0; f < n_fish; f++) {
        const double *const arc = export->control_arc + f * slots, *const jump = bodies->pressure + f * slots;
        size_t n = 0;
        while (n < slots && isfinite(arc[n]) && isfinite(jump[n])) n++;
        for (int j = 0; j < reader->n_sheet[f]; j++) {
            const double s = export->sheet_arc[f * reader->length[SHEET] + (size_t)j];
            bodies->pressure_at[line++] = n > 1 ? value_at(arc, jump, n, s) : NAN;
        }
        for (int i = 0; i < OUTLINE_SIDES; i++)
            bodies->pressure_at[side++] = n > 1 ? value_at(arc, jump, n, outline_arc(export, f, i)) : NAN;
    }
}

/* Put the points of all lines and outlines together. */
static void bodies_place(const struct export *export, struct bodies *bodies) {
    const struct result_reader *const reader = &export->reader;
    const size_t n_fish = reader->length[FISH], n_slots = reader->length[SHEET];
    size_t n = 0;

    for (size_t f = 0; f < n_fish; f++) {
        bodies->size[f] = (size_t)reader->n_sheet[f];
        memcpy(bodies->xy + 2 * n, bodies->sheet + 2 * f * n_slots, 2 * bodies->size[f] * sizeof *bodies->xy);
        memcpy(bodies->value + n, bodies->strength + f * n_slots, bodies->size[f] * sizeof *bodies->value);
        n += bodies->size[f];
    }

    for (size_t f = 0; f < n_fish; f++) {
        bodies->size[n_fish + f] = OUTLINE_SIDES;
        outline_polygon(&export->outline[f], bodies->nodes + 2 * f * reader->length[NODE], bodies->xy + 2 * n);
        for (int i = 0; i < OUTLINE_SIDES; i++) {
            bodies->value[n++] = value_at(export->sheet_arc + f * n_slots, bodies->strength + f * n_slots,
                                          (size_t)reader->n_sheet[f], outline_arc(export, f, i));
        }
    }

    for (size_t i = 0; i < 2 * n_fish; i++) {
        bodies->fish[i] = (int64_t)(i % n_fish);
        bodies->is_outline[i] = i >= n_fish;
    }
}

/* A value of each fish as one of each cell. */
static void write_of_fish(const struct bodies *bodies, FILE *stream, const char *name, size_t n_fish,
                          const double *values) {
    for (size_t i = 0; i < 2 * n_fish; i++) bodies->cell[i] = values[i % n_fish];
    write_doubles(stream, name, 2 * n_fish, bodies->cell);
}

static enum status vtk_write_bodies(const struct export *export, size_t row, FILE *stream) {
    struct bodies bodies;
    const size_t n_fish = export->reader.length[FISH];
    enum status status = bodies_read(export, row, &bodies);

    if (status == STATUS_OK) {
        bodies_place(export, &bodies);
        if (export->control_arc) bodies_press(export, &bodies);
        begin_piece(stream, export->n_points, 0, n_fish, n_fish);
        fputs("<PointData Scalars=\"sheet_strength\">\n", stream);
        write_doubles(stream, "sheet_strength", export->n_points, bodies.value);
        if (export->control_arc) write_doubles(stream, "pressure", export->n_points, bodies.pressure_at);
        fputs("</PointData>\n<CellData>\n", stream);
        write_integers(stream, "fish", 2 * n_fish, bodies.fish);
        write_integers(stream, "outline", 2 * n_fish, bodies.is_outline);
        write_of_fish(&bodies, stream, "speed", n_fish, bodies.speed);
        write_of_fish(&bodies, stream, "heading", n_fish, bodies.heading);
        fputs("</CellData>\n", stream);
        status = write_points(export, stream, export->n_points, bodies.xy);
    }

    if (status == STATUS_OK) status = write_cells(export, stream, "Lines", n_fish, bodies.size, 0);
    if (status == STATUS_OK)
        status = write_cells(export, stream, "Polys", n_fish, bodies.size + n_fish,
                             export->n_points - n_fish * OUTLINE_SIDES);
    end_piece(stream);
    bodies_free(&bodies);
    return status;
}

// ---- wakes

struct wakes {
    double *x, *circulation, *birth; /* as in the file */
    double *age;                     /* of those that there are, as the three before once gathered */
    int64_t *fish;
    size_t *size; /* of the cells: 1 */
    size_t n;
};

static void wakes_free(struct wakes *wakes) {
    void *const arrays[] = {wakes->x, wakes->circulation, wakes->birth, wakes->age, wakes->fish, wakes->size};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
}

static enum status wakes_read(const struct export *export, size_t row, struct wakes *wakes) {
    const size_t slots = export->reader.length[FISH] * export->reader.length[VORTEX];
    *wakes = (struct wakes){0};
    TRY(MEMORY_NEW(wakes->age, slots + 1, export->reader.file.path));
    TRY(MEMORY_NEW(wakes->fish, slots + 1, export->reader.file.path));
    TRY(MEMORY_NEW(wakes->size, slots + 1, export->reader.file.path));
    TRY(result_reader_new(&export->reader, "wake_x", row, &wakes->x));
    TRY(result_reader_new(&export->reader, "wake_circulation", row, &wakes->circulation));
    TRY(result_reader_new(&export->reader, "wake_birth", row, &wakes->birth));
    double t;
    TRY(result_reader_row(&export->reader, "time", row, &t));

    // move the vortices of all fish together, to the front of the arrays
    for (size_t i = 0; i < slots; i++) {
        if (!isfinite(wakes->circulation[i])) continue;
        const size_t n = wakes->n++;
        wakes->age[n] = t - wakes->birth[i];
        wakes->circulation[n] = wakes->circulation[i] * wake_strength(&export->school, wakes->age[n]);
        wakes->x[2 * n] = wakes->x[2 * i];
        wakes->x[2 * n + 1] = wakes->x[2 * i + 1];
        wakes->fish[n] = (int64_t)(i / export->reader.length[VORTEX]);
        wakes->size[n] = 1;
    }

    return STATUS_OK;
}

static enum status vtk_write_wakes(const struct export *export, size_t row, FILE *stream) {
    struct wakes wakes;
    enum status status = wakes_read(export, row, &wakes);

    if (status == STATUS_OK) {
        begin_piece(stream, wakes.n, wakes.n, 0, 0);
        fputs("<PointData Scalars=\"circulation\">\n", stream);
        write_doubles(stream, "circulation", wakes.n, wakes.circulation);
        write_doubles(stream, "age", wakes.n, wakes.age);
        write_integers(stream, "fish", wakes.n, wakes.fish);
        fputs("</PointData>\n", stream);
        status = write_points(export, stream, wakes.n, wakes.x);
    }

    if (status == STATUS_OK) status = write_cells(export, stream, "Verts", wakes.n, wakes.size, 0);
    end_piece(stream);
    wakes_free(&wakes);
    return status;
}

// ---- walls

/* Find the smallest and the largest x of all nodes in all rows, and go two lengths of a body beyond. */
static enum status find_ends(const struct export *export, double ends[2]) {
    const size_t n = result_reader_n(&export->reader, "x"), n_fish = export->reader.length[FISH];
    double *x, *length, longest = 0;
    ends[0] = INFINITY;
    ends[1] = -INFINITY;

    for (size_t row = 0; row < export->reader.length[TIME]; row++) {
        TRY(result_reader_new(&export->reader, "x", row, &x));
        // fmin and fmax leave out the NaN of slots without a node
        for (size_t i = 0; i < n; i += 2) {
            ends[0] = fmin(ends[0], x[i]);
            ends[1] = fmax(ends[1], x[i]);
        }
        free(x);
    }

    TRY(result_reader_new(&export->reader, "body_length", 0, &length));
    for (size_t f = 0; f < n_fish; f++) longest = fmax(longest, length[f]);
    free(length);
    ends[0] -= 2 * longest;
    ends[1] += 2 * longest;
    return STATUS_OK;
}

/* One file for all rows: walls do not move. */
static enum status vtk_write_walls(const struct export *export, size_t row, FILE *stream) {
    (void)row;
    const size_t n = export->reader.length[WALL], size[] = {2, 2};
    double ends[2], xy[8];
    TRY(find_ends(export, ends));

    for (size_t i = 0; i < 2 * n; i++) {
        xy[2 * i] = ends[i % 2];
        xy[2 * i + 1] = export->reader.wall_y[i / 2];
    }

    begin_piece(stream, 2 * n, 0, n, 0);
    TRY(write_points(export, stream, 2 * n, xy));
    TRY(write_cells(export, stream, "Lines", n, size, 0));
    end_piece(stream);
    return STATUS_OK;
}

// ---- files

/* The name of a file without the folder. */
static void add_name(struct text *text, const struct export *export, const char *what, size_t row) {
    text_add(text, "%s-%s-%04zu.vtp", export->stem, what, row);
}

/* Write one file of a row. */
static enum status write_file(const struct export *export, const char *what, size_t row,
                              enum status (*write)(const struct export *export, size_t row, FILE *stream)) {
    struct text path = {0};
    struct plain_file file;
    text_add(&path, "%s/", export->folder);
    add_name(&path, export, what, row);
    enum status status = path.failed ? memory_check(NULL, export->reader.file.path)
                                     : plain_file_open(&file, path.text, TARGET_VTK, export->overwrite, 0666);
    if (status == STATUS_OK) status = plain_file_close(&file, write(export, row, file.stream));
    text_free(&path);
    return status;
}

/* Put the name of the file of a row into the list. */
static void list_file(const struct export *export, FILE *list, double t, int part, const char *what, size_t row) {
    struct text name = {0};
    add_name(&name, export, what, row);
    fprintf(list, "<DataSet timestep=\"%.12g\" part=\"%d\" name=\"%s\" file=\"%s\"/>\n", t, part, what,
            name.text ? name.text : "");
    text_free(&name);
}

/* Write the files of all rows, and list the names. */
static enum status vtk_write_rows(const struct export *export, FILE *list) {
    fputs("<?xml version=\"1.0\"?>\n" TARGET_VTK_MARK
          "\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
          "<Collection>\n",
          list);
    const bool has_walls = export->reader.length[WALL] > 0;
    if (has_walls) TRY(write_file(export, "walls", 0, vtk_write_walls));

    for (size_t row = 0; row < export->reader.length[TIME]; row++) {
        double t;
        bool has_wake;
        TRY(result_reader_row(&export->reader, "time", row, &t));
        TRY(result_reader_has_wake(&export->reader, row, &has_wake));
        TRY(write_file(export, "bodies", row, vtk_write_bodies));
        if (has_wake) TRY(write_file(export, "wakes", row, vtk_write_wakes));
        list_file(export, list, t, 0, "bodies", row);
        if (has_wake) list_file(export, list, t, 1, "wakes", row);
        if (has_walls) list_file(export, list, t, 2, "walls", 0);
    }

    fputs("</Collection>\n</VTKFile>\n", list);
    return STATUS_OK;
}

/* The stem of the names: the stem of the result, with letters that need no escape in XML. */
static void find_stem(struct export *export) {
    const char *const path = export->reader.file.path, *const slash = strrchr(path, '/');
    snprintf(export->stem, sizeof export->stem, "%.200s", slash ? slash + 1 : path);
    char *const dot = strrchr(export->stem, '.');
    if (dot && dot > export->stem) *dot = '\0';
    for (char *c = export->stem; *c; c++)
        if (strchr("<>&\"'", *c)) *c = '_';
}

static enum status fill_export(struct export *export) {
    const struct result_reader *const reader = &export->reader;
    if (reader->has_pressure) TRY(result_reader_new(reader, "control_arc", 0, &export->control_arc));
    find_stem(export);
    TRY(result_reader_row(reader, "shedding_interval", 0, &export->school.interval));
    TRY(result_reader_row(reader, "wake_lifetime", 0, &export->school.lifetime));
    TRY(result_reader_row(reader, "wake_decay", 0, &export->school.decay));
    TRY(result_reader_new(reader, "sheet_arc", 0, &export->sheet_arc));
    TRY(MEMORY_NEW(export->outline, reader->length[FISH], reader->file.path));
    double *thickness;
    TRY(result_reader_new(reader, "edge_thickness", 0, &thickness));
    enum status status = STATUS_OK;

    for (size_t f = 0; f < reader->length[FISH] && status == STATUS_OK; f++) {
        export->n_points += (size_t)reader->n_sheet[f] + OUTLINE_SIDES;
        status = outline_create(&export->outline[f], reader->n_nodes[f], thickness + f * reader->length[EDGE],
                                reader->has_mean_section[f]);
    }

    free(thickness);
    return status;
}

static enum status vtk_write_list(const struct export *export, char **name) {
    struct text path = {0};
    struct plain_file list;
    text_add(&path, "%s/%s.pvd", export->folder, export->stem);
    if (path.failed) return memory_check(NULL, export->reader.file.path);
    enum status status = plain_file_open(&list, path.text, TARGET_VTK, export->overwrite, 0666);
    if (status == STATUS_OK) status = plain_file_close(&list, vtk_write_rows(export, list.stream));
    if (status == STATUS_OK && name) {
        *name = path.text;
    } else {
        text_free(&path);
    }
    return status;
}

enum status vtk_export(const char *from, const char *folder, bool overwrite, char **name) {
    struct export export = {.folder = folder, .overwrite = overwrite};
    TRY(result_reader_open(&export.reader, from));
    enum status status = fill_export(&export);
    if (status == STATUS_OK && mkdir(folder, 0777) != 0 && errno != EEXIST)
        status = status_fail(STATUS_FILE, "%s: cannot make this folder: %s", folder, strerror(errno));
    if (status == STATUS_OK) status = vtk_write_list(&export, name);
    for (size_t f = 0; export.outline && f < export.reader.length[FISH]; f++) outline_free(&export.outline[f]);
    free(export.outline);
    free(export.sheet_arc);
    free(export.control_arc);
    result_reader_close(&export.reader);
    return status;
}
