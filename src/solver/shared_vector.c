/* shared_vector.c: the serial operations of SUNDIALS on parts of the vectors. */
#include "solver/shared_vector.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"

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

static void set_constant(double c, N_Vector z);

// a clone that found no memory for its school is a serial vector
static int threads_of(N_Vector vector) {
    return vector->ops->nvconst == set_constant ? school_of(vector)->threads : 1;
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

/* An operation on n vectors each: their factors and their vectors. */
struct operation {
    int n;
    double a, b;
    const double *factor; /* (n) */
    N_Vector *x, *y, *z;  /* (n) */
};

static void linear_sum_of_part(int i, double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    struct part of_x, of_y, of_z;
    N_VLinearSum_Serial(a, part_of(x, i, &of_x), b, part_of(y, i, &of_y), part_of(z, i, &of_z));
}

static void scale_part(int i, double c, N_Vector x, N_Vector z) {
    struct part of_x, of_z;
    N_VScale_Serial(c, part_of(x, i, &of_x), part_of(z, i, &of_z));
}

// the operations on part i; one vector after another: each may be an argument of the next
static void set_constants(void *data, int i) {
    const struct operation *const of = data;
    struct part of_z;
    N_VConst_Serial(of->a, part_of(of->z[0], i, &of_z));
}

static void scale_all(void *data, int i) {
    const struct operation *const of = data;
    for (int k = 0; k < of->n; k++) scale_part(i, of->factor[k], of->x[k], of->z[k]);
}

static void sum_all(void *data, int i) {
    const struct operation *const of = data;
    for (int k = 0; k < of->n; k++) linear_sum_of_part(i, of->a, of->x[k], of->b, of->y[k], of->z[k]);
}

// term after term, as SUNDIALS does it with operations on two vectors
static void combine(void *data, int i) {
    const struct operation *const of = data;
    scale_part(i, of->factor[0], of->x[0], of->z[0]);
    for (int k = 1; k < of->n; k++) linear_sum_of_part(i, of->factor[k], of->x[k], 1, of->z[0], of->z[0]);
}

static int operate(parallel_body *operation, struct operation of) {
    const sunindextype length = NV_LENGTH_S(of.z[0]);
    const int n_parts = (int)((length + PART - 1) / PART), all = threads_of(of.z[0]);
    const int threads = parallel_threads(all, n_parts, (double)length * of.n, PARALLEL_ELEMENTS);
    parallel_for(threads, n_parts, operation, &of);
    return 0;
}

static void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector z) {
    operate(sum_all, (struct operation){.n = 1, .a = a, .b = b, .x = &x, .y = &y, .z = &z});
}

static void scale(double c, N_Vector x, N_Vector z) {
    operate(scale_all, (struct operation){.n = 1, .factor = &c, .x = &x, .z = &z});
}

static void set_constant(double c, N_Vector z) {
    operate(set_constants, (struct operation){.n = 1, .a = c, .z = &z});
}

static int linear_combination(int n, double *c, N_Vector *x, N_Vector z) {
    return operate(combine, (struct operation){.n = n, .factor = c, .x = x, .z = &z});
}

static int scale_many(int n, double *c, N_Vector *x, N_Vector *z) {
    return operate(scale_all, (struct operation){.n = n, .factor = c, .x = x, .z = z});
}

static int linear_sum_many(int n, double a, N_Vector *x, double b, N_Vector *y, N_Vector *z) {
    return operate(sum_all, (struct operation){.n = n, .a = a, .b = b, .x = x, .y = y, .z = z});
}

// in the order of the serial vector, without its branch on the kind of an element
static double masked_norm(N_Vector x, N_Vector weight, N_Vector mask) {
    const double *const value = NV_DATA_S(x), *const w = NV_DATA_S(weight), *const kind = NV_DATA_S(mask);
    const sunindextype n = NV_LENGTH_S(x);
    double sum = 0;
    for (sunindextype i = 0; i < n; i++) {
        const double weighted = value[i] * w[i];
        sum += kind[i] > 0 ? weighted * weighted : 0;
    }
    return sqrt(sum / (double)n);
}

// make room for the school in the content of a serial vector, and put it there; returns whether there was memory for it
static int give_school(N_Vector vector, const struct school *school) {
    struct content *const content = realloc(vector->content, sizeof *content);
    if (!content) return 0;
    content->school = school;
    vector->content = content;
    return 1;
}

static void take_serial_operations(N_Vector_Ops ops) {
    ops->nvclone = N_VClone_Serial;
    ops->nvlinearsum = N_VLinearSum_Serial;
    ops->nvscale = N_VScale_Serial;
    ops->nvconst = N_VConst_Serial;
    ops->nvlinearcombination = NULL;
    ops->nvscalevectorarray = NULL;
    ops->nvlinearsumvectorarray = NULL;
}

// SUNDIALS crashes where there is no clone: without memory for the school it is a serial vector
static N_Vector clone(N_Vector vector) {
    const N_Vector new = N_VClone_Serial(vector);
    if (!new) return NULL;
    if (!give_school(new, school_of(vector))) take_serial_operations(new->ops);
    return new;
}

enum status shared_vector_create(N_Vector *vector, SUNContext context, const struct school *school, double *values) {
    *vector = N_VMake_Serial(school->n_unknowns, values, context);
    if (*vector && !give_school(*vector, school)) {
        N_VDestroy(*vector);
        *vector = NULL;
    }
    if (!*vector) return status_fail(STATUS_MEMORY, "out of memory: a vector of %d unknowns", school->n_unknowns);
    const N_Vector_Ops ops = (*vector)->ops;
    ops->nvclone = clone;
    ops->nvlinearsum = linear_sum;
    ops->nvscale = scale;
    ops->nvconst = set_constant;
    ops->nvwrmsnormmask = masked_norm;
    ops->nvlinearcombination = linear_combination;
    ops->nvscalevectorarray = scale_many;
    ops->nvlinearsumvectorarray = linear_sum_many;
    return STATUS_OK;
}
