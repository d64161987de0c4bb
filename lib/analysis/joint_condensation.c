/* Exact dynamic condensation. With J the solved rows of nodes that joints act on and I the others,
 *
 *     S = A_JJ + joint tangents - A_JI A_II^-1 A_IJ,     R^T S R y = R^T (f_J - A_JI A_II^-1 f_I - S p),
 *     d_J = p + R y,
 *
 * R leading from independent coordinates to the rows, p what drives of joints ask for. The complex system is solved as
 * [Re -Im; Im Re]. */
#include "analysis/joint_condensation.h"

#include <string.h>

#include "math/dense_lu.h"

static int acts_on(const dmb_scene *scene, uint32_t node)
{
    return scene->cluster_count > 0 && scene->node_cluster[node] != UINT32_MAX;
}

uint32_t dmb_condensation_rows(const dmb_linear *linear)
{
    const dmb_scene *scene = &linear->scene;
    uint32_t count = 0;
    for (uint32_t node = 0; node < scene->node_count; node++)
        for (uint32_t c = 0; acts_on(scene, node) && c < scene->layout.size[node]; c++)
            count += scene->solved_row[scene->layout.row[node] + c];
    return count;
}

static dmb_complex_array take(dmb_arena *arena, size_t count)
{
    dmb_complex_array array;
    array.re = DMB_ARENA_DOUBLES(arena, count);
    array.im = DMB_ARENA_DOUBLES(arena, count);
    return array;
}

/* As many reduced coordinates as rows at most. */
void dmb_condensation_lay_out(dmb_arena *arena, const dmb_linear *linear, uint32_t rows, dmb_condensation *out)
{
    const size_t n = rows;
    out->rows = rows;
    out->place = DMB_ARENA_ARRAY(arena, uint32_t, linear->rows);
    if (rows == 0) return;
    out->number = DMB_ARENA_ARRAY(arena, uint32_t, linear->rows);
    out->row = DMB_ARENA_ARRAY(arena, uint32_t, n);
    out->node = DMB_ARENA_ARRAY(arena, uint32_t, n);
    out->pivot = DMB_ARENA_ARRAY(arena, uint32_t, 2 * n);
    out->inside = take(arena, n * linear->rows);
    out->schur = take(arena, n * n);
    out->half = take(arena, n * n);
    out->force = take(arena, n);
    out->moved = take(arena, n);
    out->dense = DMB_ARENA_DOUBLES(arena, 4 * n * n);
    out->solution = DMB_ARENA_DOUBLES(arena, 2 * n);
}

void dmb_condensation_number(const dmb_linear *linear, dmb_condensation *out)
{
    const dmb_scene *scene = &linear->scene;
    uint32_t count = 0;
    for (uint32_t r = 0; r < linear->rows; r++) out->place[r] = UINT32_MAX;
    if (out->rows == 0) return;
    for (uint32_t node = 0; node < scene->node_count; node++)
        for (uint32_t c = 0; acts_on(scene, node) && c < scene->layout.size[node]; c++) {
            const uint32_t row = scene->layout.row[node] + c;
            if (!scene->solved_row[row]) continue;
            out->place[row] = count;
            out->row[count] = row;
            out->node[count++] = node;
        }
    for (uint32_t i = 0; i < linear->coordinates; i++)
        out->number[i] = out->place[linear->row_of[i]] != UINT32_MAX ? out->reduced++ : UINT32_MAX;
}

/* ---- Schur complement -------------------------------------------------------------------------------------------- */

static dmb_complex_array row_of(dmb_complex_array array, size_t stride, size_t row)
{
    const dmb_complex_array out = {array.re + stride * row, array.im + stride * row};
    return out;
}

static uint32_t component(const dmb_dynamic_stiffness *s, uint32_t j)
{
    return s->condensation.row[j] - s->linear->scene.layout.row[s->condensation.node[j]];
}

static uint32_t chain_of(const dmb_dynamic_stiffness *s, uint32_t j)
{
    return s->linear->scene.node_chain[s->condensation.node[j]];
}

/* Column j of A_JJ into the Schur complement, and A_II^-1 A_Ij. */
static void column_of(dmb_dynamic_stiffness *s, uint32_t j)
{
    dmb_condensation *J = &s->condensation;
    const dmb_complex_array z = row_of(J->inside, s->linear->rows, j);
    const dmb_complex_number minus = {-1.0, 0.0};
    memset(z.re, 0, s->linear->rows * sizeof(double));
    memset(z.im, 0, s->linear->rows * sizeof(double));
    dmb_dynamic_subtract_column(s, J->node[j], component(s, j), minus, z);
    for (uint32_t a = 0; a < J->rows; a++) {
        J->schur.re[(size_t)J->rows * a + j] = z.re[J->row[a]];
        J->schur.im[(size_t)J->rows * a + j] = z.im[J->row[a]];
    }
    for (uint32_t r = 0; r < s->linear->rows; r++)
        if (s->held[r]) z.re[r] = z.im[r] = 0.0;
    dmb_dynamic_chain_solve(s, chain_of(s, j), z);
}

static void subtract_inside(dmb_dynamic_stiffness *s)
{
    dmb_condensation *J = &s->condensation;
    for (uint32_t j = 0; j < J->rows; j++)
        for (uint32_t a = 0; a < J->rows; a++) {
            if (chain_of(s, a) != chain_of(s, j)) continue;
            const dmb_complex_number x =
                dmb_dynamic_row_times(s, J->node[a], component(s, a), row_of(J->inside, s->linear->rows, j));
            J->schur.re[(size_t)J->rows * a + j] -= x.re;
            J->schur.im[(size_t)J->rows * a + j] -= x.im;
        }
}

/* What joints add between their nodes. */
static void add_joint(dmb_dynamic_stiffness *s, const dmb_constraint *c, uint32_t a, uint32_t r, uint32_t b, uint32_t q)
{
    const dmb_scene *scene = &s->linear->scene;
    const dmb_condensation *J = &s->condensation;
    const uint32_t row = J->place[scene->layout.row[c->node[a]] + r];
    const uint32_t column = J->place[scene->layout.row[c->node[b]] + q];
    const size_t at = c->tangent + (size_t)(c->column[a] + r) * c->columns + c->column[b] + q;
    if (row == UINT32_MAX || column == UINT32_MAX) return;
    const dmb_complex_number x = dmb_dynamic_entry(s, s->linear->mass.joints[at], s->linear->damping.joints[at],
                                                   s->linear->stiffness.joints[at]);
    J->schur.re[(size_t)J->rows * row + column] += x.re;
    J->schur.im[(size_t)J->rows * row + column] += x.im;
}

static void add_joints(dmb_dynamic_stiffness *s)
{
    const dmb_scene *scene = &s->linear->scene;
    for (uint32_t i = 0; i < scene->constraint_count; i++) {
        const dmb_constraint *c = scene->constraints + i;
        for (uint32_t a = 0; a < c->node_count; a++)
            for (uint32_t r = 0; r < scene->layout.size[c->node[a]]; r++)
                for (uint32_t b = 0; b < c->node_count; b++)
                    for (uint32_t q = 0; q < scene->layout.size[c->node[b]]; q++) add_joint(s, c, a, r, b, q);
    }
}

/* ---- Reduction --------------------------------------------------------------------------------------------------- */

/* half = S R */
static void times_null_space(dmb_dynamic_stiffness *s)
{
    const dmb_linear *linear = s->linear;
    dmb_condensation *J = &s->condensation;
    const size_t width = J->reduced;
    memset(J->half.re, 0, J->rows * width * sizeof(double));
    memset(J->half.im, 0, J->rows * width * sizeof(double));
    for (uint32_t j = 0; j < J->rows; j++)
        for (uint32_t i = linear->start[J->row[j]]; i < linear->start[J->row[j] + 1]; i++) {
            const uint32_t m = J->number[linear->column[i]];
            for (uint32_t a = 0; a < J->rows; a++) {
                J->half.re[width * a + m] += J->schur.re[(size_t)J->rows * a + j] * linear->value[i];
                J->half.im[width * a + m] += J->schur.im[(size_t)J->rows * a + j] * linear->value[i];
            }
        }
}

/* dense += R^T half, in its four quarters */
static void reduce(dmb_dynamic_stiffness *s)
{
    const dmb_linear *linear = s->linear;
    dmb_condensation *J = &s->condensation;
    const size_t width = J->reduced;
    memset(J->dense, 0, 4 * width * width * sizeof(double));
    for (uint32_t a = 0; a < J->rows; a++)
        for (uint32_t i = linear->start[J->row[a]]; i < linear->start[J->row[a] + 1]; i++) {
            double *upper = J->dense + 2 * width * J->number[linear->column[i]], *lower = upper + 2 * width * width;
            for (size_t m = 0; m < width; m++) {
                const double re = linear->value[i] * J->half.re[width * a + m];
                const double im = linear->value[i] * J->half.im[width * a + m];
                upper[m] += re;
                upper[width + m] -= im;
                lower[m] += im;
                lower[width + m] += re;
            }
        }
}

static uint32_t node_of_reduced(const dmb_dynamic_stiffness *s, uint32_t m)
{
    const dmb_condensation *J = &s->condensation;
    for (uint32_t i = 0; i < s->linear->coordinates; i++)
        if (J->number[i] == m) return J->node[J->place[s->linear->row_of[i]]];
    return 0;
}

int64_t dmb_condensation_factor(dmb_dynamic_stiffness *s)
{
    dmb_condensation *J = &s->condensation;
    const uint32_t n = 2 * J->reduced;
    for (uint32_t j = 0; j < J->rows; j++) column_of(s, j);
    subtract_inside(s);
    add_joints(s);
    times_null_space(s);
    reduce(s);
    const int64_t bad = dmb_dense_factor(n, J->dense, J->pivot);
    return bad >= 0 ? (int64_t)node_of_reduced(s, (uint32_t)bad % J->reduced) : -1;
}

/* ---- Solution ---------------------------------------------------------------------------------------------------- */

void dmb_condensation_take(dmb_dynamic_stiffness *s, int32_t joint_moves, dmb_complex_array x)
{
    const dmb_condensation *J = &s->condensation;
    const dmb_complex_array to = joint_moves ? J->moved : J->force, none = joint_moves ? J->force : J->moved;
    for (uint32_t j = 0; j < J->rows; j++) {
        const uint32_t r = J->row[j];
        to.re[j] = x.re[r];
        to.im[j] = x.im[r];
        none.re[j] = none.im[j] = x.re[r] = x.im[r] = 0.0;
    }
}

/* S_j. p */
static dmb_complex_number row_of_moved(const dmb_condensation *J, uint32_t j)
{
    const dmb_complex_array S = row_of(J->schur, J->rows, j);
    dmb_complex_number sum = {0.0, 0.0};
    for (uint32_t i = 0; i < J->rows; i++) {
        sum.re += S.re[i] * J->moved.re[i] - S.im[i] * J->moved.im[i];
        sum.im += S.re[i] * J->moved.im[i] + S.im[i] * J->moved.re[i];
    }
    return sum;
}

/* R^T (f_J - A_JI x_I - S p) */
static void restrict_forces(dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const dmb_linear *linear = s->linear;
    const dmb_condensation *J = &s->condensation;
    memset(J->solution, 0, 2 * (size_t)J->reduced * sizeof(double));
    for (uint32_t j = 0; j < J->rows; j++) {
        const dmb_complex_number Ax = dmb_dynamic_row_times(s, J->node[j], component(s, j), x);
        const dmb_complex_number Sp = row_of_moved(J, j);
        for (uint32_t i = linear->start[J->row[j]]; i < linear->start[J->row[j] + 1]; i++) {
            const uint32_t m = J->number[linear->column[i]];
            J->solution[m] += linear->value[i] * (J->force.re[j] - Ax.re - Sp.re);
            J->solution[J->reduced + m] += linear->value[i] * (J->force.im[j] - Ax.im - Sp.im);
        }
    }
}

void dmb_condensation_give(dmb_dynamic_stiffness *s, dmb_complex_array x)
{
    const dmb_linear *linear = s->linear;
    const dmb_condensation *J = &s->condensation;
    restrict_forces(s, x);
    dmb_dense_solve_vector(2 * J->reduced, J->dense, J->pivot, J->solution);
    for (uint32_t j = 0; j < J->rows; j++) {
        const dmb_complex_array z = row_of(J->inside, linear->rows, j);
        dmb_complex_number d = {J->moved.re[j], J->moved.im[j]};
        for (uint32_t i = linear->start[J->row[j]]; i < linear->start[J->row[j] + 1]; i++) {
            const uint32_t m = J->number[linear->column[i]];
            d.re += linear->value[i] * J->solution[m];
            d.im += linear->value[i] * J->solution[J->reduced + m];
        }
        for (uint32_t r = 0; r < linear->rows; r++) {
            x.re[r] -= z.re[r] * d.re - z.im[r] * d.im;
            x.im[r] -= z.re[r] * d.im + z.im[r] * d.re;
        }
        x.re[J->row[j]] += d.re;
        x.im[J->row[j]] += d.im;
    }
}
