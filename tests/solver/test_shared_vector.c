/* test_shared_vector.c: against the serial vectors of SUNDIALS, bit by bit, with any number of threads. */
#include <math.h>

#include "base/parallel.h"
#include "failing_malloc.h"
#include "school.h"
#include "solver/shared_vector.h"

// several parts, the last of which is not whole, and enough for threads
enum { N = PARALLEL_ELEMENTS + 77, N_VECTORS = 4, SHARED = 0, SERIAL = 1 };

static double values[2][N_VECTORS][N];

/* The same numbers twice: in shared vectors and in serial ones. */
struct both {
    struct school school;
    SUNContext context;
    N_Vector vector[2][N_VECTORS];
};

static void fill(void) {
    for (int k = 0; k < N_VECTORS; k++) {
        for (int i = 0; i < N; i++) values[SHARED][k][i] = values[SERIAL][k][i] = sin(1 + i + 100 * k);
    }
}

static void create(struct both *both) {
    both->school = (struct school){.n_fish = 5, .n_unknowns = N, .threads = 1};
    assert_int_equal(SUNContext_Create(SUN_COMM_NULL, &both->context), 0);
    for (int k = 0; k < N_VECTORS; k++) {
        school_ok(shared_vector_create(&both->vector[SHARED][k], both->context, &both->school, values[SHARED][k]));
        both->vector[SERIAL][k] = N_VMake_Serial(N, values[SERIAL][k], both->context);
    }
}

static void clear(struct both *both) {
    for (int k = 0; k < 2 * N_VECTORS; k++) N_VDestroy(both->vector[k / N_VECTORS][k % N_VECTORS]);
    SUNContext_Free(&both->context);
}

// all operations that are shared, also where the result is an argument
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

static void every_element_has_the_bits_of_the_serial_vector(void **state) {
    (void)state;
    for (int threads = 1; threads <= 3; threads++) {
        struct both both;
        fill();
        create(&both);
        both.school.threads = threads;
        for (int k = 0; k < 2; k++) operate(both.vector[k]);
        assert_memory_equal(values[SHARED], values[SERIAL], sizeof values[SERIAL]);
        clear(&both);
    }
}

static void norms_have_the_bits_of_the_serial_vector(void **state) {
    (void)state;
    struct both both;
    fill();
    create(&both);
    double all[2], masked[2];
    for (int k = 0; k < 2; k++) {
        N_Vector *const v = both.vector[k];
        all[k] = N_VWrmsNorm(v[0], v[1]);
        masked[k] = N_VWrmsNormMask(v[0], v[1], v[2]);
    }
    NEAR(all[SHARED], all[SERIAL], 0, 0);
    NEAR(masked[SHARED], masked[SERIAL], 0, 0);
    assert_true(masked[SERIAL] > 0 && masked[SERIAL] < all[SERIAL]);
    clear(&both);
}

static void a_clone_is_a_shared_vector_with_values_of_its_own(void **state) {
    (void)state;
    struct both both;
    fill();
    create(&both);
    both.school.threads = 2;
    N_Vector const clone = N_VClone(both.vector[SHARED][0]), second = N_VClone(clone);
    N_VLinearSum(0.3, both.vector[SHARED][0], 0.7, both.vector[SHARED][1], clone);
    N_VScale(2, clone, second);
    for (int i = 0; i < N; i++) {
        NEAR(N_VGetArrayPointer(second)[i], 2 * N_VGetArrayPointer(clone)[i], 0, 0);
        NEAR(N_VGetArrayPointer(clone)[i], 0.3 * values[SERIAL][0][i] + 0.7 * values[SERIAL][1][i], 0, 0);
    }
    assert_memory_equal(values[SHARED], values[SERIAL], sizeof values[SERIAL]);
    N_VDestroy(second);
    N_VDestroy(clone);
    clear(&both);
}

static void without_memory_there_is_no_vector(void **state) {
    (void)state;
    struct both both;
    create(&both);
    N_Vector vector;
    n_until_failure = 0;
    assert_int_equal(shared_vector_create(&vector, both.context, &both.school, values[SHARED][0]), STATUS_MEMORY);
    n_until_failure = -1;
    clear(&both);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_element_has_the_bits_of_the_serial_vector),
        cmocka_unit_test(norms_have_the_bits_of_the_serial_vector),
        cmocka_unit_test(a_clone_is_a_shared_vector_with_values_of_its_own),
        cmocka_unit_test(without_memory_there_is_no_vector),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
