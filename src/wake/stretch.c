/* stretch.c: the forms of a stretch, and the passes that drop and restore markers. */
#include "wake/stretch.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// the least and largest ratio of the durations of neighbours for a form of more than two markers
static const double least_ratio = 0.2, largest_ratio = 8;

// the least length of a stretch that gets its middle marker back, over the largest length of two that lose it, near
// bodies and elsewhere; above 1, so that no marker comes and goes
static const double restored_over_dropped[] = {1.1, 1.5};

// the largest distance of a stretch near a body from its middle node, in lengths of the body: one from its ends
static const double near_body = 1.5;

// times are multiples of the interval, but for rounding
static const double time_rounding = 1e-6;

static bool is_near(double one, double other, const struct school *school) {
    return fabs(one - other) < time_rounding * school->interval;
}

/* The Lagrange polynomials l_a of n nodes are scale_a times the product of tau - node_b over all b but a. */
static void find_scales(int n, const double *node, double scale[STRETCH_MARKERS]) {
    for (int a = 0; a < n; a++) {
        double product = 1;
        for (int b = 0; b < n; b++) product *= b == a ? 1 : node[a] - node[b];
        scale[a] = 1 / product;
    }
}

// the polynomials and their slopes at tau
static void evaluate_polynomials(int n, const double *node, const double *scale, double tau,
                                 double value[STRETCH_MARKERS], double slope[STRETCH_MARKERS]) {
    // products of the factors before node a, then times those behind it
    double product = 1, rate = 0;
    for (int a = 0; a < n; a++) {
        value[a] = scale[a] * product;
        slope[a] = scale[a] * rate;
        rate = rate * (tau - node[a]) + product;
        product *= tau - node[a];
    }
    product = 1;
    rate = 0;
    for (int a = n - 1; a >= 0; a--) {
        slope[a] = slope[a] * product + value[a] * rate;
        value[a] *= product;
        rate = rate * (tau - node[a]) + product;
        product *= tau - node[a];
    }
}

typedef double parts[STRETCH_MARKERS][STRETCH_MARKERS];

// the integrals of l_a dl_b over the stretch `middle` between n nodes, by n - 1 Gauss points, which are exact; gap: the
// durations of the stretches
static void find_parts(int n, const double *gap, int middle, parts to) {
    static const double cubic[2][3] = {{0.1127016653792583, 0.5, 0.8872983346207417}, {5. / 18, 8. / 18, 5. / 18}};
    static const double quintic[2][5] = {
        {0.04691007703066800, 0.2307653449471585, 0.5, 0.7692346550528415, 0.9530899229693320},
        {0.1184634425280945, 0.2393143352496832, 0.2844444444444444, 0.2393143352496832, 0.1184634425280945}};
    const double *const place = n == 4 ? cubic[0] : quintic[0], *const weight = n == 4 ? cubic[1] : quintic[1];
    double node[STRETCH_MARKERS] = {0}, scale[STRETCH_MARKERS];
    for (int k = 0; k + 1 < n; k++) node[k + 1] = node[k] + gap[k];
    find_scales(n, node, scale);
    memset(to, 0, sizeof(parts));
    for (int p = 0; p < n - 1; p++) {
        double value[STRETCH_MARKERS], slope[STRETCH_MARKERS];
        evaluate_polynomials(n, node, scale, node[middle] + place[p] * gap[middle], value, slope);
        for (int a = 0; a < n; a++) {
            const double weighted = weight[p] * gap[middle] * value[a];
            for (int b = 0; b < n; b++) to[a][b] += weighted * slope[b];
        }
    }
}

/* Durations of neighbours over that of the stretch itself, on dyadic levels. A form is the same at any scale of time,
 * so these serve almost all old stretches. */
enum { MIDDLE = STRETCH_MARKERS / 2 - 1, N_RATIOS = 6, N_FORMS = N_RATIOS * N_RATIOS * N_RATIOS * N_RATIOS };
static const double ratios[N_RATIOS] = {0.25, 0.5, 1, 2, 4, 8};

struct stretch_forms {
    parts part[N_FORMS];
};

const struct stretch_forms *stretch_forms_create(struct arena *arena) {
    struct stretch_forms *forms;
    NEW(arena, forms, 1);
    for (int i = 0; i < N_FORMS; i++) {
        double gap[STRETCH_MARKERS - 1];
        for (int k = STRETCH_MARKERS - 2, rest = i; k >= 0; k--) {
            gap[k] = k == MIDDLE ? 1 : ratios[rest % N_RATIOS];
            if (k != MIDDLE) rest /= N_RATIOS;
        }
        find_parts(STRETCH_MARKERS, gap, MIDDLE, forms->part[i]);
    }
    return forms;
}

// the number of the form with these durations, or -1 if there is none
static int find_form(const double gap[STRETCH_MARKERS - 1], const struct school *school) {
    int form = 0;
    for (int k = 0; k < STRETCH_MARKERS - 1; k++) {
        if (k == MIDDLE) continue;
        int i = 0;
        while (i < N_RATIOS && !is_near(gap[k], ratios[i] * gap[MIDDLE], school)) i++;
        if (i == N_RATIOS) return -1;
        form = form * N_RATIOS + i;
    }
    return form;
}

void stretch_set_form(struct stretch_form *form, const struct wake *wake, const struct school *school, int j) {
    // the highest degree that the markers and their times allow
    for (int n = STRETCH_MARKERS; n > 2 && j < wake->n_old; n -= 2) {
        const int first = j + 1 > n / 2 ? j + 1 - n / 2 : 0;
        const double own = wake->birth[j + 1] - wake->birth[j];
        double gap[STRETCH_MARKERS - 1];
        bool is_smooth = first + n <= wake->n_vortex;
        for (int k = 0; k < n - 1 && is_smooth; k++) {
            gap[k] = wake->birth[first + k + 1] - wake->birth[first + k];
            is_smooth = gap[k] > 0 && gap[k] >= least_ratio * own && gap[k] <= largest_ratio * own;
        }
        if (!is_smooth) continue;

        form->first = first;
        form->n = n;
        form->part = form->other;
        const int known = n == STRETCH_MARKERS && j - first == MIDDLE ? find_form(gap, school) : -1;
        if (known >= 0) {
            form->part = wake->forms->part[known];
        } else {
            find_parts(n, gap, j - first, form->other);
        }
        return;
    }

    // half of the stretch at both ends
    static const parts half = {{-0.5, 0.5}, {-0.5, 0.5}};
    form->first = j;
    form->n = 2;
    form->part = half;
}

// ---- the old part

// the vector along stretch j, and its length
static double stretch_along(const struct wake *wake, int j, double along[2]) {
    along[0] = wake->x[j + 1] - wake->x[j];
    along[1] = wake->y[j + 1] - wake->y[j];
    return sqrt(along[0] * along[0] + along[1] * along[1]);
}

void stretch_find_old(struct wake *wake, const struct fish *fish, const struct school *school) {
    const double far = 0.5, farthest = 1, lengths = 16;  // of the fish; of the stretch
    const int resolved = 16, newest = 6;  // intervals of a decay; stretches, of which some have several points
    const int tail = wake->n_vortex - 1;
    if (!wake->has_markers || school->decay < resolved * school->interval) return;
    while (wake->n_old < tail - newest) {
        const int j = wake->n_old;
        double along[2];
        const double away[2] = {wake->x[j + 1] - wake->x[tail], wake->y[j + 1] - wake->y[tail]};
        const double wide = fmin(lengths * stretch_along(wake, j, along), farthest * fish->length);
        const double least = fmax(far * fish->length, wide);
        if (away[0] * away[0] + away[1] * away[1] < least * least) break;
        wake->n_old++;
        wake->version++;
    }
}

// whether the times allow to drop marker i
static bool is_odd(const struct wake *wake, const struct fish *fish, const struct school *school, int i) {
    const double gap = wake->birth[i] - wake->birth[i - 1], next = wake->birth[i + 1] - wake->birth[i];
    const double longest = fmin(1 / (12 * fish_rate(school, fish)), school->decay / 8);
    if (!(gap > 0) || !is_near(gap, next, school) || 2 * gap > longest * (1 + time_rounding)) return false;
    const double number = wake->birth[i] / gap, nearest = round(number);
    return fabs(number - nearest) < 1e-3 && fabs(fmod(nearest, 2)) > 0.5;
}

// the largest distance between the neighbours of a marker that can be dropped
static double most_spacing(const struct fish *fish, const struct school *school) {
    const double depth = fish->strip_depth > 0 ? fish->strip_depth / 2 : INFINITY;
    return school->wake_spacing * fmin(fish->smoothing, depth);
}

void stretch_drop(struct wake *wake, const struct fish *fish, const struct school *school) {
    const double cosine = 0.86602540378443865;  // of 30 degrees
    const double most = most_spacing(fish, school);
    double a[2], b[2];

    // the way along the sheet from the oldest marker to the tail
    double way = 0;
    for (int j = 0; j + 1 < wake->n_vortex; j++) way += stretch_along(wake, j, a);

    for (int i = 1; i < wake->n_old; i++) {
        const double before = stretch_along(wake, i - 1, a), behind = stretch_along(wake, i, b);
        way -= before;
        const bool is_straight = before > 0 && behind > 0 && a[0] * b[0] + a[1] * b[1] >= cosine * before * behind;
        const bool is_close = before + behind <= fmin(most, 0.1 * (way - behind));
        if (!is_straight || !is_close || !is_odd(wake, fish, school, i)) continue;

        // the number i now belongs to the next marker, which stays
        wake_drop(wake, i);
        way -= behind;
    }
}

// whether the middle of stretch j is near a body
static bool is_near_body(const struct wake *wake, const struct school *school, const double *y, int j) {
    const double x = (wake->x[j] + wake->x[j + 1]) / 2, across = (wake->y[j] + wake->y[j + 1]) / 2;
    for (int f = 0; f < school->n_fish; f++) {
        const struct fish *const fish = &school->fish[f];
        const int middle = fish->n_nodes / 2;
        const double away[2] = {y[fish->at.x + middle] - x, y[fish->at.y + middle] - across};
        const double reach = near_body * fish->length;
        if (away[0] * away[0] + away[1] * away[1] < reach * reach) return true;
    }
    return false;
}

void stretch_restore(struct wake *wake, const struct fish *fish, const struct school *school, const double *y) {
    const double most = most_spacing(fish, school);
    struct stretch_form form;
    double along[2];
    for (int j = 1; j < wake->n_old; j++) {
        // an even number of intervals: a marker was dropped in the middle
        const double duration = (wake->birth[j + 1] - wake->birth[j]) / school->interval;
        if (duration < 1.5 || fabs(fmod(round(duration), 2)) > 0.5) continue;
        const double length = stretch_along(wake, j, along);
        if (!(length > restored_over_dropped[0] * most)) continue;
        if (!(length > restored_over_dropped[1] * most) && !is_near_body(wake, school, y, j)) continue;
        stretch_set_form(&form, wake, school, j);
        if (form.n < STRETCH_MARKERS) continue;

        const double *const node = wake->birth + form.first;
        double scale[STRETCH_MARKERS], value[STRETCH_MARKERS], slope[STRETCH_MARKERS];
        find_scales(form.n, node, scale);
        evaluate_polynomials(form.n, node, scale, (wake->birth[j] + wake->birth[j + 1]) / 2, value, slope);
        wake_insert(wake, j, form.first, form.n, value);

        // the next stretch is the newer half of this one
        j++;
    }
}
