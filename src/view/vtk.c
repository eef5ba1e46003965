/* vtk.c: writes VTK's XML files of lines, polygons and points, with numbers in base 64. */
#include "view/vtk.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>

#include "base/arena.h"
#include "base/text.h"
#include "result/durable.h"
#include "result/result_reader.h"
#include "view/outline.h"
#include "wake/wake.h"

struct export {
    struct arena *arena;
    struct result_reader *reader;
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
static void vtk_write_array(FILE *stream, const char *type, const char *name, int components, size_t n_values,
                            const void *values) {
    fprintf(stream, "<DataArray type=\"%s\" Name=\"%s\" NumberOfComponents=\"%d\" format=\"binary\">", type, name,
            components);

    // the number and the values are one sequence of bytes; 3 bytes make 4 letters, so groups of 24 need no padding
    const uint64_t n = n_values * sizeof(double);
    const size_t bytes = n_values * sizeof(double);
    unsigned char head[24];
    const size_t in_head = bytes < sizeof head - sizeof n ? bytes : sizeof head - sizeof n;
    memcpy(head, &n, sizeof n);
    if (in_head > 0) memcpy(head + sizeof n, values, in_head);
    text_print_base64(stream, sizeof n + in_head, head);
    text_print_base64(stream, bytes - in_head, (const char *)values + in_head);
    fputs("</DataArray>\n", stream);
}

static void begin_piece(FILE *stream, size_t n_points, size_t n_verts, size_t n_lines, size_t n_polys) {
    fprintf(stream,
            "<?xml version=\"1.0\"?>\n" TARGET_VTK_MARK
            "\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
            "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"%zu\" NumberOfVerts=\"%zu\" "
            "NumberOfLines=\"%zu\" NumberOfStrips=\"0\" NumberOfPolys=\"%zu\">\n",
            n_points, n_verts, n_lines, n_polys);
}

static const char end_of_piece[] = "</Piece>\n</PolyData>\n</VTKFile>\n";

/* Positions in the plane as points in space. */
static void write_points(struct arena *arena, FILE *stream, size_t n, const double *xy) {
    double *points;
    NEW(arena, points, 3 * (n + 1));
    for (size_t i = 0; i < n; i++) {
        points[3 * i] = xy[2 * i];
        points[3 * i + 1] = xy[2 * i + 1];
    }

    fputs("<Points>\n", stream);
    vtk_write_array(stream, "Float64", "Points", 3, 3 * n, points);
    fputs("</Points>\n", stream);
}

/* Cells that take the points one after the other, from number first on: sizes[i] points each. */
static void write_cells(struct arena *arena, FILE *stream, const char *kind, size_t n_cells, const size_t *sizes,
                        size_t first) {
    size_t n = 0;
    for (size_t i = 0; i < n_cells; i++) n += sizes[i];
    int64_t *numbers, *offsets, end = 0;
    NEW(arena, numbers, n + 1);
    NEW(arena, offsets, n_cells + 1);
    for (size_t i = 0; i < n; i++) numbers[i] = (int64_t)(first + i);
    for (size_t i = 0; i < n_cells; i++) offsets[i] = end += (int64_t)sizes[i];
    fprintf(stream, "<%s>\n", kind);
    vtk_write_array(stream, "Int64", "connectivity", 1, n, numbers);
    vtk_write_array(stream, "Int64", "offsets", 1, n_cells, offsets);
    fprintf(stream, "</%s>\n", kind);
}

// ---- bodies

/* The bodies of a row: first the points of all lines, then the points of all outlines. */
struct bodies {
    double *nodes, *sheet, *strength, *pressure; /* as in the file */
    double *xy, *value, *pressure_at;            /* points, strengths and pressures there  (n_points, 2), (n_points) */
    size_t *size;                                /* of the cells                           (2 n_fish) */
    int64_t *fish, *is_outline;                  /* of the cells                           (2 n_fish) */
    double *cell;                                /* a value of each cell                   (2 n_fish) */
};

/* Interpolate a value at an arc coordinate between n points. */
static double value_at(const double *arc, const double *value, size_t n, double s) {
    size_t k = 0;
    while (k + 2 < n && s > arc[k + 1]) k++;
    const double q = fmin(1, fmax(0, (s - arc[k]) / (arc[k + 1] - arc[k])));
    return (1 - q) * value[k] + q * value[k + 1];
}

/* Put the points of all lines and outlines together, with the strength and the pressure jump there, from that at the
 * control points; NaN for fish that have none. */
static void bodies_place(const struct export *export, struct bodies *bodies) {
    const struct result_reader *const reader = export->reader;
    const size_t n_fish = reader->length[FISH], n_slots = reader->length[SHEET], n_control = reader->length[CONTROL];
    size_t line = 0, side = export->n_points - n_fish * OUTLINE_SIDES;

    for (size_t f = 0; f < n_fish; f++) {
        const size_t n_sheet = (size_t)reader->n_sheet[f];
        const double *const sheet_arc = export->sheet_arc + f * n_slots;
        const double *const strength = bodies->strength + f * n_slots;
        outline_polygon(&export->outline[f], bodies->nodes + 2 * f * reader->length[NODE], bodies->xy + 2 * side);
        memcpy(bodies->xy + 2 * line, bodies->sheet + 2 * f * n_slots, 2 * n_sheet * sizeof *bodies->xy);
        memcpy(bodies->value + line, strength, n_sheet * sizeof *bodies->value);

        // control points with a pressure jump
        const double *const arc = export->control_arc ? export->control_arc + f * n_control : NULL;
        const double *const jump = arc ? bodies->pressure + f * n_control : NULL;
        size_t n_jumps = 0;
        while (arc && n_jumps < n_control && isfinite(arc[n_jumps]) && isfinite(jump[n_jumps])) n_jumps++;
        for (size_t j = 0; j < n_sheet; j++) {
            bodies->pressure_at[line++] = n_jumps > 1 ? value_at(arc, jump, n_jumps, sheet_arc[j]) : NAN;
        }

        // points of the outline, at the arc coordinate of the point of the curve
        for (int i = 0; i < OUTLINE_SIDES; i++) {
            const double s = outline_part(i) * sheet_arc[n_sheet - 1];
            bodies->value[side] = value_at(sheet_arc, strength, n_sheet, s);
            bodies->pressure_at[side++] = n_jumps > 1 ? value_at(arc, jump, n_jumps, s) : NAN;
        }

        bodies->size[f] = n_sheet;
        bodies->size[n_fish + f] = OUTLINE_SIDES;
        bodies->fish[f] = bodies->fish[n_fish + f] = (int64_t)f;
        bodies->is_outline[n_fish + f] = 1;
    }
}

static enum status vtk_write_bodies(const struct export *export, struct arena *arena, size_t row, FILE *stream) {
    const struct result_reader *const reader = export->reader;
    const size_t n_fish = reader->length[FISH], n_cells = 2 * n_fish;
    struct bodies bodies = {0};
    double *of_fish[2];
    static const char *const names[] = {"speed", "heading"};
    NEW(arena, bodies.xy, 2 * export->n_points);
    NEW(arena, bodies.value, export->n_points);
    NEW(arena, bodies.pressure_at, export->n_points);
    NEW(arena, bodies.size, n_cells);
    NEW(arena, bodies.fish, n_cells);
    NEW(arena, bodies.is_outline, n_cells);
    NEW(arena, bodies.cell, n_cells);
    if (export->control_arc) TRY(result_reader_new(arena, reader, "pressure", row, &bodies.pressure));
    TRY(result_reader_new(arena, reader, "x", row, &bodies.nodes));
    TRY(result_reader_new(arena, reader, "sheet_x", row, &bodies.sheet));
    TRY(result_reader_new(arena, reader, "sheet_strength", row, &bodies.strength));
    for (int i = 0; i < 2; i++) TRY(result_reader_new(arena, reader, names[i], row, &of_fish[i]));
    bodies_place(export, &bodies);

    begin_piece(stream, export->n_points, 0, n_fish, n_fish);
    fputs("<PointData Scalars=\"sheet_strength\">\n", stream);
    vtk_write_array(stream, "Float64", "sheet_strength", 1, export->n_points, bodies.value);
    if (export->control_arc) vtk_write_array(stream, "Float64", "pressure", 1, export->n_points, bodies.pressure_at);
    fputs("</PointData>\n<CellData>\n", stream);
    vtk_write_array(stream, "Int64", "fish", 1, n_cells, bodies.fish);
    vtk_write_array(stream, "Int64", "outline", 1, n_cells, bodies.is_outline);
    for (int i = 0; i < 2; i++) {
        // a value of each fish as one of each cell
        for (size_t c = 0; c < n_cells; c++) bodies.cell[c] = of_fish[i][c % n_fish];
        vtk_write_array(stream, "Float64", names[i], 1, n_cells, bodies.cell);
    }
    fputs("</CellData>\n", stream);
    write_points(arena, stream, export->n_points, bodies.xy);
    write_cells(arena, stream, "Lines", n_fish, bodies.size, 0);
    write_cells(arena, stream, "Polys", n_fish, bodies.size + n_fish, export->n_points - n_fish * OUTLINE_SIDES);
    fputs(end_of_piece, stream);
    return STATUS_OK;
}

// ---- wakes

static enum status vtk_write_wakes(const struct export *export, struct arena *arena, size_t row, FILE *stream) {
    const struct result_reader *const reader = export->reader;
    const size_t slots = reader->length[FISH] * reader->length[VORTEX];
    double t, *x, *circulation, *birth, *age;
    int64_t *fish;
    size_t *size, n = 0;
    TRY(result_reader_row(reader, "time", row, &t));
    TRY(result_reader_new(arena, reader, "wake_x", row, &x));
    TRY(result_reader_new(arena, reader, "wake_circulation", row, &circulation));
    TRY(result_reader_new(arena, reader, "wake_birth", row, &birth));
    NEW(arena, age, slots + 1);
    NEW(arena, fish, slots + 1);
    NEW(arena, size, slots + 1);

    // move the vortices of all fish together, to the front of the arrays
    for (size_t i = 0; i < slots; i++) {
        if (!isfinite(circulation[i])) continue;
        age[n] = t - birth[i];
        const double aged = wake_aged(&export->school, reader->wake_part[i / reader->length[VORTEX]]);
        circulation[n] = circulation[i] * wake_strength(&export->school, age[n] + aged);
        x[2 * n] = x[2 * i];
        x[2 * n + 1] = x[2 * i + 1];
        fish[n] = (int64_t)(i / reader->length[VORTEX]);
        size[n++] = 1;
    }

    begin_piece(stream, n, n, 0, 0);
    fputs("<PointData Scalars=\"circulation\">\n", stream);
    vtk_write_array(stream, "Float64", "circulation", 1, n, circulation);
    vtk_write_array(stream, "Float64", "age", 1, n, age);
    vtk_write_array(stream, "Int64", "fish", 1, n, fish);
    fputs("</PointData>\n", stream);
    write_points(arena, stream, n, x);
    write_cells(arena, stream, "Verts", n, size, 0);
    fputs(end_of_piece, stream);
    return STATUS_OK;
}

// ---- walls

/* Write one file for all rows, because walls do not move. Its lines end two body lengths beyond the nodes of all rows.
 * */
static enum status vtk_write_walls(const struct export *export, struct arena *arena, size_t row, FILE *stream) {
    (void)row;
    const struct result_reader *const reader = export->reader;
    const size_t n = reader->length[WALL], size[] = {2, 2};
    double *x, *length, longest = 0, ends[2] = {INFINITY, -INFINITY}, xy[8];
    NEW(arena, x, result_reader_n(reader, "x"));

    for (size_t i = 0; i < reader->length[TIME]; i++) {
        TRY(result_reader_row(reader, "x", i, x));
        // fmin and fmax leave out the NaN of slots without a node
        for (size_t k = 0; k < result_reader_n(reader, "x"); k += 2) {
            ends[0] = fmin(ends[0], x[k]);
            ends[1] = fmax(ends[1], x[k]);
        }
    }

    TRY(result_reader_new(arena, reader, "body_length", 0, &length));
    for (size_t f = 0; f < reader->length[FISH]; f++) longest = fmax(longest, length[f]);
    for (size_t i = 0; i < 2 * n; i++) {
        xy[2 * i] = ends[i % 2] + (i % 2 ? 2 : -2) * longest;
        xy[2 * i + 1] = reader->wall_y[i / 2];
    }

    begin_piece(stream, 2 * n, 0, n, 0);
    write_points(arena, stream, 2 * n, xy);
    write_cells(arena, stream, "Lines", n, size, 0);
    fputs(end_of_piece, stream);
    return STATUS_OK;
}

// ---- files

/* The content of a file: its name, and the function that writes this content for a row. */
struct content {
    const char *name;
    enum status (*write)(const struct export *export, struct arena *arena, size_t row, FILE *stream);
};

static enum status write_file(const struct export *export, const char *name, const struct content *content,
                              size_t row) {
    struct arena *const arena = arena_create(export->arena, export->reader->file.path);
    struct plain_file file;
    TRY(plain_file_open(&file, arena_text(arena, "%s/%s", export->folder, name), TARGET_VTK, export->overwrite, 0666));
    const enum status status = plain_file_close(&file, content->write(export, arena, row, file.stream));
    arena_free(arena);
    return status;
}

/* Write the list of times, and the files of all rows. */
static enum status vtk_write_list(const struct export *export, struct arena *arena, size_t row, FILE *list) {
    (void)arena;
    static const struct content contents[] = {
        {"bodies", vtk_write_bodies}, {"wakes", vtk_write_wakes}, {"walls", vtk_write_walls}};
    enum { BODIES, WAKES, WALLS, N_CONTENTS };
    fputs("<?xml version=\"1.0\"?>\n" TARGET_VTK_MARK
          "\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
          "<Collection>\n",
          list);

    for (; row < export->reader->length[TIME]; row++) {
        double t;
        bool is_there[N_CONTENTS] = {true, false, export->reader->length[WALL] > 0};
        TRY(result_reader_row(export->reader, "time", row, &t));
        TRY(result_reader_has_wake(export->reader, row, &is_there[WAKES]));
        for (int i = 0; i < N_CONTENTS; i++) {
            char name[320];
            if (!is_there[i]) continue;
            snprintf(name, sizeof name, "%s-%s-%04zu.vtp", export->stem, contents[i].name, i == WALLS ? 0 : row);
            if (i != WALLS || row == 0) TRY(write_file(export, name, &contents[i], row));
            fprintf(list, "<DataSet timestep=\"%.12g\" part=\"%d\" name=\"%s\" file=\"%s\"/>\n", t, i, contents[i].name,
                    name);
        }
    }

    fputs("</Collection>\n</VTKFile>\n", list);
    return STATUS_OK;
}

enum status vtk_export(struct arena *arena, const char *from, const char *folder, bool overwrite, const char **list) {
    struct export export = {.arena = arena_create(arena, from), .folder = folder, .overwrite = overwrite};
    TRY(result_reader_open(export.arena, &export.reader, from));
    const struct result_reader *const reader = export.reader;

    // the stem of the names: the stem of the result, with letters that need no escape in XML
    const char *const slash = strrchr(from, '/');
    snprintf(export.stem, sizeof export.stem, "%.200s", slash ? slash + 1 : from);
    char *const dot = strrchr(export.stem, '.');
    if (dot && dot > export.stem) *dot = '\0';
    for (char *c = export.stem; *c; c++)
        if (strchr("<>&\"'", *c)) *c = '_';

    // data of all rows
    double *thickness;
    if (reader->has_pressure) TRY(result_reader_new(export.arena, reader, "control_arc", 0, &export.control_arc));
    TRY(result_reader_row(reader, "shedding_interval", 0, &export.school.interval));
    TRY(result_reader_row(reader, "wake_lifetime", 0, &export.school.lifetime));
    TRY(result_reader_row(reader, "wake_decay", 0, &export.school.decay));
    TRY(result_reader_new(export.arena, reader, "sheet_arc", 0, &export.sheet_arc));
    TRY(result_reader_new(export.arena, reader, "edge_thickness", 0, &thickness));
    NEW(export.arena, export.outline, reader->length[FISH]);
    for (size_t f = 0; f < reader->length[FISH]; f++) {
        export.n_points += (size_t)reader->n_sheet[f] + OUTLINE_SIDES;
        export.outline[f] = outline_create(export.arena, reader->n_nodes[f], thickness + f * reader->length[EDGE],
                                           reader->has_mean_section[f]);
    }

    struct stat existing;
    if (mkdir(folder, 0777) != 0 && (errno != EEXIST || stat(folder, &existing) != 0 || !S_ISDIR(existing.st_mode))) {
        return status_fail(STATUS_FILE, "%s: cannot make this folder: %s: choose another name with --vtk", folder,
                           strerror(errno));
    }
    const struct content times = {"times", vtk_write_list};
    const char *const name = arena_text(export.arena, "%s.pvd", export.stem);
    *list = arena_text(arena, "%s/%s", folder, name);
    if (!overwrite && lstat(*list, &existing) == 0) {
        return status_fail(STATUS_FILE, "%s exists: choose another folder with --vtk or replace it with --force",
                           *list);
    }
    return write_file(&export, name, &times, 0);
}
