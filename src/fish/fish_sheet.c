/* fish_sheet.c: cosine points on the polygon or the smooth curve. */
#include "fish/fish_sheet.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

static enum status sheet_allocate(struct fish *fish) {
    double **const per_control[] = {&fish->end_correction, &fish->control_density, &fish->control_interval};
    TRY(MEMORY_NEW(fish->sheet_weight, fish->n_sheet, "the sheet of a fish"));
    TRY(MEMORY_ARRAYS(per_control, fish->n_control, "the sheet of a fish"));
    fish->sheet_point = calloc((size_t)fish->n_sheet, sizeof *fish->sheet_point);
    fish->sheet_slope = calloc((size_t)fish->n_sheet, sizeof *fish->sheet_slope);
    fish->control_point = calloc((size_t)fish->n_control, sizeof *fish->control_point);
    fish->control_tangent = calloc((size_t)fish->n_control, sizeof *fish->control_tangent);

    if (!fish->sheet_point || !fish->sheet_slope || !fish->control_point || !fish->control_tangent) {
        return status_fail(STATUS_MEMORY, "out of memory: %d points of a sheet", fish->n_sheet);
    }

    return STATUS_OK;
}

// sigma at j intervals of the angle from the nose
static double cosine_place(const struct fish *fish, double j) {
    const int last = fish->n_sheet - 1;
    return j == last ? 1 : (1 - cos(M_PI * j / last)) / 2;
}

// sigma of a control point
static double control_place(const struct fish *fish, int c, enum collocation collocation) {
    if (collocation == COLLOCATION_CHEBYSHEV) return cosine_place(fish, c + 0.5);
    return (cosine_place(fish, c) + cosine_place(fish, c + 1)) / 2;
}

static void sheet_set_on_polygon(struct fish *fish, enum collocation collocation) {
    for (int j = 0; j < fish->n_sheet; j++) {
        fish->sheet_point[j] = curve_polygon_point(fish->curve, cosine_place(fish, j) * fish->n_edges);
    }

    for (int c = 0; c < fish->n_control; c++) {
        const struct stencil *const a = &fish->sheet_point[c], *const b = &fish->sheet_point[c + 1];
        fish->control_point[c] = collocation == COLLOCATION_CHEBYSHEV
                                     ? curve_polygon_point(fish->curve, cosine_place(fish, c + 0.5) * fish->n_edges)
                                     : curve_polygon_middle(fish->curve, a, b);
        fish->control_tangent[c] = (struct tangent){.from = *a, .to = *b};
    }

    fish->tail_tangent = fish->control_tangent[fish->n_control - 1];
}

static void sheet_set_on_smooth_curve(struct fish *fish, enum collocation collocation) {
    const int last = fish->n_sheet - 1;
    for (int j = 0; j <= last; j++) {
        const double u = cosine_place(fish, j) * fish->n_edges;
        fish->sheet_point[j] = curve_smooth_point(fish->curve, u);
        if (j == 0 || j == last) continue;  // quadrature weight 0
        fish->sheet_slope[j] = curve_smooth_slope(fish->curve, u);
        fish->sheet_weight[j] = fish->length / 2 * sin(M_PI * j / last) * M_PI / last;
    }

    for (int c = 0; c < last; c++) {
        const double u = control_place(fish, c, collocation) * fish->n_edges;
        fish->control_point[c] = curve_smooth_point(fish->curve, u);
        fish->control_tangent[c].to = curve_smooth_slope(fish->curve, u);
    }

    fish->tail_tangent.to = curve_smooth_slope(fish->curve, fish->n_edges);
    fish->nose_tangent.to = curve_smooth_slope(fish->curve, 0);
}

// set E_c, for a sheet with the vortex strength of the wake at the tail
static void end_correction_set(struct fish *fish) {
    const int last = fish->n_sheet - 1;
    const double h = M_PI / last, weight = fish->length / 2 * h * sin(M_PI * (last - 1) / last);
    for (int c = 0; c < fish->n_control; c++) {
        const double place = cosine_place(fish, c + 0.5);
        double quadrature = 0;
        for (int j = 1; j < last; j++) {
            const double sigma = cosine_place(fish, j);
            quadrature += h / 2 * sin(j * h) * sigma / (2 * M_PI * (place - sigma));
        }

        const double exact = (place * log(place / (1 - place)) - 1) / (2 * M_PI);
        fish->end_correction[c] = (exact - quadrature) / weight;
    }
}

// bound vortices and control points: doc/model.md, section 6
static enum status sheet_set(struct fish *fish, const struct sheet_parameters *sheet, enum shedding shedding) {
    for (int j = 1; j < fish->n_sheet; j++) {
        const double distance = cosine_place(fish, j) - cosine_place(fish, j - 1);
        fish->sheet_weight[j - 1] += distance * fish->length / 2;
        fish->sheet_weight[j] += distance * fish->length / 2;
    }

    // place the points on the line of the body
    const int is_smooth = sheet->curve == BODY_LINE_SMOOTH;
    TRY(curve_create(&fish->curve, fish->n_nodes, is_smooth ? 1 : 2 * fish->n_sheet,
                     is_smooth ? 4 * fish->n_sheet + 1 : 0));

    if (is_smooth) {
        sheet_set_on_smooth_curve(fish, sheet->collocation);
    } else {
        sheet_set_on_polygon(fish, sheet->collocation);
    }

    if (shedding == SHEDDING_SHEET) end_correction_set(fish);
    fish->heading_point = curve_polygon_point(fish->curve, 1.0 / 3.0 * fish->n_edges);
    return STATUS_OK;
}

// w and dw/du at u: monotone cubics between edge midpoints, slope 0 at both ends, constant beyond
static void strip_depth_at(const struct fish *fish, double u, double *depth, double *slope) {
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
    *depth = w[k] + q * (tangent[0] + q * (c2 + q * c3));
    *slope = u <= 0.5 || u >= fish->n_edges - 0.5 ? 0 : tangent[0] + q * (2 * c2 + 3 * q * c3);
}

static double strip_half(const struct fish *fish, double u) {
    double depth, slope;
    strip_depth_at(fish, u, &depth, &slope);
    return depth * depth / 32;
}

// the strip of the sheets of the body: doc/model.md, section 18
static enum status strip_set(struct fish *fish) {
    const int n_points = fish->n_control + fish->n_edges + 1;
    TRY(MEMORY_NEW(fish->sheet_half, fish->n_sheet, "the sheet of a fish"));
    TRY(MEMORY_NEW(fish->point_half, n_points, "the sheet of a fish"));
    TRY(MEMORY_NEW(fish->control_widening, fish->n_control, "the sheet of a fish"));
    fish->strip_depth = fish->depth[fish->n_edges - 1];
    for (int k = 0; k < fish->n_edges; k++) fish->depth_varies |= fabs(fish->depth[k] - fish->strip_depth) > 0;
    for (int j = 0; j < fish->n_sheet; j++)
        fish->sheet_half[j] = strip_half(fish, cosine_place(fish, j) * fish->n_edges);

    for (int c = 0; c < fish->n_control; c++) {
        double depth, slope;
        strip_depth_at(fish, cosine_place(fish, c + 0.5) * fish->n_edges, &depth, &slope);
        fish->point_half[c] = depth * depth / 32;
        fish->control_widening[c] = depth * slope / 16;
    }

    for (int k = 0; k < fish->n_edges; k++) fish->point_half[fish->n_control + k] = strip_half(fish, k + 0.5);
    fish->point_half[n_points - 1] = strip_half(fish, fish->n_edges);
    return STATUS_OK;
}

// the pressure of the bound sheet: doc/model.md, section 15
static enum status pressure_set(struct fish *fish, const struct fish_parameters *from, double density, int is_strip) {
    if (fish->force != FORCE_PRESSURE && !is_strip) return STATUS_OK;
    const double h = M_PI / fish->n_control;
    double *per_edge;
    if (is_strip) TRY(strip_set(fish));
    TRY(MEMORY_NEW(per_edge, fish->n_edges, "the pressure of a fish"));
    for (int k = 0; k < fish->n_edges; k++) per_edge[k] = density * (is_strip ? fish->strip_depth : fish->depth[k]);

    for (int c = 0; c < fish->n_control; c++) {
        fish->control_density[c] = per_edge[(int)(cosine_place(fish, c + 0.5) * fish->n_edges)];
        fish->control_interval[c] = fish->n_edges / 2.0 * sin((c + 0.5) * h) * h;
    }

    fish->fluid_density = density;
    fish->nose_factor = fish->n_control * fish->sheet_weight[0] / (M_PI * fish->length);
    // the unknowns of a strip are circulations times w(s)/w_L
    if (is_strip) fish->nose_factor *= fish->strip_depth / fish->depth[0];
    fish->full_suction = M_PI * (density * fish->depth[0]) * fish->length;
    fish->suction = from->suction * fish->full_suction;
    fish->suction_limit = from->suction_limit;
    const enum status status = sheet_integrals_create(&fish->integrals, fish->n_nodes, fish->n_sheet, per_edge);
    free(per_edge);

    return status;
}

enum status fish_sheet_set(struct fish *fish, const struct fish_parameters *from,
                           const struct school_parameters *parameters) {
    TRY(sheet_allocate(fish));
    TRY(sheet_set(fish, &parameters->sheet, parameters->wake.shedding));
    int is_strip = 0;
    for (int f = 0; f < parameters->n_fish; f++) is_strip |= fish_is_strip(&parameters->fish[f]);
    return pressure_set(fish, from, parameters->fluid.density, is_strip);
}

int fish_is_strip(const struct fish_parameters *from) {
    return from->force == FORCE_PRESSURE && from->span == SPAN_FINITE;
}

int fish_sheet_least(const struct fish_parameters *from) {
    if (!fish_is_strip(from)) return 0;
    double depth = from->body.depth * from->length;
    for (int k = 0; from->body.profile == PROFILE_TABLE && k < from->body.depth_table.n; k++) {
        depth = k == 0 ? from->body.depth_table.value[0] : fmin(depth, from->body.depth_table.value[k]);
    }

    const double least = ceil(1 + 5 * from->length / depth * (1 - 1e-9));
    return least < 1e6 ? (int)least : 1000000;
}
