/* stretch.c: the linear and the cubic form of a stretch, and one pass that drops markers. */
#include "wake/stretch.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// the least and largest ratio of the durations of neighbours for a cubic form
static const double least_ratio = 0.2, largest_ratio = 8;

// times are multiples of the interval, but for rounding
static const double time_rounding = 1e-6;

static bool is_near(double one, double other, const struct school *school) {
    return fabs(one - other) < time_rounding * school->interval;
}

// the integrals of l_a dl_b over the stretch `middle` of three, by three Gauss points, which are exact
static void set_cubic(struct stretch_form *form, const double gap[3], int middle) {
    static const double place[3] = {0.1127016653792583, 0.5, 0.8872983346207417},
                        weight[3] = {5. / 18, 8. / 18, 5. / 18};
    const double node[STRETCH_MARKERS] = {0, gap[0], gap[0] + gap[1], gap[0] + gap[1] + gap[2]};
    memset(form->part, 0, sizeof form->part);
    for (int p = 0; p < 3; p++) {
        const double tau = node[middle] + place[p] * gap[middle];
        double value[STRETCH_MARKERS], slope[STRETCH_MARKERS];
        for (int a = 0; a < STRETCH_MARKERS; a++) {
            value[a] = 1;
            slope[a] = 0;
            for (int b = 0; b < STRETCH_MARKERS; b++) {
                if (b == a) continue;
                slope[a] = (slope[a] * (tau - node[b]) + value[a]) / (node[a] - node[b]);
                value[a] *= (tau - node[b]) / (node[a] - node[b]);
            }
        }
        for (int a = 0; a < STRETCH_MARKERS; a++) {
            for (int b = 0; b < STRETCH_MARKERS; b++) {
                form->part[a][b] += weight[p] * gap[middle] * value[a] * slope[b];
            }
        }
    }
}

void stretch_set_form(struct stretch_form *form, const struct wake *wake, const struct school *school, int j) {
    const int first = j > 0 ? j - 1 : 0;
    bool is_cubic = j < wake->n_old && first + STRETCH_MARKERS <= wake->n_vortex, is_known = form->n == STRETCH_MARKERS;
    double gap[3];
    for (int k = 0; k < 3 && is_cubic; k++) {
        gap[k] = wake->birth[first + k + 1] - wake->birth[first + k];
        is_known = is_known && is_near(gap[k], form->gap[k], school);
    }
    const double own = is_cubic ? gap[j - first] : 0;
    for (int k = 0; k < 3 && is_cubic; k++) {
        is_cubic = gap[k] > 0 && gap[k] >= least_ratio * own && gap[k] <= largest_ratio * own;
    }

    if (is_cubic) {
        // the form of the stretch before may serve again
        if (!is_known || j <= 1) set_cubic(form, gap, j - first);
        form->first = first;
        form->n = STRETCH_MARKERS;
        memcpy(form->gap, gap, sizeof gap);
        return;
    }

    // half of the stretch at both ends
    form->first = j;
    form->n = 2;
    for (int a = 0; a < 2; a++) {
        form->part[a][0] = -0.5;
        form->part[a][1] = 0.5;
    }
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

void stretch_drop(struct wake *wake, const struct fish *fish, const struct school *school) {
    const double cosine = 0.86602540378443865;  // of 30 degrees
    const double depth = fish->strip_depth > 0 ? fish->strip_depth / 2 : INFINITY;
    const double most = school->wake_spacing * fmin(fish->smoothing, depth);
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
