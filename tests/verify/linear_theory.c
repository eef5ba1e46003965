/* linear_theory.c: closed forms of Theodorsen and Garrick, Wu's series, and Galerkin's method for clamped plates. */
#include "linear_theory.h"

#include <lapacke.h>
#include <math.h>
#include <stdlib.h>

#include "base/mathematics.h"

static const double pi = 3.14159265358979323846;

// ---- Theodorsen, Wagner

// H_n^(2) = J_n - i Y_n of the C library
double complex linear_theory_theodorsen(double k) {
    const double complex h0 = j0(k) - I * y0(k), h1 = j1(k) - I * y1(k);
    return h1 / (h1 + I * h0);
}

// int over (from, to) of (Re C - 1/2) sin(k s)/k
static double wagner_piece(double s, double from, double to) {
    enum { N = 16 };
    double node[N], weight[N], sum = 0;
    quadrature_legendre(N, node, weight);
    for (int i = 0; i < N; i++) {
        const double k = from + (to - from) * node[i];
        sum += weight[i] * (to - from) * (creal(linear_theory_theodorsen(k)) - 0.5) * sin(k * s) / k;
    }
    return sum;
}

// pieces that grow from 0, where C has a term k log k, but stay below one period; beyond the last one, k = 400, there
// is less than 1e-7
double linear_theory_wagner(double s) {
    double sum = 0;
    for (double from = 0, to = 1e-6; from < 400; from = to, to += fmin(to, fmin(1, pi / s))) {
        sum += wagner_piece(s, from, to);
    }
    return 0.5 + 2 / pi * sum;
}

double complex linear_theory_sears(double k) {
    return (j0(k) - I * j1(k)) * linear_theory_theodorsen(k) + I * j1(k);
}

// downwash at three quarters of the chord with Wagner's lift; added mass of the part in the gust
double linear_theory_kuessner(double s) {
    enum { N = 32 };
    const double front = s < 2 ? acos(1 - s) : pi;
    double node[N], weight[N], sum = sin(front);
    quadrature_legendre(N, node, weight);
    for (int i = 0; i < N; i++) {
        const double c = cos(front * node[i]);
        sum += weight[i] * front * (1 - c) * linear_theory_wagner(s - 1 + c);
    }
    return sum / pi;
}

// Wagner's integral equation int_0^s G'(q) sqrt((2 + s - q)/(s - q)) dq = 1 for G'(q) = f(q)/sqrt(q) with a smooth f:
// linear between n + 1 points of [0, last], computed one after another. With q = s (1 - cos phi)/2 the integrand
// becomes f sqrt(2 + s - q) over phi, for which equal steps are most accurate.
enum { ANGLES = 2000 };

// the position q of an angle, as one of n cells of length h and the fraction of the cell
static double place_of(int angle, int n, double h, int *cell, double *part) {
    const double q = n * h * (1 - cos(pi * (angle + 0.5) / ANGLES)) / 2;
    *cell = (int)(q / h) < n - 1 ? (int)(q / h) : n - 1;
    *part = q / h - *cell;
    return q;
}

static void solve_growth(double h, int n, double *f) {
    f[0] = 1 / (pi * sqrt(2));
    for (int i = 1; i <= n; i++) {
        double known = 0, weight = 0, part;
        for (int angle = 0, cell; angle < ANGLES; angle++) {
            const double q = place_of(angle, i, h, &cell, &part), kernel = sqrt(2 + i * h - q) * pi / ANGLES;
            known += kernel * (1 - part) * f[cell];
            if (cell == i - 1) {
                weight += kernel * part;
            } else {
                known += kernel * part * f[cell + 1];
            }
        }
        f[i] = (1 - known) / weight;
    }
}

static struct linear_theory_growth growth_linear(double s, int n) {
    struct linear_theory_growth growth = {0};
    const double h = s / n;
    double *const f = calloc((size_t)n + 1, sizeof *f);
    if (!f) abort();
    solve_growth(h, n, f);
    // int f/sqrt(q) dq = int 2 f dz, z = sqrt(q): exact for f linear in q
    for (int i = 0; i < n; i++) {
        const double a = i * h, slope = (f[i + 1] - f[i]) / h, root = sqrt(a), next = sqrt(a + h);
        growth.circulation +=
            2 * (f[i] - slope * a) * (next - root) + slope * 2 / 3 * (next * next * next - root * root * root);
    }
    // the lift of a sheet is the sum over the parts: (1 + s - q)/sqrt((2 + s - q) (s - q)) each
    for (int angle = 0, cell; angle < ANGLES; angle++) {
        double part;
        const double r = 1 + s - place_of(angle, n, h, &cell, &part);
        growth.lift += ((1 - part) * f[cell] + part * f[cell + 1]) * r / sqrt(1 + r) * pi / ANGLES;
    }
    free(f);
    return growth;
}

// the error falls with the square of the step: two steps give the limit, to about 1e-7
struct linear_theory_growth linear_theory_growth(double s) {
    const int n = 60 + 10 * (int)s;
    const struct linear_theory_growth coarse = growth_linear(s, n), fine = growth_linear(s, 2 * n);
    return (struct linear_theory_growth){(4 * fine.circulation - coarse.circulation) / 3,
                                         (4 * fine.lift - coarse.lift) / 3};
}

// ---- rigid plates

// amplitudes: the mean of the product of two oscillations
static double mean_product(double complex a, double complex b) {
    return creal(a * conj(b)) / 2;
}

struct linear_theory_load linear_theory_rigid(const struct linear_theory_plate *plate, double complex heave,
                                              double complex pitch, double axis) {
    const double b = plate->length / 2, u = plate->speed, a = axis / b - 1;
    const double complex rate = I * plate->omega, c = linear_theory_theodorsen(plate->omega * b / u);
    // Theodorsen's h is positive downwards, his alpha nose up
    const double complex alpha = -pitch, alpha1 = rate * alpha, alpha2 = rate * alpha1;
    const double complex h1 = -rate * heave, h2 = rate * h1;
    const double complex q = h1 + u * alpha + b * (0.5 - a) * alpha1;
    const double complex lift = pi * plate->density * b * (b * (h2 + u * alpha1 - b * a * alpha2) + 2 * u * c * q);
    const double complex nose_up =
        pi * plate->density * b * b *
        (b * a * h2 - u * b * (0.5 - a) * alpha1 - b * b * (0.125 + a * a) * alpha2 + 2 * u * (a + 0.5) * c * q);
    const double complex suction = 2 * c * q - b * alpha1;
    return (struct linear_theory_load){
        .lift = lift,
        .moment = -nose_up + axis * lift,
        .thrust = pi * plate->density * b / 2 * mean_product(suction, suction) - mean_product(alpha, lift),
        .power = mean_product(lift, h1) - mean_product(nose_up, alpha1)};
}

double linear_theory_heaving_speed(const struct linear_theory_plate *plate, double amplitude, double friction) {
    double low = 1e-3, high = 1e3;  // in units of omega L
    for (int i = 0; i < 100; i++) {
        struct linear_theory_plate moving = *plate;
        const double middle = sqrt(low * high);
        moving.speed = middle * plate->omega * plate->length;
        const double thrust = linear_theory_rigid(&moving, amplitude, 0, 0).thrust;
        *(thrust > friction * pow(moving.speed, 1.5) ? &low : &high) = middle;
    }
    return low * plate->omega * plate->length;
}

// ---- two plates in line

// A velocity w of heave makes A_0 of the sheet at the nose C(k) w, an upwash V exp(i (omega t - k x/b)), x from the
// middle, S(k) V with the function of Sears, S = 2 i/(pi k (H1 + i H0)). The far wake of the leader has V = pi k S w.
// So A_0 of the follower over A_0 of the leader is exp(i lead) - Z exp(-i k d/b), d the distance of the middles and Z =
// pi k S^2/C. The thrust is proportional to the square of A_0.
static double complex wake_over_heave(const struct linear_theory_plate *plate, double smoothing) {
    const double k = plate->omega * plate->length / 2 / plate->speed;
    const double complex h0 = j0(k) - I * y0(k), h1 = j1(k) - I * y1(k);
    return -4 / (pi * k * h1 * (h1 + I * h0)) * exp(-plate->omega * smoothing / plate->speed);
}

double linear_theory_follower_thrust(const struct linear_theory_plate *plate, double smoothing, double gap,
                                     double lead) {
    const double phase = plate->omega * (gap + plate->length) / plate->speed + lead;
    const double suction = cabs(1 - wake_over_heave(plate, smoothing) * cexp(-I * phase));
    return suction * suction;
}

// |1 - Z exp(-i phase)| = 1 where 2 cos(arg Z - phase) = |Z|
struct linear_theory_places linear_theory_places(const struct linear_theory_plate *plate, double smoothing) {
    const double complex z = wake_over_heave(plate, smoothing);
    const double turn = acos(cabs(z) / 2), along = carg(z) - plate->omega * plate->length / plate->speed;
    const double stable = (along + turn) / (2 * pi), unstable = (along - turn) / (2 * pi);
    return (struct linear_theory_places){stable - floor(stable), unstable - floor(unstable)};
}

// ---- impulse

// m v = C = sum b_n sin(n theta), and the sheet induces the stream less v: sum n b_n sin(n theta)/sin(theta).
// Times sin(theta) sin(l theta), integrated: n and l are odd
double linear_theory_impulse(double mass, double stream) {
    enum { N = 60 };
    double matrix[N * N], b[N] = {0};
    lapack_int pivot[N];
    for (int i = 0; i < N; i++) {
        const double l = 2 * i + 1;
        for (int j = 0; j < N; j++) {
            const double n = 2 * j + 1;
            // int sin(theta) sin(l theta) sin(n theta) = -4 l n/((1 - (l - n)^2) (1 - (l + n)^2)) for even l + n
            matrix[i * N + j] = -4 * l * n / ((1 - (l - n) * (l - n)) * (1 - (l + n) * (l + n))) / mass;
            if (i == j) matrix[i * N + j] += pi / 2 * n;
        }
    }
    b[0] = pi / 2 * stream;
    LAPACKE_dgesv(LAPACK_ROW_MAJOR, N, 1, matrix, N, pivot, b, 1);
    return pi / 4 * b[0] / mass;
}

// ---- plates of any shape

void linear_theory_sample(const struct linear_theory_function *function, struct linear_theory_shape *shape) {
    enum { N = LINEAR_THEORY_TERMS };
    *shape = (struct linear_theory_shape){0};
    for (int q = 0; q < N; q++) {
        const double theta = pi * (q + 0.5) / N;
        double complex place, slope;
        function->at((1 + cos(theta)) / 2, function->data, &place, &slope);
        for (int n = 0; n < N; n++) {
            shape->place[n] += 2 * place * cos(n * theta) / N;
            shape->slope[n] += 2 * slope * cos(n * theta) / N;
        }
    }
}

// [p] = -density U (a_0 tan(theta/2) + 2 sum a_n sin(n theta)), from the velocity of the plate relative to the stream,
// i omega y + U dy/dx = b_0/2 + sum b_n cos(n theta): Wu (1961)
static void pressure_of(const struct linear_theory_plate *plate, const struct linear_theory_shape *shape,
                        double complex a[LINEAR_THEORY_TERMS]) {
    const double k = plate->omega * plate->length / 2 / plate->speed;
    double complex b[LINEAR_THEORY_TERMS + 1] = {0};
    for (int n = 0; n < LINEAR_THEORY_TERMS; n++)
        b[n] = I * plate->omega * shape->place[n] + plate->speed * shape->slope[n];
    a[0] = (b[0] + b[1]) * linear_theory_theodorsen(k) - b[1];
    for (int n = 1; n < LINEAR_THEORY_TERMS; n++) a[n] = b[n] + I * k / (2 * n) * (b[n - 1] - b[n + 1]);
}

// int [p] f dx for f = c_0/2 + sum c_n cos(n theta)
static double complex weighted_pressure(const struct linear_theory_plate *plate, const double complex *a,
                                        const double complex *c) {
    double complex sum = a[0] * (c[0] - c[1]);
    for (int n = 1; n < LINEAR_THEORY_TERMS; n++) {
        sum += a[n] * (c[n - 1] - (n + 1 < LINEAR_THEORY_TERMS ? c[n + 1] : 0));
    }
    return -plate->density * plate->speed * plate->length * pi / 4 * sum;
}

struct linear_theory_load linear_theory_flexible(const struct linear_theory_plate *plate,
                                                 const struct linear_theory_shape *shape) {
    const double b = plate->length / 2;
    const double complex one[LINEAR_THEORY_TERMS] = {2}, arm[LINEAR_THEORY_TERMS] = {2 * b, b};
    double complex a[LINEAR_THEORY_TERMS], rate[LINEAR_THEORY_TERMS], slope[LINEAR_THEORY_TERMS];
    pressure_of(plate, shape, a);
    // the mean of a product takes one factor conjugate
    for (int n = 0; n < LINEAR_THEORY_TERMS; n++) {
        rate[n] = conj(I * plate->omega * shape->place[n]);
        slope[n] = conj(shape->slope[n]);
    }
    return (struct linear_theory_load){.lift = weighted_pressure(plate, a, one),
                                       .moment = weighted_pressure(plate, a, arm),
                                       .thrust = pi * plate->density * b / 2 * mean_product(a[0], a[0]) +
                                                 creal(weighted_pressure(plate, a, slope)) / 2,
                                       .power = -creal(weighted_pressure(plate, a, rate)) / 2};
}

// ---- modes of a clamped beam

// cos(beta) + 1/cosh(beta) = 0 near (j + 1/2) pi
double linear_theory_mode_number(int j) {
    double beta = (j + 0.5) * pi;
    for (int i = 0; i < 8; i++) beta -= (cos(beta) + 1 / cosh(beta)) / (-sin(beta) - tanh(beta) / cosh(beta));
    return beta;
}

// 1 - s of the mode cosh - cos - s (sinh - sin), the small factor of the growing exponential, without cancellation
static double mode_rest(double beta) {
    return (sin(beta) - cos(beta) - exp(-beta)) / (sinh(beta) + sin(beta));
}

void linear_theory_mode(int j, double x, double *place, double *slope) {
    const double beta = linear_theory_mode_number(j), z = beta * x;
    const double rest = mode_rest(beta), s = 1 - rest;
    const double grows = rest / 2 * exp(z), falls = (1 + s) / 2 * exp(-z);
    *place = grows + falls - cos(z) + s * sin(z);
    *slope = beta * (grows - falls + sin(z) + s * cos(z));
}

struct mode_of {
    int j;
    double length;
};
static void mode_at(double x, const void *data, double complex *place, double complex *slope) {
    const struct mode_of *const mode = data;
    double value, derivative;
    linear_theory_mode(mode->j, x, &value, &derivative);
    *place = value;
    *slope = derivative / mode->length;
}

static void sample_modes(double length, struct linear_theory_shape *modes) {
    for (int j = 0; j < LINEAR_THEORY_MODES; j++) {
        const struct mode_of mode = {j, length};
        linear_theory_sample(&(struct linear_theory_function){mode_at, &mode}, &modes[j]);
    }
}

// ---- the prescribed plate

// mode j: (stiffness beta^4/L^4 - omega^2 mass) L q_j - sum_i int [p]_i psi_j q_i = the same of the heave, to the right
void linear_theory_driven(const struct linear_theory_plate *plate, const struct linear_theory_body *body,
                          struct linear_theory_shape *shape, double complex *tip) {
    enum { N = LINEAR_THEORY_MODES };
    struct linear_theory_shape modes[N];
    double complex matrix[N * N], amplitude[N], of_heave[LINEAR_THEORY_TERMS];
    lapack_int pivots[N];
    *shape = (struct linear_theory_shape){.place = {2}};
    sample_modes(plate->length, modes);
    pressure_of(plate, shape, of_heave);
    for (int i = 0; i < N; i++) {
        const double beta = linear_theory_mode_number(i), inertia = plate->omega * plate->omega * body->mass;
        double complex of_mode[LINEAR_THEORY_TERMS];
        pressure_of(plate, &modes[i], of_mode);
        for (int j = 0; j < N; j++) matrix[i * N + j] = -weighted_pressure(plate, of_mode, modes[j].place);
        matrix[i * N + i] += body->stiffness * pow(beta, 4) / pow(plate->length, 3) - inertia * plate->length;
        // int psi dx = 2 s L/beta
        amplitude[i] = weighted_pressure(plate, of_heave, modes[i].place) +
                       inertia * 2 * (1 - mode_rest(beta)) * plate->length / beta;
    }
    if (LAPACKE_zgesv(LAPACK_COL_MAJOR, N, 1, matrix, N, pivots, amplitude, N) != 0) abort();
    *tip = 1;
    for (int i = 0; i < N; i++) {
        double place, slope;
        linear_theory_mode(i, 1, &place, &slope);
        *tip += amplitude[i] * place;
        for (int n = 0; n < LINEAR_THEORY_TERMS; n++) {
            shape->place[n] += amplitude[i] * modes[i].place[n];
            shape->slope[n] += amplitude[i] * modes[i].slope[n];
        }
    }
}

// ---- flutter

// With L, U and density 1 a neutral motion has (beta_j^4/U*^2) q_j = 4 k^2 q_j + M* sum_i int [p]_i psi_j q_i: at every
// k the eigenvalues of a matrix, of which those that are real and positive are 1/U*^2.
static void inverse_squares(double k, double mass_ratio, int n, const struct linear_theory_shape *modes,
                            double complex *eigenvalue) {
    enum { N = LINEAR_THEORY_MODES };
    const struct linear_theory_plate plate = {1, 1, 1, 2 * k};
    double complex matrix[N * N];
    for (int i = 0; i < n; i++) {
        double complex of_mode[LINEAR_THEORY_TERMS];
        pressure_of(&plate, &modes[i], of_mode);
        for (int j = 0; j < n; j++) {
            matrix[i * n + j] =
                (mass_ratio * weighted_pressure(&plate, of_mode, modes[j].place) + (i == j) * 4 * k * k) /
                pow(linear_theory_mode_number(j), 4);
        }
    }
    if (LAPACKE_zgeev(LAPACK_COL_MAJOR, 'N', 'N', n, matrix, n, eigenvalue, NULL, 1, NULL, 1) != 0) abort();
}

static double complex nearest(int n, const double complex *eigenvalue, double complex to) {
    double complex best = eigenvalue[0];
    for (int i = 1; i < n; i++) {
        if (cabs(eigenvalue[i] - to) < cabs(best - to)) best = eigenvalue[i];
    }
    return best;
}

// an eigenvalue at two k, between which it becomes real
struct bracket {
    double k[2];
    double complex value[2];
};

static struct linear_theory_threshold neutral_between(struct bracket at, double mass_ratio, int n,
                                                      const struct linear_theory_shape *modes) {
    for (int i = 0; i < 50; i++) {
        double complex eigenvalue[LINEAR_THEORY_MODES];
        const double k = (at.k[0] + at.k[1]) / 2;
        inverse_squares(k, mass_ratio, n, modes, eigenvalue);
        const double complex value = nearest(n, eigenvalue, (at.value[0] + at.value[1]) / 2);
        const int side = cimag(value) * cimag(at.value[0]) > 0 ? 0 : 1;
        at.k[side] = k;
        at.value[side] = value;
    }
    return (struct linear_theory_threshold){1 / sqrt(creal(at.value[0])), at.k[0] / pi};
}

struct linear_theory_threshold linear_theory_flutter(double mass_ratio, int n_modes) {
    struct linear_theory_shape modes[LINEAR_THEORY_MODES];
    double complex before[LINEAR_THEORY_MODES], now[LINEAR_THEORY_MODES];
    struct linear_theory_threshold least = {INFINITY, 0};
    const double ratio = 1.01;
    sample_modes(1, modes);
    inverse_squares(0.1, mass_ratio, n_modes, modes, before);
    for (double k = 0.1 * ratio; k < 20; k *= ratio) {
        inverse_squares(k, mass_ratio, n_modes, modes, now);
        for (int i = 0; i < n_modes; i++) {
            const double complex next = nearest(n_modes, now, before[i]);
            if (cimag(before[i]) * cimag(next) >= 0 || creal(next) <= 0) continue;
            const struct bracket bracket = {{k / ratio, k}, {before[i], next}};
            const struct linear_theory_threshold found = neutral_between(bracket, mass_ratio, n_modes, modes);
            if (found.speed < least.speed) least = found;
        }
        for (int i = 0; i < n_modes; i++) before[i] = now[i];
    }
    return least;
}
