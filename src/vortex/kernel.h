/* kernel.h: innermost loops of the velocity of smoothed point vortices at points. doc/model.md, first
 * paragraph: K_e(r) = (-r_y, r_x) / (2 pi (|r|^2 + e^2)). Tested by tests/vortex/test_kernel.c.
 *
 * The sum at a target runs over the sources in array order, and every operation is rounded as written here. The results
 * have the same bits on all processors of a family, for any vector width:
 *
 * - |r|^2 + e^2 and the sums are fused products, a b + c with one rounding, on x86-64 with AVX2 and on arm64. Fused
 *   products are explicit; the compiler fuses nothing. The baseline for other processors rounds twice, so the last bits
 *   differ.
 * - Targets are processed in blocks of 16. In a block, targets i and i + 8 share a division, 1/(d_i d_i+8): the last
 *   bits of one target depend on the other target. In a last block of at most 8 targets, and for gradients, each target
 *   has a separate division. Lengths between 1e-75 and 1e75 m do not overflow.
 *
 * Arrays are separate for x and y, without alignment: each source is copied to all lanes of a vector, and a block of
 * targets is read once for all sources. */
#ifndef KERNEL_H
#define KERNEL_H

/* The head of a function with plain loops, compiled for several vector widths; each call selects the widest vectors of
 * the processor. The body follows, static may precede:
 *
 *     KERNEL_WIDE(void, double_all, (int n, double *x), (n, x)) {
 *         for (int i = 0; i < n; i++) x[i] *= 2;
 *     } */
#ifdef __x86_64__
#define KERNEL_WIDE(type, name, parameters, arguments)                         \
    type name parameters;                                                      \
    static inline __attribute__((always_inline)) type name##_loops parameters; \
    static __attribute__((target("avx512f"))) type name##_avx512 parameters {  \
        return name##_loops arguments;                                         \
    }                                                                          \
    static __attribute__((target("avx2"))) type name##_avx2 parameters {       \
        return name##_loops arguments;                                         \
    }                                                                          \
    static type name##_baseline parameters {                                   \
        return name##_loops arguments;                                         \
    }                                                                          \
    type name parameters {                                                     \
        if (__builtin_cpu_supports("avx512f")) return name##_avx512 arguments; \
        if (__builtin_cpu_supports("avx2")) return name##_avx2 arguments;      \
        return name##_baseline arguments;                                      \
    }                                                                          \
    static inline type name##_loops parameters
#else
#define KERNEL_WIDE(type, name, parameters, arguments) \
    type name parameters;                              \
    type name parameters
#endif

/* Add to (u, v) at each target the velocity of all sources; smoothing is the length e. A source at a target adds 0. */
void kernel_add_velocity(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                         const double *source_y, const double *circulation, double smoothing, double *u, double *v);

/* The same, and add the gradient: u_x = du/dx = -dv/dy, u_y = du/dy, v_x = dv/dx (the field has no divergence). */
void kernel_add_gradient(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                         const double *source_y, const double *circulation, double smoothing, double *u, double *v,
                         double *u_x, double *u_y, double *v_x);

/* The same for sources of different smoothings; square: e^2 of each source, m2 (n_sources). */
void kernel_add_velocity_each(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                              const double *source_y, const double *circulation, const double *square, double *u,
                              double *v);
void kernel_add_gradient_each(int n_targets, const double *x, const double *y, int n_sources, const double *source_x,
                              const double *source_y, const double *circulation, const double *square, double *u,
                              double *v, double *u_x, double *u_y, double *v_x);

/* A change of smoothing from one value for all sources to a value per source. */
struct kernel_changes {
    int n;
    const double *x, *y, *circulation; /* (n) */
    double from;                       /* the old square, e^2, m2 */
    const double *to;                  /* the new squares, m2 (n) */
};

/* Add the change of the velocity, and of the gradient, at each target. */
void kernel_add_velocity_change(int n_targets, const double *x, const double *y, const struct kernel_changes *changes,
                                double *u, double *v);
void kernel_add_gradient_change(int n_targets, const double *x, const double *y, const struct kernel_changes *changes,
                                double *u, double *v, double *u_x, double *u_y, double *v_x);

/* The same for a smoothing that depends on the target: square [m2] (n_targets) replaces `from` for all sources. */
void kernel_add_velocity_change_at(int n_targets, const double *x, const double *y, const double *square, int n_sources,
                                   const double *source_x, const double *source_y, const double *circulation,
                                   double from, double *u, double *v);

/* Vortices of a pairwise sum. */
struct kernel_tile {
    int n; /* a multiple of 16, at most KERNEL_TILE, padded with vortices of circulation 0 */
    const double *x, *y, *circulation; /* position, m, and circulation, m2 s-1 (n) */
    double *u, *v;                     /* velocity, m s-1                      (n) */
};
enum { KERNEL_TILE = 128 };

/* Add the mutually induced velocities of the vortices of two different tiles: K is odd, one division per pair.
 */
void kernel_add_pairwise(const struct kernel_tile *a, const struct kernel_tile *b, double smoothing);

/* Velocity and gradient at a chunk of targets. */
enum { KERNEL_CHUNK = 64 };
struct kernel_values {
    double u[KERNEL_CHUNK], v[KERNEL_CHUNK];
    double u_x[KERNEL_CHUNK], u_y[KERNEL_CHUNK], v_x[KERNEL_CHUNK];
};

/* The velocity of one source of unit circulation at n <= KERNEL_CHUNK targets. */
void kernel_unit(int n, const double *x, const double *y, double source_x, double source_y, double smoothing,
                 struct kernel_values *values);

/* Add to n targets the derivative of the velocity by a displacement of each source in x and in y, times the factor of
 * the source (n_sources); sign: of the displacement in y. u_by_x and v_by_x receive u_x and v_x, u_by_y and v_by_y
 * receive u_y and v_y = -u_x. */
void kernel_add_motion(int n, int n_sources, const double *factor, double sign, const struct kernel_values *values,
                       double *u_by_x, double *v_by_x, double *u_by_y, double *v_by_y);

/* product += matrix * vector: a dense matrix (n_rows, n_columns) in column-major order; columns are added in array
 * order. */
void kernel_multiply(int n_rows, int n_columns, const double *matrix, const double *vector, double *product);

/* The sources of one sum. */
struct kernel_sources {
    int n;
    const double *x, *y, *circulation;
    double square; /* e^2, plus a tiny number that avoids 0/0 for a source at a target */
};

/* The loops for one vector width; the functions above use the fastest variant of the processor. The number of targets
 * is a multiple of 8. */
struct kernel_variant {
    const char *name;
    void (*velocity)(int n, const double *x, const double *y, const struct kernel_sources *sources, double *u,
                     double *v);
    void (*gradient)(int n, const double *x, const double *y, const struct kernel_sources *sources, double *u,
                     double *v, double *u_x, double *u_y, double *v_x);
    void (*velocity_change)(int n, const double *x, const double *y, const struct kernel_changes *changes, double *u,
                            double *v);
    void (*gradient_change)(int n, const double *x, const double *y, const struct kernel_changes *changes, double *u,
                            double *v, double *u_x, double *u_y, double *v_x);
    void (*pairwise)(const struct kernel_tile *a, const struct kernel_tile *b, double square);
};

/* Variant i of this processor, the fastest first; NULL after the last variant. */
const struct kernel_variant *kernel_variant(int i);

#endif
