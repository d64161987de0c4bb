/* Balancing (Parlett, Reinsch, Balancing a matrix, 1969; by Euclidean lengths with the diagonal: James, Langou, Lowery,
 * On matrix balancing and eigenvector computation, 2014), Hessenberg form by Householder reflections, real Schur form
 * by Francis' steps with two shifts, vectors by substitution (Golub, Van Loan, Matrix Computations, 4th ed., 7.4
 * to 7.6). */
#include <complex.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "math/bridge.h"

typedef struct schur {
    size_t n;
    double *T, *Z; /* A = Z T Z^T at the end */
    double *re, *im;
    double *scale, *v; /* (n) (4 n) */
    double norm;
} schur;

static double *at(const schur *s, size_t i, size_t j)
{
    return s->T + i + s->n * j;
}

/* ---- Balancing --------------------------------------------------------------------------------------------------- */

/* Scales row and column i to similar length, by a power of 2, which is exact: rounding of the eigenvalues, relative to
 * the norm of the matrix, is then smaller and nothing is added to it. A row or column of zeros has no scale. Returns 0
 * if they are similar already, that is if their sum would fall by less than 5 %. */
static int balance_row(schur *s, size_t i)
{
    const size_t n = s->n;
    double column = 0.0, row = 0.0, factor = 1.0;
    for (size_t j = 0; j < n; j++) {
        column = hypot(column, *at(s, j, i));
        row = hypot(row, *at(s, i, j));
    }
    if (!(column > 0.0 && row > 0.0 && column <= DBL_MAX && row <= DBL_MAX)) return 0;
    const double sum = column + row;
    while (column < 0.5 * row && factor < 0x1p500) column *= 4.0, factor *= 2.0;
    while (column >= 2.0 * row && factor > 0x1p-500) column *= 0.25, factor *= 0.5;
    if ((column + row) / factor >= 0.95 * sum) return 0;
    s->scale[i] *= factor;
    for (size_t j = 0; j < n; j++) *at(s, i, j) /= factor;
    for (size_t j = 0; j < n; j++) *at(s, j, i) *= factor;
    return 1;
}

static void balance(schur *s)
{
    int changed = 1;
    for (size_t i = 0; i < s->n; i++) s->scale[i] = 1.0;
    for (int tries = 0; tries < 100 && changed; tries++) {
        changed = 0;
        for (size_t i = 0; i < s->n; i++) changed |= balance_row(s, i);
    }
}

/* ---- Reflections ------------------------------------------------------------------------------------------------- */

/* v of I - beta v v^T that makes x a multiple of e1; returns beta, 0 if x = 0. x is divided by its largest entry, so
 * that squares neither overflow nor vanish; the sign of the length is that of x_0, so that v_0 is a sum, not a
 * difference: |v|^2 = 2 (L^2 + L |x_0|) = 2 L |v_0|, hence beta = 2/|v|^2 = 1/(L |v_0|). */
static double reflection(size_t m, const double *x, double *v)
{
    double most = 0.0, sum = 0.0;
    for (size_t i = 0; i < m; i++) most = fmax(most, fabs(x[i]));
    memset(v, 0, m * sizeof(double));
    if (!(most > 0.0)) return 0.0;
    for (size_t i = 0; i < m; i++) {
        v[i] = x[i] / most;
        sum += v[i] * v[i];
    }
    const double length = sqrt(sum), first = v[0] + copysign(length, v[0]);
    v[0] = first;
    return 1.0 / (length * fabs(first));
}

/* Applies P T to rows `row` .. row + m - 1 and columns from `first` on. */
static void from_left(schur *s, size_t row, size_t m, size_t first, const double *v, double beta)
{
    for (size_t j = first; j < s->n; j++) {
        double *x = at(s, row, j), sum = 0.0;
        for (size_t i = 0; i < m; i++) sum += v[i] * x[i];
        for (size_t i = 0; i < m; i++) x[i] -= beta * sum * v[i];
    }
}

/* Applies A P to m columns from A on, in their first `rows` rows. */
static void from_right(size_t n, double *A, size_t m, size_t rows, const double *v, double beta)
{
    for (size_t i = 0; i < rows; i++) {
        double *x = A + i, sum = 0.0;
        for (size_t j = 0; j < m; j++) sum += v[j] * x[n * j];
        for (size_t j = 0; j < m; j++) x[n * j] -= beta * sum * v[j];
    }
}

/* Column by column, a reflection of the rows below the subdiagonal clears the rest of the column; the same from the
 * right keeps the eigenvalues and does not touch the columns that are done. Z collects the reflections. */
static void hessenberg(schur *s)
{
    const size_t n = s->n;
    memset(s->Z, 0, n * n * sizeof(double));
    for (size_t k = 0; k < n; k++) s->Z[k + n * k] = 1.0;
    for (size_t k = 0; k + 2 < n; k++) {
        const size_t m = n - k - 1;
        const double beta = reflection(m, at(s, k + 1, k), s->v);
        from_left(s, k + 1, m, k, s->v, beta);
        from_right(n, at(s, 0, k + 1), m, n, s->v, beta);
        from_right(n, s->Z + n * (k + 1), m, n, s->v, beta);
        for (size_t i = k + 2; i < n; i++) *at(s, i, k) = 0.0;
    }
}

/* ---- Schur form -------------------------------------------------------------------------------------------------- */

/* First row of the block that ends at `last`; a subdiagonal entry below rounding before it is set to zero. */
static size_t block_start(schur *s, size_t last)
{
    size_t l = last;
    for (; l > 0; l--) {
        const double sum = fabs(*at(s, l, l)) + fabs(*at(s, l - 1, l - 1));
        if (fabs(*at(s, l, l - 1)) <= DBL_EPSILON * (sum > 0.0 ? sum : s->norm)) break;
    }
    if (l > 0) *at(s, l, l - 1) = 0.0;
    return l;
}

/* First column of (T - shift 1) (T - shift 2), from the sum and product of the shifts, up to a factor. */
static void first_column(const schur *s, size_t l, double sum, double product, double x[3])
{
    const double scale = fabs(*at(s, l + 1, l)) > 0.0 ? *at(s, l + 1, l) : s->norm, a = *at(s, l, l);
    x[0] = (a * (a - sum) + product) / scale + *at(s, l, l + 1);
    x[1] = a + *at(s, l + 1, l + 1) - sum;
    x[2] = *at(s, l + 2, l + 1);
}

/* One step on rows l .. last, at least three. Both shifts are the eigenvalues of the last block of two rows: they may
 * be a complex pair, but enter by sum and product alone, so that all is real. The first reflection makes the first
 * column that of (T - shift 1)(T - shift 2), which leaves a bulge of two entries below the subdiagonal; the following
 * ones chase it off the end (implicit Q theorem). Rows above and columns behind the block are transformed too, since T
 * becomes the Schur form. Exceptional shifts break the cycles of matrices that reproduce themselves. */
static void francis(schur *s, size_t l, size_t last, int exceptional)
{
    double sum = *at(s, last - 1, last - 1) + *at(s, last, last), x[3];
    double product = *at(s, last - 1, last - 1) * *at(s, last, last) - *at(s, last - 1, last) * *at(s, last, last - 1);
    if (exceptional) {
        const double size = fabs(*at(s, last, last - 1)) + fabs(*at(s, last - 1, last - 2));
        sum = 1.5 * size;
        product = size * size;
    }
    first_column(s, l, sum, product, x);
    for (size_t k = l; k < last; k++) {
        const size_t m = k + 2 <= last ? 3 : 2, rows = k + 4 <= last + 1 ? k + 4 : last + 1;
        const double beta = reflection(m, x, s->v);
        from_left(s, k, m, k > l ? k - 1 : l, s->v, beta);
        from_right(s->n, at(s, 0, k), m, rows, s->v, beta);
        from_right(s->n, s->Z + s->n * k, m, s->n, s->v, beta);
        for (size_t i = k + 1; k > l && i < k + m; i++) *at(s, i, k - 1) = 0.0;
        for (size_t i = 0; i < 3 && k + 1 + i <= last; i++) x[i] = *at(s, k + 1 + i, k);
    }
}

static void rotate(schur *s, size_t k, double c, double p)
{
    const size_t n = s->n;
    for (size_t j = k; j < n; j++) {
        const double x = *at(s, k, j), y = *at(s, k + 1, j);
        *at(s, k, j) = c * x + p * y;
        *at(s, k + 1, j) = c * y - p * x;
    }
    for (size_t i = 0; i < n + k + 2; i++) { /* rows of T down to k + 1, then all of Z */
        double *x = i < k + 2 ? s->T + i + n * k : s->Z + (i - k - 2) + n * k;
        const double kept = x[0];
        x[0] = c * kept + p * x[n];
        x[n] = c * x[n] - p * kept;
    }
}

/* Computes the two eigenvalues d + half +- sqrt(half^2 + b c) of the block [a b; c d] at k, half = (a - d)/2; if they
 * are real, the block is made triangular. z is the larger root of z^2 - 2 half z - b c, without cancellation; the other
 * one is -b c/z. The rotation has the eigenvector (z, c) of d + z as its first column. */
static void split(schur *s, size_t k)
{
    const double d = *at(s, k + 1, k + 1), half = 0.5 * (*at(s, k, k) - d), c = *at(s, k + 1, k);
    const double product = *at(s, k, k + 1) * c, square = half * half + product, root = sqrt(fabs(square));
    if (square < 0.0) {
        s->re[k] = s->re[k + 1] = d + half;
        s->im[k] = root;
        s->im[k + 1] = -root;
        return;
    }
    const double z = half + copysign(root, half), length = sqrt(c * c + z * z);
    if (length > 0.0) rotate(s, k, z / length, c / length);
    *at(s, k + 1, k) = 0.0;
    s->re[k] = *at(s, k, k) = d + z;
    s->re[k + 1] = *at(s, k + 1, k + 1) = fabs(z) > 0.0 ? d - product / z : d + z;
    s->im[k] = s->im[k + 1] = 0.0;
}

/* Eigenvalues leave at the end of the matrix, one or two at a time. Convergence is quadratic, some two or three steps
 * each; 300 without one are a failure, and every tenth has other shifts. */
static int32_t to_schur(schur *s)
{
    int tries = 0;
    for (size_t left = s->n; left > 0;) {
        const size_t last = left - 1, l = block_start(s, last);
        if (l + 1 < last) {
            if (++tries > 300) return (int32_t)left;
            francis(s, l, last, tries % 10 == 0);
            continue;
        }
        if (l == last) {
            s->re[last] = *at(s, last, last);
            s->im[last] = 0.0;
        } else {
            split(s, l);
        }
        left = l;
        tries = 0;
    }
    return 0;
}

/* ---- Vectors ----------------------------------------------------------------------------------------------------- */

/* Replaces a divisor that rounding made zero by the rounding error of the eigenvalue that it is the distance to. */
static double complex divisor(double complex x, double complex value)
{
    const double least = fmax(DBL_EPSILON * cabs(value), 1e-290);
    return fabs(creal(x)) + fabs(cimag(x)) > 0.0 ? x : least;
}

static double complex rest(const schur *s, const double complex *y, size_t i, size_t from, size_t end)
{
    double complex sum = 0.0;
    for (size_t j = from; j < end; j++) sum -= *at(s, i, j) * y[j];
    return sum;
}

/* Close eigenvalues make components grow by the inverse of their distance, again and again up the matrix: the vector is
 * scaled long before it overflows. Its length is set at the end. */
static void scale_down(double complex *y, size_t from, size_t end)
{
    const double most = fmax(fabs(creal(y[from])), fabs(cimag(y[from])));
    if (!(most > 1e100)) return;
    for (size_t i = from; i < end; i++) y[i] /= most;
}

/* Solves (B - value) y = (f, g) for a block B of two rows, with columns `step` apart, by elimination with row exchange,
 * which close eigenvalues require. */
static void solve_two(const double *B, size_t step, double complex value, double complex f, double complex g,
                      double complex *y)
{
    const double b = B[step], c = B[1];
    const double complex a = B[0] - value, d = B[step + 1] - value;
    if (cabs(a) >= fabs(c)) {
        const double complex pivot = divisor(a, value), m = c / pivot;
        y[1] = (g - m * f) / divisor(d - m * b, value);
        y[0] = (f - b * y[1]) / pivot;
    } else {
        const double complex m = a / c;
        y[1] = (f - m * g) / divisor(b - m * d, value);
        y[0] = (g - d * y[1]) / c;
    }
}

/* Solves (T - value) y = 0 in the rows before `known`, from below, with y given from there to `end`. */
static void substitute(const schur *s, double complex value, double complex *y, size_t known, size_t end)
{
    for (size_t i = known; i-- > 0;) {
        const double complex f = rest(s, y, i, i + 1, end), d = *at(s, i, i) - value;
        if (i == 0 || !(fabs(*at(s, i, i - 1)) > 0.0)) {
            y[i] = f / divisor(d, value);
        } else { /* a block of two rows, i - 1 and i */
            solve_two(at(s, i - 1, i - 1), s->n, value, rest(s, y, i - 1, i + 1, end), f, y + i - 1);
            i--;
        }
        scale_down(y, i, end);
    }
}

/* Column k of V and, for a pair, the next: Z y scaled to length 1, with its largest component real. `end`: length of y.
 */
static void back(schur *s, const double complex *y, size_t k, size_t end)
{
    const size_t n = s->n;
    double complex *x = (double complex *)s->v, largest = 0.0;
    double sum = 0.0;
    for (size_t i = 0; i < n; i++) {
        x[i] = 0.0;
        for (size_t j = 0; j < end; j++) x[i] += s->Z[i + n * j] * y[j];
        x[i] *= s->scale[i];
        if (cabs(x[i]) > cabs(largest)) largest = x[i];
    }
    if (!(cabs(largest) > 0.0)) largest = 1.0;
    for (size_t i = 0; i < n; i++) {
        x[i] /= largest;
        sum += creal(x[i]) * creal(x[i]) + cimag(x[i]) * cimag(x[i]);
    }
    for (size_t i = 0; i < n; i++) {
        s->Z[i + n * k] = creal(x[i]) / sqrt(sum);
        if (end > k + 1) s->Z[i + n * (k + 1)] = cimag(x[i]) / sqrt(sum);
    }
}

/* From the last to the first: a vector requires the columns of Z up to its own only. */
static void vectors(schur *s)
{
    double complex *y = (double complex *)(s->v + 2 * s->n);
    for (size_t end = s->n; end > 0;) {
        const size_t k = s->im[end - 1] < 0.0 ? end - 2 : end - 1;
        const double complex value = s->re[k] + s->im[k] * (double complex)I;
        y[end - 1] = 1.0;
        if (k + 1 <
            end) { /* of a block [a b; c d]: c y_k + (d - value) y_k+1 = 0, or the row above where b is larger */
            const double b = *at(s, k, k + 1), c = *at(s, k + 1, k);
            if (fabs(b) > fabs(c)) {
                y[k] = 1.0;
                y[k + 1] = (value - *at(s, k, k)) / b;
            } else {
                y[k] = (value - *at(s, k + 1, k + 1)) / c;
            }
        }
        substitute(s, value, y, k, end);
        back(s, y, k, end);
        end = k;
    }
}

int32_t dmb_dense_general(size_t n, double *A, double *re, double *im, double *V, double *work)
{
    schur s = {n, A, V, re, im, work, work + n, 0.0};
    for (size_t i = 0; i < n * n; i++) {
        if (!(fabs(A[i]) <= DBL_MAX)) return 1;
    }
    balance(&s);
    for (size_t i = 0; i < n * n; i++) s.norm = fmax(s.norm, fabs(A[i]));
    if (!(s.norm > 0.0)) s.norm = DBL_MIN;
    hessenberg(&s);
    const int32_t failed = to_schur(&s);
    if (failed == 0) vectors(&s);
    return failed;
}
