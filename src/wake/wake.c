/* wake.c: the queue of free vortices of one fish. */
#include "wake/wake.h"

#include <math.h>
#include <string.h>

#include "base/mathematics.h"

enum { N_ARRAYS = 10 };

static void wake_list_arrays(struct wake *wake, double **array[N_ARRAYS]) {
    double **const all[N_ARRAYS] = {&wake->x,        &wake->y,           &wake->u,     &wake->v,    &wake->u_before,
                                    &wake->v_before, &wake->circulation, &wake->birth, &wake->rate, &wake->rate_before};
    memcpy(array, all, sizeof all);
}

static void wake_grow(struct wake *wake, int capacity) {
    double **array[N_ARRAYS];
    wake_list_arrays(wake, array);
    for (int i = 0; i < N_ARRAYS; i++) GROW(wake->arena, *array[i], capacity);
    wake->capacity = capacity;
}

void wake_reserve(struct wake *wake, int n) {
    if (n > wake->capacity) wake_grow(wake, n + n / 2);
}

void wake_create(struct arena *arena, struct wake *wake, int capacity) {
    *wake = (struct wake){.arena = arena};
    wake_grow(wake, capacity);
}

int wake_most(const struct school *school, long n_events) {
    // one vortex is released at every event except the first (impulsive shedding: including the first) and lives for a
    // lifetime
    const double in_a_lifetime = ceil(school->lifetime / school->interval * (1 - 1e-9)) + 1;
    const double ever = (double)n_events + 1;
    return (int)fmin(fmin(in_a_lifetime, ever) + school->wake_spare, 2e9);
}

void wake_resize(struct wake *wake, int n) {
    wake_reserve(wake, n);
    wake->n_vortex = n;
}

void wake_release(struct wake *wake, double x, double y, double circulation, double birth) {
    wake_reserve(wake, wake->n_vortex + 1);
    const int i = wake->n_vortex++;
    wake->version++;

    wake->x[i] = x;
    wake->y[i] = y;
    wake->u[i] = wake->v[i] = wake->u_before[i] = wake->v_before[i] = 0;
    wake->circulation[i] = circulation;
    wake->rate[i] = wake->rate_before[i] = 0;
    wake->birth[i] = birth;
}

// without a decay time a vortex of continuous shedding vanishes within the last interval of its lifetime
static bool decays_in_one_interval(const struct school *school) {
    return school->decay <= 0 && school->shedding != SHEDDING_IMPULSIVE;
}

double wake_strength(const struct school *school, double age) {
    const double left = school->lifetime - age;
    if (decays_in_one_interval(school)) return fmax(0, fmin(1, left / school->interval));
    if (school->decay <= 0) return 1;
    // the vortex represents circulation shed half an interval before the release, on average
    return 1 - ramp_step((school->interval / 2 + school->decay - left) / school->decay);
}

// age from which the strength may be less than 1 within an interval
static double age_of_decay(const struct school *school) {
    return school->lifetime - fmax(school->decay + school->interval / 2, school->interval);
}

void wake_set_tail(struct wake *wake, const double velocity[2], const double tangent[2]) {
    wake->version++;
    wake->n_turns++;
    memcpy(wake->tail_velocity, velocity, sizeof wake->tail_velocity);
    memcpy(wake->tail_tangent, tangent, sizeof wake->tail_tangent);
}

double wake_aged(const struct school *school, double part) {
    return (1 - part) * school->lifetime;
}

double wake_age(const struct wake *wake, int i, double t) {
    return t - wake->birth[i] + wake->aged;
}

static double along_path(double x, double u, double u_before, double tau, double interval) {
    return x + tau * u + tau * tau / (2 * interval) * (u - u_before);
}

void wake_marker(const struct wake *wake, int i, double interval, double tau, double position[2]) {
    position[0] = along_path(wake->x[i], wake->u[i], wake->u_before[i], tau, interval);
    position[1] = along_path(wake->y[i], wake->v[i], wake->v_before[i], tau, interval);
}

double wake_label(const struct wake *wake, int i, double interval, double tau) {
    return along_path(wake->circulation[i], wake->rate[i], wake->rate_before[i], tau, interval);
}

double wake_circulation(const struct wake *wake, int i) {
    if (!wake->has_markers) return wake->circulation[i];
    const int older = i > 0 ? i - 1 : 0, newer = i + 1 < wake->n_vortex ? i + 1 : i;
    return (wake->circulation[newer] - wake->circulation[older]) / 2;
}

int wake_n_sources(const struct wake *wake) {
    return wake->has_markers && wake->n_vortex > 0 ? wake->n_vortex - 1 : wake->n_vortex;
}

double wake_source(const struct wake *wake, int i) {
    return wake->has_markers ? wake->circulation[i + 1] - wake->circulation[i] : wake->circulation[i];
}

// whether a vortex of this age keeps its whole strength until the next event
static bool is_whole(const struct school *school, double age) {
    return age + school->interval <= age_of_decay(school);
}

double wake_strength_within(const struct school *school, double age, double q) {
    if (is_whole(school, age)) return 1;
    const double now = wake_strength(school, age), next = wake_strength(school, age + school->interval);
    return now + q * (next - now);
}

void wake_places(const struct wake *wake, double interval, double tau, double *restrict x, double *restrict y) {
    for (int i = 0; i < wake->n_vortex; i++) {
        x[i] = along_path(wake->x[i], wake->u[i], wake->u_before[i], tau, interval);
        y[i] = along_path(wake->y[i], wake->v[i], wake->v_before[i], tau, interval);
    }
}

double wake_part_of_label(const struct wake *wake, const struct school *school, double t, double q, int i) {
    if (wake->has_markers && !school->finite) return 1;
    return wake_strength_within(school, wake_age(wake, i, t), q);
}

void wake_parts_of_labels(const struct wake *wake, const struct school *school, double t, double q, double *part) {
    // from the first whole label on all are whole, because births are in order
    int i = 0;
    for (; i < wake->n_vortex && !is_whole(school, wake_age(wake, i, t)); i++) {
        part[i] = wake_part_of_label(wake, school, t, q, i);
    }
    for (; i < wake->n_vortex; i++) part[i] = 1;
}

double wake_part_of_stretch(const struct wake *wake, const struct school *school, double t, double q, int j) {
    return school->finite ? 1 : wake_strength_within(school, wake_age(wake, j + 1, t), q);
}

double wake_part_of_marker(const struct wake *wake, const struct school *school, double t, double q, int i) {
    return school->finite ? 1 : wake_strength_within(school, wake_age(wake, i, t) - school->interval / 2, q);
}

double wake_strength_of(const struct wake *wake, const struct school *school, double t, double tau, int i) {
    const double part = wake_part_of_label(wake, school, t, tau / school->interval, i);
    return part * wake_label(wake, i, school->interval, tau);
}

void wake_labels(const struct wake *wake, double interval, double tau, double *restrict label) {
    for (int i = 0; i < wake->n_vortex; i++) label[i] = wake_label(wake, i, interval, tau);
}

void wake_strengths(const struct wake *wake, const struct school *school, double t, double tau, double *strength) {
    for (int i = 0; i < wake->n_vortex; i++) strength[i] = wake_strength_of(wake, school, t, tau, i);
}

void wake_advance(struct wake *wake, double interval) {
    wake->version++;
    for (int i = 0; i < wake->n_vortex; i++) {
        wake->x[i] = along_path(wake->x[i], wake->u[i], wake->u_before[i], interval, interval);
        wake->y[i] = along_path(wake->y[i], wake->v[i], wake->v_before[i], interval, interval);

        const double label = wake_label(wake, i, interval, interval);
        // the oldest label equals the removed circulation
        if (i == 0 && wake->has_markers) wake->removed += label - wake->circulation[i];
        wake->circulation[i] = label;
    }
}

void wake_remove_old(struct wake *wake, const struct school *school, double t) {
    // ages are multiples of the interval; the margin makes the comparison independent of rounding
    const double rounding = school->interval * (decays_in_one_interval(school) ? 1e-6 : 0.5);

    // the age of a stretch is the age of the newer marker
    const int newer = wake->has_markers;
    int n = 0;
    while (n + newer < wake->n_vortex && wake_age(wake, n + newer, t) > school->lifetime - rounding) {
        wake->removed += wake_source(wake, n++);
    }
    if (n == 0) return;

    wake->version++;
    wake->n_vortex -= n;
    double **array[N_ARRAYS];
    wake_list_arrays(wake, array);
    for (int i = 0; i < N_ARRAYS; i++) memmove(*array[i], *array[i] + n, (size_t)wake->n_vortex * sizeof **array[i]);
    wake->n_old = wake->n_old > n ? wake->n_old - n : 0;
}

void wake_drop(struct wake *wake, int i) {
    double **array[N_ARRAYS];
    wake_list_arrays(wake, array);
    for (int k = 0; k < N_ARRAYS; k++) {
        double *const at = *array[k] + i;
        memmove(at, at + 1, (size_t)(wake->n_vortex - 1 - i) * sizeof *at);
    }
    wake->n_vortex--;
    if (i < wake->n_old) wake->n_old--;
    wake->version++;
}

void wake_insert(struct wake *wake, int i, int first, int n, const double *weight) {
    wake_resize(wake, wake->n_vortex + 1);
    const double birth = (wake->birth[i] + wake->birth[i + 1]) / 2;
    double **array[N_ARRAYS];
    wake_list_arrays(wake, array);
    for (int k = 0; k < N_ARRAYS; k++) {
        double *const at = *array[k] + i;
        double value = 0;
        for (int a = 0; a < n; a++) value += weight[a] * (*array[k])[first + a];
        memmove(at + 2, at + 1, (size_t)(wake->n_vortex - 2 - i) * sizeof *at);
        at[1] = value;
    }
    wake->birth[i + 1] = birth;
    if (i < wake->n_old) wake->n_old++;
    wake->version++;
}

void wake_add_shed(struct wake *wake, double circulation) {
    // the label of a marker is the circulation shed until the birth of the marker
    for (int i = 0; i < wake->n_vortex && wake->has_markers; i++) wake->circulation[i] += circulation;
    wake->shed_before += circulation;
    wake->removed += circulation;
    wake->version++;
}

// ---- from outside

// reserve n vortices from outside
static enum status wake_make_spare(struct wake *wake, const struct school *school, int n) {
    if (wake->n_added + n > school->wake_spare) {
        return status_fail(STATUS_CASE,
                           "wake.spare_vortices: %d, of which %d are used; %d more are required: set "
                           "wake.spare_vortices to the number "
                           "of vortices that the program adds to one wake",
                           school->wake_spare, wake->n_added, n);
    }

    wake_reserve(wake, wake->n_vortex + n);
    wake->n_added += n;
    wake->version++;
    return STATUS_OK;
}

enum status wake_add_vortex(struct wake *wake, const struct school *school, double t, double x, double y,
                            double circulation) {
    enum { BEHIND = 5, N_MARKERS = WAKE_PER_VORTEX };  // newest markers stay consecutive: graded points
    if (school->removed == REMOVED_DROPPED) {
        return status_fail(
            STATUS_CASE,
            "wake.removed_circulation: dropped: removal of an added vortex would add its circulation to the "
            "body: choose 'retained'");
    }

    if (school->finite) {
        return status_fail(STATUS_CASE,
                           "pressure.span: finite: a single vortex is not a ring: choose 'infinite' to add vortices");
    }

    TRY(wake_make_spare(wake, school, wake->has_markers ? N_MARKERS : 1));
    wake->removed -= circulation;
    if (!wake->has_markers || wake->n_vortex == 0) {
        wake_release(wake, x, y, circulation, t);
        return STATUS_OK;
    }

    // insert N_MARKERS markers behind marker i
    const int i = wake->n_vortex > BEHIND ? wake->n_vortex - 1 - BEHIND : 0;
    double **array[N_ARRAYS];
    wake_list_arrays(wake, array);
    for (int k = 0; k < N_ARRAYS; k++) {
        double *const values = *array[k];
        memmove(values + i + 1 + N_MARKERS, values + i + 1, (size_t)(wake->n_vortex - 1 - i) * sizeof *values);
        for (int m = 1; m <= N_MARKERS; m++) values[i + m] = values[i];
    }

    wake->n_vortex += N_MARKERS;
    if (i < wake->n_old) wake->n_old += N_MARKERS;

    // both ends of the stretch are at the vortex; subtract the circulation from the labels up to the older end
    for (int m = 1; m <= 2; m++) {
        wake->x[i + m] = x;
        wake->y[i + m] = y;
    }

    for (int k = 0; k <= i + 1; k++) wake->circulation[k] -= circulation;
    return STATUS_OK;
}

enum status wake_break(struct wake *wake, const struct school *school, double t, const double tail[2]) {
    const int newest = wake->n_vortex - 1;
    if (!wake->has_markers || newest < 0) return STATUS_OK;
    if (!(hypot(tail[0] - wake->x[newest], tail[1] - wake->y[newest]) > 0)) return STATUS_OK;
    TRY(wake_make_spare(wake, school, 1));
    wake_release(wake, tail[0], tail[1], wake->circulation[newest], t);
    return STATUS_OK;
}

void wake_leave_behind(struct wake *wake, double shed) {
    wake->n_vortex = wake->n_old = 0;
    wake->shed_before = wake->removed = shed;
    wake->version++;
}

void wake_set_velocity(struct wake *wake, const double *u, const double *v, const double *rate, int n_new) {
    const int n_old = wake->n_vortex - n_new;
    const double *const from[] = {u, v, rate};
    double *const now[] = {wake->u, wake->v, wake->rate};
    double *const before[] = {wake->u_before, wake->v_before, wake->rate_before};

    wake->version++;
    wake->n_turns++;
    for (int i = 0; i < (rate ? 3 : 2); i++) {
        memcpy(before[i], now[i], (size_t)n_old * sizeof *u);
        memcpy(before[i] + n_old, from[i] + n_old, (size_t)n_new * sizeof *u);
        memcpy(now[i], from[i], (size_t)wake->n_vortex * sizeof *u);
    }

    // both markers of a vortex from outside move together: rounding would let them rotate about each other
    for (int i = 0; i + 2 < wake->n_vortex && wake->has_markers; i++) {
        const bool is_vortex = !(fabs(wake->x[i + 1] - wake->x[i]) > 0) && !(fabs(wake->y[i + 1] - wake->y[i]) > 0) &&
                               fabs(wake->circulation[i + 1] - wake->circulation[i]) > 0;
        if (!is_vortex) continue;
        for (int k = 0; k < 2; k++) {
            now[k][i + 1] = now[k][i];
            before[k][i + 1] = before[k][i];
        }
    }
}

void wake_nascent(const struct wake *wake, double tau, const double tail[2], double position[2]) {
    position[0] = tail[0] + tau * wake->slip[0] / 2;
    position[1] = tail[1] + tau * wake->slip[1] / 2;
}
