/* contact.c: finds the pairs in contact, and gives the potential between the edges of two bodies with its
 * derivatives. */
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
    bool *is_near;   /* whether the overlaps of neighbours->other are (possible) partners */
    int capacity;    /* of other and is_near */
    double *between; /* scratch                                                   (n_unknowns) */
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

enum status contact_find(struct contact *contact, const struct state *state, double t, const double *y) {
    struct neighbours *const neighbours = contact->neighbours;
    const struct school *const school = contact->school;
    const double *const before = state->closest->before, range = school->contact_range;

    // node paths are straight: a body between the walls at both ends of a step is between the walls during the step
    for (int f = 0; school->walls.n > 0 && f < school->n_fish; f++) {
        if (fish_wall_distance(school, &school->fish[f], y, NULL) > 0) continue;
        return status_fail(STATUS_RETRY, "the body of %s touches a wall before t = %.10g s", school->fish[f].name, t);
    }
    if (!neighbours) return STATUS_OK;

    // candidates: fish with overlapping boxes
    const int n_fish = school->n_fish, threads = fish_threads(school);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int f = 0; f < n_fish; f++) neighbours->box[f] = clearance_box(&school->fish[f], range, before, y);
    neighbours_find(neighbours);
    if (neighbours->capacity > contact->capacity) {
        contact->capacity = neighbours->capacity;
        GROW(contact->arena, contact->other, contact->capacity);
        GROW(contact->arena, contact->is_near, contact->capacity);
    }

    // possible partners among the candidates
#pragma omp parallel for num_threads(threads) schedule(dynamic, 4)
    for (int f = 0; f < n_fish; f++) {
        for (int i = neighbours->first[f]; i < neighbours->first[f + 1]; i++) {
            const int g = neighbours->other[i];
            if (g > f)
                contact->is_near[i] = clearance_may_be_near(&school->fish[f], &school->fish[g], before, y, range);
        }
    }

    int n = 0;
    for (int f = 0; f < n_fish; f++) {
        contact->first[f] = n;
        for (int i = neighbours->first[f]; i < neighbours->first[f + 1]; i++) {
            const int g = neighbours->other[i];
            if (g < f) {
                // the result for the pair (g, f), found before
                int same = neighbours->first[g];
                while (neighbours->other[same] != f) same++;
                contact->is_near[i] = contact->is_near[same];
            } else if (contact->is_near[i]) {
                // repulsion cannot separate two prescribed bodies
                const struct fish *const a = &school->fish[f], *const b = &school->fish[g];
                contact->is_near[i] = false;
                if (fish_is_prescribed(a, a->n_edges, 0) && fish_is_prescribed(b, b->n_edges, 0)) continue;
                const struct passage passage = clearance_passage(a, b, before, y, range, contact->between);
                contact->is_near[i] = passage.now < range;
                if (passage.least <= 0) {
                    return status_fail(STATUS_RETRY, "the bodies of %s and %s touch or cross before t = %.10g s",
                                       a->name, b->name, t);
                }
            }
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

// ---- one point above one edge or one wall

/* Node 0 is the point, nodes 1 and 2 are the ends of the edge; a wall has no nodes. gradient and bend: first and second
 * derivatives of the distance by the node positions. */
struct touch {
    int n_nodes; /* 3, or 1 above a wall */
    int fish[3], node[3];
    double energy, slope, curvature; /* of the potential by the distance, J, N, N m-1 */
    double gradient[6];              /* x and y of each node */
    double bend[6][6];
};

// function called for each touch
typedef void visit(void *data, const struct touch *touch);

// energy of a gap below the range, with derivatives: strength range (1 - s)^3/s with s = gap/range
static void gap_potential(double gap, double range, double strength, struct touch *touch) {
    const double s = gap / range;
    touch->energy = strength * range * (1 - s) * (1 - s) * (1 - s) / s;
    touch->slope = strength * (3 - 2 * s - 1 / (s * s));
    touch->curvature = 2 * strength / range * (1 / (s * s * s) - 1);
}

// visit a node of fish f, an end of its edge i, above edge j of fish g, if the gap is below the range
static void touch_visit(const struct school *school, int f, int node, int i, int g, int j, const double *y,
                        visit *visitor, void *data) {
    const struct fish *const fish = &school->fish[f], *const other = &school->fish[g];
    const double a[2] = {y[other->at.x + j], y[other->at.y + j]};
    const double e[2] = {y[other->at.x + j + 1] - a[0], y[other->at.y + j + 1] - a[1]};
    const double r[2] = {y[fish->at.x + node] - a[0], y[fish->at.y + node] - a[1]};

    // nearest point of the edge, at the fraction q, and gap
    const double square = e[0] * e[0] + e[1] * e[1];
    const double along = square > 0 ? (r[0] * e[0] + r[1] * e[1]) / square : 0, q = fmin(1, fmax(0, along));
    const double distance = hypot(r[0] - q * e[0], r[1] - q * e[1]);
    const double gap = distance - (fish->thickness[i] + other->thickness[j]) / 2;
    if (gap >= school->contact_range) return;

    struct touch touch = {.n_nodes = 3, .fish = {f, g, g}, .node = {node, j, j + 1}};
    const struct fish *const low = &school->fish[f < g ? f : g], *const high = &school->fish[f < g ? g : f];
    const double strength =
        low->contact_strength * high->contact_strength / (low->contact_strength + high->contact_strength);
    gap_potential(gap, school->contact_range, strength / 4, &touch);

    // derivatives of the distance: beside the edge the normal turns with the edge, and the nearest point slides; at an
    // end the normal turns with the point
    const double n[2] = {(r[0] - q * e[0]) / distance, (r[1] - q * e[1]) / distance}, t[2] = {-n[1], n[0]};
    const double part[3] = {1, q - 1, -q}, turn[3] = {0, -1, 1};
    const double length = e[0] * t[0] + e[1] * t[1];  // signed: positive along t
    const bool is_beside = q > 0 && q < 1;
    for (int row = 0; row < 6; row++) {
        touch.gradient[row] = part[row / 2] * n[row % 2];
        for (int column = 0; column < 6; column++) {
            const double b = part[row / 2], c = part[column / 2], u = turn[row / 2], v = turn[column / 2];
            const double tt = t[row % 2] * t[column % 2], nn = n[row % 2] * n[column % 2];
            const double tn = t[row % 2] * n[column % 2], nt = n[row % 2] * t[column % 2];
            touch.bend[row][column] = is_beside ? -(b * v * tn + u * c * nt) / length - distance * u * v * nn / square
                                                : b * c * tt / distance;
        }
    }
    visitor(data, &touch);
}

// visit every touch of fish f with fish g, or with the walls and all partners if g is f, in a fixed order
static void each_touch(const struct contact *contact, int f, int g, const double *y, visit *visitor, void *data) {
    const struct school *const school = contact->school;
    const struct fish *const fish = &school->fish[f];
    for (int i = 0; f == g && i < 2 * school->walls.n * fish->n_edges; i++) {
        const int edge = i / 2 % fish->n_edges, node = edge + i % 2, wall = i / (2 * fish->n_edges);
        const double inward = school->walls.inward[wall];
        const double gap = inward * (y[fish->at.y + node] - school->walls.y[wall]) - fish->thickness[edge] / 2;
        if (gap >= school->contact_range) continue;
        struct touch touch = {.n_nodes = 1, .fish = {f}, .node = {node}, .gradient = {0, inward}};
        gap_potential(gap, school->contact_range, fish->contact_strength / 2, &touch);
        visitor(data, &touch);
    }

    for (int partner = contact->first[f]; partner < contact->first[f + 1]; partner++) {
        const int other = contact->other[partner], first = f < other ? f : other, last = f + other - first;
        if (f != g && other != g) continue;
        const struct fish *const a = &school->fish[first], *const b = &school->fish[last];
        for (int i = 0; i < a->n_edges; i++) {
            const double p[2] = {y[a->at.x + i], y[a->at.y + i]};
            const double length = fabs(y[a->at.x + i + 1] - p[0]) + fabs(y[a->at.y + i + 1] - p[1]);
            for (int j = 0; j < b->n_edges; j++) {
                const double r[2] = {y[b->at.x + j], y[b->at.y + j]};
                const double beside = fabs(y[b->at.x + j + 1] - r[0]) + fabs(y[b->at.y + j + 1] - r[1]);

                // every point of an edge is within the edge length of the first node
                const double reach = length + beside + (a->thickness[i] + b->thickness[j]) / 2 + school->contact_range;
                const double dx = r[0] - p[0], dy = r[1] - p[1];
                if (dx * dx + dy * dy > reach * reach) continue;
                for (int end = 0; end < 2; end++) {
                    touch_visit(school, first, i + end, i, last, j, y, visitor, data);
                    touch_visit(school, last, j + end, j, first, i, y, visitor, data);
                }
            }
        }
    }
}

// ---- forces, derivatives, energies

/* The fish f with a residual, with the block of derivatives by fish g, or with the sums over its contacts. */
struct visited {
    const struct school *school;
    int f, g;
    const double *y;
    double *value;
    struct coupling_block *rows;
    struct contact_terms *terms;
};

static void force_add(void *data, const struct touch *touch) {
    const struct visited *const to = data;
    const struct layout *const at = &to->school->fish[to->f].at;
    for (int i = 0; i < touch->n_nodes; i++) {
        if (touch->fish[i] != to->f) continue;
        to->value[at->ax + touch->node[i]] += touch->slope * touch->gradient[2 * i];
        to->value[at->ay + touch->node[i]] += touch->slope * touch->gradient[2 * i + 1];
    }
}

void contact_residual(const struct contact *contact, int f, const double *y, double *value) {
    struct visited to = {.school = contact->school, .f = f, .value = value};
    each_touch(contact, f, f, y, force_add, &to);
}

static void derivative_add(void *data, const struct touch *touch) {
    const struct visited *const to = data;
    const struct fish *const fish = &to->school->fish[to->f], *const other = &to->school->fish[to->g];
    for (int i = 0; i < 2 * touch->n_nodes; i++) {
        if (touch->fish[i / 2] != to->f) continue;
        const int node = touch->node[i / 2], row = i % 2 * fish->n_nodes + node;
        for (int j = 0; j < 2 * touch->n_nodes; j++) {
            if (touch->fish[j / 2] != to->g) continue;
            const int column = j % 2 * other->n_nodes + touch->node[j / 2];
            const double second =
                touch->curvature * touch->gradient[i] * touch->gradient[j] + touch->slope * touch->bend[i][j];
            to->rows->value[(long)column * to->rows->n_rows + row] += second / fish->mass[node];
        }
    }
}

void contact_jacobian(const struct contact *contact, int f, int g, const double *y, struct coupling_block *rows) {
    struct visited to = {.school = contact->school, .f = f, .g = g, .rows = rows};
    each_touch(contact, f, g, y, derivative_add, &to);
}

static void terms_add(void *data, const struct touch *touch) {
    const struct visited *const to = data;
    struct contact_terms *const terms = to->terms;
    // a wall is at rest and exchanges no power; the body holds the full energy of the contact
    const bool is_wall = touch->n_nodes == 1;
    terms->energy += is_wall ? touch->energy : touch->energy / 2;
    for (int i = 0; i < touch->n_nodes; i++) {
        const struct layout *const at = &to->school->fish[touch->fish[i]].at;
        const int x = at->x + touch->node[i], y = at->y + touch->node[i];
        const double force[2] = {-touch->slope * touch->gradient[2 * i], -touch->slope * touch->gradient[2 * i + 1]};
        const double power = force[0] * to->y[at->vx + touch->node[i]] + force[1] * to->y[at->vy + touch->node[i]];
        const bool is_own = touch->fish[i] == to->f;
        if (!is_wall) terms->power += (is_own ? power : -power) / 2;
        if (!is_own) continue;
        for (int c = 0; c < 2; c++) terms->force[c] += force[c];
        terms->moment += to->y[x] * force[1] - to->y[y] * force[0];
    }
}

struct contact_terms contact_terms(const struct contact *contact, int f, const double *y) {
    struct contact_terms terms = {0};
    struct visited to = {.school = contact->school, .f = f, .y = y, .terms = &terms};
    each_touch(contact, f, f, y, terms_add, &to);
    return terms;
}
