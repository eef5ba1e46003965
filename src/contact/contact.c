/* contact.c: pairs in contact, and the potential between the edges of two bodies with derivatives. */
#include "contact/contact.h"

#include <math.h>
#include <string.h>

#include "contact/clearance.h"
#include "fish/fish.h"
#include "fish/fish_motion.h"

struct contact {
    struct arena *arena;
    const struct school *school;
    struct neighbours *neighbours; /* NULL: no repulsion between bodies */
    int *first;                    /* the partners of each fish in other                       (n_fish + 1) */
    int *other;
    unsigned char *is_near; /* whether the overlaps of neighbours->other are (possible) partners */
    int capacity;           /* of other and is_near */
    double *between;        /* scratch                                                   (n_unknowns) */
};

struct contact *contact_create(struct arena *arena, const struct school *school) {
    struct contact *contact;
    NEW(arena, contact, 1);
    contact->arena = arena;
    contact->school = school;
    NEW(arena, contact->first, school->n_fish + 1);
    NEW(arena, contact->between, school->n_unknowns);
    if (school->contact == CONTACT_REPEL && school->n_fish > 1) {
        contact->neighbours = neighbours_create(arena, school->n_fish);
    }
    return contact;
}

// ---- pairs in contact

// whether the motion of the whole body is prescribed
static int body_is_prescribed(const struct fish *fish) {
    return fish_is_prescribed(fish, fish->n_nodes - 1, 0);
}

// whether fish f and g are in contact at y; fails if the bodies touch on the way to y
static enum status partner_check(const struct contact *contact, const struct state *state, double t, const double *y,
                                 int f, int g, unsigned char *is_near) {
    const struct fish *const a = &contact->school->fish[f], *const b = &contact->school->fish[g];
    const double range = contact->school->contact_range;
    *is_near = 0;

    // repulsion cannot separate two prescribed bodies
    if (body_is_prescribed(a) && body_is_prescribed(b)) return STATUS_OK;
    const struct passage passage = clearance_passage(a, b, state->closest->before, y, range, contact->between);
    *is_near = passage.now < range;
    if (passage.least > 0) return STATUS_OK;

    return status_fail(STATUS_RETRY, "the bodies of %s and %s touch or cross before t = %.10g s", a->name, b->name, t);
}

// possible partners among the fish with overlapping boxes
static void partners_find(const struct contact *contact, const struct state *state, const double *y) {
    const struct neighbours *const neighbours = contact->neighbours;
    const struct school *const school = contact->school;
    const double *const before = state->closest->before, range = school->contact_range;
    const int threads = fish_threads(school);

#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (int f = 0; f < school->n_fish; f++) {
        for (int i = neighbours->first[f]; i < neighbours->first[f + 1]; i++) {
            const int g = neighbours->other[i];
            if (g < f) continue;
            contact->is_near[i] =
                (unsigned char)clearance_may_be_near(&school->fish[f], &school->fish[g], before, y, range);
        }
    }
}

// the result for the pair (g, f), g < f, found before
static unsigned char pair_is_near(const struct contact *contact, int f, int g) {
    const struct neighbours *const neighbours = contact->neighbours;
    int i = neighbours->first[g];
    while (neighbours->other[i] != f) i++;
    return contact->is_near[i];
}

enum status contact_find(struct contact *contact, const struct state *state, double t, const double *y) {
    struct neighbours *const neighbours = contact->neighbours;
    const struct school *const school = contact->school;

    // node paths are straight: a body between the walls at both ends of a step is between the walls during the step
    for (int f = 0; school->walls.n > 0 && f < school->n_fish; f++) {
        if (fish_wall_distance(school, &school->fish[f], y, NULL) > 0) continue;
        return status_fail(STATUS_RETRY, "the body of %s touches a wall before t = %.10g s", school->fish[f].name, t);
    }

    if (!neighbours) return STATUS_OK;
    const int n_fish = school->n_fish, threads = fish_threads(school);

#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < n_fish; f++) {
        neighbours->box[f] = clearance_box(&school->fish[f], school->contact_range, state->closest->before, y);
    }

    // candidates: fish with overlapping boxes
    neighbours_find(neighbours);
    if (neighbours->capacity > contact->capacity) {
        contact->capacity = neighbours->capacity;
        GROW(contact->arena, contact->other, contact->capacity);
        GROW(contact->arena, contact->is_near, contact->capacity);
    }
    partners_find(contact, state, y);
    int n = 0;

    for (int f = 0; f < n_fish; f++) {
        contact->first[f] = n;
        for (int i = neighbours->first[f]; i < neighbours->first[f + 1]; i++) {
            const int g = neighbours->other[i];
            if (g < f) contact->is_near[i] = pair_is_near(contact, f, g);
            if (g > f && contact->is_near[i]) TRY(partner_check(contact, state, t, y, f, g, &contact->is_near[i]));
            if (contact->is_near[i]) contact->other[n++] = g;
        }
    }

    contact->first[n_fish] = n;
    return STATUS_OK;
}

int contact_partners(const struct contact *contact, int f, const int **other) {
    *other = contact->other + contact->first[f];
    return contact->first[f + 1] - contact->first[f];
}

// ---- one point above one edge

/* Node 0 is the point, nodes 1 and 2 are the ends of the edge. gradient and bend: first and second derivatives of the
 * distance by the node positions. */
struct touch {
    int fish[3], node[3];
    double energy, slope, curvature; /* of the potential by the distance, J, N, N m-1 */
    double gradient[6];              /* x and y of each node */
    double bend[6][6];
};

// energy of a gap below the range, with derivatives: strength range (1 - s)^3/s with s = gap/range
static void gap_potential(double gap, double range, double strength, struct touch *touch) {
    const double s = gap / range;
    touch->energy = strength * range * (1 - s) * (1 - s) * (1 - s) / s;
    touch->slope = strength * (3 - 2 * s - 1 / (s * s));
    touch->curvature = 2 * strength / range * (1 / (s * s * s) - 1);
}

// the derivatives of the distance from the edge e to the point at r from the first end of the edge, at the fraction q
// of the edge
static void distance_derivatives(const double r[2], const double e[2], double q, double distance, struct touch *touch) {
    const double square = e[0] * e[0] + e[1] * e[1];
    const double n[2] = {(r[0] - q * e[0]) / distance, (r[1] - q * e[1]) / distance}, t[2] = {-n[1], n[0]};
    const double part[3] = {1, q - 1, -q};

    // beside the edge the normal turns with the edge, and the nearest point slides; at an end the normal turns with the
    // point
    const int beside = q > 0 && q < 1;
    const double turn[3] = {0, -1, 1};
    const double length = (e[0] * t[0] + e[1] * t[1]);  // signed: positive along t

    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 2; c++) touch->gradient[2 * i + c] = part[i] * n[c];
    }

    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            const double a = part[i / 2], b = part[j / 2], u = turn[i / 2], v = turn[j / 2];
            const double tt = t[i % 2] * t[j % 2], nn = n[i % 2] * n[j % 2];
            const double tn = t[i % 2] * n[j % 2], nt = n[i % 2] * t[j % 2];
            touch->bend[i][j] =
                beside ? -(a * v * tn + u * b * nt) / length - distance * u * v * nn / square : a * b * tt / distance;
        }
    }
}

// function called for each touch of two bodies
typedef void visit(void *data, const struct touch *touch);

struct pair {
    const struct fish *fish[2]; /* in ascending order */
    int number[2];
    double range, strength;
    const double *y;
};

// visit the end of edge i of one body above edge j of the other, if the gap is below the range
static void touch_visit(const struct pair *pair, int one, int node, int i, int j, visit *visitor, void *data) {
    const struct fish *const fish = pair->fish[one], *const other = pair->fish[1 - one];
    const double *const y = pair->y;
    const double a[2] = {y[other->at.x + j], y[other->at.y + j]};
    const double e[2] = {y[other->at.x + j + 1] - a[0], y[other->at.y + j + 1] - a[1]};
    const double r[2] = {y[fish->at.x + node] - a[0], y[fish->at.y + node] - a[1]};

    // nearest point of the edge, at the fraction q, and gap
    const double square = e[0] * e[0] + e[1] * e[1];
    const double along = square > 0 ? (r[0] * e[0] + r[1] * e[1]) / square : 0, q = fmin(1, fmax(0, along));
    const double distance = hypot(r[0] - q * e[0], r[1] - q * e[1]);
    const double gap = distance - (fish->thickness[i] + other->thickness[j]) / 2;
    if (gap >= pair->range) return;

    struct touch touch = {.fish = {pair->number[one], pair->number[1 - one], pair->number[1 - one]},
                          .node = {node, j, j + 1}};
    gap_potential(gap, pair->range, pair->strength / 4, &touch);
    distance_derivatives(r, e, q, distance, &touch);
    visitor(data, &touch);
}

// visit every touch of two bodies, in a fixed order
static void each_touch(const struct contact *contact, int f, int g, const double *y, visit *visitor, void *data) {
    const int number[2] = {f < g ? f : g, f < g ? g : f};
    const struct fish *const a = &contact->school->fish[number[0]], *const b = &contact->school->fish[number[1]];
    const double both = a->contact_strength + b->contact_strength;

    const struct pair pair = {{a, b},
                              {number[0], number[1]},
                              contact->school->contact_range,
                              a->contact_strength * b->contact_strength / both,
                              y};

    for (int i = 0; i < a->n_edges; i++) {
        const double p[2] = {y[a->at.x + i], y[a->at.y + i]};
        const double length = fabs(y[a->at.x + i + 1] - p[0]) + fabs(y[a->at.y + i + 1] - p[1]);
        for (int j = 0; j < b->n_edges; j++) {
            const double r[2] = {y[b->at.x + j], y[b->at.y + j]};
            const double other = fabs(y[b->at.x + j + 1] - r[0]) + fabs(y[b->at.y + j + 1] - r[1]);

            // every point of an edge is within the edge length of the first node
            const double reach = length + other + (a->thickness[i] + b->thickness[j]) / 2 + pair.range;
            const double dx = r[0] - p[0], dy = r[1] - p[1];
            if (dx * dx + dy * dy > reach * reach) continue;

            for (int end = 0; end < 2; end++) {
                touch_visit(&pair, 0, i + end, i, j, visitor, data);
                touch_visit(&pair, 1, j + end, j, i, visitor, data);
            }
        }
    }
}

/* A node of a body, as an end of an edge, above a wall; fields as in struct touch. */
struct wall_touch {
    int node;
    double energy, slope, curvature;
    double inward; /* the gradient of the gap by the y of the node: 1 or -1 */
};

typedef void visit_wall(void *data, const struct wall_touch *touch);

static void each_wall_touch(const struct contact *contact, int f, const double *y, visit_wall *visitor, void *data) {
    const struct school *const school = contact->school;
    const struct fish *const fish = &school->fish[f];
    for (int i = 0; i < 2 * school->walls.n * fish->n_edges; i++) {
        const int edge = i / 2 % fish->n_edges, node = edge + i % 2, wall = i / (2 * fish->n_edges);
        const double inward = school->walls.inward[wall];
        const double gap = inward * (y[fish->at.y + node] - school->walls.y[wall]) - fish->thickness[edge] / 2;
        if (gap >= school->contact_range) continue;

        struct touch touch;
        gap_potential(gap, school->contact_range, fish->contact_strength / 2, &touch);
        visitor(data, &(struct wall_touch){node, touch.energy, touch.slope, touch.curvature, inward});
    }
}

// ---- the terms

// sums over the contacts of one fish
struct sums {
    const struct contact *contact;
    int f;
    const double *y;
    double *value; /* a residual */
    double energy, power;
    struct contact_forces on;
};

static void force_add(void *data, const struct touch *touch) {
    struct sums *const sums = data;
    const struct layout *const at = &sums->contact->school->fish[sums->f].at;
    for (int i = 0; i < 3; i++) {
        if (touch->fish[i] != sums->f) continue;
        sums->value[at->ax + touch->node[i]] += touch->slope * touch->gradient[2 * i];
        sums->value[at->ay + touch->node[i]] += touch->slope * touch->gradient[2 * i + 1];
    }
}

static void wall_force_add(void *data, const struct wall_touch *touch) {
    struct sums *const sums = data;
    const struct layout *const at = &sums->contact->school->fish[sums->f].at;
    sums->value[at->ay + touch->node] += touch->slope * touch->inward;
}

void contact_residual(const struct contact *contact, int f, const double *y, double *value) {
    struct sums sums = {.contact = contact, .f = f, .value = value};
    each_wall_touch(contact, f, y, wall_force_add, &sums);
    for (int i = contact->first[f]; i < contact->first[f + 1]; i++) {
        each_touch(contact, f, contact->other[i], y, force_add, &sums);
    }
}

struct block {
    const struct contact *contact;
    int f, g;
    struct coupling_block *rows;
};

static void derivative_add(void *data, const struct touch *touch) {
    const struct block *const block = data;
    const struct fish *const fish = &block->contact->school->fish[block->f];
    const struct fish *const other = &block->contact->school->fish[block->g];

    for (int i = 0; i < 6; i++) {
        if (touch->fish[i / 2] != block->f) continue;
        const int node = touch->node[i / 2], row = i % 2 * fish->n_nodes + node;
        for (int j = 0; j < 6; j++) {
            if (touch->fish[j / 2] != block->g) continue;
            const int column = j % 2 * other->n_nodes + touch->node[j / 2];
            const double second =
                touch->curvature * touch->gradient[i] * touch->gradient[j] + touch->slope * touch->bend[i][j];
            block->rows->value[(long)column * block->rows->n_rows + row] += second / fish->mass[node];
        }
    }
}

static void wall_derivative_add(void *data, const struct wall_touch *touch) {
    const struct block *const block = data;
    const struct fish *const fish = &block->contact->school->fish[block->f];
    const int place = fish->n_nodes + touch->node;
    block->rows->value[(long)place * block->rows->n_rows + place] += touch->curvature / fish->mass[touch->node];
}

void contact_jacobian(const struct contact *contact, int f, int g, const double *y, struct coupling_block *rows) {
    struct block block = {contact, f, g, rows};
    if (f == g) each_wall_touch(contact, f, y, wall_derivative_add, &block);
    for (int i = contact->first[f]; i < contact->first[f + 1]; i++) {
        const int other = contact->other[i];
        if (f == g || other == g) each_touch(contact, f, other, y, derivative_add, &block);
    }
}

// add a force on a node of fish f
static void add_to_forces(struct sums *sums, int node, const double force[2]) {
    const struct layout *const at = &sums->contact->school->fish[sums->f].at;
    for (int c = 0; c < 2; c++) sums->on.force[c] += force[c];
    sums->on.moment += sums->y[at->x + node] * force[1] - sums->y[at->y + node] * force[0];
}

static void sums_add(void *data, const struct touch *touch) {
    struct sums *const sums = data;
    sums->energy += touch->energy / 2;
    for (int i = 0; i < 3; i++) {
        const struct layout *const at = &sums->contact->school->fish[touch->fish[i]].at;
        const double force[2] = {-touch->slope * touch->gradient[2 * i], -touch->slope * touch->gradient[2 * i + 1]};
        const double power = force[0] * sums->y[at->vx + touch->node[i]] + force[1] * sums->y[at->vy + touch->node[i]];

        const int is_own = touch->fish[i] == sums->f;
        sums->power += (is_own ? power : -power) / 2;
        if (is_own) add_to_forces(sums, touch->node[i], force);
    }
}

// a wall is at rest and exchanges no power; the body holds the full energy of the contact
static void wall_sums_add(void *data, const struct wall_touch *touch) {
    struct sums *const sums = data;
    sums->energy += touch->energy;
    add_to_forces(sums, touch->node, (const double[2]){0, -touch->slope * touch->inward});
}

static struct sums sums_of(const struct contact *contact, int f, const double *y) {
    struct sums sums = {.contact = contact, .f = f, .y = y};
    each_wall_touch(contact, f, y, wall_sums_add, &sums);
    for (int i = contact->first[f]; i < contact->first[f + 1]; i++) {
        each_touch(contact, f, contact->other[i], y, sums_add, &sums);
    }
    return sums;
}

double contact_energy(const struct contact *contact, int f, const double *y) {
    return sums_of(contact, f, y).energy;
}

double contact_power(const struct contact *contact, int f, const double *y) {
    return sums_of(contact, f, y).power;
}

struct contact_forces contact_forces(const struct contact *contact, int f, const double *y) {
    return sums_of(contact, f, y).on;
}
