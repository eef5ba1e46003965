/* shared_vector.c: the serial operations of SUNDIALS on parts of the vectors. */
#include "solver/shared_vector.h"

#include <nvector/nvector_serial.h>
#include <stdlib.h>

/* Elements of a part: of all vectors of an operation they stay in the cache while it goes through its terms. */
enum { PART = 512 };

/* What a vector has: the serial one's content first, so that all operations of the serial vector know it. */
struct content {
    struct _N_VectorContent_Serial serial;
    const struct school *school;
};

static const struct school *school_of(N_Vector vector) {
    return ((const struct content *)vector->content)->school;
}

/* A part of a vector as a serial vector of its own. */
struct part {
    struct _N_VectorContent_Serial content;
    struct _generic_N_Vector vector;
};

static N_Vector part_of(N_Vector vector, int i, struct part *part) {
    const sunindextype first = (sunindextype)i * PART, rest = NV_LENGTH_S(vector) - first;
    part->content = (struct _N_VectorContent_Serial){rest < PART ? rest : PART, SUNFALSE, NV_DATA_S(vector) + first};
    part->vector = *vector;
    part->vector.content = &part->content;
    return &part->vector;
}

static int n_parts(N_Vector vector) {
    return (int)((NV_LENGTH_S(vector) + PART - 1) / PART);
}

static void linear_sum_of_part(int i, double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    struct part of_x, of_y, of_z;
    N_VLinearSum_Serial(a, part_of(x, i, &of_x), b, part_of(y, i, &of_y), part_of(z, i, &of_z));
}

static void scale_part(int i, double c, N_Vector x, N_Vector z) {
    struct part of_x, of_z;
    N_VScale_Serial(c, part_of(x, i, &of_x), part_of(z, i, &of_z));
}

static void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    const int n = n_parts(z), threads = fish_threads(school_of(z));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < n; i++) linear_sum_of_part(i, a, x, b, y, z);
}

static void scale(double c, N_Vector x, N_Vector z) {
    const int n = n_parts(z), threads = fish_threads(school_of(z));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < n; i++) scale_part(i, c, x, z);
}

static void set_constant(double c, N_Vector z) {
    const int n = n_parts(z), threads = fish_threads(school_of(z));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < n; i++) {
        struct part of_z;
        N_VConst_Serial(c, part_of(z, i, &of_z));
    }
}

// term after term, as SUNDIALS does it with operations on two vectors
static int linear_combination(int n_terms, double *c, N_Vector *x, N_Vector z) {
    const int n = n_parts(z), threads = fish_threads(school_of(z));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < n; i++) {
        scale_part(i, c[0], x[0], z);
        for (int k = 1; k < n_terms; k++) linear_sum_of_part(i, c[k], x[k], 1, z, z);
    }
    return 0;
}

static int scale_many(int n_vectors, double *c, N_Vector *x, N_Vector *z) {
    const int n = n_parts(z[0]), threads = fish_threads(school_of(z[0]));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n_vectors; k++) scale_part(i, c[k], x[k], z[k]);
    }
    return 0;
}

// one vector after another: each may be an argument of the next
static int linear_sum_many(int n_vectors, double a, N_Vector *x, double b, N_Vector *y, N_Vector *z) {
    const int n = n_parts(z[0]), threads = fish_threads(school_of(z[0]));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n_vectors; k++) linear_sum_of_part(i, a, x[k], b, y[k], z[k]);
    }
    return 0;
}

// put the school into the content of a serial vector; the vector is released where there is no memory for it
static N_Vector give_school(N_Vector vector, const struct school *school) {
    if (!vector) return NULL;
    struct content *const content = realloc(vector->content, sizeof *content);
    if (!content) {
        N_VDestroy(vector);
        return NULL;
    }
    content->school = school;
    vector->content = content;
    return vector;
}

static N_Vector clone(N_Vector vector) {
    return give_school(N_VClone_Serial(vector), school_of(vector));
}

enum status shared_vector_create(N_Vector *vector, SUNContext context, const struct school *school, double *values) {
    *vector = give_school(N_VMake_Serial(school->n_unknowns, values, context), school);
    if (!*vector) return status_fail(STATUS_MEMORY, "out of memory: a vector of %d unknowns", school->n_unknowns);
    const N_Vector_Ops ops = (*vector)->ops;
    ops->nvclone = clone;
    ops->nvlinearsum = linear_sum;
    ops->nvscale = scale;
    ops->nvconst = set_constant;
    ops->nvlinearcombination = linear_combination;
    ops->nvscalevectorarray = scale_many;
    ops->nvlinearsumvectorarray = linear_sum_many;
    return STATUS_OK;
}
