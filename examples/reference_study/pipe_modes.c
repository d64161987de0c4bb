/* Which reading gives the reference's highest frequency? It counts 6 + 22 coordinates for each pipe, so its pipes are
 * not meshes but flexible bodies described by modes (Craig, Bampton 1968): 12 shapes that the ends press a pipe into, 6
 * of them rigid, and normal modes with both ends clamped, K = [K_e, 0; 0, diag(w_n^2)]      M = [M_e, m; m^T, 1]      m
 * = integral of rho (A N w_n + I G theta_n) with the element of the whole pipe for its ends (shape functions N, G of
 * the library's beam element). The highest modes bend in one plane, so only this plane is assembled: deflection and
 * slope of the ends, and normal modes. In a long string of equal pipes the highest swings with neighbours alike or
 * opposite, w_B = +- w_A. */
#include <math.h>
#include <stdio.h>

#include "study.h"

enum { INTERVALS = 200, ENDS = 4, MOST_MODES = 40, MOST_BENDING = 16, MOST = ENDS + MOST_BENDING, TURNS = 3000 };

const int study_normal_modes[STUDY_NORMALS] = {16, 22, 28};

/* One plane of a pipe: normal modes at equal distances along it, and what is put together of them. */
typedef struct plane {
    double length, bending, shear, mass, turning; /* [m, N m2, N, kg/m, kg m] */
    int bends;                                    /* [-] normal modes in this plane, of how many in all: */
    int order[MOST_BENDING];
    double square[MOST_BENDING];                                                        /* [1/s2] w_n^2 */
    double deflection[MOST_BENDING][INTERVALS + 1], slope[MOST_BENDING][INTERVALS + 1]; /* generalised mass 1 */
    double k[MOST][MOST], m[MOST][MOST];
} plane;

static void measure(plane *p, const dmb_pipe_def *pipe)
{
    const double outer = pow(pipe->outer_diameter, 2.0), inner = pow(pipe->inner_diameter, 2.0);
    const double area = STUDY_TURN / 8.0 * (outer - inner), second = area * (outer + inner) / 16.0;
    p->length = pipe->length;
    p->bending = pipe->young_modulus * second;
    p->shear = pipe->shear_factor * area * pipe->young_modulus / (2.0 + 2.0 * pipe->poisson_ratio);
    p->mass = pipe->density * area;
    p->turning = pipe->density * second;
}

/* ---- Normal modes ------------------------------------------------------------------------------------------------ */

static int32_t clamp_pipe(study_string *s, const dmb_pipe_def *described)
{
    const study_string empty = {0};
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_string_def held = dmb_string_def_default();
    dmb_pipe_def pipe = *described;
    *s = empty;
    environment.gravity[2] = 0.0;
    held.start_free = held.end_free = DMB_FREE_NONE;
    pipe.elements = 40;
    pipe.eccentricity = 0.0;
    int32_t status = dmb_model_create(NULL, &s->model);
    if (status >= 0) status = dmb_model_set_environment(s->model, &environment);
    if (status >= 0) status = dmb_model_add_string(s->model, &held, &pipe.string);
    if (status >= 0) status = dmb_model_add_pipes(s->model, &pipe, 1, &s->string);
    if (status >= 0) status = dmb_model_compile(s->model, NULL);
    return status < 0 ? status : dmb_sim_create(s->model, NULL, &s->sim);
}

/* Each order bends in two planes, any two: what is taken is the motion in the plane of its largest deflection. */
static int32_t take_bending(plane *p, const study_string *s, const dmb_modes *modes, uint32_t number)
{
    double *w = p->deflection[p->bends], *slope = p->slope[p->bends], y = 0.0, z = 0.0;
    dmb_mode_shape shape[INTERVALS + 1];
    for (int i = 0; i <= INTERVALS; ++i) {
        shape[i] = dmb_mode_shape_default();
        const int32_t status =
            dmb_modes_shape(modes, number, dmb_station(s->string, 0, (double)i / INTERVALS), shape + i);
        if (status < 0) return status;
        if (hypot(shape[i].re[DMB_Y], shape[i].re[DMB_Z]) <= hypot(y, z)) continue;
        y = shape[i].re[DMB_Y];
        z = shape[i].re[DMB_Z];
    }
    for (int i = 0; i <= INTERVALS; ++i) {
        const double *at = shape[i].re;
        w[i] = (at[DMB_Y] * y + at[DMB_Z] * z) / hypot(y, z);
        slope[i] = (at[DMB_RZ] * y - at[DMB_RY] * z) / hypot(y, z);
    }
    return DMB_OK;
}

static int32_t take_modes(plane *p, const study_string *s, const dmb_modes *modes)
{
    int32_t status = DMB_OK;
    int sideways = 0;
    for (uint32_t i = 0; i < MOST_MODES && p->bends < MOST_BENDING && status >= 0; ++i) {
        dmb_mode mode = dmb_mode_default();
        status = dmb_modes_get(modes, i, &mode);
        if (status < 0 || mode.share[2] < 0.5 || sideways++ % 2 == 1) continue;
        status = take_bending(p, s, modes, i);
        p->order[p->bends] = (int)i + 1;
        p->square[p->bends++] = pow(STUDY_TURN * mode.frequency, 2.0);
    }
    return status;
}

/* ---- Putting together -------------------------------------------------------------------------------------------- */

static void end_shapes(const plane *p, double x, double n[ENDS], double g[ENDS])
{
    const double h = p->length, phi = 12.0 * p->bending / (p->shear * h * h), q = 1.0 / (1.0 + phi);
    n[0] = (1.0 - 3.0 * x * x + 2.0 * x * x * x + phi * (1.0 - x)) * q;
    n[1] = h * (x - 2.0 * x * x + x * x * x + 0.5 * phi * (x - x * x)) * q;
    n[2] = (3.0 * x * x - 2.0 * x * x * x + phi * x) * q;
    n[3] = h * (x * x * x - x * x - 0.5 * phi * (x - x * x)) * q;
    g[0] = 6.0 * (x * x - x) * q / h;
    g[1] = (1.0 - 4.0 * x + 3.0 * x * x + phi * (1.0 - x)) * q;
    g[2] = -g[0];
    g[3] = (3.0 * x * x - 2.0 * x + phi * x) * q;
}

/* Simpson's rule over the pipe for the whole mass matrix, so that it stays that of one set of shapes. */
static void add_mass(plane *p)
{
    for (int i = 0; i <= INTERVALS; ++i) {
        double w[MOST], slope[MOST];
        const double part = (i == 0 || i == INTERVALS ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * p->length / (3.0 * INTERVALS);
        end_shapes(p, (double)i / INTERVALS, w, slope);
        for (int b = 0; b < p->bends; ++b) {
            w[ENDS + b] = p->deflection[b][i];
            slope[ENDS + b] = p->slope[b][i];
        }
        for (int r = 0; r < ENDS + p->bends; ++r)
            for (int c = 0; c < ENDS + p->bends; ++c)
                p->m[r][c] += part * (p->mass * w[r] * w[c] + p->turning * slope[r] * slope[c]);
    }
}

static void add_stiffness(plane *p)
{
    const double h = p->length, phi = 12.0 * p->bending / (p->shear * h * h);
    const double factor = p->bending / (h * h * h * (1.0 + phi)), near = (4.0 + phi) * h * h, far = (2.0 - phi) * h * h;
    const double element[ENDS][ENDS] = {{12.0, 6.0 * h, -12.0, 6.0 * h},
                                        {6.0 * h, near, -6.0 * h, far},
                                        {-12.0, -6.0 * h, 12.0, -6.0 * h},
                                        {6.0 * h, far, -6.0 * h, near}};
    for (int r = 0; r < ENDS; ++r)
        for (int c = 0; c < ENDS; ++c) p->k[r][c] = factor * element[r][c];
    for (int b = 0; b < p->bends; ++b) p->k[ENDS + b][ENDS + b] = p->square[b] * p->m[ENDS + b][ENDS + b];
}

/* ---- The highest of a string ------------------------------------------------------------------------------------- */

/* The far end moves as the near one times `sign`: rows and columns of it are added to those of the near one. */
static void join(const double full[MOST][MOST], int bends, double sign, double joined[MOST][MOST])
{
    const int size = ENDS + bends;
    for (int r = 0; r < MOST; ++r)
        for (int c = 0; c < MOST; ++c) joined[r][c] = 0.0;
    for (int r = 0; r < size; ++r)
        for (int c = 0; c < size; ++c) {
            const int row = r < ENDS ? r % 2 : r - 2, column = c < ENDS ? c % 2 : c - 2;
            const double factor = (r == 2 || r == 3 ? sign : 1.0) * (c == 2 || c == 3 ? sign : 1.0);
            joined[row][column] += factor * full[r][c];
        }
}

/* m becomes its Cholesky factor. */
static void cholesky(int size, double m[MOST][MOST])
{
    for (int r = 0; r < size; ++r)
        for (int c = 0; c <= r; ++c) {
            double rest = m[r][c];
            for (int i = 0; i < c; ++i) rest -= m[r][i] * m[c][i];
            m[r][c] = r == c ? sqrt(rest) : rest / m[c][c];
        }
}

static void solve(int size, double m[MOST][MOST], double x[MOST])
{
    for (int r = 0; r < size; ++r) {
        for (int i = 0; i < r; ++i) x[r] -= m[r][i] * x[i];
        x[r] /= m[r][r];
    }
    for (int r = size - 1; r >= 0; --r) {
        for (int i = r + 1; i < size; ++i) x[r] -= m[i][r] * x[i];
        x[r] /= m[r][r];
    }
}

/* [Hz] of the largest w^2 in K x = w^2 M x, by x <- M^-1 K x. */
static double highest(int size, double k[MOST][MOST], double m[MOST][MOST])
{
    double x[MOST], growth = 0.0;
    cholesky(size, m);
    for (int i = 0; i < size; ++i) x[i] = 1.0 + 0.1 * i;
    for (int turn = 0; turn < TURNS; ++turn) {
        double y[MOST] = {0.0};
        for (int r = 0; r < size; ++r)
            for (int c = 0; c < size; ++c) y[r] += k[r][c] * x[c];
        solve(size, m, y);
        growth = 0.0;
        for (int i = 0; i < size; ++i) growth = fmax(growth, fabs(y[i]));
        for (int i = 0; i < size; ++i) x[i] = y[i] / growth;
    }
    return sqrt(growth) / STUDY_TURN;
}

static double highest_of_string(const plane *p, int normal_modes)
{
    int bends = 0;
    double found = 0.0;
    while (bends < p->bends && p->order[bends] <= normal_modes) bends++;
    for (int alike = 0; alike <= 1; ++alike) {
        double k[MOST][MOST], m[MOST][MOST];
        join(p->k, bends, alike ? 1.0 : -1.0, k);
        join(p->m, bends, alike ? 1.0 : -1.0, m);
        found = fmax(found, highest(2 + bends, k, m));
    }
    return found;
}

int32_t study_find_by_modes(study_modal *modal, study_string *s)
{
    const study_scene scene = study_base();
    dmb_modes_options options = dmb_modes_options_default();
    dmb_modes *modes = NULL;
    plane p = {0};
    options.count = MOST_MODES;
    measure(&p, &scene.pipe);
    int32_t status = clamp_pipe(s, &scene.pipe);
    if (status >= 0) status = dmb_analysis_modes(s->sim, &options, &modes);
    if (status >= 0) status = take_modes(&p, s, modes);
    dmb_modes_destroy(&modes);
    if (status < 0) return status;
    add_mass(&p);
    add_stiffness(&p);
    for (int i = 0; i < STUDY_NORMALS; ++i) modal->by_modes[i] = highest_of_string(&p, study_normal_modes[i]);
    return DMB_OK;
}
