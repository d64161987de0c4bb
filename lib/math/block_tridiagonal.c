/* Block elimination down the chain, W_i = D_i^-1 U_i, D_{i+1} -= L_i W_i (block Thomas algorithm; Golub and
 * Van Loan, Matrix Computations, 4.5.1). */
#include "math/block_kernels.h"

int32_t dmb_block_count(uint32_t n, const uint8_t *size, dmb_block_totals *totals)
{
    uint64_t rows = 0, diagonal = 0, link = 0;
    for (uint32_t i = 0; i < n; i++) {
        if (size[i] < 1 || size[i] > MAX) return -1;
        rows += size[i];
        diagonal += (uint64_t)size[i] * size[i];
        if (i + 1 < n) link += (uint64_t)size[i] * size[i + 1];
    }
    if (diagonal > UINT32_MAX || link > UINT32_MAX) return -1;
    totals->rows = (uint32_t)rows;
    totals->diagonal = (uint32_t)diagonal;
    totals->link = (uint32_t)link;
    return 0;
}

void dmb_block_fill(uint32_t n, const uint8_t *size, uint32_t *row, uint32_t *diag, uint32_t *link)
{
    row[0] = diag[0] = 0;
    if (n > 0) link[0] = 0;
    for (uint32_t i = 0; i < n; i++) {
        row[i + 1] = row[i] + size[i];
        diag[i + 1] = diag[i] + (uint32_t)size[i] * size[i];
        if (i + 1 < n) link[i + 1] = link[i] + (uint32_t)size[i] * size[i + 1];
    }
}

int64_t dmb_block_factor(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first, uint32_t count)
{
    return factor_blocks(layout, matrix, first, count, NULL);
}

int64_t dmb_block_factor_watched(const dmb_block_layout *layout, dmb_block_matrix *matrix, uint32_t first,
                                 uint32_t count, dmb_block_weakest *weakest)
{
    weakest->ratio = (double)INFINITY;
    weakest->block = first;
    weakest->unknown = 0;
    return factor_blocks(layout, matrix, first, count, weakest);
}

void dmb_block_solve(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                     double *rhs)
{
    solve_blocks(layout, matrix, first, count, rhs);
}

/* y_i += D_i x_i + U_i x_{i+1}, and the next y += L_i x_i */
KERNEL void add_product(int rows, int columns, const double *restrict A, const double *restrict x, double *restrict y)
{
    for (int i = 0; i < rows; i++) {
        double s = y[i];
        for (int j = 0; j < columns; j++) s += A[columns * i + j] * x[j];
        y[i] = s;
    }
}

void dmb_block_multiply(const dmb_block_layout *layout, const dmb_block_matrix *matrix, uint32_t first, uint32_t count,
                        const double *x, double *y)
{
    const uint32_t end = first + count, *row = layout->row;
    for (uint32_t r = row[first]; r < row[end]; r++) y[r] = 0.0;
    for (uint32_t i = first; i < end; i++) {
        const int n = layout->size[i], m = i + 1 < end ? layout->size[i + 1] : 0;
        const uint32_t link = layout->link[i];
        BY_SIZE(add_product, n, n, matrix->diagonal + layout->diag[i], x + row[i], y + row[i]);
        BY_SIZE(add_product, n, m, matrix->upper + link, x + row[i + 1], y + row[i]);
        BY_SIZE(add_product, m, n, matrix->lower + link, x + row[i], y + row[i + 1]);
    }
}
