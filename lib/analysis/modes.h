/* Modes of a linear system: what dmb_analysis_modes answers with, and the ways to find them. */
#ifndef DMB_ANALYSIS_MODES_H
#define DMB_ANALYSIS_MODES_H

#include "analysis/linearise.h"
#include "drillmbd/modes.h"

/* Asymmetry of K, over its diagonal, that is rounding. */
#define DMB_MODES_ASYMMETRY 1e-9
/* An eigenvalue of up to so much noise may be 0. */
#define DMB_RIGID_NOISE 1e3
/* K is singular where a pivot is this part of its block. */
#define DMB_MODES_LOOSE 1e-14

struct dmb_modes {
    uint32_t magic;
    uint32_t count, capacity;
    uint32_t rows;
    dmb_allocator allocator;
    dmb_sim *state;      /* the state they are about; a copy, which holds the model */
    dmb_modes_info info;
    double *s;           /* [1/s] re, im >= 0, shape (capacity, 2) */
    double *re, *im;     /* body-frame increments by rows, d^H M d = 1, shape (capacity, rows); im NULL of undamped modes */
    double *whirl;       /* [-] shape (capacity) */
    uint8_t *rigid;      /* shape (capacity) */
};

/* What is searched, and where it goes. */
typedef struct dmb_mode_search {
    dmb_linear *linear;
    const dmb_modes_options *options;
    dmb_modes *modes;
    dmb_message *message; /* of the sim */
    double *work;        /* shape (6 rows) */
    double noise;        /* [1/s2] what rounding of K makes of an eigenvalue 0, largest K_ii/M_ii times an epsilon */
    int32_t general;     /* 1: damped, or K not symmetric */
    int32_t pinned;      /* 1: the factors are those of K with its rigid-body motions pinned, and p = 0 */
    double shift;        /* of the sparse search: of s^2, of s where general */
    double *rigid, *rigid_momentum; /* rigid-body motions r, r^T M r = I, and M r, shape (rigid_count, rows) */
    size_t rigid_bytes;
    uint32_t rigid_count;
    uint32_t reserved;
} dmb_mode_search;

/* A result without modes about the state of a sim; dmb_modes_destroy gives it back. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_open(const dmb_sim *sim, dmb_modes **modes);
/* Room for `capacity` modes, what was there being kept. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_reserve(dmb_modes *modes, uint32_t capacity, int32_t with_im);
/* Adds a mode, d = x + i y by rows (y NULL: 0), normalised. */
int32_t dmb_modes_add(dmb_mode_search *search, double re, double im, const double *x, const double *y);
/* Adds an undamped mode of eigenvalue `square` = -s^2 of K d = square M d. */
int32_t dmb_modes_add_square(dmb_mode_search *search, double square, const double *x);
/* [1/s2] eigenvalue of an undamped mode x, x^T M x = 1, with the digits that its strain energy has where K x lost them. */
double dmb_modes_sharpen(const dmb_mode_search *search, double square, double *x);
/* Whether a mode leaves all elements unstrained at no frequency but rounding. */
int dmb_modes_is_rigid(const dmb_mode_search *search, double re, double im, double *x, double *y);
/* [1/s] |s| of mode i. */
double dmb_modes_size(const dmb_modes *modes, uint32_t i);
void dmb_modes_exchange(dmb_modes *modes, uint32_t i, uint32_t j);
/* Those of low to high [Hz] only. */
void dmb_modes_keep_band(dmb_modes *modes, double low, double high);
/* The roots 0 of rigid-body motions that are apart, give way to these motions; modes by rising frequency. */
int32_t dmb_modes_put_rigid(dmb_mode_search *search);
/* By rising frequency; keeps the first `keep`. */
void dmb_modes_sort(dmb_modes *modes, uint32_t keep);

/* The modes that the options ask for, and others with them. */
int32_t dmb_modes_find(dmb_mode_search *search);
/* [-] |(s^2 M + s C + K) d| of mode k over the norms of the terms that balance in it. */
double dmb_modes_residual(const dmb_mode_search *search, uint32_t k);

/* All modes, by LAPACK on the independent coordinates. */
int32_t dmb_modes_dense(dmb_mode_search *search);
/* `wanted` modes nearest the shift, by Krylov subspaces, rigid-body motions that are pinned apart. */
int32_t dmb_modes_sparse(dmb_mode_search *search, uint32_t wanted);

/* Factors a singular, symmetric K with pins and finds its rigid-body motions: 1. 0 if it is not that simple: with joints,
 * or where something weak holds. DMB_ERR_NO_MEMORY. */
int32_t dmb_modes_pin(dmb_mode_search *search);
void dmb_modes_forget_rigid(dmb_mode_search *search);
/* Whether C leaves the rigid-body motions alone: C r = 0 and r^T C = 0. */
int dmb_modes_rigid_undamped(const dmb_mode_search *search);
/* x -= sum by_i (from_i . x) over the rigid-body motions. */
void dmb_modes_take_rigid(const dmb_mode_search *search, const double *from, const double *by, double *x);

#endif
