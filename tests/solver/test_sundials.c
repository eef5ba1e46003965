/* test_sundials.c: The threaded vectors have the bits of the serial vectors of SUNDIALS with any number of threads, a
 * lack of memory of SUNDIALS is told, and its messages arrive. */
#include <limits.h>
#include <math.h>
#include <string.h>
#include <sys/resource.h>

#include "base/parallel.h"
#include "school.h"
#include "solver/sundials.h"

// enough for threads
enum { N = PARALLEL_ELEMENTS + 77, N_VECTORS = 4, OURS = 0, SERIAL = 1 };

static double values[2][N_VECTORS][N];

/* The same numbers twice: in vectors of ours and in serial ones. */
struct both {
    struct arena *arena;
    struct sundials_context context;
    enum status failure;
    N_Vector vector[2][N_VECTORS];
};

static void fill(void) {
    for (int k = 0; k < N_VECTORS; k++) {
        for (int i = 0; i < N; i++) values[OURS][k][i] = values[SERIAL][k][i] = sin(1 + i + 100 * k);
    }
}

static void create(struct both *both, int threads) {
    both->failure = STATUS_OK;
    both->arena = arena_create(NULL, "vectors");
    sundials_context_create(&both->context, both->arena, N, threads, &both->failure);
    for (int k = 0; k < N_VECTORS; k++) {
        both->vector[OURS][k] = sundials_context_vector(&both->context, values[OURS][k]);
        both->vector[SERIAL][k] = N_VMake_Serial(N, values[SERIAL][k], both->context.context);
    }
}

static void clear(struct both *both) {
    for (int k = 0; k < 2 * N_VECTORS; k++) N_VDestroy(both->vector[k / N_VECTORS][k % N_VECTORS]);
    arena_free(both->arena);
}

// all operations of the solvers on single values, also where the result is an argument
static void operate(N_Vector *v) {
    const double factor[][2] = {{1, 1},    {1, -1},    {-1, 1},     {0.3, 1},  {1, 0.3},
                                {-1, 0.3}, {0.3, 0.3}, {0.3, -0.3}, {0.3, 0.7}};
    for (size_t i = 0; i < sizeof factor / sizeof *factor; i++) {
        N_VLinearSum(factor[i][0], v[0], factor[i][1], v[1], v[2]);
        N_VLinearSum(factor[i][0], v[2], factor[i][1], v[1], v[1]);
        N_VLinearSum(factor[i][0], v[0], factor[i][1], v[2], v[0]);
    }
    double c[] = {0.7, 0.7, 0.3};
    assert_int_equal(N_VLinearCombination(3, c, v, v[3]), 0);
    assert_int_equal(N_VLinearCombination(2, c, v, v[2]), 0);
    assert_int_equal(N_VScaleVectorArray(3, c, v, v), 0);
    // each result is an argument of the next sum
    N_Vector to[] = {v[1], v[2], v[3]};
    assert_int_equal(N_VLinearSumVectorArray(3, 1, v, 0.3, to, to), 0);
    N_VScale(-1, v[0], v[0]);
    N_VScale(0.3, v[1], v[2]);
    N_VConst(0.3, v[1]);
}

TEST(every_element_has_the_bits_of_the_serial_vector) {
    for (int threads = 1; threads <= 3; threads++) {
        struct both both;
        fill();
        create(&both, threads);
        for (int k = 0; k < 2; k++) operate(both.vector[k]);
        assert_memory_equal(values[OURS], values[SERIAL], sizeof values[SERIAL]);
        clear(&both);
    }
}

TEST(norms_have_the_bits_of_the_serial_vector) {
    for (int threads = 1; threads <= 3; threads++) {
        struct both both;
        fill();
        create(&both, threads);
        double all[2], masked[2];
        for (int k = 0; k < 2; k++) {
            N_Vector *const v = both.vector[k];
            all[k] = N_VWrmsNorm(v[0], v[1]);
            masked[k] = N_VWrmsNormMask(v[0], v[1], v[2]);
        }
        NEAR(all[OURS], all[SERIAL], 0, 0);
        NEAR(masked[OURS], masked[SERIAL], 0, 0);
        ABOVE(masked[SERIAL], 0);
        BELOW(masked[SERIAL], all[SERIAL]);
        clear(&both);
    }
}

TEST(a_clone_has_values_of_its_own) {
    struct both both;
    fill();
    create(&both, 2);
    N_Vector const clone = N_VClone(both.vector[OURS][0]), second = N_VClone(clone);
    N_VLinearSum(0.3, both.vector[OURS][0], 0.7, both.vector[OURS][1], clone);
    N_VScale(2, clone, second);
    for (int i = 0; i < N; i++) {
        NEAR(N_VGetArrayPointer(second)[i], 2 * N_VGetArrayPointer(clone)[i], 0, 0);
        NEAR(N_VGetArrayPointer(clone)[i], 0.3 * values[SERIAL][0][i] + 0.7 * values[SERIAL][1][i], 0, 0);
    }
    assert_memory_equal(values[OURS], values[SERIAL], sizeof values[SERIAL]);
    NEAR(N_VWrmsNorm(clone, second), N_VWrmsNorm(second, clone), 0, 0);
    N_VDestroy(second);
    N_VDestroy(clone);
    clear(&both);
}

// a call that IDA refuses: its message is ours, unless a callback has failed before, whose message is the cause
TEST(errors_of_a_package_become_messages) {
    struct both both;
    create(&both, 1);
    void *ida = IDACreate(both.context.context);
    assert_int_equal(IDASetErrHandlerFn(ida, sundials_context_message, &both.failure), SUN_SUCCESS);
    status_fail(STATUS_CASE, "the last message");
    assert_int_equal(IDASetMaxOrd(ida, -1), IDA_ILL_INPUT);
    assert_non_null(strstr(status_message(), "(IDASetMaxOrd)"));
    both.failure = status_fail(STATUS_CASE, "the cause");
    assert_int_equal(IDASetMaxOrd(ida, -1), IDA_ILL_INPUT);
    assert_string_equal(status_message(), "the cause");
    IDAFree(&ida);
    clear(&both);
}

#ifndef __SANITIZE_ADDRESS__
static int no_root(sunrealtype t, N_Vector y, N_Vector yp, sunrealtype *value, void *data) {
    (void)t, (void)y, (void)yp, (void)value, (void)data;
    return 0;
}
#endif

TEST(a_lack_of_memory_of_sundials_is_told_from_other_errors) {
    struct both both;
    create(&both, 1);
    void *ida = IDACreate(both.context.context);
    assert_int_equal(IDASetErrHandlerFn(ida, sundials_context_message, &both.failure), SUN_SUCCESS);
    assert_int_equal(IDASetMaxOrd(ida, -1), IDA_ILL_INPUT);
    assert_int_equal(sundials_context_failed(&both.context, "IDA"), STATUS_SOLVER);
    assert_non_null(strstr(status_message(), "IDA cannot be set up: "));
#ifndef __SANITIZE_ADDRESS__  // which ends the program instead
    // arrays of 16 GB, with a limit of 4 GB
    struct rlimit limit, small;
    getrlimit(RLIMIT_AS, &limit);
    small = limit;
    small.rlim_cur = (rlim_t)1 << 32;
    assert_int_equal(setrlimit(RLIMIT_AS, &small), 0);
    const int code = IDARootInit(ida, INT_MAX, no_root);
    assert_int_equal(setrlimit(RLIMIT_AS, &limit), 0);
    assert_int_equal(code, IDA_MEM_FAIL);
    assert_int_equal(sundials_context_failed(&both.context, "IDA"), STATUS_MEMORY);
    assert_string_equal(status_message(), "out of memory: SUNDIALS (IDARootInit)");
#endif
    IDAFree(&ida);
    clear(&both);
}
