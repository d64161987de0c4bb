/* Modes of a linear system: result of dmb_analysis_modes, and the methods of computation. */
#ifndef DMB_ANALYSIS_MODES_MODES_H
#define DMB_ANALYSIS_MODES_MODES_H

#include <float.h>

#include "analysis/linear/linear.h"
#include "drillmbd/analyse.h"

/* [-] Largest asymmetry of K, relative to its diagonal, that counts as rounding. */
#define DMB_MODES_ASYMMETRY 1e-9
/* [-] Largest asymmetry at which undamped modes are those of the symmetric part first (eq:modes.skew). */
#define DMB_MODES_WEAK 1e-5
/* [-] Rounding of K_ii/M_ii, relative. */
#define DMB_NOISE DBL_EPSILON
/* [-] The same for each multiple of a part's size in its distance from the origin, where poses are rounded. */
#define DMB_RIGID_AWAY (16.0 * DBL_EPSILON)
/* An eigenvalue may be 0 up to this multiple of the rounding level. */
#define DMB_RIGID_NOISE 1e3

struct dmb_modes {
    uint32_t magic;
    uint32_t count, capacity;
    uint32_t rows;
    dmb_allocator allocator;
    dmb_sim *state; /* state of the modes; a copy, which keeps the model */
    dmb_modes_info info;
    double *s;       /* [1/s] re, im >= 0, shape (capacity, 2) */
    double *re, *im; /* body-frame increments by rows, d^H M d = 1, shape (capacity, rows); im NULL of undamped modes */
    double *whirl;   /* [-] shape (capacity) */
    uint8_t *rigid;  /* shape (capacity) */
};

/* Workspace and result of a modal analysis. */
typedef struct dmb_mode_search {
    dmb_linear *linear;
    const dmb_modes_options *options;
    dmb_modes *modes;
    dmb_message *message;           /* of the sim */
    double *work;                   /* shape (9 rows) */
    double *coordinate_mass;        /* [kg, kg m2] approximate diagonal of R^T M R, shape (coordinates) */
    double noise;                   /* [1/s2] rounding level of an eigenvalue 0: largest K_ii/M_ii times an epsilon */
    int32_t general;                /* 1: damped, or K not symmetric */
    int32_t symmetric;              /* 1: K is symmetric, or its symmetric part is in its place */
    int32_t pinned;                 /* 1: the factors are those of K with pinned rigid-body motions, and p = 0 */
    double shift;                   /* shift of the sparse method: of s^2; of s if general */
    double *rigid, *rigid_momentum; /* all rigid-body motions r, r^T M r = I, and M r, shape (rigid_count, rows) */
    size_t rigid_bytes;
    uint32_t rigid_count;
    int32_t partly;   /* 1: an iteration may return fewer modes than wanted: the converged ones */
    double crowded;   /* [1/s] near it roots are so dense that those beyond did not converge; 0: all converged */
    int32_t counted;  /* 1: counts of eigenvalues confirm the result */
    size_t most;      /* subspace dimension, 0: default of dmb_krylov_largest */
    double window[2]; /* [1/s2] ends the iteration once `enough` modes with eigenvalues inside have converged */
    uint32_t enough;  /* 0: no such end */
    double definite;  /* [1/s2] no eigenvalue is known below minus this; 0: not known */
    int32_t above;    /* 1: an iteration returns only modes of eigenvalues above its shift */
    double reach;     /* [1/s2] of the last symmetric iteration: estimated distance of the last mode wanted from the
                         shift, if fewer converged; 0: no estimate */
    double next;      /* [1/s2] of the same iteration: lower bound of the distance of an eigenvalue that has not
                         converged, from the estimate of the first one; 0: no estimate */
    int32_t apart; /* 1: the motions are uncoupled, r^T K = 0, C r = 0, r^T C = 0, and projected out of the iteration */
} dmb_mode_search;

/* Residual of a mode, relative to the norms of the forces in its equation, and its bound. */
typedef struct dmb_mode_defect {
    double value, bound;
} dmb_mode_defect;

/* [1/s] Root of the fastest-growing damped mode about the state of a sim whose gravity, loads and bit loads are
 * multiplied by 1 + load_growth: real part and imaginary part >= 0, shape (2); of all modes up to 60 coordinates, of
 * the 24 lowest otherwise. Rigid-body motions are excluded. -INFINITY if there is no mode. Memory, errors and messages
 * as dmb_analysis_modes. */
int32_t dmb_modes_growth(const dmb_sim *state, double load_growth, dmb_message *message, double root[2]);

/* Replaces the stiffness by its symmetric part; *K: the stiffness, in memory that dmb_modes_put_back frees.
 * DMB_ERR_NO_MEMORY: nothing has changed. */
int32_t dmb_modes_keep_symmetric(dmb_linear *linear, dmb_linear_matrix *K);
void dmb_modes_put_back(dmb_linear *linear, dmb_linear_matrix *K);

/* Creates a result without modes about the state of a sim; dmb_modes_destroy frees it. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_open(const dmb_sim *sim, dmb_modes **modes);
/* Capacity for `capacity` modes; existing modes are kept. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_reserve(dmb_modes *modes, uint32_t capacity, int32_t with_im);
/* Adds a mode, d = x + i y by rows (y NULL: 0), normalised. */
int32_t dmb_modes_add(dmb_mode_search *search, double re, double im, const double *x, const double *y);
/* The same two operations in place of mode k. */
void dmb_modes_put_square(dmb_mode_search *search, uint32_t k, double square, const double *x);
void dmb_modes_put(dmb_mode_search *search, uint32_t k, double re, double im, const double *x, const double *y);
/* Adds an undamped mode of eigenvalue `square` = -s^2 of K d = square M d. */
int32_t dmb_modes_add_square(dmb_mode_search *search, double square, const double *x);
/* [1/s2] Eigenvalue of an undamped mode x, x^T M x = 1: from the strain energy if K x has lost digits by
 * cancellation. */
double dmb_modes_refine(const dmb_mode_search *search, double square, double *x);
/* [1/s2] Twice the strain energy of a motion. */
double dmb_modes_twice_strain_energy(const dmb_modes *modes, double *x);
/* 1: the root is a copy of a root 0 of rigid-body motions; y NULL: x is real. */
int dmb_modes_is_rigid_root(const dmb_mode_search *search, double re, double im, const double *x, const double *y);
/* 1: y of a normalised shape x + i y, where x^T M y = 0 and x is the larger one, is an independent shape. */
int dmb_modes_are_two_shapes(const dmb_mode_search *search, const double *y);
/* 1: a pair, d = x + i y, is two real roots of shapes x and y, which rounding has moved off the real axis; x and y
 * change by a common phase. */
int dmb_modes_is_real_pair(const dmb_mode_search *search, double re, double im, double *x, double *y);
/* Adds a root of a general problem, im >= 0, if it is a mode: a real root of shape x, a pair, or the two real roots of
 * such a pair. x and y may change. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_add_root(dmb_mode_search *search, double re, double im, double *x, double *y);
/* [1/s] |s| of mode i. */
double dmb_modes_size(const dmb_modes *modes, uint32_t i);
void dmb_modes_exchange(dmb_modes *modes, uint32_t i, uint32_t j);
/* Keeps the modes of low to high [Hz] only. */
void dmb_modes_keep_band(dmb_modes *modes, double low, double high);
/* Adds the rigid-body motions, which no iteration adds. */
int32_t dmb_modes_put_rigid(dmb_mode_search *search);
/* Sorts by frequency; keeps the first `keep` modes. */
void dmb_modes_sort(dmb_modes *modes, uint32_t keep);

/* Computes the requested modes, and possibly others. */
int32_t dmb_modes_find(dmb_mode_search *search);
/* [-] |(s^2 M + s C + K) d| of mode k over the norms of the terms of the equation. */
double dmb_modes_residual(const dmb_mode_search *search, uint32_t k);
/* The same relative to the forces themselves, as a vector over the roots of the masses of its coordinates. */
dmb_mode_defect dmb_modes_defect(const dmb_mode_search *search, uint32_t k);
/* Checks the residual of every mode. Of the lowest modes, those before the first failure are kept: DMB_NOTE_INCOMPLETE.
 * DMB_ERR_NO_CONVERGENCE. */
int32_t dmb_modes_check(dmb_mode_search *search);
/* Refines modes with excessive residuals. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_refine_shapes(dmb_mode_search *search);
/* Replaces roots of one shape that differ by rounding only by their mean. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_join(dmb_mode_search *search);
void dmb_modes_weigh_coordinates(const dmb_mode_search *search);

/* All modes by LAPACK, in the independent coordinates. */
int32_t dmb_modes_dense(dmb_mode_search *search);
/* `wanted` modes nearest the shift by Krylov subspaces, without separated rigid-body motions. */
int32_t dmb_modes_sparse(dmb_mode_search *search, uint32_t wanted);

/* Roots nearest growth + i omega, omega >= 0, and its conjugate. If the shift hits a root, such as the roots 0 of
 * rigid-body motions, growth changes by `aside` [1/s], > 0. *least: smallest operator value among them, 0 if these are
 * all; roots of larger dmb_shifted_value are complete. */
int32_t dmb_modes_shifted(dmb_mode_search *search, double *growth, double omega, double aside, uint32_t wanted,
                          double *least);
/* Value of the shifted operator at the root re + i im. */
double dmb_shifted_value(double growth, double omega, double re, double im);
/* 1: the dense method is faster for so many modes. */
int dmb_modes_is_dense(const dmb_mode_search *search, uint32_t wanted);
/* No shift if K is regular or pinned; otherwise a small one, away from the eigenvalues of a stable system; factors K
 * with it. Errors of dmb_modes_sparse. */
int32_t dmb_modes_choose_shift(dmb_mode_search *search);
/* The modes of smallest |s|: at least the requested number, or all; after dmb_modes_choose_shift. */
int32_t dmb_modes_lowest(dmb_mode_search *search);
/* Number of eigenvalues s^2 below *square, without those of separated rigid-body motions. *square changes by `aside` if
 * a block is singular; -1 if that does not help. The factors are overwritten. */
int64_t dmb_modes_count_below(const dmb_mode_search *search, double *square, double aside);
/* Adds all modes of eigenvalues from <= s^2 < to of a symmetric problem, chunk by chunk, each with the number of modes
 * given by counts. DMB_ERR_NO_CONVERGENCE, _SINGULAR, _NO_MEMORY. */
int32_t dmb_modes_squares(dmb_mode_search *search, double from, double to);
/* Keeps, of the modes from number `first` on, those of eigenvalues from <= s^2 < to; result: their number. */
uint32_t dmb_modes_keep_squares(dmb_modes *modes, uint32_t first, double from, double to);
/* All modes of low to high [Hz] and some at its edges, chunk by chunk: of symmetric problems, and of general ones.
 * DMB_ERR_NO_CONVERGENCE, _SINGULAR, _TOO_LARGE, _NO_MEMORY. */
int32_t dmb_modes_band_of_squares(dmb_mode_search *search, double low, double high);
int32_t dmb_modes_band_of_roots(dmb_mode_search *search, double low, double high);
/* 1: all roots lie in a strip along the imaginary axis, which is quick to cover. */
int dmb_modes_find_strip(dmb_mode_search *search, double high, double strip[2]);

/* Computes all rigid-body motions. DMB_ERR_NO_MEMORY; DMB_ERR_NO_CONVERGENCE, with a message, if rounding makes it
 * undecidable whether the forces of the state resist one. */
int32_t dmb_modes_find_rigid(dmb_mode_search *search);
/* Keeps the motions without stiffness, to the fraction `away` of its terms above rounding. Errors as above. */
int32_t dmb_modes_check_rigid(dmb_mode_search *search, double away);
/* sum |K_ij| |d_j| by rows, and the contribution of frames and unbalanced forces of the state to the rounding of K d,
 * over the tolerance. */
void dmb_modes_rigid_terms(dmb_linear *linear, double tolerance, const double *d, double *terms);
/* Factors K with pins if its rigid-body motions are separated: pinned 1, or 0 if another motion is singular too.
 * DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_pin(dmb_mode_search *search);
void dmb_modes_forget_rigid(dmb_mode_search *search);
/* 1: damping does not act on the rigid-body motions: C r = 0 and r^T C = 0. */
int dmb_modes_rigid_undamped(const dmb_mode_search *search);
/* x -= sum by_i (from_i . x) over the rigid-body motions, if they are separated. */
void dmb_modes_add_rigid(const dmb_mode_search *search, const double *from, const double *by, double *x);

/* Workspace shared by the dense methods. */

typedef struct dmb_dense {
    size_t n;           /* number of coordinates */
    size_t m;           /* rigid-body motions, the first columns of X */
    double *M, *X;      /* mass, overwritten after the modes X of the symmetric part of K, X^T M X = I, shape (n, n) */
    double *square;     /* [1/s2] their eigenvalues, ascending, shape (n) */
    double *motion;     /* rigid-body motions by coordinates, and M times them, shape (2, rigid_count, n) */
    double *rate;       /* [1/s] scale of their displacements, shape (n) */
    double *coupling;   /* skew part of K, then C; shape (n, n), like the following used for coupled modes only */
    double *half;       /* work, shape (n + 1, n) */
    double *system, *V; /* the coupled equations and their vectors, shape (m, m), m of dmb_coupled_size */
    double *re, *im;    /* shape (2n) */
    double *work, *x, *y; /* of LAPACK; rows */
    void *block;
    size_t bytes;
} dmb_dense;

/* Number of the coupled equations: 2n with damping, n without, 0 if the modes are uncoupled. */
size_t dmb_coupled_size(const dmb_mode_search *search);
/* Adds the modes of the coupled equations; X and square are input, with the skew part of K in coupling. */
int32_t dmb_modes_coupled(dmb_mode_search *search, dmb_dense *d);

#endif
