/* field_file.c: sums a field in memory and writes it at once. */
#include "view/field_file.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mathematics.h"
#include "flow/flow.h"
#include "flow/flow_at_bodies.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "view/field_row.h"

// ---- the variables

enum { TIME_AT, X_AT, Y_AT, U, V, VORTICITY, BODY_X, THICKNESS, MEAN_SECTION, N_NODES, FISH_NAME, WALL_Y, N_VARIABLES };
enum { NO_AXIS, TIME_AXIS, Y_AXIS, X_AXIS, FISH_AXIS, NODE_AXIS, EDGE_AXIS, XY_AXIS, NAME_AXIS, WALL_AXIS, N_AXES };

static const char *const axis_name[N_AXES] = {"", "time", "y", "x", "fish", "node", "edge", "xy", "name", "wall"};

/* In the order of the file; wall_y only with walls. */
static const struct variable {
    const char *name;
    int axis[NETCDF_MAX_DIMENSIONS + 1]; /* NO_AXIS at the end */
    enum netcdf_type type;               /* NETCDF_FLOAT: or double, as output.precision says */
    const char *unit, *long_name;
} variables[N_VARIABLES] = {
    {"time", {TIME_AXIS}, NETCDF_DOUBLE, "s", "time"},
    {"x", {X_AXIS}, NETCDF_DOUBLE, "m", "x coordinate of the grid"},
    {"y", {Y_AXIS}, NETCDF_DOUBLE, "m", "y coordinate of the grid"},
    {"u", {TIME_AXIS, Y_AXIS, X_AXIS}, NETCDF_FLOAT, "m s-1", "velocity of the fluid in direction x"},
    {"v", {TIME_AXIS, Y_AXIS, X_AXIS}, NETCDF_FLOAT, "m s-1", "velocity of the fluid in direction y"},
    {"vorticity", {TIME_AXIS, Y_AXIS, X_AXIS}, NETCDF_FLOAT, "s-1", "vorticity of the fluid, dv/dx - du/dy"},
    {"body_x", {TIME_AXIS, FISH_AXIS, NODE_AXIS, XY_AXIS}, NETCDF_DOUBLE, "m", "position of the nodes, nose first"},
    {"edge_thickness", {FISH_AXIS, EDGE_AXIS}, NETCDF_DOUBLE, "m", "thickness of the body in the plane of motion"},
    {"mean_section", {FISH_AXIS}, NETCDF_INT, "1", "edge_thickness"},
    {"n_nodes", {FISH_AXIS}, NETCDF_INT, "1", "number of nodes"},
    {"fish", {FISH_AXIS, NAME_AXIS}, NETCDF_TEXT, "", "name of the fish"},
    {"wall_y", {WALL_AXIS}, NETCDF_DOUBLE, "m", "y of the walls; only with walls"},
};

static const char mean_flags[] = "mean_of_both_nodes mean_over_edge";

int field_file_listed(int i, struct result_listed *listed) {
    if (i >= N_VARIABLES) return 0;
    static const char *const type_name[] = {"char", "int", "int64", "double or float", "double"};
    const struct variable *const variable = &variables[i];
    *listed = (struct result_listed){variable->name,
                                     variable->unit,
                                     type_name[variable->type],
                                     variable->long_name,
                                     "",
                                     i == MEAN_SECTION ? mean_flags : NULL};

    for (int d = 0; variable->axis[d] != NO_AXIS; d++) {
        const size_t length = strlen(listed->dimensions);
        snprintf(listed->dimensions + length, sizeof listed->dimensions - length, "%s%s", d > 0 ? ", " : "",
                 axis_name[variable->axis[d]]);
    }

    return 1;
}

// ---- the field

/* A field that is being made. */
struct field {
    const struct field_row *row;
    double *x, *y;         /* the points, row after row of the grid                   (n) */
    struct targets at;     /* the induced velocity at these points                    (n) */
    double *vorticity;     /* (n) */
    size_t length[N_AXES]; /* of the dimensions */
};

/* Make the points of the grid, and sum the velocities there. */
static enum status field_sum(struct arena *arena, struct field *field, const struct field_grid *grid) {
    const size_t n = (size_t)grid->nx * (size_t)grid->ny;
    const int size[2] = {grid->nx, grid->ny};
    struct targets *const at = &field->at;
    NEW(arena, field->x, n);
    NEW(arena, field->y, n);
    NEW(arena, field->vorticity, n);
    NEW(arena, at->u, n);
    NEW(arena, at->v, n);
    NEW(arena, at->u_x, n);
    NEW(arena, at->u_y, n);
    NEW(arena, at->v_x, n);
    at->n = (int)n;
    at->x = field->x;
    at->y = field->y;
    for (int i = 0; i < at->n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            const int k = axis == 0 ? i % grid->nx : i / grid->nx;
            double *const place = axis == 0 ? field->x : field->y;
            place[i] = grid->low[axis] + (grid->high[axis] - grid->low[axis]) * k / (size[axis] - 1);
        }
    }

    // without markers all circulation was shed infinitely long ago
    struct flow *const flow = flow_create(arena, field->row->school);
    int n_markers = 0;
    for (int f = 0; f < field->row->school->n_fish; f++) n_markers += field->row->state->wake[f].n_vortex;
    const bool is_steady = n_markers == 0;
    if (is_steady) TRY(flow_check_steady(field->row->school));
    flow_field(flow, field->row->state, at, is_steady);
    for (int i = 0; i < at->n; i++) field->vorticity[i] = at->v_x[i] - at->u_y[i];
    return STATUS_OK;
}

// ---- the box

void field_file_box(const struct field_row *row, double low[2], double high[2]) {
    struct box box = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}};
    double margin = 0;
    for (int f = 0; f < row->school->n_fish; f++) {
        const struct fish *const fish = &row->school->fish[f];
        const struct wake *const wake = &row->state->wake[f];
        const double *const y = row->state->y;
        box = box_union(box, box_around(fish->n_nodes, y + fish->at.x, y + fish->at.y));
        box = box_union(box, box_around(wake->n_vortex, wake->x, wake->y));
        margin = fmax(margin, fish->length / 2);
    }

    box = box_widen(box, margin);
    memcpy(low, box.low, sizeof box.low);
    memcpy(high, box.high, sizeof box.high);
}

// ---- writing

static void grid_define_all(struct netcdf_writer *writer, const struct field *field, const char *run) {
    int number[N_AXES];
    // walls come last
    const bool has_walls = field->length[WALL_AXIS] > 0;
    const int n_axes = has_walls ? N_AXES : WALL_AXIS;
    for (int a = TIME_AXIS; a < n_axes; a++)
        number[a] = netcdf_define_dimension(writer, axis_name[a], field->length[a]);
    const bool is_single = field->row->values.output.precision == PRECISION_SINGLE;

    for (int i = 0; i < (has_walls ? N_VARIABLES : WALL_Y); i++) {
        const struct variable *const variable = &variables[i];
        struct netcdf_variable to_define = {.name = variable->name, .long_name = variable->long_name};
        to_define.units = variable->unit;
        to_define.axis = i == TIME_AT ? "T" : i == X_AT ? "X" : i == Y_AT ? "Y" : NULL;
        to_define.flags = i == MEAN_SECTION ? mean_flags : NULL;
        to_define.type = variable->type == NETCDF_FLOAT && !is_single ? NETCDF_DOUBLE : variable->type;
        for (const int *axis = variable->axis; *axis != NO_AXIS; axis++) {
            to_define.dimension[to_define.n_dimensions++] = number[*axis];
        }
        netcdf_define_variable(writer, &to_define);
    }

    netcdf_write_integer(writer, NETCDF_GLOBAL, "shoal_field", FIELD_FILE_SCHEMA);
    netcdf_write_string(writer, NETCDF_GLOBAL, "run", run);
    netcdf_write_string(writer, NETCDF_GLOBAL, "comment",
                        "external flow, all wakes and all bound sheets, with the smoothing of the velocity induced at "
                        "other bodies; bodies are lines, so the flow around the thickness is omitted, as is the "
                        "smaller smoothing of the newest wake at its own body");
    netcdf_write_string(writer, NETCDF_GLOBAL, "case_effective", field->row->effective);
    netcdf_end_definitions(writer);
}

static void grid_write_all(struct netcdf_writer *writer, const struct field *field) {
    const struct school *const school = field->row->school;
    const size_t *const length = field->length;
    netcdf_write_doubles(writer, TIME_AT, NULL, NULL, &field->row->state->t);
    netcdf_write_doubles(writer, X_AT, NULL, NULL, field->at.x);
    for (size_t i = 0; i < length[Y_AXIS]; i++) {
        netcdf_write_doubles(writer, Y_AT, (const size_t[]){i}, (const size_t[]){1}, field->at.y + i * length[X_AXIS]);
    }
    netcdf_write_doubles(writer, U, NULL, NULL, field->at.u);
    netcdf_write_doubles(writer, V, NULL, NULL, field->at.v);
    netcdf_write_doubles(writer, VORTICITY, NULL, NULL, field->vorticity);

    // the bodies
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const double *const y = field->row->state->y;
        const size_t at = (size_t)f;
        for (size_t k = 0; k < length[NODE_AXIS]; k++) {
            const bool is_node = (int)k < fish->n_nodes;
            const double place[2] = {is_node ? y[fish->at.x + (int)k] : NAN, is_node ? y[fish->at.y + (int)k] : NAN};
            netcdf_write_doubles(writer, BODY_X, (const size_t[]){0, at, k, 0}, (const size_t[]){1, 1, 1, 2}, place);
        }
        for (size_t k = 0; k < length[EDGE_AXIS]; k++) {
            const double thickness = (int)k < fish->n_edges ? fish->thickness[k] : NAN;
            netcdf_write_doubles(writer, THICKNESS, (const size_t[]){at, k}, (const size_t[]){1, 1}, &thickness);
        }
        netcdf_write(writer, MEAN_SECTION, (const size_t[]){at}, (const size_t[]){1},
                     &(const int){fish->has_mean_section});
        netcdf_write(writer, N_NODES, (const size_t[]){at}, (const size_t[]){1}, &fish->n_nodes);
        for (size_t i = 0; i < length[NAME_AXIS]; i++) {
            const char letter = i < strlen(fish->name) ? fish->name[i] : '\0';
            netcdf_write(writer, FISH_NAME, (const size_t[]){at, i}, (const size_t[]){1, 1}, &letter);
        }
    }

    if (school->walls.n > 0) netcdf_write_doubles(writer, WALL_Y, NULL, NULL, school->walls.y);
}

enum status field_file_write(struct arena *arena, const char *path, int overwrite, const char *run, const char *command,
                             const struct field_row *row, const struct field_grid *grid) {
    const struct school *const school = row->school;
    struct field field = {.row = row,
                          .length = {[TIME_AXIS] = 1,
                                     [X_AXIS] = (size_t)grid->nx,
                                     [Y_AXIS] = (size_t)grid->ny,
                                     [FISH_AXIS] = (size_t)school->n_fish,
                                     [XY_AXIS] = 2,
                                     [WALL_AXIS] = (size_t)school->walls.n}};
    for (int f = 0; f < school->n_fish; f++) {
        const size_t n_nodes = (size_t)school->fish[f].n_nodes, n_name = strlen(school->fish[f].name);
        if (n_nodes > field.length[NODE_AXIS]) field.length[NODE_AXIS] = n_nodes;
        if (n_name > field.length[NAME_AXIS]) field.length[NAME_AXIS] = n_name;
    }
    field.length[EDGE_AXIS] = field.length[NODE_AXIS] - 1;

    struct netcdf_writer writer;
    TRY(target_check(path, TARGET_NETCDF, overwrite));
    TRY(field_sum(arena, &field, grid));
    TRY(netcdf_create(&writer, path, row->values.name, command));
    grid_define_all(&writer, &field, run);
    grid_write_all(&writer, &field);
    const enum status status = netcdf_publish(&writer, overwrite), finished = netcdf_finish(&writer);
    return status == STATUS_OK ? finished : status;
}

// ---- info

enum status field_file_info(const struct netcdf_reader *file, FILE *stream) {
    static const char *const axes[] = {"x", "y"};
    double time;
    char *text;
    TRY(netcdf_read_doubles(file, "time", (struct netcdf_slice[]){{"time", 0, 1}, {NULL}}, &time));
    TRY(netcdf_attribute(file, "run", &text));
    fprintf(stream, "  run         %s\n  time        %g s\n", text, time);

    for (int a = 0; a < 2; a++) {
        size_t n;
        double ends[2];
        TRY(netcdf_read_length(file, axes[a], 2, INT_MAX, &n));
        for (size_t i = 0; i < 2; i++) {
            const struct netcdf_slice slice[] = {{axes[a], i * (n - 1), 1}, {NULL}};
            TRY(netcdf_read_doubles(file, axes[a], slice, &ends[i]));
        }
        fprintf(stream, "  %-10s  %zu points from %g m to %g m\n", axes[a], n, ends[0], ends[1]);
    }

    TRY(netcdf_attribute(file, "comment", &text));
    fprintf(stream, "  it is       %s\n", text);
    return STATUS_OK;
}
