/* Search for the eigenvalues of largest modulus (krylov.h). One turn of `search`:
 *
 *     extend    each vector is multiplied and orthogonalised, which adds a column of H and a vector
 *     project   eigenvalues of the projection H; the residual of a pair is the rows of H below the square, times its
 *               vector
 *     done      all requested values have converged, and
 *                 counted            after one more extension, for vectors as accurate as after a confirmation
 *                 not counted        again after a random vector and an extension: a missed value would appear
 *                 `enough`           so many of them lie beyond the bounds
 *     end       the space is complete: its values are exact
 *               the limit of vectors is reached: DMB_ERR_NO_CONVERGENCE, or the values as they are (`partly`) */
#include "math/krylov.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "math/bridge.h"
#include "math/dense.h"

/* A vector whose length is below this fraction of its length before orthogonalisation is rounding: the space is
 * invariant. */
#define DMB_KRYLOV_CLOSED 1e-13

/* A residual that another extension leaves above this fraction is of a crowd of values, which it does not resolve. */
#define DMB_KRYLOV_CROWD 0.1

/* The space grows by at least this fraction before convergence is checked again. */
enum { DMB_KRYLOV_GROWTH = 12 };

typedef struct basis {
    const dmb_operator *A;
    const dmb_allocator *allocator;
    double **vector;  /* shape (limit): v, then G v, then none */
    double *H;        /* projection, column by column: A V = V H, shape (limit, limit) */
    size_t limit;     /* of vectors */
    size_t count;     /* of vectors */
    size_t processed; /* of them multiplied */
    uint64_t seed;
    double *work; /* shape (2 length) */
    /* of the last projection */
    double *matrix, *re, *im, *S, *lapack;
    uint32_t *order; /* values by descending modulus, without those of im < 0 and those left out */
    size_t values;   /* length of order */
} basis;

/* ---- Vectors ----------------------------------------------------------------------------------------------------- */

static void add(size_t n, double factor, const double *x, double *y)
{
    for (size_t i = 0; i < n; i++) y[i] += factor * x[i];
}

static const double *metric_of(const basis *b, size_t i)
{
    return b->vector[i] + b->A->length;
}

/* Subtracts from x its components along the vectors from `first` on, and adds them to `column` if there is one. */
static void orthogonalise(const basis *b, size_t first, double *x, double *column)
{
    const size_t n = b->A->length;
    for (size_t i = first; i < b->count; i++) {
        const double part = dmb_dot(n, metric_of(b, i), x);
        add(n, -part, b->vector[i], x);
        if (column != NULL) column[i] += part;
    }
}

/* Appends x, which is orthogonal to the others, to the basis. Returns its length; 0 if it vanishes, < 0 without memory.
 */
static double append(basis *b, const double *x, double before)
{
    const size_t n = b->A->length;
    double *Gx = b->work + n;
    b->A->metric(b->A->context, x, Gx);
    const double length = sqrt(fmax(dmb_dot(n, x, Gx), 0.0));
    if (!(length > DMB_KRYLOV_CLOSED * before) || b->count == b->limit) return 0.0;
    double *v = dmb_allocate_array(b->allocator, 2 * n, sizeof(double));
    if (v == NULL) return -1.0;
    b->vector[b->count++] = v;
    for (size_t i = 0; i < n; i++) {
        v[i] = x[i] / length;
        v[n + i] = Gx[i] / length;
    }
    return length;
}

/* Appends a random vector, smoothed by the operator. */
static int32_t throw_in(basis *b)
{
    double *x = b->work, *y = b->work + b->A->length;
    b->A->draw(b->A->context, &b->seed, x);
    b->A->metric(b->A->context, x, y);
    const double before = sqrt(fabs(dmb_dot(b->A->length, x, y)));
    orthogonalise(b, 0, x, NULL);
    orthogonalise(b, 0, x, NULL);
    return append(b, x, before) < 0.0 ? DMB_ERR_NO_MEMORY : DMB_OK;
}

/* Multiplies the next vector: adds a column of H, and a new vector from the part outside the space. With a symmetric
 * operator all components except those along the last vectors vanish apart from rounding, which the second pass
 * removes. */
static int32_t process(basis *b, size_t start)
{
    const size_t n = b->A->length, k = b->processed++;
    double *x = b->work, *column = b->H + b->limit * k;
    b->A->apply(b->A->context, b->vector[k], metric_of(b, k), x);
    orthogonalise(b, b->A->symmetric && k > 2 * start ? k - 2 * start : 0, x, column);
    orthogonalise(b, 0, x, column);
    const double before = sqrt(dmb_dot(b->count, column, column)), length = append(b, x, before);
    (void)n;
    if (length < 0.0) return DMB_ERR_NO_MEMORY;
    if (length > 0.0) column[b->count - 1] = length;
    return DMB_OK;
}

/* ---- Projection -------------------------------------------------------------------------------------------------- */

static double modulus(const basis *b, uint32_t i)
{
    return hypot(b->re[i], b->im[i]);
}

static void sort(basis *b)
{
    b->values = 0;
    for (uint32_t i = 0; i < b->processed; i++) {
        if (b->im[i] < 0.0 || (b->A->positive && !(b->re[i] > 0.0))) continue;
        size_t k = b->values++;
        for (; k > 0 && modulus(b, b->order[k - 1]) < modulus(b, i); k--) b->order[k] = b->order[k - 1];
        b->order[k] = i;
    }
}

static int32_t project(basis *b)
{
    const size_t p = b->processed;
    int32_t failed;
    for (size_t j = 0; j < p; j++)
        for (size_t i = 0; i < p; i++) {
            const double *H = b->H;
            const double here = H[b->limit * j + i];
            b->matrix[p * j + i] = b->A->symmetric ? 0.5 * (here + H[b->limit * i + j]) : here;
        }
    if (b->A->symmetric) {
        memset(b->im, 0, p * sizeof(double));
        failed = dmb_eigen_symmetric(p, b->matrix, b->re, b->lapack);
        memcpy(b->S, b->matrix, p * p * sizeof(double));
    } else {
        failed = dmb_eigen_general(p, b->matrix, b->re, b->im, b->S, b->lapack);
    }
    if (failed != 0) return DMB_ERR_NO_CONVERGENCE;
    sort(b);
    return DMB_OK;
}

/* |rows of H below the processed square times s|: the part of A x - value x outside the space. */
static double residual_part(const basis *b, const double *s)
{
    double sum = 0.0;
    for (size_t i = b->processed; i < b->count; i++) {
        double here = 0.0;
        for (size_t j = 0; j < b->processed; j++) here += b->H[b->limit * j + i] * s[j];
        sum += here * here;
    }
    return sum;
}

static double residual(const basis *b, uint32_t i)
{
    const double *s = b->S + b->processed * i;
    const double sum = residual_part(b, s) + (b->im[i] > 0.0 ? residual_part(b, s + b->processed) : 0.0);
    return sqrt(sum);
}

/* Number of values that have converged before the first one that has not. */
static uint32_t converged(const basis *b, uint32_t wanted, double tolerance)
{
    uint32_t k = 0;
    while (k < wanted && k < b->values && residual(b, b->order[k]) <= tolerance * modulus(b, b->order[k])) k++;
    return k;
}

static int have_converged(const basis *b, uint32_t wanted, double tolerance)
{
    if (b->values < wanted) return b->processed == b->count; /* these are all values */
    for (uint32_t k = 0; k < wanted; k++)
        if (!(residual(b, b->order[k]) <= tolerance * modulus(b, b->order[k]))) return 0;
    return 1;
}

/* First value that has not converged, and its residual at the last check. */
typedef struct crowd {
    uint32_t value;
    double residual;
} crowd;

/* 1: the first value that has not converged has hardly improved since the last check. */
static int is_crowded(const basis *b, uint32_t wanted, double tolerance, crowd *last)
{
    const crowd now = {converged(b, wanted, tolerance), 0.0};
    if (b->A->partly != 1 || b->A->most == 0 || now.value == wanted || now.value >= b->values) return 0;
    const crowd before = *last;
    *last = (crowd){now.value, residual(b, b->order[now.value])};
    return before.value == now.value && last->residual > DMB_KRYLOV_CROWD * before.residual;
}

/* Number of values, all converged, that include `enough` values beyond the two bounds; 0 if there are fewer. */
static uint32_t enough_converged(const basis *b, uint32_t wanted, double tolerance)
{
    const dmb_operator *A = b->A;
    const uint32_t most = A->enough > 0 ? converged(b, wanted, tolerance) : 0;
    uint32_t inside = 0;
    for (uint32_t k = 0; k < most; k++) {
        const double value = b->re[b->order[k]];
        inside += value <= A->beyond[0] || value >= A->beyond[1];
        if (inside == A->enough) return k + 1;
    }
    return 0;
}

/* ---- Search ------------------------------------------------------------------------------------------------------ */

/* Processes up to `target` vectors; if the space becomes invariant before the dimension is reached, a random vector is
 * added. */
static int32_t extend(basis *b, size_t target, size_t start)
{
    int32_t status = DMB_OK;
    while (b->processed < target && status >= 0) {
        if (b->A->go_on != NULL) status = b->A->go_on(b->A->context);
        if (status < 0) return status;
        if (b->processed == b->count) {
            const size_t before = b->count;
            if (b->count < b->A->dimension) status = throw_in(b);
            if (b->count == before) return status;
        }
        if (status >= 0) status = process(b, start);
    }
    return status;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Extends the space until the requested values have converged, appends a random vector, and extends it until they have
 * converged again. */
static int32_t search(basis *b, uint32_t *count, size_t start, double tolerance)
{
    const size_t end = smaller(b->A->dimension, b->limit - start - 2);
    const uint32_t wanted = *count, first = b->A->enough > 0 ? b->A->enough : wanted;
    size_t target = smaller(end, first + (b->A->symmetric ? 0 : first) + 3 * start + 2), confirmed = SIZE_MAX;
    crowd last = {UINT32_MAX, 0.0};
    for (;;) {
        int32_t status = extend(b, target, start);
        if (status >= 0) status = project(b);
        if (status < 0) return status;
        const int all = b->processed >= b->A->dimension || b->processed == b->count;
        if (all) return DMB_OK;
        const uint32_t enough = enough_converged(b, wanted, tolerance);
        const int done = enough > 0 || have_converged(b, wanted, tolerance);
        if (done && b->A->counted && (confirmed != SIZE_MAX || target == end)) {
            *count = enough > 0 ? enough : wanted;
            return DMB_OK;
        }
        if (done && b->A->counted) { /* one more extension, for vectors as accurate as a confirmation gives */
            confirmed = target = smaller(end, target + 2 * start);
            continue;
        }
        if (done) {
            if (confirmed == SIZE_MAX) {
                confirmed = b->processed + 2 * start + 4;
                status = throw_in(b);
            } else if (b->processed >= confirmed) {
                return DMB_OK;
            }
        }
        if (status < 0) return status;
        if (target == end || is_crowded(b, wanted, tolerance, &last)) return DMB_ERR_NO_CONVERGENCE;
        const size_t more = 2 * (size_t)start + 2; /* the cost of a projection is cubic in the size of the space:
                                                      therefore the space grows by a fraction of it */
        target = smaller(end, target + (target / DMB_KRYLOV_GROWTH > more ? target / DMB_KRYLOV_GROWTH : more));
    }
}

/* ---- Result ------------------------------------------------------------------------------------------------------ */

/* out = V s, scaled */
static void combine(const basis *b, const double *s, double factor, double *out)
{
    memset(out, 0, b->A->length * sizeof(double));
    for (size_t j = 0; j < b->processed; j++) add(b->A->length, factor * s[j], b->vector[j], out);
}

static int32_t answer(const basis *b, uint32_t wanted, dmb_krylov *out)
{
    const size_t n = b->A->length, count = smaller(wanted, b->values), parts = b->A->symmetric ? 1 : 2;
    out->allocator = *b->allocator;
    out->block_size = (count * 2 + count * n * parts) * sizeof(double);
    out->block = dmb_allocate(b->allocator, out->block_size);
    if (out->block == NULL) return DMB_ERR_NO_MEMORY;
    out->count = (uint32_t)count;
    out->applications = (uint32_t)b->processed;
    out->re = out->block;
    out->im = out->re + count;
    out->x = out->im + count;
    out->y = parts > 1 ? out->x + count * n : NULL;
    for (size_t k = 0; k < count; k++) {
        const uint32_t i = b->order[k];
        out->re[k] = b->re[i];
        out->im[k] = b->im[i];
        combine(b, b->S + b->processed * i, 1.0, out->x + n * k);
        if (parts > 1 && b->im[i] > 0.0) combine(b, b->S + b->processed * (i + 1), 1.0, out->y + n * k);
    }
    return DMB_OK;
}

void dmb_krylov_release(dmb_krylov *krylov)
{
    dmb_release(&krylov->allocator, krylov->block, krylov->block_size);
    memset(krylov, 0, sizeof *krylov);
}

/* ---- Memory ------------------------------------------------------------------------------------------------------ */

typedef struct store {
    void *block;
    size_t bytes;
} store;

static int32_t open_basis(basis *b, store *s)
{
    const size_t m = b->limit, n = b->A->length;
    const size_t lapack = b->A->symmetric ? dmb_eigen_work(m) : dmb_eigen_general_work(m);
    const uint64_t squares = 3 * (uint64_t)m * m + lapack;
    if (lapack == SIZE_MAX || squares > SIZE_MAX / (2 * sizeof(double))) return DMB_ERR_TOO_LARGE;
    s->bytes = m * sizeof(double *) + ((size_t)squares + 2 * m + 2 * n + m) * sizeof(double);
    s->block = dmb_allocate(b->allocator, s->bytes);
    if (s->block == NULL) return DMB_ERR_NO_MEMORY;
    b->vector = s->block;
    b->H = (double *)(b->vector + m);
    b->matrix = b->H + m * m;
    b->S = b->matrix + m * m;
    b->re = b->S + m * m;
    b->im = b->re + m;
    b->work = b->im + m;
    b->lapack = b->work + 2 * n;
    b->order = (uint32_t *)(b->lapack + lapack);
    return DMB_OK;
}

static void close_basis(basis *b, const store *s)
{
    for (size_t i = 0; i < b->count; i++) dmb_release(b->allocator, b->vector[i], 2 * b->A->length * sizeof(double));
    dmb_release(b->allocator, s->block, s->bytes);
}

int32_t dmb_krylov_largest(const dmb_operator *A, uint32_t wanted, uint32_t start, double tolerance,
                           const dmb_allocator *allocator, dmb_krylov *out)
{
    basis b;
    store s = {NULL, 0};
    double next = 0.0, bound = 0.0;
    memset(&b, 0, sizeof b);
    memset(out, 0, sizeof *out);
    b.A = A;
    b.allocator = allocator;
    b.seed = 1;
    b.limit = smaller(A->dimension, (A->symmetric ? 4 : 8) * (size_t)wanted + 150) + start + 2; /* pairs count once */
    if (A->most > 0) b.limit = smaller(b.limit, A->most + start + 2);
    int32_t status = open_basis(&b, &s);
    if (status < 0) return status;
    for (uint32_t k = 0; k < start && status >= 0; k++) status = throw_in(&b);
    if (status >= 0) status = search(&b, &wanted, start, tolerance);
    if (status == DMB_ERR_NO_CONVERGENCE && A->partly && b.values > 0) {
        const uint32_t last = (uint32_t)smaller(wanted, b.values) - 1;
        const uint32_t first = (uint32_t)smaller(converged(&b, wanted, tolerance), last);
        next = modulus(&b, b.order[last]);
        bound = modulus(&b, b.order[first]) + residual(&b, b.order[first]);
        if (A->partly == 1) wanted = converged(&b, wanted, tolerance);
        if (wanted > 0 || A->counted) status = DMB_OK;
    }
    if (status >= 0) status = answer(&b, wanted, out);
    out->next = next;
    out->bound = bound;
    close_basis(&b, &s);
    return status;
}
