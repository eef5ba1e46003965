/* test_edge.c: The frame of an edge and its motion follow from its two nodes (doc/model.md, section 2). */
#include "body/rod.h"
#include "school.h"

#define TIME "time: {end: 1, shedding_interval: 0.02, output_interval: 0.02}\n"

TEST(frame_is_orthonormal_and_points_from_node_to_node) {
    struct setup setup = setup_stirred(TIME "fish: [{nodes: 5}]\n");
    const struct fish *fish = setup.school->fish;
    const double *const y = setup.state->y;
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        for (int i = 0; i < 2; i++) {
            // rounding of positions of the size of the body
            NEAR(y[edge_place(fish, i, k)] + edge.length * edge.t[i], y[edge_place(fish, i, k + 1)], 1e-15, 0);
            NEAR(edge.middle[i], (y[edge_place(fish, i, k)] + y[edge_place(fish, i, k + 1)]) / 2, 0, 0);
            NEAR(edge.velocity[i], (y[edge_velocity(fish, i, k)] + y[edge_velocity(fish, i, k + 1)]) / 2, 0, 0);
            NEAR(edge.acceleration[i], (y[edge_acceleration(fish, i, k)] + y[edge_acceleration(fish, i, k + 1)]) / 2, 0,
                 0);
        }
        NEAR(edge_dot(edge.t, edge.t), 1, 1e-15, 0);
        NEAR(edge_dot(edge.t, edge.n), 0, 0, 0);
        // a quarter of a turn to the left
        NEAR(edge.t[0] * edge.n[1] - edge.t[1] * edge.n[0], 1, 1e-15, 0);
    }
}

TEST(rate_of_turn_is_that_of_a_rigid_rotation) {
    struct setup setup = setup_stirred(TIME "fish: [{nodes: 5}]\n");
    const struct fish *fish = setup.school->fish;
    double *const y = setup.state->y;
    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.vx + k] = 0.3 - 2 * y[fish->at.y + k];
        y[fish->at.vy + k] = -0.1 + 2 * y[fish->at.x + k];
    }
    for (int k = 0; k < fish->n_edges; k++) {
        const struct edge edge = edge_at(fish, k, y);
        NEAR(edge_turn_rate(&edge), 2, 0, 1e-14);
    }
}
