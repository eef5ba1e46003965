/* ring_sources.h: positions and strengths of the vortex rings of bodies and wakes of finite depth. doc/model.md,
 * section 18. Part of flow.h. Tested by tests/flow/test_flow_rings.c. */
#ifndef RING_SOURCES_H
#define RING_SOURCES_H

#include "state/state.h"
#include "vortex/ring.h"
#include "wake/ring_sheet.h"

enum { N_LEG_SUMS = 7 };

/* The rings of one fish. */
struct fish_rings {
    struct ring_sheet graded, middles; /* the wake for the own control points; the wake for all other targets */
    struct rings own;     /* own body at the own control points: bound vortices, then legs of control points */
    struct rings body;    /* control points, each with the circulation of its interval and its leg */
    double *line[2];      /* dx of the control points, m                        (n_control) */
    double newest[3];     /* label of the newest marker, m2 s-1; position of the marker relative to the tail, m */
    struct rings markers; /* at the last event */
    struct rings body_image, middles_image, markers_image;
};

struct flow_rings {
    struct fish_rings *fish; /* (n_fish) */
    /* with the velocity at points: div u, gradient of div u; a, gradient of a, one component after the other
     * (n_points) */
    double *div, *div_x, *div_y, *edge, *edge_gradient;
    double *image_div;        /* after flow_rings_images                                       (n_points) */
    double *legs[N_LEG_SUMS]; /* workspace: velocities of the own legs at control points   (n_points) */
    /* at markers, after flow_rings_at_markers: rates of labels; div u of images; velocity and div u of the own legs
     * (n_markers) */
    int wake_capacity;
    double *wake_div, *wake_rate, *wake_image_div, *wake_leg_u, *wake_leg_v, *wake_leg_div;
};

/* Create the rings of a school with `finite`; n_points: number of evaluation points of all bodies. Fails with
 * STATUS_MEMORY; ring_sources_free accepts NULL. */
enum status ring_sources_create(struct flow_rings **rings, const struct school *school, int n_points);
void ring_sources_free(struct flow_rings *rings, int n_fish);

/* Place the wakes tau after the event of the state; is_new: the wakes have changed. Fails with STATUS_MEMORY. */
enum status ring_sources_place_wakes(struct flow_rings *rings, const struct school *school, const struct state *state,
                                     double tau, int is_new);

/* Place body, nascent stretch and images of fish f tau after the event for the unknowns y; ring_body: x, y of control
 * points and of bound vortices, and circulations of bound vortices. *nascent: circulation of the nascent stretch. Fails
 * with STATUS_MEMORY. */
struct ring_body {
    const double *point[2], *sheet[2], *circulation;
};
enum status ring_sources_place(struct flow_rings *rings, const struct school *school, const struct state *state, int f,
                               double tau, const double *y, const struct ring_body *body, double *nascent);

/* The image of a source at y lies at ring_sources_mirror - y (one wall). */
double ring_sources_mirror(const struct school *school);

#endif
