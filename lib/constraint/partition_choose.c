/* Choosing is Gaussian elimination with complete pivoting (Golub and Van Loan, Matrix Computations, 3.4) of rows scaled
 * to unit length in weighted columns (Wehage, Haug, J. Mech. Design 104, 1982). */
#include "constraint/partition_row.h"

/* Largest |x_j|. */
static double row_largest(size_t n, const double *x)
{
    double m[4] = {0.0, 0.0, 0.0, 0.0};
    size_t j = 0;
    for (; j + 4 <= n; j += 4)
        for (size_t i = 0; i < 4; i++) m[i] = larger(fabs(x[j + i]), m[i]);
    for (; j < n; j++) m[0] = larger(fabs(x[j]), m[0]);
    return larger(larger(m[0], m[1]), larger(m[2], m[3]));
}

/* The rows of B diag(weight) at unit length into a, their largest entries into top; zeros for a row of length zero and
 * for one that is not finite. Returns whether all are finite. */
static bool scale_rows(const double *B, uint32_t stride, const double *weight, const dmb_partition *p, double *a,
                       double *top)
{
    const size_t n = p->columns;
    bool finite = true;
    for (size_t i = 0; i < p->rows; i++) {
        const double *b = B + i * stride;
        const double length = row_length(n, b, weight);
        const double scale = usable(length) ? 1.0 / length : 0.0;
        double *row = a + i * n;
        for (size_t j = 0; j < n; j++) row[j] = scale > 0.0 ? b[j] * weight[j] * scale : 0.0;
        top[i] = row_largest(n, row);
        finite = finite && length <= DBL_MAX;
    }
    return finite;
}

/* The largest entry of the remaining rows and its places in the two orders. Both are walked ascending, so that the
 * first of equals is taken, and "equal" is wider than rounding: symmetric mechanisms have many equal candidates. */
static double find_pivot(const dmb_partition *p, const double *a, const double *top, uint32_t *row_place,
                         uint32_t *column_place)
{
    double best = 0.0;
    for (uint32_t s = p->rank; s < p->rows; s++) {
        const size_t i = p->row_order[s];
        if (!(top[i] > best * DMB_CLEARLY)) continue;
        for (uint32_t c = p->rank; c < p->columns; c++) {
            const double v = fabs(a[i * p->columns + p->column_order[c]]);
            if (!(v > best * DMB_CLEARLY)) continue;
            best = v;
            *row_place = s;
            *column_place = c;
        }
    }
    return best;
}

/* Moves order[from] down to `to`; those it passes keep their order. */
static void move_item(uint32_t *order, uint32_t from, uint32_t to)
{
    const uint32_t item = order[from];
    for (uint32_t i = from; i > to; i--) order[i] = order[i - 1];
    order[to] = item;
}

/* Subtracts the last pivot row from those that remain. Its column becomes exactly zero there, as columns of weight 0
 * are: neither is found again, and whole rows can be worked on. */
static void eliminate(const dmb_partition *p, double *a, double *top)
{
    const size_t n = p->columns, column = p->column_order[p->rank - 1];
    const double *pivot_row = a + n * p->row_order[p->rank - 1];
    uint32_t places[DMB_PLACES];
    const size_t count = find_places(n, pivot_row, places);
    for (uint32_t s = p->rank; s < p->rows; s++) {
        const size_t i = p->row_order[s];
        double *row = a + n * i;
        if (row[column] == 0.0) continue;
        row_subtract_at(n, count, places, row[column] / pivot_row[column], pivot_row, row);
        row[column] = 0.0;
        top[i] = row_largest(n, row);
    }
}

double dmb_partition_choose(const double *B, uint32_t stride, const double *weight, double *work,
                            dmb_partition *partition)
{
    dmb_partition *p = partition;
    double *a = work, *top = work + (size_t)p->rows * p->columns;
    for (uint32_t i = 0; i < p->rows; i++) p->row_order[i] = i;
    for (uint32_t j = 0; j < p->columns; j++) p->column_order[j] = j;
    p->rank = 0;
    const bool finite = scale_rows(B, stride, weight, p, a, top);
    double smallest = DBL_MAX, largest = 0.0;
    for (;;) {
        uint32_t row_place = 0, column_place = 0;
        const double size = find_pivot(p, a, top, &row_place, &column_place);
        if (!(size > DMB_RANK_TOLERANCE)) break;
        move_item(p->row_order, row_place, p->rank);
        move_item(p->column_order, column_place, p->rank);
        p->rank++;
        if (size < smallest) smallest = size;
        if (size > largest) largest = size;
        eliminate(p, a, top);
    }
    if (!finite) return 0.0;
    return p->rank == 0 ? 1.0 : smallest / largest;
}
