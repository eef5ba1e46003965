/* study_file.c: writes and reads study.nc, and reports. */
#define _DEFAULT_SOURCE  // mkdtemp
#include "study/study_file.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/text.h"
#include "case/sweep.h"
#include "case/sweep_expect.h"
#include "case/sweep_quantity.h"
#include "result/netcdf.h"
#include "result/target.h"
#include "study/study_folder.h"
#include "study/study_print.h"

static const char owner[] = "the report of a study"; /* of the arenas */

// ---- the variables

/* Dimensions, in the order of the dimensions of every variable, and as bits of a set, one or two letters each; the
 * dimension point exists in a sweep of errors only. */
enum dimension { BY_MEMBER, BY_GROUP, BY_POINT, BY_KEY, BY_KEY_LEVEL, BY_FISH, BY_XY, BY_LEVEL, BY_TEXT, N_DIMENSIONS };
enum { M = 1, G = 2, P = 4, K = 8, KL = 16, F = 32, X = 64, L = 128, T = 256, MOST_DIMENSIONS = 4 /* of a variable */ };
static const char *const dimension_names[N_DIMENSIONS] = {"member", "group", "point", "key", "key_level",
                                                          "fish",   "xy",    "level", "text"};

/* The rows of the table, in this order. */
enum {
    MEMBER,
    STATUS,
    WARNINGS,
    LABEL,
    MEMBER_FILE,
    ARCLENGTH,
    FISH_NAME,
    SWEPT_KEY,
    QUANTITY,
    REFERENCE,
    RATIO,
    N_MEMBER_ROWS
};
enum { LEVEL_VALUE = N_MEMBER_ROWS, LEVEL_SIZE, GROUP_MEMBER, DESIGN_ORDER, N_LEVEL_ROWS };
enum { DIFFERENCE = N_LEVEL_ROWS, COARSE_ORDER, ORDER, LIMIT, ERROR, FLAG, N_ORDER_ROWS };
enum { POINT_MEMBER = N_ORDER_ROWS, KEY_NAME, KEY_REASON, KEY_LEVELS, KEY_STATED, KEY_IS_CHOICE, N_NAME_ROWS };
enum {
    KEY_DESIGN_ORDER = N_NAME_ROWS,
    KEY_VALUE,
    KEY_MEMBER,
    STATED,
    BAR,
    LIMIT_OF_ALL,
    OF_NOISE,
    LOWEST,
    HIGHEST,
    PART,
    SHIFT,
    SPREAD,
    AT_LEVEL,
    KEY_ORDER,
    KEY_FLAG,
    SENSITIVITY,
    SENSITIVITY_ERROR,
    N_ROWS
};

/* Existence of the variables of a row: once, in a branch, for each swept key, for each quantity of members; with
 * `relative_to`, and then for each number of members; with a refined axis, and for each quantity with orders; in an
 * error study, in a sweep of errors, and for each quantity with errors; if there are inputs, for each quantity. */
enum existence {
    ALWAYS,
    IN_BRANCH,
    BY_SWEPT_KEY,
    BY_QUANTITY,
    IN_RATIOS,
    BY_RATIO,
    IN_ORDERS,
    BY_ORDER,
    IN_ERRORS,
    IN_POINTS,
    BY_ERROR,
    BY_INPUT
};

static const char of_key[] = "of the key"; /* the unit of the key */

/* A row: %s in name and meaning is the name of a quantity; unit NULL: unit of the quantity. */
static const struct row {
    const char *name, *unit;
    enum netcdf_type type;
    enum existence existence;
    int dimensions; /* a set */
    const char *meaning;
} rows[N_ROWS] = {
    {"member", "1", NETCDF_INT, ALWAYS, M, "number of the member"},
    {"status", "", NETCDF_TEXT, ALWAYS, M | T, "status of the member at the end"},
    {"warnings", "", NETCDF_TEXT, ALWAYS, M | T, "warnings about the result of the member, one per line"},
    {"label", "", NETCDF_TEXT, IN_BRANCH, M | T,
     "what a branch does at this point: fold, or loss of stability; or empty"},
    {"file", "", NETCDF_TEXT, IN_BRANCH, M | T, "name of the file of the steady state in the folder"},
    {"arclength", "1", NETCDF_DOUBLE, IN_BRANCH, M, "distance along a branch from its first point (doc/steady.md)"},
    {"fish", "", NETCDF_TEXT, ALWAYS, F | T, "name of the fish"},
    {"%s", NULL, NETCDF_DOUBLE, BY_SWEPT_KEY, M, "%s"},
    {"%s", NULL, NETCDF_DOUBLE, BY_QUANTITY, M | F | X, "%s"},
    {"relative_member", "1", NETCDF_INT, IN_RATIOS, M,
     "member whose values ratio_... divides by: relative_to of the sweep"},
    {"ratio_%s", "1", NETCDF_DOUBLE, BY_RATIO, M | F, "%s over that of relative_member; NaN: one is unknown or 0"},
    {"level_value", of_key, NETCDF_DOUBLE, IN_ORDERS, L, "value of the refined key, from coarse to fine"},
    {"level_size", of_key, NETCDF_DOUBLE, IN_ORDERS, L, "grid spacing: the value, or 1/(n - 1) of n points"},
    {"group_member", "1", NETCDF_INT, IN_ORDERS, G, "first member of each group"},
    {"group_design_order", "1", NETCDF_DOUBLE, IN_ORDERS, G, "order that the refined key has by design; NaN: none"},
    {"difference_%s", NULL, NETCDF_DOUBLE, BY_ORDER, G | F | L,
     "distance of %s from the finest level, or from the reference of the case"},
    {"order_before_%s", "1", NETCDF_DOUBLE, BY_ORDER, G | F, "observed order of %s of the next coarser levels"},
    {"order_%s", "1", NETCDF_DOUBLE, BY_ORDER, G | F, "observed order of %s of the finest levels"},
    {"limit_%s", NULL, NETCDF_DOUBLE, BY_ORDER, G | F | X,
     "%s extrapolated to zero spacing by Richardson's method (xy: positions only)"},
    {"error_%s", NULL, NETCDF_DOUBLE, BY_ORDER, G | F, "error of %s at the finest level (doc/studies.md)"},
    {"objection_%s", "", NETCDF_TEXT, BY_ORDER, G | F | T,
     "reason why the levels of %s have no order, and the error is a largest difference"},
    {"point_member", "1", NETCDF_INT, IN_POINTS, P, "member of the stated values of each point of a sweep with errors"},
    {"key_name", "", NETCDF_TEXT, IN_ERRORS, K | T, "numerical key that is varied alone"},
    {"key_reason", "", NETCDF_TEXT, IN_ERRORS, P | K | T, "reason why the key is not varied, or empty"},
    {"key_levels", "1", NETCDF_INT, IN_ERRORS, P | K, "levels of the key"},
    {"key_stated", "1", NETCDF_INT, IN_ERRORS, P | K, "level of the stated value, from 0, the finest"},
    {"key_is_choice", "1", NETCDF_INT, IN_ERRORS, K, "1: choice of the model, not in the sum; 2: input"},
    {"key_design_order", "1", NETCDF_DOUBLE, IN_ERRORS, K, "order that the key has by design; NaN: none"},
    {"key_value", of_key, NETCDF_DOUBLE, IN_ERRORS, P | K | KL, "value of the key at each level, from fine to coarse"},
    {"key_member", "1", NETCDF_INT, IN_ERRORS, P | K | KL, "member of each level; -1: none"},
    {"stated_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | F, "stated value of %s"},
    {"bar_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | F, "error of the stated value of %s, of all keys"},
    {"expected_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | F, "limit of %s to which the finest levels of all keys lead"},
    {"noise_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | F, "error of the stated value of %s by integrator and search"},
    {"lowest_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | F, "lowest %s of other models; NaN: none"},
    {"highest_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | F, "highest %s of other models"},
    {"part_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | K | F,
     "error of %s by each key, or change by a choice of the model"},
    {"shift_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | K | F,
     "change of %s from the stated value to where the levels of each key lead"},
    {"spread_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | K | F, "error of shift_%s"},
    {"level_%s", NULL, NETCDF_DOUBLE, BY_ERROR, P | K | KL | F, "%s at each level of each key, from fine to coarse"},
    {"key_order_%s", "1", NETCDF_DOUBLE, BY_ERROR, P | K | F, "observed order of %s in each key"},
    {"key_flag_%s", "", NETCDF_TEXT, BY_ERROR, P | K | F | T,
     "reason why the levels of each key give no order of %s, or empty"},
    {"sensitivity_%s", "1", NETCDF_DOUBLE, BY_INPUT, P | K | F,
     "d ln Q/d ln p of Q, %s, by each input p; NaN: no input"},
    {"sensitivity_error_%s", "1", NETCDF_DOUBLE, BY_INPUT, P | K | F, "error of d ln Q/d ln p of Q, %s"},
};

/* A variable of a file. */
struct variable {
    int row;
    int number;    /* of the quantity: in sweep_quantities for orders, requested for errors, else in member_file.h */
    int axis, key; /* of a swept key */
    enum error_relation relation;
    const struct member_file_quantity *quantity; /* NULL: none */
    const char *name, *unit, *meaning;
    enum netcdf_type type;
    int n_dimensions; /* but for the dimension text */
    enum dimension dimension[MOST_DIMENSIONS];
};

/* The contents of a study.nc. */
struct contents {
    struct arena *arena;
    const struct case_values *study;
    const struct member_file *member;
    const struct convergence_orders *orders;
    const struct error_sweep *errors;                          /* NULL: none */
    const struct sweep_error_key *error_key[ERROR_STUDY_KEYS]; /* varied at some point            (dimension key) */
    size_t length[N_DIMENSIONS];                               /* 0: the dimension does not exist */
    int n_variables;
    struct variable *variable; /* (n_variables) */
};

/* Insert the name of a quantity for the %s of a text of the table. */
static char *fill_name(struct arena *arena, const char *format, const char *quantity) {
    const char *const place = strstr(format, "%s");
    if (!place) return arena_text(arena, "%s", format);
    return arena_text(arena, "%.*s%s%s", (int)(place - format), format, quantity, place + 2);
}

/* Append a variable to the list. */
static void add_variable(struct contents *contents, struct variable v) {
    const struct row *const row = &rows[v.row];
    const char *name = v.quantity ? v.quantity->name : "", *meaning = v.row == QUANTITY ? v.quantity->long_name : name;
    const char *unit = v.quantity && v.relation != ERROR_RATIO ? v.quantity->unit : "1";
    if (v.relation != ERROR_VALUE) {
        name = arena_text(contents->arena, "%s_%s", error_relation_words[v.relation], name);
        meaning =
            arena_text(contents->arena, "%s %s that of the twin", meaning, v.relation == ERROR_RATIO ? "over" : "less");
    }
    v.type = row->type;
    if (v.row == SWEPT_KEY) {
        // the variable of "fish[*].body.modulus" is fish_body_modulus
        const struct sweep_key *const key = &contents->study->sweep[v.axis].key[v.key];
        char *const text = arena_text(contents->arena, "%s", key->path);
        int n = 0;
        for (const char *c = key->path; *c; c++) {
            if (*c != '[' && *c != ']' && *c != '*') text[n++] = *c == '.' ? '_' : *c;
        }
        text[n] = '\0';
        name = text;
        meaning = key->path;
        unit = key->unit;
        v.type = key->is_number ? NETCDF_DOUBLE : NETCDF_TEXT;
    }
    if (row->existence == IN_ORDERS) unit = contents->study->sweep[contents->orders->axis].key[0].unit;

    v.name = fill_name(contents->arena, row->name, name);
    v.meaning = fill_name(contents->arena, row->meaning, meaning);
    v.unit = v.type == NETCDF_TEXT ? "1" : row->unit && row->unit != of_key ? row->unit : unit;
    for (enum dimension d = BY_MEMBER; d < BY_TEXT; d++) {
        // a quantity without fish or directions lacks these dimensions, a case without a sweep the dimension of points
        const bool is_of_quantity = v.row == QUANTITY || v.row == LIMIT;
        const bool is_missing = (d == BY_FISH && (v.row == QUANTITY || v.row == RATIO) && !v.quantity->of_fish) ||
                                (d == BY_XY && is_of_quantity && !v.quantity->of_xy);
        if (!(row->dimensions >> d & 1) || is_missing || contents->length[d] == 0) continue;
        v.dimension[v.n_dimensions++] = d;
    }
    GROW(contents->arena, contents->variable, contents->n_variables + 1);
    contents->variable[contents->n_variables++] = v;
}

/* List all variables, row by row. */
static void list_variables(struct contents *contents) {
    const struct case_values *const study = contents->study;
    const bool has_orders = contents->orders->n_groups > 0, has_ratios = sweep_member_reference(study, 0) >= 0;
    for (int r = 0; r < N_ROWS; r++) {
        const enum existence existence = rows[r].existence;
        const bool is_one = existence == ALWAYS || (existence == IN_BRANCH && contents->member[0].label) ||
                            (existence == IN_RATIOS && has_ratios) || (existence == IN_ORDERS && has_orders) ||
                            (existence == IN_ERRORS && contents->errors) ||
                            (existence == IN_POINTS && contents->length[BY_POINT] > 0);
        if (is_one) add_variable(contents, (struct variable){.row = r});
        for (int a = 0; a < study->n_axes && existence == BY_SWEPT_KEY; a++) {
            for (int k = 0; k < study->sweep[a].n_keys; k++) {
                add_variable(contents, (struct variable){.row = r, .axis = a, .key = k});
            }
        }
        const bool of_quantity = existence == BY_QUANTITY || (existence == BY_RATIO && has_ratios);
        for (int q = 0; member_file_quantity(q) && of_quantity; q++) {
            const struct member_file_quantity *const quantity = member_file_quantity(q);
            if (r == RATIO && (quantity->of_xy || strcmp(quantity->name, "time") == 0)) continue;
            const bool is_here =
                quantity->of_steady ? sweep_is_steady(study) : !quantity->of_comparison || compare_is(study);
            if (is_here) add_variable(contents, (struct variable){.row = r, .number = q, .quantity = quantity});
        }
        for (int q = 0; q < SWEEP_N_ORDERS && existence == BY_ORDER && has_orders; q++) {
            const int number = member_file_quantity_number(sweep_quantities[q].name);
            if (!(sweep_refine_orders(study) >> q & 1)) continue;
            add_variable(contents, (struct variable){.row = r, .number = q, .quantity = member_file_quantity(number)});
        }
        const int n_relations = contents->errors && contents->errors->twin ? N_ERROR_RELATIONS : 1;
        const bool has_inputs = contents->errors && (study->error->sensitivity || study->error->n_inputs > 0);
        const bool is_of_error = existence == BY_ERROR || (existence == BY_INPUT && has_inputs);
        for (int q = 0; contents->errors && is_of_error && q < n_relations * contents->errors->point->n_asked; q++) {
            const int asked = q / n_relations, number = contents->errors->point[0].quantity[asked];
            add_variable(contents, (struct variable){.row = r,
                                                     .number = asked,
                                                     .relation = (enum error_relation)(q % n_relations),
                                                     .quantity = member_file_quantity(number)});
        }
    }
}

// ---- the values of the variables

/* A number, or a text. */
struct value {
    double number;
    const char *text;
};

/* A value of a row of members, fish or swept keys. */
static struct value member_value(const struct contents *contents, const struct variable *v, const int *i) {
    const struct case_values *const study = contents->study;
    const struct member_file *const member = v->row == FISH_NAME ? NULL : &contents->member[i[0]];
    struct value value = {.number = NAN, .text = ""};
    switch (v->row) {
        case MEMBER: value.number = i[0]; break;
        case STATUS: value.text = member->status; break;
        case WARNINGS: value.text = member->warnings ? member->warnings : ""; break;
        case LABEL: value.text = member->label; break;
        case MEMBER_FILE: value.text = member->file; break;
        case ARCLENGTH: value.number = member->arclength; break;
        case FISH_NAME: value.text = study->school.fish[i[0]].name; break;
        case SWEPT_KEY: {
            const struct sweep_axis *const axis = &study->sweep[v->axis];
            value.text = axis->value[sweep_member_value(study, i[0], v->axis) * axis->n_keys + v->key];
            if (!text_number(value.text, &value.number)) value.number = NAN;
            break;
        }
        case REFERENCE: value.number = sweep_member_reference(study, i[0]); break;
        case RATIO: {
            const int other = sweep_member_reference(study, i[0]);
            value.number = member_file_ratio(contents->member, i[0], other, v->number, v->quantity->of_fish ? i[1] : 0);
            break;
        }
        default: {
            const bool of_fish = v->quantity->of_fish, of_xy = v->quantity->of_xy;
            value.number = member_file_value(member, v->number, of_fish ? i[1] : 0, of_xy ? i[1 + of_fish] : 0);
        }
    }
    return value;
}

/* A value of a row of a refined axis. */
static struct value order_value(const struct contents *contents, const struct variable *v, const int *i) {
    const struct convergence_orders *const orders = contents->orders;
    const struct sweep_axis *const axis = &contents->study->sweep[orders->axis];
    switch (v->row) {
        case LEVEL_VALUE: return (struct value){.number = orders->value[i[0]]};
        case LEVEL_SIZE: return (struct value){.number = orders->grid_spacing[i[0]]};
        case GROUP_MEMBER: return (struct value){.number = orders->first[i[0]]};
        case DESIGN_ORDER:
            return (struct value){.number = sweep_error_order(contents->study, sweep_error_find(axis->key[0].row))};
        default: break;
    }

    const int place = convergence_place(orders, i[0], v->number, i[1]);
    const struct convergence_row *const row = &orders->row[place];
    switch (v->row) {
        case DIFFERENCE: return (struct value){.number = orders->error[place * orders->n_levels + i[2]]};
        case COARSE_ORDER: return (struct value){.number = row->result.coarse_order};
        case ORDER: return (struct value){.number = row->result.order};
        case LIMIT: return (struct value){.number = row->limit[v->n_dimensions > 2 ? i[2] : 0]};
        case ERROR: return (struct value){.number = row->result.error};
        default: return (struct value){.text = row->flag};
    }
}

/* A value of a row of an error study. text: for the reason of a flag */
static struct value error_value(const struct contents *contents, const struct variable *v, const int *i,
                                char text[CONVERGENCE_BYTES]) {
    const bool is_of_point = v->n_dimensions > 0 && v->dimension[0] == BY_POINT;
    const struct error_sweep *const errors = v->relation == ERROR_RATIO    ? contents->errors->ratio
                                             : v->relation == ERROR_CHANGE ? contents->errors->change
                                                                           : contents->errors;
    const struct error_study *const point = &errors->point[is_of_point ? *i : 0];
    if (v->row == POINT_MEMBER) return (struct value){.number = point->stated};
    if (is_of_point) i++;
    const bool is_model = v->row == LOWEST || v->row == HIGHEST;
    const bool is_sum = (v->row >= STATED && v->row <= OF_NOISE) || is_model;
    const int place = error_plan_place(point, v->number, is_sum ? i[0] : i[v->row == AT_LEVEL ? 2 : 1]);
    if (is_model && !(contents->study->error->models && point->is_full)) return (struct value){.number = NAN};
    if (is_model) return (struct value){.number = (v->row == LOWEST ? point->lowest : point->highest)[place].value};
    if (v->row == LIMIT_OF_ALL) return (struct value){.number = point->value[place] + point->shift[place]};
    if (v->row == OF_NOISE) return (struct value){.number = point->of_noise[place]};
    if (is_sum) return (struct value){.number = v->row == STATED ? point->value[place] : point->error[place]};

    // the key does not have to be varied at this point
    const struct sweep_error_key *const row = contents->error_key[i[0]];
    const struct error_study_key *key = NULL;
    for (int k = 0; k < point->n_keys; k++) {
        if (point->key[k].row == row) key = &point->key[k];
    }
    const int n_levels = key ? key->n_levels : 0;
    switch (v->row) {
        case KEY_NAME: return (struct value){.text = sweep_error_name(row)};
        case KEY_IS_CHOICE:
            return (struct value){.number = row->kind == SWEEP_MODEL ? 1 : row->kind == SWEEP_INPUT ? 2 : 0};
        case KEY_DESIGN_ORDER: return (struct value){.number = sweep_error_order(contents->study, row)};
        case KEY_REASON: return (struct value){.text = n_levels == 1 ? key->objection : ""};
        case KEY_LEVELS: return (struct value){.number = n_levels};
        case KEY_STATED: return (struct value){.number = key ? key->stated : 0};
        case KEY_VALUE: return (struct value){.number = i[1] < n_levels ? key->value[i[1]] : NAN};
        case KEY_MEMBER: return (struct value){.number = i[1] < n_levels ? key->member[i[1]] : -1};
        case PART: return (struct value){.number = n_levels > 1 ? key->part[place].error : NAN};
        case SHIFT: return (struct value){.number = n_levels > 1 ? key->part[place].shift : NAN};
        case SPREAD: return (struct value){.number = n_levels > 1 ? key->part[place].spread : NAN};
        case AT_LEVEL:
            if (i[1] >= n_levels) return (struct value){.number = NAN};
            return (struct value){
                .number = convergence_study_value(point, contents->member, key->member[i[1]], v->number, i[2])};
        case SENSITIVITY: return (struct value){.number = n_levels > 1 && key->slope ? key->slope[place].value : NAN};
        case SENSITIVITY_ERROR:
            return (struct value){.number = n_levels > 1 && key->slope ? key->slope[place].error : NAN};
        case KEY_ORDER: return (struct value){.number = n_levels > 1 ? key->part[place].order : NAN};
        default:
            *text = '\0';
            if (n_levels > 1 && !key->slope) study_print_reason(point, key, place, text);
    }
    return (struct value){.text = text};
}

/* Value number e of a variable, the last index fastest. index: of the value in each dimension; text: scratch */
static struct value value_at(const struct contents *contents, const struct variable *v, size_t e,
                             int index[MOST_DIMENSIONS], char text[CONVERGENCE_BYTES]) {
    for (int d = v->n_dimensions - 1; d >= 0; d--) {
        const size_t length = contents->length[v->dimension[d]];
        index[d] = (int)(e % length);
        e /= length;
    }
    const enum existence existence = rows[v->row].existence;
    if (existence == IN_ORDERS || existence == BY_ORDER) return order_value(contents, v, index);
    if (existence >= IN_ERRORS) return error_value(contents, v, index, text);
    return member_value(contents, v, index);
}

static size_t n_values(const struct contents *contents, const struct variable *v) {
    size_t n = 1;
    for (int d = 0; d < v->n_dimensions; d++) n *= contents->length[v->dimension[d]];
    return n;
}

// ---- writing

/* Define and write the variables of an open file without memory of the arena. number: (most numbers of a variable);
 * text: (dimension text) */
static void write_variables(struct netcdf_writer *writer, const struct contents *contents, double *number, char *text) {
    char scratch[CONVERGENCE_BYTES];
    int dimension[N_DIMENSIONS] = {0}, index[MOST_DIMENSIONS];
    for (enum dimension d = BY_MEMBER; d < N_DIMENSIONS; d++) {
        if (contents->length[d] > 0) {
            dimension[d] = netcdf_define_dimension(writer, dimension_names[d], contents->length[d]);
        }
    }
    netcdf_write_integer(writer, NETCDF_GLOBAL, "shoal_study", STUDY_FILE_SCHEMA);
    netcdf_write_string(writer, NETCDF_GLOBAL, "study_case", contents->study->merged);

    for (int i = 0; i < contents->n_variables; i++) {
        const struct variable *const v = &contents->variable[i];
        struct netcdf_variable defined = {.name = v->name,
                                          .long_name = v->meaning,
                                          .units = v->unit,
                                          .type = v->type,
                                          .n_dimensions = v->n_dimensions};
        for (int d = 0; d < v->n_dimensions; d++) defined.dimension[d] = dimension[v->dimension[d]];
        if (v->type == NETCDF_TEXT) defined.dimension[defined.n_dimensions++] = dimension[BY_TEXT];
        const int variable = netcdf_define_variable(writer, &defined);
        if (v->row != SWEPT_KEY) continue;
        netcdf_write_integer(writer, variable, "axis", v->axis);
        const bool is_swept = contents->errors && v->key < contents->errors->n_swept;
        if (is_swept) netcdf_write_integer(writer, variable, "swept", 1);
        const bool is_refined = v->key == 0 && contents->study->sweep[v->axis].refine;
        if (is_refined) netcdf_write_integer(writer, variable, "refine", 1);
    }
    netcdf_end_definitions(writer);

    // numbers at once, texts one by one
    for (int i = 0; i < contents->n_variables; i++) {
        const struct variable *const v = &contents->variable[i];
        const int variable = netcdf_number(writer, v->name);
        for (size_t e = 0; e < n_values(contents, v); e++) {
            const struct value value = value_at(contents, v, e, index, scratch);
            number[e] = value.number;
            if (v->type != NETCDF_TEXT) continue;
            size_t start[MOST_DIMENSIONS] = {0}, count[MOST_DIMENSIONS] = {1, 1, 1, 1};
            for (int d = 0; d < v->n_dimensions; d++) start[d] = (size_t)index[d];
            count[v->n_dimensions] = contents->length[BY_TEXT];
            memset(text, 0, contents->length[BY_TEXT]);
            memcpy(text, value.text, strlen(value.text));
            netcdf_write(writer, variable, start, count, text);
        }
        if (v->type != NETCDF_TEXT) netcdf_write_doubles(writer, variable, NULL, NULL, number);
    }
}

enum status study_file_write(struct arena *arena, const char *path, const struct case_values *study,
                             const struct member_file *member, const struct convergence_orders *orders,
                             const struct error_sweep *errors, const char *command) {
    struct contents contents = {.arena = arena, .study = study, .member = member, .orders = orders, .errors = errors};
    size_t *const length = contents.length;
    length[BY_MEMBER] = (size_t)sweep_n_members(study);
    length[BY_FISH] = (size_t)study->school.n_fish;
    length[BY_XY] = 2;
    length[BY_GROUP] = (size_t)orders->n_groups;
    length[BY_LEVEL] = (size_t)orders->n_levels;
    if (errors) {
        if (errors->n_swept > 0) length[BY_POINT] = (size_t)errors->n_points;
        length[BY_KEY_LEVEL] = ERROR_STUDY_LEVELS;
        // the keys of the table, and those of one fish
        const struct sweep_error *const error = errors->study.error;
        for (int i = 0; i < ERROR_STUDY_KEYS + error->n_inputs; i++) {
            const struct sweep_error_key *const row = i < SWEEP_N_ERROR_KEYS ? &sweep_error_keys[i]
                                                      : i < ERROR_STUDY_KEYS ? &sweep_inputs[i - SWEEP_N_ERROR_KEYS]
                                                                             : error->input[i - ERROR_STUDY_KEYS].key;
            if (i >= ERROR_STUDY_KEYS && !row->name) continue;
            bool is_varied = false;
            for (int p = 0; p < errors->n_points; p++) {
                const struct error_study *const point = &errors->point[p];
                for (int k = 0; k < point->n_keys; k++) is_varied |= point->key[k].row == row;
            }
            if (is_varied) contents.error_key[length[BY_KEY]++] = row;
        }
    }

    // the longest text and the most numbers of a variable
    list_variables(&contents);
    size_t n_text = CONVERGENCE_BYTES, n_numbers = 0;
    for (int i = 0; i < contents.n_variables; i++) {
        const struct variable *const v = &contents.variable[i];
        char scratch[CONVERGENCE_BYTES];
        int index[MOST_DIMENSIONS];
        n_numbers = n_values(&contents, v) > n_numbers ? n_values(&contents, v) : n_numbers;
        for (size_t e = 0; e < n_values(&contents, v) && v->type == NETCDF_TEXT; e++) {
            const size_t n = strlen(value_at(&contents, v, e, index, scratch).text);
            n_text = n > n_text ? n : n_text;
        }
    }
    length[BY_TEXT] = n_text;
    double *number;
    char *text;
    NEW(arena, number, n_numbers);
    NEW(arena, text, n_text);

    // write a temporary file, then rename the file to path
    struct netcdf_writer writer;
    TRY(target_check(path, TARGET_NETCDF, true));
    TRY(netcdf_create(&writer, path, study->name, command));
    write_variables(&writer, &contents, number, text);
    const enum status published = netcdf_publish(&writer, true);
    const enum status finished = netcdf_finish(&writer);
    return published == STATUS_OK ? finished : published;
}

// ---- the list of variables

int study_file_listed(int i, struct result_listed *listed) {
    // of the quantities of members, the list has those that are computed; Q stands for any other quantity
    static char name[N_ROWS][64], meaning[N_ROWS][160];
    const struct member_file_quantity *quantity = NULL;
    int r = MEMBER;
    for (int n = 0, q = 0; r < N_ROWS; r++) {
        if (r == SWEPT_KEY) continue;
        for (; r == QUANTITY && member_file_quantity(q); q++) {
            quantity = member_file_quantity(q);
            if (quantity->is_computed && n++ == i) break;
        }
        if (r == QUANTITY && !member_file_quantity(q)) continue;
        if (r == QUANTITY || n++ == i) break;
    }
    if (r == N_ROWS) return 0;

    const struct row *const row = &rows[r];
    const char *const place = strstr(row->name, "%s"), *const word = strstr(row->meaning, "%s");
    snprintf(name[r], sizeof name[r], "%.*s%s", place ? (int)(place - row->name) : (int)strlen(row->name), row->name,
             place ? "Q" : "");
    snprintf(meaning[r], sizeof meaning[r], "%.*s%s%s", word ? (int)(word - row->meaning) : (int)strlen(row->meaning),
             row->meaning, word ? "Q" : "", word ? word + 2 : "");
    *listed = (struct result_listed){.name = r == QUANTITY ? quantity->name : name[r],
                                     .unit = r == QUANTITY ? quantity->unit
                                             : row->unit   ? row->unit
                                                           : "of Q",
                                     .type = row->type == NETCDF_TEXT  ? "char"
                                             : row->type == NETCDF_INT ? "int"
                                                                       : "double",
                                     .meaning = r == QUANTITY ? quantity->long_name : meaning[r]};
    int length = 0;
    for (enum dimension by = BY_MEMBER; by < N_DIMENSIONS; by++) {
        const bool is_missing =
            r == QUANTITY && ((by == BY_FISH && !quantity->of_fish) || (by == BY_XY && !quantity->of_xy));
        if (!(row->dimensions >> by & 1) || is_missing || (by == BY_POINT && r != POINT_MEMBER)) continue;
        length += snprintf(listed->dimensions + length, sizeof listed->dimensions - (size_t)length, "%s%s",
                           length > 0 ? ", " : "", dimension_names[by]);
    }
    return 1;
}

// ---- reading

enum { MAX_MEMBERS = 100000 };

/* An open study.nc. */
struct reading {
    const struct netcdf_reader *reader;
    struct case_values *study;
    struct member_file *member;
    size_t n_members, n_text; /* lengths of dimensions */
};

static enum status study_file_read_members(struct reading *reading) {
    const int n_fish = reading->study->school.n_fish;
    const struct netcdf_reader *const reader = reading->reader;
    struct arena *const arena = reader->arena;
    size_t length;

    // an error study with refinement has a variable number of members
    const size_t n = (size_t)sweep_n_members(reading->study);
    const bool is_open = reading->study->error != NULL;
    TRY(netcdf_read_length(reader, "member", is_open ? 1 : n, is_open ? MAX_MEMBERS : n, &reading->n_members));
    TRY(netcdf_read_length(reader, "fish", (size_t)n_fish, (size_t)n_fish, &length));
    TRY(netcdf_read_length(reader, "text", 1, INT_MAX, &reading->n_text));
    NEW(arena, reading->member, reading->n_members);

    // status and warnings of each member
    for (size_t m = 0; m < reading->n_members; m++) {
        struct member_file *const member = &reading->member[m];
        const struct netcdf_slice slice[] = {{"member", m, 1}, {"text", 0, reading->n_text}, {NULL}};
        char *status, *warnings;
        member->number = (int)m;
        member_file_create_values(arena, member, n_fish);
        NEW(arena, status, reading->n_text + 1);
        NEW(arena, warnings, reading->n_text + 1);
        TRY(netcdf_read_text(reader, "status", slice, status));
        TRY(netcdf_read_text(reader, "warnings", slice, warnings));
        member->status = status;
        member->warnings = warnings;
        if (!netcdf_has(reader, "label")) continue;
        char *label;
        NEW(arena, label, reading->n_text + 1);
        TRY(netcdf_read_text(reader, "label", slice, label));
        member->label = label;
    }

    // quantities; those of comparisons exist in comparisons only
    double *buffer;
    NEW(arena, buffer, reading->n_members * (size_t)n_fish * 2);
    for (int q = 0; member_file_quantity(q); q++) {
        const struct member_file_quantity *const quantity = member_file_quantity(q);
        if (!netcdf_has(reader, quantity->name)) continue;
        const struct netcdf_slice slice[] = {{"member", 0, reading->n_members},
                                             {quantity->of_fish ? "fish" : NULL, 0, (size_t)n_fish},
                                             {quantity->of_xy ? "xy" : NULL, 0, 2},
                                             {NULL}};
        TRY(netcdf_read_doubles(reader, quantity->name, slice, buffer));
        const double *from = buffer;
        for (size_t m = 0; m < reading->n_members; m++) {
            for (int f = 0; f < (quantity->of_fish ? n_fish : 1); f++) {
                for (int k = 0; k < 1 + quantity->of_xy; k++)
                    *member_file_place(&reading->member[m], q, f, k) = *from++;
            }
        }
    }

    return STATUS_OK;
}

enum status study_file_read(const struct netcdf_reader *reader, struct case_values **study,
                            struct member_file **members, int *n_members) {
    struct reading reading = {.reader = reader};
    char *text;
    enum status status = netcdf_attribute(reader, "study_case", &text);
    if (status == STATUS_OK) status = study_folder_parse(reader->arena, &reading.study, text, reader->path, 0, NULL);
    if (status == STATUS_OK) status = study_file_read_members(&reading);
    *study = reading.study;
    *members = reading.member;
    *n_members = (int)reading.n_members;
    if (status == STATUS_OK || status == STATUS_MEMORY) return status;
    return status_fail(STATUS_FILE, "%s; write study.nc again with `shoal gather`", status_message());
}

// ---- the report of a study

/* Print orders and expectations; the first failure counts. */
static enum status print_expected(struct arena *arena, const struct case_values *study,
                                  const struct member_file *members, const struct convergence_orders *orders,
                                  FILE *stream) {
    const enum status of_orders = study_print_orders(arena, study, orders, stream);
    if (of_orders != STATUS_OK && of_orders != STATUS_MISSED) return of_orders;
    const enum status of_members = study_expect(study, members, stream);
    return of_orders == STATUS_OK ? of_members : of_orders;
}

/* Fail if a member is incomplete and the case does not expect the failure. */
static enum status test_completeness(const struct case_values *study, const struct member_file *members,
                                     const char *folder) {
    const int n = sweep_n_members(study);
    int n_failed = 0;
    for (int m = 0; m < n; m++) {
        bool is_expected = member_file_is_complete(&members[m]);
        for (int i = 0; i < study->n_expectations && !is_expected; i++) {
            const struct sweep_expectation *const one = &study->expect[i];
            is_expected =
                one->fails && sweep_expects_of(study, one, m) && member_file_has_failed(&members[m], one->fails);
        }
        n_failed += !is_expected;
    }
    if (n_failed == 0) return STATUS_OK;
    return status_fail(STATUS_SOLVER,
                       "%d of %d members in %s are not complete; repeat `shoal %s` with the same options", n_failed, n,
                       folder, study->error ? "error" : "study");
}

/* Flush the streams of a report, so that they take the memory for all that was printed. main reports a full standard
 * output. */
static enum status end_texts(FILE *stream, FILE *warnings) {
    if ((fflush(stream) == 0 && fflush(warnings) == 0) || errno != ENOMEM) return STATUS_OK;
    return status_fail(STATUS_MEMORY, "out of memory: text to print");
}

enum status study_report(const struct case_values *study, const char *folder, const char *path, const char *command,
                         bool strict, FILE *stream, FILE *warnings) {
    ARENA(arena, NULL, owner);
    struct member_file *members;
    TRY(study_folder_read_members(arena, &members, study, folder));
    compare_fill(study, members);

    // request all memory before study.nc is written, because it has to be there also after an expectation was missed
    struct convergence_orders orders;
    const char *const table = path ? path : study_folder_path(arena, folder, "study.nc");
    const char *const csv = study_folder_path(arena, folder, "error.csv");
    convergence_orders_create(arena, &orders, study, members);
    (compare_is(study) ? compare_print : study_print)(arena, study, members, stream);
    enum status status = print_expected(arena, study, members, &orders, stream);

    // the warnings of short runs in a comparison of methods concern the case
    const int n = compare_is(study) ? 0 : study_print_warnings(arena, members, sweep_n_members(study), warnings);
    if (strict && status == STATUS_OK && n > 0) {
        status = status_fail(STATUS_MISSED, "%d warning%s about the members, with --strict", n, n > 1 ? "s" : "");
    }
    TRY(end_texts(stream, warnings));
    TRY(study_file_write(arena, table, study, members, &orders, NULL, command));

    // the table of an error study that the folder contained before
    if (target_is(csv, TARGET_TABLE)) unlink(csv);
    return status == STATUS_OK ? test_completeness(study, members, folder) : status;
}

// ---- the run and the report of a comparison

/* Run all members in a temporary folder, then report. */
static enum status run_in_folder(struct arena *arena, const char *folder, const struct case_values *values,
                                 const struct compare_options *options, const struct study_options *run, FILE *stream) {
    struct case_values *study;
    TRY(compare_create(arena, &study, values, options));
    const struct study_options all = {.folder = folder,
                                      .command = run->command,
                                      .n_processes = 1,
                                      .n_required = COMPARE_N_REFERENCES,
                                      .limit = run->limit,
                                      .progress = run->progress,
                                      .data = run->data,
                                      .stop = run->stop};
    int n_failed;
    const enum status status = study_run(study, &all, &n_failed);
    if (status == STATUS_SOLVER) {
        return status_fail(STATUS_SOLVER, "the reference, %s; see --reference-rtol and --limit", status_message());
    }

    if (status == STATUS_STOPPED) return status_fail(STATUS_STOPPED, "stopped by a signal");
    TRY(status);
    const enum status reported = study_report(study, folder, options->path, run->command, false, stream, stream);

    // a method that fails on a case is a valid result
    return reported == STATUS_SOLVER ? STATUS_OK : reported;
}

static void folder_remove(void *folder) {
    study_folder_remove(folder);
}

enum status study_compare(const struct case_values *values, const struct compare_options *options,
                          const struct study_options *run, FILE *stream) {
    const char *const place = getenv("TMPDIR");
    struct arena *const arena = arena_create(values->arena, "a comparison");
    char *const folder = arena_text(arena, "%s/shoal-compare-XXXXXX", place && *place ? place : "/tmp");
    if (!mkdtemp(folder)) {
        return status_fail(STATUS_FILE, "%s: cannot create this folder (%s): set TMPDIR to another folder", folder,
                           strerror(errno));
    }
    arena_defer(arena, folder_remove, folder);
    const enum status status = run_in_folder(arena, folder, values, options, run, stream);
    arena_free(arena);
    return status;
}

// ---- the report of errors

/* Read and judge the members in a folder, add the members required by the error bound, and repeat; then report. Unless
 * options is NULL, run new members first. */
static enum status refine_and_report(struct arena *arena, struct error_sweep *sweep, const char *folder,
                                     const struct study_options *options, const char *command, bool strict,
                                     FILE *stream, FILE *warnings) {
    const struct case_values *const study = &sweep->study;
    struct error_study *const first = &sweep->point[0];
    struct member_file *members;
    int most_members = INT_MAX, n_failed;

    // without runs, the members before the first missing member
    for (int m = 0; !options && most_members == INT_MAX; m++) {
        if (access(study_folder_member(arena, folder, m, ".nc"), F_OK) != 0) most_members = m;
    }
    for (;;) {
        struct arena *const round = arena_create(arena, owner);
        if (options) TRY(study_run(study, options, &n_failed));
        TRY(study_folder_read_members(round, &members, study, folder));
        convergence_sweep_judge(sweep, members);
        if (convergence_study_refine(first, members, most_members) == 0) break;
        arena_free(round);
    }

    // request all memory before the files are written, because they have to be there also after a bound was missed
    const struct convergence_orders none = {0};
    const char *const table = study_folder_path(arena, folder, "study.nc");
    const char *const csv = study_folder_path(arena, folder, "error.csv");
    enum status status = study_print_errors(first, members, stream);

    // expectations concern the cases of the points, which are the first members
    struct sweep_axis axis = *study->sweep;
    struct case_values points = *study;
    points.sweep = &axis;
    axis.n_values = sweep->n_points;
    const enum status expected = study_expect(&points, members, stream);
    if (status == STATUS_OK) status = expected;

    // deliberately coarse levels have separate warnings, which are not printed
    const bool is_one = sweep->n_swept == 0;
    int n = study_print_warnings(arena, &members[is_one ? first->stated : 0], is_one ? 1 : sweep->n_points, warnings);
    const struct error_study *const against = sweep->against;
    if (against) n += study_print_warnings(arena, &members[against->base], 1, warnings);
    if (strict && n > 0 && status == STATUS_OK) {
        status = status_fail(STATUS_MISSED, "%d warning%s about the stated value%s, with --strict", n, n > 1 ? "s" : "",
                             is_one ? "" : "s");
    }
    TRY(end_texts(stream, warnings));
    TRY(study_file_write(arena, table, study, members, &none, sweep, command));
    TRY(study_print_csv(sweep, csv));
    return status == STATUS_OK ? test_completeness(study, members, folder) : status;
}

enum status study_errors(const struct case_values *values, const struct study_options *options, int plan, bool strict,
                         FILE *stream, FILE *warnings) {
    ARENA(arena, NULL, owner);
    struct error_sweep *sweep;
    TRY(error_plan_create(arena, &sweep, values, options));
    if (options->from && !sweep->point[0].is_steady) {
        return status_fail(STATUS_CASE, "--from %s: starts a search: ask for quantities of a steady state (steady_...)",
                           options->from);
    }
    if (options->from && access(options->from, R_OK) != 0) {
        return status_fail(STATUS_FILE, "--from %s: cannot be read: %s", options->from, strerror(errno));
    }
    if (plan > 0) {
        const int n = options->n_processes > 0 ? options->n_processes : omp_get_num_procs() / values->school.threads;
        TRY(study_print_plan(sweep, n < 1 ? 1 : n, options, stream));
    }
    if (plan == 2) return STATUS_OK;
    fflush(stream);
    return refine_and_report(arena, sweep, options->folder, options, options->command, strict, stream, warnings);
}

// ---- gather and info

enum status study_gather(const char *folder, const char *command, bool strict, FILE *stream, FILE *warnings) {
    ARENA(arena, NULL, owner);
    const char *text;
    struct case_values *study;
    TRY(study_folder_find_study(arena, folder, &text));
    TRY(study_folder_parse(arena, &study, text, folder, 0, NULL));
    if (!study->error) return study_report(study, folder, NULL, command, strict, stream, warnings);
    struct error_sweep *sweep;
    TRY(error_plan_create(arena, &sweep, study, NULL));
    return refine_and_report(arena, sweep, folder, NULL, command, strict, stream, warnings);
}

enum status study_info(const struct netcdf_reader *reader, FILE *stream) {
    struct arena *const arena = reader->arena;
    struct case_values *study;
    struct member_file *members;
    int n, n_complete = 0;
    TRY(study_file_read(reader, &study, &members, &n));

    // the number of members, the number of complete members and the axes
    for (int m = 0; m < n; m++) n_complete += member_file_is_complete(&members[m]);
    fprintf(stream, "  %-10s  %d, %d of them complete\n", "members", n, n_complete);
    for (int a = 0; a < study->n_axes; a++) {
        const struct sweep_axis *const axis = &study->sweep[a];
        fprintf(stream, "  axis %-5d  %d values of ", a, axis->n_values);
        for (int k = 0; k < axis->n_keys; k++) fprintf(stream, "%s%s", k > 0 ? ", " : "", axis->key[k].path);
        fprintf(stream, "%s\n", axis->refine ? ", refined" : "");
    }
    fprintf(stream, "\n");

    // a missed expectation belongs to the contents of the file
    enum status status;
    if (study->error) {
        // refine up to the members of the file
        struct error_sweep *sweep;
        TRY(error_plan_create(arena, &sweep, study, NULL));
        if (sweep_n_members(&sweep->study) > n) {
            return status_fail(STATUS_FILE,
                               "the file has %d members, expected %d: write study.nc again with `shoal gather`", n,
                               sweep_n_members(&sweep->study));
        }
        do {
            convergence_sweep_judge(sweep, members);
        } while (convergence_study_refine(&sweep->point[0], members, n) > 0);
        status = study_print_errors(&sweep->point[0], members, stream);
    } else {
        struct convergence_orders orders;
        convergence_orders_create(arena, &orders, study, members);
        (compare_is(study) ? compare_print : study_print)(arena, study, members, stream);
        status = print_expected(arena, study, members, &orders, stream);
    }
    if (status == STATUS_MISSED) fprintf(stream, "missed: %s\n", status_message());
    if (!study->error && !compare_is(study)) study_print_warnings(arena, members, n, stream);
    return status == STATUS_MISSED ? STATUS_OK : status;
}
