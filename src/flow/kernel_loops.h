/* ring_loops.h: the loops over targets and sources of the velocity of rings. ring.c includes this text once for every
 * vector width, with VARIANT, TARGET, lanes and FUSED as in kernel_loops.h, and
 *
 *     ONE_OVER_ROOT(a)    one over the square root of every lane, in single precision: IEEE 754 rounds both operations
 *
 * Targets i and i + HALF of a block share a division. The operations on one target, and the order of operations, are
 * the same for every width. */

enum { VARIANT(width) = sizeof(lanes) / sizeof(double) };

static inline TARGET lanes VARIANT(get)(const double *value) {
    lanes vector;
    memcpy(&vector, value, sizeof vector);
    return vector;
}

static inline TARGET void VARIANT(put)(double *value, lanes vector) {
    memcpy(value, &vector, sizeof vector);
}

// T^(-1/2): the error e of single precision, 2e-7 of the value, becomes (5/2) e^3, below the rounding. T is within the
// range of single precision, 1e-37 to 1e38 m2.
static inline TARGET lanes VARIANT(inverse_root)(lanes t) {
    const lanes near = ONE_OVER_ROOT(t), error = 1 - t * near * near;
    return FUSED(near * error, FUSED(error, 0.375 - (lanes){0}, 0.5 - (lanes){0}), near);
}

static TARGET void VARIANT(velocity)(struct kernel_block *at, const struct block_sources *from) {
    const double scale = from->span * inverse_two_pi;
    for (int i = 0; i < HALF; i += VARIANT(width)) {
        lanes x[2], y[2], half[2], square[2], u[2], v[2], leg_u[2], leg_v[2], div[2];
        for (int k = 0; k < 2; k++) {
            x[k] = VARIANT(get)(at->x + i + k * HALF);
            y[k] = VARIANT(get)(at->y + i + k * HALF);
            half[k] = VARIANT(get)(at->half + i + k * HALF);
            square[k] = VARIANT(get)(at->square + i + k * HALF);
            u[k] = v[k] = leg_u[k] = leg_v[k] = div[k] = (lanes){0};
        }

        for (int n = 0; n < from->n; n++) {
            const double q = from->q[n] * scale, dx = from->dx[n] * scale, dy = from->dy[n] * scale;
            const double half_n = from->factor * from->half[n] + from->leg[n], square_n = from->square[n] + from->add;
            const lanes all_dx = dx - (lanes){0}, all_dy = dy - (lanes){0};
            lanes rx[2], ry[2], r[2], root[2];
            for (int k = 0; k < 2; k++) {
                rx[k] = x[k] - from->x[n];
                ry[k] = y[k] - from->y[n];
                const lanes r2 = FUSED(rx[k], rx[k], ry[k] * ry[k]);
                r[k] = r2 + (square[k] + square_n);
                root[k] = VARIANT(inverse_root)(r2 + (half[k] + half_n));
            }

            // a bound vortex has no leg, and a leg of the body has no spanwise vortex
            if (fabs(q) > 0) {
                const lanes shared = q / (r[0] * r[1]);
                for (int k = 0; k < 2; k++) {
                    const lanes f = shared * r[1 - k] * root[k];
                    u[k] = FUSED(f, ry[k], u[k]);
                    v[k] = FUSED(f, rx[k], v[k]);
                }
            }

            if (!(fabs(dx) + fabs(dy) > 0)) continue;
            for (int k = 0; k < 2; k++) {
                const lanes inverse = root[k] * root[k], g = inverse * root[k];
                leg_u[k] = FUSED(g, all_dy, leg_u[k]);
                leg_v[k] = FUSED(g, all_dx, leg_v[k]);
                div[k] = FUSED(g * inverse, rx[k] * dy - ry[k] * dx, div[k]);
            }
        }

        for (int k = 0; k < 2; k++) {
            VARIANT(put)(at->u + i + k * HALF, -u[k]);
            VARIANT(put)(at->v + i + k * HALF, v[k]);
            VARIANT(put)(at->leg_u + i + k * HALF, -leg_u[k]);
            VARIANT(put)(at->leg_v + i + k * HALF, leg_v[k]);
            VARIANT(put)(at->div + i + k * HALF, div[k]);
        }
    }
}

// a block of rings and later sources, each the targets of the others: the sums of a source stay one number per lane
static TARGET void VARIANT(mutual)(struct kernel_block *at, const struct block_mates *mates,
                                   const struct block_sources *from, struct block_lanes *sums) {
    const double scale = from->span * inverse_two_pi;
    for (int i = 0; i < HALF; i += VARIANT(width)) {
        lanes x[2], y[2], half[2], square[2], q_at[2], dx_at[2], dy_at[2], u[2], v[2], leg_u[2], leg_v[2], div[2];
        for (int k = 0; k < 2; k++) {
            const int p = i + k * HALF;
            x[k] = VARIANT(get)(at->x + p);
            y[k] = VARIANT(get)(at->y + p);
            half[k] = VARIANT(get)(at->half + p);
            square[k] = VARIANT(get)(at->square + p);
            q_at[k] = scale * VARIANT(get)(mates->q + p);
            dx_at[k] = scale * VARIANT(get)(mates->dx + p);
            dy_at[k] = scale * VARIANT(get)(mates->dy + p);
            u[k] = v[k] = leg_u[k] = leg_v[k] = div[k] = (lanes){0};
        }

        for (int n = 0; n < from->n; n++) {
            const double q = from->q[n] * scale, dx = from->dx[n] * scale, dy = from->dy[n] * scale;
            const double half_n = from->factor * from->half[n] + from->leg[n], square_n = from->square[n] + from->add;
            const lanes all_q = q - (lanes){0}, all_dx = dx - (lanes){0}, all_dy = dy - (lanes){0};
            lanes rx[2], ry[2], r[2], root[2];
            for (int k = 0; k < 2; k++) {
                rx[k] = x[k] - from->x[n];
                ry[k] = y[k] - from->y[n];
                const lanes r2 = FUSED(rx[k], rx[k], ry[k] * ry[k]);
                r[k] = r2 + (square[k] + square_n);
                root[k] = VARIANT(inverse_root)(r2 + (half[k] + half_n));
            }

            const lanes shared = 1 / (r[0] * r[1]);
            struct block_lanes *const sum = &sums[n];
            lanes to_u = VARIANT(get)(sum->u + i), to_v = VARIANT(get)(sum->v + i);
            lanes to_leg_u = VARIANT(get)(sum->leg_u + i), to_leg_v = VARIANT(get)(sum->leg_v + i);
            lanes to_div = VARIANT(get)(sum->div + i);
            for (int k = 0; k < 2; k++) {
                const lanes inverse = root[k] * root[k], f = shared * r[1 - k] * root[k], g = inverse * root[k];
                const lanes fx = f * rx[k], fy = f * ry[k], h = g * inverse;
                u[k] = FUSED(all_q, fy, u[k]);
                v[k] = FUSED(all_q, fx, v[k]);
                leg_u[k] = FUSED(g, all_dy, leg_u[k]);
                leg_v[k] = FUSED(g, all_dx, leg_v[k]);
                div[k] = FUSED(h, rx[k] * dy - ry[k] * dx, div[k]);

                // at the source, with the opposite distance
                to_u = FUSED(q_at[k], fy, to_u);
                to_v = FUSED(q_at[k], fx, to_v);
                to_leg_u = FUSED(g, dy_at[k], to_leg_u);
                to_leg_v = FUSED(g, dx_at[k], to_leg_v);
                to_div = FUSED(h, rx[k] * dy_at[k] - ry[k] * dx_at[k], to_div);
            }
            VARIANT(put)(sum->u + i, to_u);
            VARIANT(put)(sum->v + i, to_v);
            VARIANT(put)(sum->leg_u + i, to_leg_u);
            VARIANT(put)(sum->leg_v + i, to_leg_v);
            VARIANT(put)(sum->div + i, to_div);
        }

        for (int k = 0; k < 2; k++) {
            VARIANT(put)(at->u + i + k * HALF, -u[k]);
            VARIANT(put)(at->v + i + k * HALF, v[k]);
            VARIANT(put)(at->leg_u + i + k * HALF, -leg_u[k]);
            VARIANT(put)(at->leg_v + i + k * HALF, leg_v[k]);
            VARIANT(put)(at->div + i + k * HALF, div[k]);
        }
    }
}

// ---- infinite span

// the squares of all targets are no_square, or one for each target: e^2 + r_y^2 is then one sum more
static inline __attribute__((always_inline)) TARGET void VARIANT(velocity_of_squares)(struct kernel_block *at,
                                                                                      const struct block_sources *from,
                                                                                      int has_squares) {
    const double scale = from->span * inverse_two_pi;
    for (int i = 0; i < HALF; i += VARIANT(width)) {
        lanes x[2], y[2], square[2], u[2], v[2];
        for (int k = 0; k < 2; k++) {
            x[k] = VARIANT(get)(at->x + i + k * HALF);
            y[k] = VARIANT(get)(at->y + i + k * HALF);
            square[k] = VARIANT(get)(at->square + i + k * HALF);
            u[k] = v[k] = (lanes){0};
        }

        for (int n = 0; n < from->n; n++) {
            const double q = from->q[n], square_n = from->square[n] + from->add;
            const lanes all_square = square_n + no_square - (lanes){0};
            lanes rx[2], ry[2], r[2];
            for (int k = 0; k < 2; k++) {
                rx[k] = x[k] - from->x[n];
                ry[k] = y[k] - from->y[n];
                lanes sum = all_square;
                if (has_squares) sum = square[k] + square_n;
                r[k] = FUSED(rx[k], rx[k], FUSED(ry[k], ry[k], sum));
            }

            const lanes shared = q / (r[0] * r[1]);
            for (int k = 0; k < 2; k++) {
                const lanes f = shared * r[1 - k];
                u[k] = FUSED(f, ry[k], u[k]);
                v[k] = FUSED(f, rx[k], v[k]);
            }
        }

        for (int k = 0; k < 2; k++) {
            VARIANT(put)(at->u + i + k * HALF, -scale * u[k]);
            VARIANT(put)(at->v + i + k * HALF, scale * v[k]);
        }
    }
}

static TARGET void VARIANT(velocity_infinite)(struct kernel_block *at, const struct block_sources *from) {
    if (at->has_squares) {
        VARIANT(velocity_of_squares)(at, from, 1);
    } else {
        VARIANT(velocity_of_squares)(at, from, 0);
    }
}

static const struct kernel_loops VARIANT(loops) = {.velocity = VARIANT(velocity), .mutual = VARIANT(mutual)};
static const struct kernel_loops VARIANT(loops_infinite) = {.velocity = VARIANT(velocity_infinite)};

#undef VARIANT
#undef TARGET
#undef lanes
#undef FUSED
#undef ONE_OVER_ROOT
