/* thwaites.c: Thwaites' integral along a wall, and the wall of a body, which leads from the tail along the left side to
 * the nose and along the right side back to the tail. */
#include "force/thwaites.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "body/rod.h"
#include "force/pressure.h"
#include "force/sensor_pressure.h"

const double thwaites_separation = -0.09;

// ---- Thwaites' method

void thwaites_layers(int n, const double *x, const double *u, double viscosity, double *friction, double *lambda) {
    memset(friction, 0, (size_t)n * sizeof *friction);
    memset(lambda, 0, (size_t)n * sizeof *lambda);

    // first the layers of the flow towards larger x, then those towards smaller x
    for (int direction = 1; direction >= -1; direction -= 2) {
        double integral = 0;
        for (int k = 0; k < n; k++) {
            const int i = direction > 0 ? k : n - 1 - k, before = i - direction;
            const double b = direction * u[i];
            // at lower speeds the sixth power underflows
            if (!(b > 1e-40)) {
                integral = 0;
                continue;
            }

            // add the integral of u^5 with u linear in x; if the sign of u changes, from the zero on
            if (k > 0) {
                double a = direction * u[before], distance = fabs(x[i] - x[before]);
                if (a < 0) {
                    distance *= b / (b - a);
                    a = 0;
                }
                integral += distance / 6 *
                            (a * a * a * a * a + a * a * a * a * b + a * a * a * b * b + a * a * b * b * b +
                             a * b * b * b * b + b * b * b * b * b);
            }

            // theta^2 = 0.45 nu/u^6 int u^5 ds; at an end a layer begins with no thickness
            const int low = i > 0 ? i - 1 : 0, high = i < n - 1 ? i + 1 : i;
            const double slope = (u[high] - u[low]) / (x[high] - x[low]);
            const double square = 0.45 * viscosity * integral / pow(b, 6);
            lambda[i] = square > 0 ? square * slope / viscosity : 0;
            const double shape = pow(fmin(fmax(lambda[i], thwaites_separation), 0.25) - thwaites_separation, 0.62);
            friction[i] = square > 0 ? direction * viscosity * b * shape / sqrt(square) : 0;
        }
    }
}

// ---- the wall of a body

/* Points from the tail along the left side of the fish, where eta = -sqrt(s), to the nose and along the right side,
 * where eta = sqrt(s). The normal points to the right side. */
enum { PER_INTERVAL = 4, N_ARRAYS = 6 };
struct wall {
    int n;                                         /* odd: the nose is in the middle */
    double *s, *x, *u, *friction, *lambda, *sheet; /* sheet: slip, and gamma sqrt(s), of the control points */
};

/* At the distance s from the nose the flow relative to the body is w_t -+ gamma/2. It is multiplied by 1 + h/L for the
 * thickness and by sqrt(s/(s + r/2)) for the round nose. An element of the wall has the length sqrt((s + r/2)/s) ds.
 * Velocities are positive towards larger eta. */
static void wall_fill(const struct wall *wall, const struct pressure *pressure, const double *y, const double *yp) {
    const struct fish *const fish = pressure->fish;
    const int half = wall->n / 2;
    const double nose = fish->nose_radius / 2, thickness = 1 + 2 * sqrt(nose / fish->length);
    double *const slip = wall->sheet, *const strength = slip + fish->n_control;
    for (int c = 0; c < fish->n_control; c++) {
        const struct pressure_sheet sheet = pressure_sheet_at(pressure, c, y, yp);
        const double local = fish->strip_depth > 0 ? fish->strip_depth / pressure_strip_depth_at(fish, c) : 1;
        slip[c] = sheet.slip;
        strength[c] = local * sheet.strength * sqrt(fish_mean(&fish->control_point[c], fish->arc));
    }

    for (int i = 0; i < wall->n; i++) {
        // points crowd at the nose, where the velocity changes over a distance of the root of r/2
        const double part = (double)(i - half) / half, share = sin(M_PI / 2 * part * fabs(part));
        const double eta = sqrt(fish->length) * share;
        double weight[4], w = 0, g = 0;
        const int first = sensor_weights(fish, share * share, weight);
        for (int k = 0; k < 4; k++) {
            w += weight[k] * slip[first + k];
            g += weight[k] * strength[first + k];
        }

        const double root = sqrt(eta * eta + nose);
        wall->s[i] = eta * eta;
        wall->u[i] = thickness * (w * eta - g / 2) / root;
        wall->x[i] = eta * root + nose * asinh(eta / sqrt(nose));
    }
}

struct thwaites_friction thwaites_friction(struct pressure *pressure, const double *y, const double *yp) {
    const struct fish *const fish = pressure->fish;
    struct thwaites_friction friction = {.separation = {NAN, NAN}};
    if (!(fish->viscosity > 0)) return friction;

    struct wall wall = {.n = 2 * PER_INTERVAL * fish->n_control + 1};
    double **const arrays[N_ARRAYS] = {&wall.s, &wall.x, &wall.u, &wall.friction, &wall.lambda, &wall.sheet};
    if (!pressure->wall) NEW(pressure->arena, pressure->wall, N_ARRAYS * wall.n);
    for (int i = 0; i < N_ARRAYS; i++) *arrays[i] = pressure->wall + (long)i * wall.n;
    wall_fill(&wall, pressure, y, yp);
    thwaites_layers(wall.n, wall.x, wall.u, fish->viscosity, wall.friction, wall.lambda);

    // friction pulls the body by -tau ds t on the left and by tau ds t on the right, over the depth of the edge
    const int half = wall.n / 2;
    for (int i = 0; i < wall.n; i++) {
        const int side = i > half, direction = side ? 1 : -1;
        const int low = i > 0 ? i - 1 : 0, high = i < wall.n - 1 ? i + 1 : i;
        const double s = wall.s[i], part = fabs(wall.s[high] - s) / 2 + fabs(s - wall.s[low]) / 2;
        const int edge = (int)fmin(s / fish->length * fish->n_edges, fish->n_edges - 1);
        const double along = direction * fish->fluid_density * fish->depth[edge] * wall.friction[i] * part;

        double weight[4];
        const int first = sensor_weights(fish, s / fish->length, weight);
        friction.along += along;
        for (int k = 0; k < 4; k++) {
            const double *const t = pressure->point[first + k].body.t;
            for (int j = 0; j < 2; j++) friction.force[side][j] += along * weight[k] * t[j];
        }
    }

    // a layer towards the tail separates where lambda first reaches -0.09, or where it meets a reversed flow
    for (int side = 0; side < 2; side++) {
        const int direction = side == 0 ? -1 : 1;
        bool has_layer = false;
        for (int k = 0; k <= half && isnan(friction.separation[side]); k++) {
            const int i = half + direction * k, before = i - direction;
            const bool is_layer = direction * wall.u[i] > 0;
            double part = NAN;
            if (has_layer && !is_layer) {
                part = wall.u[before] / (wall.u[before] - wall.u[i]);
            } else if (has_layer && wall.lambda[i] < thwaites_separation) {
                part = (thwaites_separation - wall.lambda[before]) / (wall.lambda[i] - wall.lambda[before]);
            }
            friction.separation[side] = ((1 - part) * wall.s[before] + part * wall.s[i]) / fish->length;
            has_layer = is_layer;
        }
    }

    return friction;
}
