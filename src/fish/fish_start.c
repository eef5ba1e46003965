/* fish_start.c: nodes of the initial shape from nose to tail. */
#include "fish/fish_start.h"

#include <math.h>

#include "fish/fish_gait.h"
#include "fish/fish_prescribed.h"

void fish_start(const struct fish *fish, double *y) {
    double *const x = y + fish->at.x, *const z = y + fish->at.y;
    if (fish->motion.prescribed != PRESCRIBED_NONE) {
        // the free nodes behind a prescribed head start with the rigid motion of the head
        fish_prescribe(fish, 1, 0, y);
        return;
    }

    // the bias of a controlled fish is not known yet: start with the shape of bias 0
    const double bias = fish->control.law == CONTROL_NONE ? fish->control.bias : 0;
    const struct fish_gait gait = fish_own_gait(fish, 0);
    double angle = fish->start_heading - M_PI;
    x[0] = fish->start_position[0];
    z[0] = fish->start_position[1];

    for (int k = 0; k < fish->n_edges; k++) {
        if (k > 0) angle += fish_natural_angle(fish, k - 1, &gait, bias);
        x[k + 1] = x[k] + fish->edge_length * cos(angle);
        z[k + 1] = z[k] + fish->edge_length * sin(angle);
    }

    for (int k = 0; k < fish->n_nodes; k++) {
        y[fish->at.vx + k] = fish->start_speed * cos(fish->start_heading);
        y[fish->at.vy + k] = fish->start_speed * sin(fish->start_heading);
    }
}
