/* fish_sheet.c: sets the constants of the bound sheet: its points, at cosine spacing on the polygon or on the smooth
 * curve, the strip of a sheet of finite span, and what the pressure needs. doc/model.md, sections 6, 15 and 18. */
#include "fish/fish_sheet.h"

#include <math.h>
#include <string.h>

#include "fish/fish_school.h"
#include "fish/shape.h"
#include "fish/sheet_integrals.h"

double fish_sheet_place(const struct fish *fish, double j) {
    const int last = fish->n_sheet - 1;
    return j == last ? 1 : (1 - cos(M_PI * j / last)) / 2;
}

double fish_sheet_index(const struct fish *fish, double place) {
    return acos(1 - 2 * place) / M_PI * (fish->n_sheet - 1);
}

// the points on the line of the body: vortices, control points between them, and tangents
static enum status points_set(struct arena *arena, struct fish *fish, bool is_smooth, bool is_chebyshev,
                              const volatile sig_atomic_t *stop) {
    const int n = fish->n_sheet, last = n - 1;
    struct curve *const curve = curve_create(arena, fish->n_nodes, is_smooth ? 1 : 2 * n, is_smooth ? 4 * n + 1 : 0);
    fish->curve = curve;
    for (int j = 0; j <= last; j++) {
        TRY(status_ask(stop));
        const double u = fish_sheet_place(fish, j) * fish->n_edges;
        fish->sheet_point[j] = is_smooth ? curve_smooth_point(curve, u) : curve_polygon_point(curve, u);
        if (!is_smooth || j == 0 || j == last) continue;  // quadrature weight 0
        fish->sheet_slope[j] = curve_smooth_slope(curve, u);
        fish->sheet_weight[j] = fish->length / 2 * sin(M_PI * j / last) * M_PI / last;
    }

    for (int c = 0; c < last; c++) {
        TRY(status_ask(stop));
        const double at_angle = fish_sheet_place(fish, c + 0.5);
        if (is_smooth) {
            const double middle = (fish_sheet_place(fish, c) + fish_sheet_place(fish, c + 1)) / 2;
            const double u = (is_chebyshev ? at_angle : middle) * fish->n_edges;
            fish->control_point[c] = curve_smooth_point(curve, u);
            fish->control_tangent[c].to = curve_smooth_slope(curve, u);
        } else {
            const struct stencil *const a = &fish->sheet_point[c], *const b = &fish->sheet_point[c + 1];
            fish->control_point[c] =
                is_chebyshev ? curve_polygon_point(curve, at_angle * fish->n_edges) : curve_polygon_middle(curve, a, b);
            fish->control_tangent[c] = (struct tangent){.from = *a, .to = *b};
        }
    }

    fish->tail_tangent = fish->control_tangent[last - 1];
    if (is_smooth) fish->tail_tangent.to = curve_smooth_slope(curve, fish->n_edges);
    if (is_smooth) fish->nose_tangent.to = curve_smooth_slope(curve, 0);
    fish->heading_point = curve_polygon_point(curve, 1.0 / 3.0 * fish->n_edges);
    return STATUS_OK;
}

// add the weights of a point to a matrix by columns
static void weights_add(const struct stencil *point, double factor, int row, int n_rows, double *matrix) {
    for (int i = 0; i < point->n; i++) matrix[(long)point->node[i] * n_rows + row] += factor * point->weight[i];
}

// w at u, and dw/du: monotone cubics between edge midpoints, slope 0 at both ends, constant beyond
static double strip_depth(const struct fish *fish, double u, double *slope) {
    const double *const w = fish->depth, from = fmin(fmax(u - 0.5, 0), fish->n_edges - 1);
    const int k = (int)fmin(from, fish->n_edges - 2);
    double tangent[2] = {0, 0};
    for (int end = 0; end < 2; end++) {
        const int i = k + end;
        if (i == 0 || i == fish->n_edges - 1) continue;
        const double before = w[i] - w[i - 1], after = w[i + 1] - w[i];
        if (before * after > 0) tangent[end] = 2 * before * after / (before + after);
    }

    const double q = from - k, rise = w[k + 1] - w[k];
    const double c2 = 3 * rise - 2 * tangent[0] - tangent[1], c3 = tangent[0] + tangent[1] - 2 * rise;
    *slope = u <= 0.5 || u >= fish->n_edges - 0.5 ? 0 : tangent[0] + q * (2 * c2 + 3 * q * c3);
    return w[k] + q * (tangent[0] + q * (c2 + q * c3));
}

// the strip of the sheets of finite span: doc/model.md, section 18
static void strip_set(struct arena *arena, struct fish *fish, double leg_length) {
    NEW(arena, fish->sheet_half, fish->n_sheet);
    NEW(arena, fish->point_half, fish->n_control + fish->n_edges + 1);
    NEW(arena, fish->control_widening, fish->n_control);
    fish->strip_depth = fish->depth[fish->n_edges - 1];
    const double resolved = fmax(fish->strip_depth, fish->smoothing);
    fish->leg_length = leg_length * resolved * resolved / 8;
    for (int k = 0; k < fish->n_edges; k++) fish->depth_varies |= fabs(fish->depth[k] - fish->strip_depth) > 0;

    double slope;
    for (int j = 0; j < fish->n_sheet; j++) {
        const double depth = strip_depth(fish, fish_sheet_place(fish, j) * fish->n_edges, &slope);
        fish->sheet_half[j] = depth * depth / 32;
    }

    // the points of the flow: control points, edge midpoints, tail
    double *const half = fish->point_half;
    for (int c = 0; c < fish->n_control; c++) {
        const double depth = strip_depth(fish, fish_sheet_place(fish, c + 0.5) * fish->n_edges, &slope);
        half[c] = depth * depth / 32;
        fish->control_widening[c] = depth * slope / 16;
    }
    for (int k = 0; k <= fish->n_edges; k++) {
        const double depth = strip_depth(fish, k < fish->n_edges ? k + 0.5 : k, &slope);
        half[fish->n_control + k] = depth * depth / 32;
    }
}

// the pressure of the bound sheet: doc/model.md, section 15
static enum status pressure_set(struct arena *arena, struct fish *fish, int f, const struct fish_parameters *from,
                                const struct school_parameters *parameters, bool is_strip) {
    const double density = parameters->fluid.density, h = M_PI / fish->n_control;
    NEW(arena, fish->edge_density, fish->n_edges);
    double *const per_edge = fish->edge_density;
    for (int k = 0; k < fish->n_edges; k++) per_edge[k] = density * (is_strip ? fish->strip_depth : fish->depth[k]);

    for (int c = 0; c < fish->n_control; c++) {
        fish->control_density[c] = per_edge[(int)(fish_sheet_place(fish, c + 0.5) * fish->n_edges)];
        fish->control_interval[c] = fish->n_edges / 2.0 * sin((c + 0.5) * h) * h;
    }

    fish->fluid_density = density;
    fish->nose_factor = fish->n_control * fish->sheet_weight[0] / (M_PI * fish->length);
    // the unknowns of a strip are circulations times w(s)/w_L
    if (is_strip) fish->nose_factor *= fish->strip_depth / fish->depth[0];
    fish->full_suction = M_PI * (density * fish->depth[0]) * fish->length;
    fish->suction = from->suction * fish->full_suction;
    fish->suction_limit = from->suction_limit;

    // integrals over the sheet: of an earlier fish with the same nodes, sheet and densities, or new
    for (int back = 1; back <= f && back <= FISH_SHARED; back++) {
        const struct fish *const other = fish - back;
        if (!other->integrals || other->n_nodes != fish->n_nodes || other->n_sheet != fish->n_sheet) continue;
        if (memcmp(other->edge_density, per_edge, (size_t)fish->n_edges * sizeof *per_edge) != 0) continue;
        fish->integrals = other->integrals;
        return STATUS_OK;
    }
    return sheet_integrals_create(arena, &fish->integrals, fish->n_nodes, fish->n_sheet, per_edge, parameters->stop);
}

// the points of the sheet, their matrices, and the weights of the strengths
static enum status line_set(struct arena *arena, struct fish *fish, const struct school_parameters *parameters) {
    const bool is_smooth = parameters->sheet.curve == BODY_LINE_SMOOTH;
    const bool is_chebyshev = parameters->sheet.collocation == COLLOCATION_CHEBYSHEV;
    const int n_sheet = fish->n_sheet, n_control = fish->n_control, last = n_sheet - 1;
    NEW(arena, fish->sheet_weight, n_sheet);
    NEW(arena, fish->sheet_point, n_sheet);
    NEW(arena, fish->sheet_slope, n_sheet);
    NEW(arena, fish->control_point, n_control);
    NEW(arena, fish->control_tangent, n_control);
    NEW(arena, fish->end_correction, n_control);

    // circulations per unknown
    for (int j = 1; j < n_sheet; j++) {
        const double distance = fish_sheet_place(fish, j) - fish_sheet_place(fish, j - 1);
        fish->sheet_weight[j - 1] += distance * fish->length / 2;
        fish->sheet_weight[j] += distance * fish->length / 2;
    }

    TRY(points_set(arena, fish, is_smooth, is_chebyshev, parameters->stop));

    // the same points as full matrices
    NEW(arena, fish->sheet_by_node, fish->n_nodes * n_sheet);
    for (int i = 0; i < 2; i++) NEW(arena, fish->control_by_node[i], fish->n_nodes * n_control);
    for (int j = 0; j < n_sheet; j++) weights_add(&fish->sheet_point[j], 1, j, n_sheet, fish->sheet_by_node);
    for (int c = 0; c < n_control; c++) {
        const struct tangent *const tangent = &fish->control_tangent[c];
        weights_add(&fish->control_point[c], 1, c, n_control, fish->control_by_node[0]);
        weights_add(&tangent->to, 1, c, n_control, fish->control_by_node[1]);
        weights_add(&tangent->from, -1, c, n_control, fish->control_by_node[1]);
    }

    // E_c, for a sheet with the vortex strength of the wake at the tail
    const double h = M_PI / last, weight = fish->length / 2 * h * sin(M_PI * (last - 1) / last);
    for (int c = 0; c < n_control && parameters->wake.shedding == SHEDDING_SHEET; c++) {
        const double place = fish_sheet_place(fish, c + 0.5);
        double quadrature = 0;
        for (int j = 1; j < last; j++) {
            const double sigma = fish_sheet_place(fish, j);
            quadrature += h / 2 * sin(j * h) * sigma / (2 * M_PI * (place - sigma));
        }

        const double exact = (place * log(place / (1 - place)) - 1) / (2 * M_PI);
        fish->end_correction[c] = (exact - quadrature) / weight;
    }
    return STATUS_OK;
}

enum status fish_sheet_set(struct arena *arena, struct fish *fish, int f, const struct school_parameters *parameters,
                           bool is_strip) {
    const int n_sheet = fish->n_sheet, n_control = fish->n_control;
    NEW(arena, fish->control_density, n_control);
    NEW(arena, fish->control_interval, n_control);

    // of an earlier fish with the same nodes, sheet and length: one copy stays in the caches
    const struct fish *same = NULL;
    for (int back = 1; back <= f && back <= FISH_SHARED && !same; back++) {
        const struct fish *const other = fish - back;
        if (other->n_nodes != fish->n_nodes || other->n_sheet != n_sheet) continue;
        if (!(fabs(other->length - fish->length) > 0)) same = other;
    }
    if (same) {
        fish->curve = same->curve;
        fish->sheet_weight = same->sheet_weight;
        fish->sheet_point = same->sheet_point;
        fish->sheet_slope = same->sheet_slope;
        fish->control_point = same->control_point;
        fish->control_tangent = same->control_tangent;
        fish->tail_tangent = same->tail_tangent;
        fish->nose_tangent = same->nose_tangent;
        fish->heading_point = same->heading_point;
        fish->sheet_by_node = same->sheet_by_node;
        for (int i = 0; i < 2; i++) fish->control_by_node[i] = same->control_by_node[i];
        fish->end_correction = same->end_correction;
    } else {
        TRY(line_set(arena, fish, parameters));
    }
    if (is_strip) strip_set(arena, fish, parameters->wake.leg_length);
    if (fish->force != FORCE_PRESSURE && !is_strip) return STATUS_OK;
    return pressure_set(arena, fish, f, &parameters->fish[f], parameters, is_strip);
}

int fish_sheet_least(const struct fish_parameters *from) {
    if (!fish_is_strip(from)) return 0;
    double depth = from->body.depth * from->length;
    // the interpolation of pairs is monotone: no depth is below the values
    const struct number_list *const table = &from->body.depth_table;
    for (int k = 0; from->body.profile == PROFILE_TABLE && k < table->n; k++) {
        const double value = table->width == 2 ? table->value[2 * k + 1] : table->value[k];
        depth = k == 0 ? value : fmin(depth, value);
    }

    return (int)fmin(ceil(1 + 5 * from->length / depth * (1 - 1e-9)), 1e9);
}
