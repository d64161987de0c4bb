/* ARPACK beside the library's own Lanczos, on the same factors: the ten lowest modes of scene A's tube, clamped, in 100
 * to 10000 pipes of 1 m. usage: peer_arpack
 *
 * A line a size: processor time of what both need (linear system and factors), then of each search, its solves with the
 * factors, and the largest error of its frequencies against Euler and Bernoulli's beam; shear and rotary inertia, which
 * the tube has, are 4e-5 of that at 100 m, and nothing at 1000. ARPACK in shift-invert mode, tolerance 0 (machine
 * precision), as many Lanczos vectors as it recommends, 2 k + 1. */
#define _POSIX_C_SOURCE 200809L

#include <stdio.h>
#include <string.h>

#include "analysis/linear/linear.h"
#include "base/memory.h"
#include "scenes.h"
#include "yardstick.h"

enum { MODES = 10, VECTORS = 2 * MODES + 1, WORK = VECTORS * (VECTORS + 8) };

/* Fortran; the lengths of the characters come last. */
extern void dsaupd_(int *ido, const char *bmat, const int *n, const char *which, const int *nev, const double *tol,
                    double *resid, const int *ncv, double *v, const int *ldv, int *iparam, int *ipntr, double *workd,
                    double *workl, const int *lworkl, int *info, size_t bmat_length, size_t which_length);
extern void dseupd_(const int *rvec, const char *howmny, int *select, double *d, double *z, const int *ldz,
                    const double *sigma, const char *bmat, const int *n, const char *which, const int *nev,
                    const double *tol, double *resid, const int *ncv, double *v, const int *ldv, int *iparam,
                    int *ipntr, double *workd, double *workl, const int *lworkl, int *info, size_t howmny_length,
                    size_t bmat_length, size_t which_length);

typedef struct found {
    double seconds, square[MODES];
    double solves;
} found;

static void start_vector(dmb_linear *linear, double *x)
{
    uint64_t seed = 1;
    for (uint32_t i = 0; i < linear->rows; ++i) {
        seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        x[i] = (double)(seed >> 11) * 0x1p-52 - 1.0;
    }
    dmb_linear_solve(linear, x);
}

static int search(dmb_linear *linear, double *memory, found *out)
{
    const int n = (int)linear->rows, nev = MODES, ncv = VECTORS, lworkl = WORK, rvec = 1;
    const double tolerance = 0.0, sigma = 0.0;
    double *resid = memory, *v = resid + n, *workd = v + (size_t)n * VECTORS, *z = workd + 3 * (size_t)n;
    double workl[WORK], d[MODES];
    int ido = 0, info = 1, iparam[11] = {1, 0, 300, 1, 0, 0, 3, 0, 0, 0, 0}, ipntr[11], select[VECTORS];
    const double begin = processor_time();
    start_vector(linear, resid);
    out->solves = 1.0;
    for (;;) {
        dsaupd_(&ido, "G", &n, "LM", &nev, &tolerance, resid, &ncv, v, &n, iparam, ipntr, workd, workl, &lworkl, &info,
                1, 2);
        if (ido == 99) break;
        double *x = workd + ipntr[0] - 1, *y = workd + ipntr[1] - 1;
        if (ido == 2 || ido == -1) dmb_linear_multiply(linear, &linear->mass, x, y);
        if (ido == 1) memcpy(y, workd + ipntr[2] - 1, (size_t)n * sizeof(double));
        if (ido != 2) {
            dmb_linear_solve(linear, y);
            out->solves += 1.0;
        }
    }
    if (info < 0) return -1;
    dseupd_(&rvec, "A", select, d, z, &n, &sigma, "G", &n, "LM", &nev, &tolerance, resid, &ncv, v, &n, iparam, ipntr,
            workd, workl, &lworkl, &info, 1, 1, 2);
    out->seconds = processor_time() - begin;
    memcpy(out->square, d, sizeof d);
    return info;
}

/* Largest error of the frequencies, w^2 ascending in pairs. */
static double worst(const double *square, double length)
{
    static const double root[MODES / 2] = {1.875104068711961, 4.694091132974175, 7.854757438237613, 10.99554073487547,
                                           14.13716839104647};
    const double outer = 0.073 * 0.073, inner = 0.059 * 0.059; /* I/A = (D^2 + d^2)/16 */
    const double stiffness = 206e9 / 7850.0 * (outer + inner) / 16.0;
    double most = 0.0;
    for (int i = 0; i < MODES; ++i) {
        const double k = root[i / 2] / length;
        most = fmax(most, fabs(sqrt(fabs(square[i])) / (k * k * sqrt(stiffness)) - 1.0));
    }
    return most;
}

static int32_t own(dmb_sim *sim, found *out)
{
    dmb_modes *modes = NULL;
    dmb_modes_info info = dmb_modes_info_default();
    const double begin = processor_time();
    int32_t status = dmb_analysis_modes(sim, NULL, &modes);
    out->seconds = processor_time() - begin;
    if (status >= 0) status = dmb_modes_get_info(modes, &info);
    out->solves = info.solves;
    for (uint32_t i = 0; i < MODES && status >= 0; ++i) {
        dmb_mode mode = dmb_mode_default();
        status = dmb_modes_get(modes, i, &mode);
        out->square[i] = mode.eigenvalue[1] * mode.eigenvalue[1];
    }
    dmb_modes_destroy(&modes);
    return status;
}

/* Both, three times over; the shortest times count. */
static int32_t measure(dmb_sim *sim, uint32_t pipes)
{
    const dmb_linear_options as_it_is = {DMB_CONTACT_AS_IS, 0, 0.0};
    found best_own = {1e9, {0.0}, 0.0}, best_arpack = {1e9, {0.0}, 0.0};
    double common = 1e9;
    for (int repeat = 0; repeat < 3; ++repeat) {
        dmb_linear *linear = NULL;
        found a = {0.0, {0.0}, 0.0}, b = {0.0, {0.0}, 0.0};
        const double begin = processor_time();
        int32_t status = dmb_linear_make(sim, &as_it_is, &linear);
        if (status < 0) return status;
        if (dmb_linear_factor(linear, 1.0, 0.0, 0.0, NULL) >= 0) return DMB_ERR_SINGULAR;
        common = fmin(common, processor_time() - begin);
        const size_t bytes = (size_t)linear->rows * (VECTORS + 4 + MODES) * sizeof(double);
        double *memory = dmb_allocate(&linear->allocator, bytes);
        if (memory == NULL || search(linear, memory, &a) != 0) return DMB_ERR_NO_CONVERGENCE;
        dmb_release(&linear->allocator, memory, bytes);
        dmb_linear_release(&linear);
        status = own(sim, &b);
        if (status < 0) return status;
        if (a.seconds < best_arpack.seconds) best_arpack = a;
        if (b.seconds < best_own.seconds) best_own = b;
    }
    printf("pipes=%u common_us=%.0f own_us=%.0f own_solves=%.0f own_error=%.2g arpack_us=%.0f arpack_solves=%.0f "
           "arpack_error=%.2g\n",
           pipes, 1e6 * common, 1e6 * (best_own.seconds - common), best_own.solves, worst(best_own.square, pipes),
           1e6 * best_arpack.seconds, best_arpack.solves, worst(best_arpack.square, pipes));
    return DMB_OK;
}

int main(void)
{
    static const uint32_t sizes[3] = {100, 1000, 10000};
    int failures = 0;
    for (int i = 0; i < 3; ++i) {
        scene s = {.kind = SCENE_C, .pipes = sizes[i], .per_pipe = 1, .length = 1.0};
        dmb_sim *sim = NULL;
        int32_t status = scene_open(&s);
        if (status >= 0) status = dmb_sim_create(s.model, NULL, &sim);
        if (status >= 0) status = measure(sim, sizes[i]);
        if (status < 0) printf("pipes=%u failed: %s\n", sizes[i], dmb_status_name(status));
        failures += status < 0;
        dmb_sim_destroy(&sim);
        dmb_model_destroy(&s.model);
    }
    return failures > 0;
}
