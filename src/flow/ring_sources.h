/* ring_sources.h: the vortex rings of bodies and wakes of finite depth, and where they are. doc/model.md, section 18.
 * Part of flow.h. Tested by tests/flow/test_flow_rings.c. */
#ifndef RING_SOURCES_H
#define RING_SOURCES_H

#include "state/state.h"
#include "vortex/ring.h"
#include "wake/ring_sheet.h"

enum { N_LEG_SUMS = 7 };

/* The rings of one fish. */
struct fish_rings {
    struct ring_sheet graded, middles; /* the wake as the own control points see it; as all else does */
    struct rings own;     /* what they see of the own body: bound vortices, then the legs of control points */
    struct rings body;    /* control points with the circulation around them and their legs */
    double *line[2];      /* dx of the control points, m                        (n_control) */
    double newest[3];     /* label of the newest marker, m2 s-1; its place less that of the tail, m */
    struct rings markers; /* at the last event */
    struct rings body_image, middles_image, markers_image;
};

struct flow_rings {
    struct fish_rings *fish; /* (n_fish) */
    /* with the velocity at points: div u, its gradient; a and its gradient, one component after the other (n_points) */
    double *div, *div_x, *div_y, *edge, *edge_gradient;
    double *image_div;        /* after flow_rings_images                                       (n_points) */
    double *legs[N_LEG_SUMS]; /* workspace: what the own legs cause at control points     (n_points) */
    /* at markers, after flow_rings_at_markers: rates of labels; div u of images; velocity and div u of the own legs
     * (n_markers) */
    int wake_capacity;
    double *wake_div, *wake_rate, *wake_image_div, *wake_leg_u, *wake_leg_v, *wake_leg_div;
};

/* For a school with `finite`, whose bodies have so many points that feel the fluid. Fails with STATUS_MEMORY;
 * ring_sources_free accepts NULL. */
enum status ring_sources_create(struct flow_rings **rings, const struct school *school, int n_points);
void ring_sources_free(struct flow_rings *rings, int n_fish);

/* The wakes tau after the event of the state; is_new: they have changed. Fails with STATUS_MEMORY. */
enum status ring_sources_place_wakes(struct flow_rings *rings, const struct school *school, const struct state *state,
                                     double tau, int is_new);

/* The body and the nascent stretch of fish f then, for the unknowns y, and all its images; x, y of its control points
 * and bound vortices, and circulations of these. Returns the circulation of the nascent stretch in *nascent. Fails with
 * STATUS_MEMORY. */
struct ring_body {
    const double *point[2], *sheet[2], *circulation;
};
enum status ring_sources_place(struct flow_rings *rings, const struct school *school, const struct state *state, int f,
                               double tau, const double *y, const struct ring_body *body, double *nascent);

/* The y of an image of a source at y is this less y: one wall. */
double ring_sources_mirror(const struct school *school);

#endif
