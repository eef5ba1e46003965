/* kernel_loops.h: the loops over targets and sources. kernel.c includes this text once for every vector width, with
 *
 *     VARIANT(name)       the name of a function for this width
 *     TARGET              the attribute of a function for this processor
 *     lanes               a vector of doubles
 *     FUSED(a, b, c)      a b + c
 *     ROOT(a)             the square root of every lane: IEEE 754 rounds it
 *
 * The operations on one target, and the order of operations, are the same for every width. */

enum { VARIANT(width) = sizeof(lanes) / sizeof(double) };

static inline TARGET lanes VARIANT(get)(const double *value) {
    lanes vector;
    memcpy(&vector, value, sizeof vector);
    return vector;
}

static inline TARGET void VARIANT(put)(double *value, lanes vector) {
    memcpy(value, &vector, sizeof vector);
}

// ---- finite span

static inline __attribute__((always_inline)) TARGET void VARIANT(rings)(struct kernel_block *at,
                                                                        const struct block_sources *from,
                                                                        bool with_gradient) {
    const double scale = from->span * inverse_two_pi;
    for (int i = 0; i < at->n; i += VARIANT(width)) {
        const lanes x = VARIANT(get)(at->x + i), y = VARIANT(get)(at->y + i);
        const lanes half = VARIANT(get)(at->half + i), square = VARIANT(get)(at->square + i);
        lanes u = {0}, v = {0}, leg_u = {0}, leg_v = {0}, div = {0};
        lanes sum_f = {0}, u_x = {0}, u_y = {0}, v_x = {0}, div_x = {0}, div_y = {0};
        for (int n = 0; n < from->n; n++) {
            const double dx = from->dx[n], dy = from->dy[n];
            const double half_n = from->factor * from->half[n] + from->leg[n], square_n = from->square[n] + from->add;
            const lanes rx = x - from->x[n], ry = y - from->y[n], r2 = FUSED(rx, rx, ry * ry);
            const lanes r = r2 + (square + square_n), t = r2 + (half + half_n), root = ROOT(t);
            const lanes inverse = 1 / (r * t * root), unit = inverse * t, f = from->q[n] * unit, g = inverse * r;
            u = FUSED(f, ry, u);
            v = FUSED(f, rx, v);
            // a bound vortex has no leg, so skip its part
            if (!with_gradient && !(fabs(dx) + fabs(dy) > 0)) continue;
            const lanes all_dx = dx - (lanes){0}, all_dy = dy - (lanes){0}, over_t = g * root, fifth = g * over_t;
            const lanes across = rx * dy - ry * dx;
            leg_u = FUSED(g, all_dy, leg_u);
            leg_v = FUSED(g, all_dx, leg_v);
            div = FUSED(fifth, across, div);
            if (!with_gradient) continue;

            // the slopes of f, g and 3/T^(5/2) over r, negative
            const lanes of_f = f * FUSED(2 * root, unit, over_t), of_g = 3 * fifth, h = 5 * over_t * of_g * across;
            const lanes by_dx = of_g * dx, by_dy = of_g * dy;
            const lanes along_x = FUSED(rx, of_f, by_dx), along_y = FUSED(ry, of_f, by_dy);
            sum_f += f;
            u_x = FUSED(along_y, rx, u_x);
            u_y = FUSED(along_y, ry, u_y);
            v_x = FUSED(along_x, rx, v_x);
            div_x = FUSED(h, rx, div_x) - by_dy;
            div_y = FUSED(h, ry, div_y) + by_dx;
        }

        VARIANT(put)(at->u + i, -scale * u);
        VARIANT(put)(at->v + i, scale * v);
        VARIANT(put)(at->leg_u + i, -scale * leg_u);
        VARIANT(put)(at->leg_v + i, scale * leg_v);
        VARIANT(put)(at->div + i, scale * div);
        if (!with_gradient) continue;
        VARIANT(put)(at->u_x + i, scale * u_x);
        VARIANT(put)(at->u_y + i, scale * (u_y - sum_f));
        VARIANT(put)(at->v_x + i, scale * (sum_f - v_x));
        VARIANT(put)(at->div_x + i, -scale * div_x);
        VARIANT(put)(at->div_y + i, -scale * div_y);
    }
}

static TARGET void VARIANT(velocity)(struct kernel_block *at, const struct block_sources *from) {
    VARIANT(rings)(at, from, false);
}

static TARGET void VARIANT(gradient)(struct kernel_block *at, const struct block_sources *from) {
    VARIANT(rings)(at, from, true);
}

// A block of rings and later sources, each of which is a target of the others. The sums of a source stay one number
// per lane until the end.
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
            struct block_lanes *const sum = &sums[n];
            lanes to_u = VARIANT(get)(sum->u + i), to_v = VARIANT(get)(sum->v + i);
            lanes to_leg_u = VARIANT(get)(sum->leg_u + i), to_leg_v = VARIANT(get)(sum->leg_v + i);
            lanes to_div = VARIANT(get)(sum->div + i);
            for (int k = 0; k < 2; k++) {
                const lanes rx = x[k] - from->x[n], ry = y[k] - from->y[n], r2 = FUSED(rx, rx, ry * ry);
                const lanes r = r2 + (square[k] + square_n), t = r2 + (half[k] + half_n), root = ROOT(t);
                const lanes inverse = 1 / (r * t * root), f = inverse * t, g = inverse * r;
                const lanes fx = f * rx, fy = f * ry, h = g * g * root;
                u[k] = FUSED(all_q, fy, u[k]);
                v[k] = FUSED(all_q, fx, v[k]);
                leg_u[k] = FUSED(g, all_dy, leg_u[k]);
                leg_v[k] = FUSED(g, all_dx, leg_v[k]);
                div[k] = FUSED(h, rx * dy - ry * dx, div[k]);

                // at the source, with the opposite distance
                to_u = FUSED(q_at[k], fy, to_u);
                to_v = FUSED(q_at[k], fx, to_v);
                to_leg_u = FUSED(g, dy_at[k], to_leg_u);
                to_leg_v = FUSED(g, dx_at[k], to_leg_v);
                to_div = FUSED(h, rx * dy_at[k] - ry * dx_at[k], to_div);
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

// The squares of the targets are either all no_square, or one for each; in the first case e^2 + r_y^2 is one sum for
// all.
static inline __attribute__((always_inline)) TARGET void VARIANT(velocity_of_squares)(struct kernel_block *at,
                                                                                      const struct block_sources *from,
                                                                                      bool has_squares) {
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

static TARGET void VARIANT(gradient_infinite)(struct kernel_block *at, const struct block_sources *from) {
    const double scale = from->span * inverse_two_pi;
    for (int i = 0; i < at->n; i += VARIANT(width)) {
        const lanes x = VARIANT(get)(at->x + i), y = VARIANT(get)(at->y + i), square = VARIANT(get)(at->square + i);
        lanes u = {0}, v = {0}, u_x = {0}, u_y = {0}, v_x = {0};
        for (int n = 0; n < from->n; n++) {
            const lanes rx = x - from->x[n], ry = y - from->y[n], r2 = FUSED(rx, rx, ry * ry);
            const lanes inverse = 1 / (r2 + (square + (from->square[n] + from->add)));
            const lanes f = scale * from->q[n] * inverse, h = 2 * f * inverse;
            u = FUSED(f, ry, u);
            v = FUSED(f, rx, v);
            u_x = FUSED(h * rx, ry, u_x);
            u_y = FUSED(h * ry, ry, u_y) - f;
            v_x = FUSED(h * rx, rx, v_x) - f;
        }

        VARIANT(put)(at->u + i, -u);
        VARIANT(put)(at->v + i, v);
        VARIANT(put)(at->u_x + i, u_x);
        VARIANT(put)(at->u_y + i, u_y);
        VARIANT(put)(at->v_x + i, -v_x);
    }
}

static const struct kernel_loops VARIANT(loops) = {VARIANT(velocity), VARIANT(gradient), VARIANT(mutual)};
static const struct kernel_loops VARIANT(loops_infinite) = {VARIANT(velocity_infinite), VARIANT(gradient_infinite),
                                                            NULL};

#undef VARIANT
#undef TARGET
#undef lanes
#undef FUSED
#undef ROOT
