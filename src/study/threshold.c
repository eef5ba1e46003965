/* threshold.c: secants to the zero of an uncertain quantity. */
#include "study/threshold.h"

#include <math.h>
#include <stdbool.h>

#include "base/mathematics.h"

/* The search ends when the last secant is shorter than this part of the error by the excess. */
static const double part_of_error = 0.25;

/* A secant steeper than this multiple of the first one may cross a jump between two branches: then bisections follow
 * until the sides are neighbours, between which the excess may still change by this part of its first change. */
static const double steep = 20, part_of_jump = 0.01;

/* MOST_STAYS: a bisection also follows if one side stays so often. */
enum { MOST_POINTS = 40, MOST_STAYS = 3 };

/* Two points give a slope if their excesses differ by this multiple of the larger error. */
static const double distinct = 4;

/* The slope of the excess near a place: from the two nearest points that differ by more than their errors. NaN: no two
 * points do. */
static double slope_near(const struct threshold_search *search, double at) {
    double slope = NAN, least = INFINITY;
    for (int i = 0; i < search->n; i++) {
        for (int j = 0; j < i; j++) {
            const struct threshold_point *const a = &search->point[i], *const b = &search->point[j];
            const double away = larger(fabs(a->at - at), fabs(b->at - at));
            const double rise = a->excess - b->excess;
            if (away >= least || !(fabs(rise) > distinct * larger(a->error, b->error))) continue;
            least = away;
            slope = rise / (a->at - b->at);
        }
    }
    return slope;
}

static enum status find_point(struct arena *arena, struct threshold_search *search, double at) {
    struct threshold_point point = {.at = at};
    TRY(search->find(search->data, &point));
    GROW(arena, search->point, search->n + 1);
    search->point[search->n++] = point;
    return STATUS_OK;
}

enum status threshold_solve(struct arena *arena, struct threshold_search *search, int a, int b,
                            struct threshold *found) {
    struct threshold_point side[] = {search->point[a], search->point[b]};
    const double first_change = fabs(side[1].excess - side[0].excess);
    const double first_slope = first_change / fabs(side[1].at - side[0].at);

    // secants between the two sides; the weight of a side that stays twice is halved (Illinois)
    double weight[2] = {1, 1};
    int stayed = -1, n_stays = 0;
    for (int n = 0;; n++) {
        const int near = fabs(side[1].excess) < fabs(side[0].excess);
        const double width = side[1].at - side[0].at, change = side[1].excess - side[0].excess;
        const bool is_distinct = fabs(change) > distinct * larger(side[0].error, side[1].error);
        const bool is_steep = is_distinct && fabs(change / width) > steep * first_slope;
        const bool are_neighbours = fabs(width) <= search->shortest;
        if (are_neighbours && is_distinct && fabs(change) > part_of_jump * first_change) {
            return status_fail(STATUS_SOLVER,
                               "no threshold: the stability jumps there, because the states on the two sides are of "
                               "different branches");
        }

        // judge the secant without the weights
        found->at = side[near].at - side[near].excess * width / change;
        found->slope = slope_near(search, found->at);
        found->by_error = side[near].error / fabs(found->slope);
        found->by_secant = fabs(found->at - side[near].at);
        if (isnan(found->slope)) {
            return status_fail(STATUS_SOLVER,
                               "undecided: the multipliers differ by less than their errors: move the ends apart, or "
                               "reduce the errors");
        }
        const bool is_near = found->by_secant <= larger(part_of_error * found->by_error, search->shortest);
        if (is_near && (are_neighbours || !is_steep)) return STATUS_OK;
        if (n == MOST_POINTS) {
            return status_fail(STATUS_SOLVER, "no threshold after %d secants: the excess changes too irregularly", n);
        }

        const double low = weight[0] * side[0].excess, high = weight[1] * side[1].excess;
        const bool bisects = is_steep || n_stays >= MOST_STAYS;
        TRY(find_point(arena, search, bisects ? side[0].at + width / 2 : side[0].at - low * width / (high - low)));
        const struct threshold_point now = search->point[search->n - 1];
        const int replaced = (now.excess > 0) != (side[0].excess > 0);
        side[replaced] = now;
        weight[replaced] = 1;
        n_stays = stayed == !replaced && !bisects ? n_stays + 1 : 0;
        if (stayed == !replaced) weight[!replaced] /= 2;
        stayed = !replaced;
    }
}
