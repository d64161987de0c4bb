/* Modes of a linear system: what dmb_analysis_modes answers with, and the ways to find them. */
#ifndef DMB_ANALYSIS_MODES_MODES_H
#define DMB_ANALYSIS_MODES_MODES_H

#include <float.h>

#include "analysis/linear/linear.h"
#include "drillmbd/modes.h"

/* Asymmetry of K, over its diagonal, that is rounding. */
#define DMB_MODES_ASYMMETRY 1e-9
/* Rounding of K_ii/M_ii, as a part of it. */
#define DMB_NOISE DBL_EPSILON
/* The same for each size of a part that the part lies away from the origin, whose poses are rounded there. */
#define DMB_RIGID_AWAY (16.0 * DBL_EPSILON)
/* An eigenvalue of up to so much noise may be 0. */
#define DMB_RIGID_NOISE 1e3

struct dmb_modes {
    uint32_t magic;
    uint32_t count, capacity;
    uint32_t rows;
    dmb_allocator allocator;
    dmb_sim *state; /* the state they are about; a copy, which holds the model */
    dmb_modes_info info;
    double *s;       /* [1/s] re, im >= 0, shape (capacity, 2) */
    double *re, *im; /* body-frame increments by rows, d^H M d = 1, shape (capacity, rows); im NULL of undamped modes */
    double *whirl;   /* [-] shape (capacity) */
    uint8_t *rigid;  /* shape (capacity) */
};

/* The search and its result. */
typedef struct dmb_mode_search {
    dmb_linear *linear;
    const dmb_modes_options *options;
    dmb_modes *modes;
    dmb_message *message;    /* of the sim */
    double *work;            /* shape (9 rows) */
    double *coordinate_mass; /* [kg, kg m2] diagonal of R^T M R or so, shape (coordinates) */
    double noise;    /* [1/s2] what rounding of K makes of an eigenvalue 0, largest K_ii/M_ii times an epsilon */
    int32_t general; /* 1: damped, or K not symmetric */
    int32_t pinned;  /* 1: the factors are those of K with its rigid-body motions pinned, and p = 0 */
    double shift;    /* of the sparse search: of s^2, of s where general */
    double *rigid, *rigid_momentum; /* all rigid-body motions r, r^T M r = I, and M r, shape (rigid_count, rows) */
    size_t rigid_bytes;
    uint32_t rigid_count;
    int32_t partly;   /* 1: a search may give back fewer modes than wanted, those that have converged */
    double crowded;   /* [1/s] near it stand so many roots that those beyond did not converge; 0: all converged */
    int32_t counted;  /* 1: counts of eigenvalues confirm what a search finds */
    size_t most;      /* vectors in the subspace of a search, 0: as dmb_krylov_largest says */
    double window[2]; /* [1/s2] likewise it ends when `enough` modes of eigenvalues inside have converged */
    uint32_t enough;  /* 0: it does not */
    double definite;  /* [1/s2] no eigenvalue is known to be below minus this; 0: not known */
    double reach;     /* [1/s2] of the last symmetric search: estimated distance of the last mode wanted from the
                         shift, where fewer converged; 0: no estimate */
    int32_t apart; /* 1: they are uncoupled from all else, r^T K = 0, C r = 0, r^T C = 0, and taken out of the search */
} dmb_mode_search;

/* Residual of a mode, over the norms of the forces that balance in them, and what it may leave. */
typedef struct dmb_mode_defect {
    double value, bound;
} dmb_mode_defect;

/* [1/s] The damped mode that grows fastest about the state of a sim whose gravity, loads and bit loads act 1 +
 * load_growth times: real part and imaginary part >= 0 of its root, shape (2); of all modes of up to 60 coordinates, of
 * the 24 lowest of more. Rigid-body motions apart. -INFINITY where there is no mode. Memory, errors and messages as
 * dmb_analysis_modes. */
int32_t dmb_modes_growth(const dmb_sim *state, double load_growth, dmb_message *message, double root[2]);

/* A result without modes about the state of a sim; dmb_modes_destroy gives it back. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_open(const dmb_sim *sim, dmb_modes **modes);
/* Room for `capacity` modes, what was there being kept. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_reserve(dmb_modes *modes, uint32_t capacity, int32_t with_im);
/* Adds a mode, d = x + i y by rows (y NULL: 0), normalised. */
int32_t dmb_modes_add(dmb_mode_search *search, double re, double im, const double *x, const double *y);
/* The same two in the place of mode k. */
void dmb_modes_put_square(dmb_mode_search *search, uint32_t k, double square, const double *x);
void dmb_modes_put(dmb_mode_search *search, uint32_t k, double re, double im, const double *x, const double *y);
/* Adds an undamped mode of eigenvalue `square` = -s^2 of K d = square M d. */
int32_t dmb_modes_add_square(dmb_mode_search *search, double square, const double *x);
/* [1/s2] eigenvalue of an undamped mode x, x^T M x = 1, with the digits that its strain energy has where K x lost them.
 */
double dmb_modes_sharpen(const dmb_mode_search *search, double square, double *x);
/* [1/s2] twice the strain energy of a motion. */
double dmb_modes_twice_strain_energy(const dmb_modes *modes, double *x);
/* Whether what was found is a root 0 of rigid-body motions once more, y NULL: x is real. */
int dmb_modes_is_rigid_root(const dmb_mode_search *search, double re, double im, const double *x, const double *y);
/* Whether y of a normalised shape x + i y, where x^T M y = 0 and x is the larger one, is a shape beside x. */
int dmb_modes_are_two_shapes(const dmb_mode_search *search, const double *y);
/* Whether a pair, d = x + i y, is two real roots of shapes x and y, which rounding alone has moved off the real axis; x
 * and y change by a common phase. */
int dmb_modes_is_real_pair(const dmb_mode_search *search, double re, double im, double *x, double *y);
/* Adds a root of a general problem, im >= 0, that is a mode: a real one of shape x, a pair, or the two of such a
 * pair. x and y may change. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_take_root(dmb_mode_search *search, double re, double im, double *x, double *y);
/* [1/s] |s| of mode i. */
double dmb_modes_size(const dmb_modes *modes, uint32_t i);
void dmb_modes_exchange(dmb_modes *modes, uint32_t i, uint32_t j);
/* Those of low to high [Hz] only. */
void dmb_modes_keep_band(dmb_modes *modes, double low, double high);
/* Adds the rigid-body motions, which no search adds. */
int32_t dmb_modes_put_rigid(dmb_mode_search *search);
/* By rising frequency; keeps the first `keep`. */
void dmb_modes_sort(dmb_modes *modes, uint32_t keep);

/* The modes that the options ask for, and others with them. */
int32_t dmb_modes_find(dmb_mode_search *search);
/* [-] |(s^2 M + s C + K) d| of mode k over the norms of the terms that balance in it. */
double dmb_modes_residual(const dmb_mode_search *search, uint32_t k);
/* The same against the forces themselves, as a vector over the roots of the masses of its coordinates. */
dmb_mode_defect dmb_modes_defect(const dmb_mode_search *search, uint32_t k);
/* Whether every mode is one. Of the lowest ones, those before the first that is not stay: DMB_NOTE_INCOMPLETE.
 * DMB_ERR_NO_CONVERGENCE. */
int32_t dmb_modes_check(dmb_mode_search *search);
/* Makes those sharper that leave more than they may. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_polish(dmb_mode_search *search);
/* Tells roots of one shape that only rounding parts as their mean. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_join(dmb_mode_search *search);
void dmb_modes_weigh_coordinates(const dmb_mode_search *search);

/* All modes, by LAPACK on the independent coordinates. */
int32_t dmb_modes_dense(dmb_mode_search *search);
/* `wanted` modes nearest the shift, by Krylov subspaces, rigid-body motions that are pinned apart. */
int32_t dmb_modes_sparse(dmb_mode_search *search, uint32_t wanted);

/* Likewise the roots nearest growth + i omega, omega >= 0, and to its conjugate; where a root stands, as those 0 of
 * rigid-body motions do, growth gives way by `aside` [1/s], > 0. *least: smallest value of the operator among them, 0
 * if these are all; roots of larger dmb_shifted_value are complete. */
int32_t dmb_modes_shifted(dmb_mode_search *search, double *growth, double omega, double aside, uint32_t wanted,
                          double *least);
/* Value that the operator of a shift has at the root re + i im. */
double dmb_shifted_value(double growth, double omega, double re, double im);
/* Whether the dense way to so many modes is the faster one. */
int dmb_modes_is_dense(const dmb_mode_search *search, uint32_t wanted);
/* No shift where K is regular or pinned; otherwise a small one off the eigenvalues of a stable system; K is factored
 * with it. Errors of dmb_modes_sparse. */
int32_t dmb_modes_choose_shift(dmb_mode_search *search);
/* The modes of smallest |s|, at least as many as the options ask for, or all there are; after
 * dmb_modes_choose_shift. */
int32_t dmb_modes_lowest(dmb_mode_search *search);
/* Number of eigenvalues s^2 below *square, those 0 of rigid-body motions left out where they are apart. *square moves
 * by `aside` where a block is singular; -1 if that does not help. The factors are gone. */
int64_t dmb_modes_count_below(const dmb_mode_search *search, double *square, double aside);
/* Adds all modes of eigenvalues from <= s^2 < to of a symmetric problem, piece by piece, each with as many as the
 * counts give. DMB_ERR_NO_CONVERGENCE, _SINGULAR, _NO_MEMORY. */
int32_t dmb_modes_squares(dmb_mode_search *search, double from, double to);
/* All modes of low to high [Hz] and some at its edges, piece by piece: of symmetric problems, and of general ones.
 * DMB_ERR_NO_CONVERGENCE, _SINGULAR, _TOO_LARGE, _NO_MEMORY. */
int32_t dmb_modes_band_of_squares(dmb_mode_search *search, double low, double high);
int32_t dmb_modes_band_of_roots(dmb_mode_search *search, double low, double high);
/* Where its roots stand in a strip along the imaginary axis, which is quick to cover: 1. */
int dmb_modes_find_strip(dmb_mode_search *search, double high, double strip[2]);

/* Finds all rigid-body motions. DMB_ERR_NO_MEMORY; DMB_ERR_NO_CONVERGENCE, with a message, where rounding hides
 * whether the forces of the state turn one back. */
int32_t dmb_modes_find_rigid(dmb_mode_search *search);
/* Leaves those of them that K does not turn back, to a part `away` of its terms above rounding. Errors as above. */
int32_t dmb_modes_check_rigid(dmb_mode_search *search, double away);
/* sum |K_ij| |d_j| by rows, and what, times the tolerance, frames and unbalanced forces of the state add to the
 * rounding of K d. */
void dmb_modes_rigid_terms(dmb_linear *linear, double tolerance, const double *d, double *terms);
/* Factors K with pins where its rigid-body motions are apart: pinned 1, or 0 if something else is singular too.
 * DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_pin(dmb_mode_search *search);
void dmb_modes_forget_rigid(dmb_mode_search *search);
/* Whether C leaves the rigid-body motions alone: C r = 0 and r^T C = 0. */
int dmb_modes_rigid_undamped(const dmb_mode_search *search);
/* x -= sum by_i (from_i . x) over the rigid-body motions, where they are apart. */
void dmb_modes_take_rigid(const dmb_mode_search *search, const double *from, const double *by, double *x);

/* Parts that the dense ways to all modes share. */

typedef struct dmb_dense {
    size_t n;             /* coordinates */
    size_t m;             /* rigid-body motions, which are the first of X */
    double *M, *X;        /* mass, gone after the modes X of the symmetric part of K, X^T M X = I, shape (n, n) */
    double *square;       /* [1/s2] their eigenvalues, ascending, shape (n) */
    double *motion;       /* rigid-body motions by coordinates, and M times them, shape (2, rigid_count, n) */
    double *rate;         /* [1/s] what their displacements are measured by, shape (n) */
    double *coupling;     /* skew part of K, then C; shape (n, n), as the following only where they are coupled */
    double *half;         /* work, shape (n + 1, n) */
    double *system, *V;   /* the coupled equations and their vectors, shape (m, m), m of dmb_coupled_size */
    double *re, *im;      /* shape (2n) */
    double *work, *x, *y; /* of LAPACK; rows */
    void *block;
    size_t bytes;
} dmb_dense;

/* Number of the coupled equations: 2n with damping, n without, 0 where nothing couples. */
size_t dmb_coupled_size(const dmb_mode_search *search);
/* Adds the modes of the coupled equations, X and square being there, the skew part of K in coupling. */
int32_t dmb_modes_coupled(dmb_mode_search *search, dmb_dense *d);

#endif
