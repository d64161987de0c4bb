/* The modes of a string against its own matrices: orthonormal, complete by the Sturm count of K - s M, and sharp.
 * Equations: eq:modes.undamped, eq:modes.damped. */
#include <string.h>

#include "modal.h"

#include "analysis/modes/modes.h"
#include "math/inertia.h"

enum { ROWS_MAX = 1300 };

/* A string of 200 pipes with tool joints that lies in its hole, free to slide and turn, so that preload, wall and the
 * pendulum in the hole are all there. */
static void open_string(rig *s, int32_t start_free)
{
    dmb_pipe_def pipe = s1_pipe();
    dmb_wall_def wall = s1_hole();
    dmb_string_def string = dmb_string_def_default();
    wall.friction_law = DMB_FRICTION_NONE;
    rig_open(s, 0, 0, -9.81);
    add_wall(s, &wall);
    string.start_free = start_free;
    pipe.string = add_string(s, &string);
    pipe.joint_length = 0.1;
    pipe.joint_outer_diameter = 0.085;
    (void)add_pipes(s, &pipe, 200);
    rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
}

static double product(const dmb_linear *linear, const dmb_linear_matrix *A, const double *x, const double *y)
{
    static double Ay[ROWS_MAX];
    double sum = 0.0;
    dmb_linear_multiply(linear, A, y, Ay);
    for (uint32_t i = 0; i < linear->rows; i++) sum += x[i] * Ay[i];
    return sum;
}

/* Eigenvalues of K d = square M d below `square`, by the signs of the factors of K - square M. */
static uint32_t count_below(const dmb_linear *linear, double square)
{
    const dmb_block_layout *layout = &linear->scene.layout;
    static double diagonal[36 * 210], lower[36 * 210], upper[36 * 210];
    for (uint32_t i = 0; i < layout->diag[layout->n]; i++)
        diagonal[i] = linear->stiffness.diagonal[i] - square * linear->mass.diagonal[i];
    for (uint32_t i = 0; i < layout->link[layout->n - 1]; i++) {
        lower[i] = linear->stiffness.lower[i] - square * linear->mass.lower[i];
        upper[i] = linear->stiffness.upper[i] - square * linear->mass.upper[i];
    }
    for (uint32_t i = 0; i < linear->scene.constrained_count; i++) {
        const uint32_t node = linear->scene.constrained_node[i];
        diagonal[layout->diag[node] + (layout->size[node] + 1) * linear->scene.constrained_component[i]] = 1.0;
    }
    return dmb_block_negative(layout, diagonal, lower, upper, NULL, 0, layout->n);
}

static dmb_linear *linearise(const dmb_sim *sim)
{
    const dmb_linear_options as_it_is = {.contact = DMB_CONTACT_AS_IS};
    dmb_linear *linear = NULL;
    assert_int_equal(dmb_linear_make(sim, &as_it_is, &linear), DMB_OK);
    return linear;
}

static void modes_are_orthonormal(void **state)
{
    (void)state;
    rig s;
    open_string(&s, DMB_FREE_CYLINDRICAL);
    dmb_linear *linear = linearise(s.sim);
    assert_true(linear->rows <= ROWS_MAX);
    dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 30);
    assert_int_equal(info_of(modes).dense, 0);
    assert_int_equal(info_of(modes).rigid, 2); /* along, and each section about its own axis, since the string sags */
    tell("asymmetry of K", info_of(modes).asymmetry);
    double mass = 0.0, stiffness = 0.0;
    for (uint32_t i = 0; i < 30; i++)
        for (uint32_t j = 0; j <= i; j++) {
            const double *x = modes->re + (size_t)modes->rows * i, *y = modes->re + (size_t)modes->rows * j;
            const double si = modes->s[2 * i + 1], sj = modes->s[2 * j + 1];
            mass = fmax(mass, fabs(product(linear, &linear->mass, x, y) - (i == j)));
            stiffness = fmax(stiffness, fabs(product(linear, &linear->stiffness, x, y) - (i == j ? si * si : 0.0)) /
                                            fmax(si * sj, 1.0));
        }
    check_below("X^T M X against I", mass, 1e-10);
    check_below("X^T K X against w^2", stiffness, 1e-8);
    check_below("largest residual", info_of(modes).residual, 1e-11);
    dmb_modes_destroy(&modes);
    dmb_linear_release(&linear);
    rig_close(&s);
}

/* As many modes below a frequency, and in a band, as the Sturm count says. */
static void sturm_counts_agree(void **state)
{
    (void)state;
    static const int32_t masks[] = {DMB_FREE_NONE, DMB_FREE_CYLINDRICAL};
    for (size_t i = 0; i < 2; i++) {
        rig s;
        open_string(&s, masks[i]);
        dmb_linear *linear = linearise(s.sim);
        dmb_modes *modes = lowest_modes(&s, DMB_MODES_UNDAMPED, 60);
        for (uint32_t k = 5; k < 59; k++) {
            const double a = modes->s[2 * k + 1], b = modes->s[2 * k + 3];
            if (b - a < 1e-6 * b) continue;
            assert_int_equal(count_below(linear, 0.25 * (a + b) * (a + b)), k + 1);
        }
        dmb_modes_destroy(&modes);
        for (int band = 0; band < 3; band++) {
            static const double edge[4] = {3.0, 8.0, 20.0, 29.0};
            const double low = 2.0 * PI * edge[band], high = 2.0 * PI * edge[band + 1];
            const uint32_t want = count_below(linear, high * high) - count_below(linear, low * low);
            modes = modes_in_band(&s, DMB_MODES_UNDAMPED, edge[band], edge[band + 1]);
            print_message("    %g .. %g Hz: %u modes\n", edge[band], edge[band + 1], want);
            assert_int_equal(info_of(modes).dense, 0);
            assert_int_equal(info_of(modes).count, want);
            dmb_modes_destroy(&modes);
        }
        dmb_linear_release(&linear);
        rig_close(&s);
    }
}

/* An eigenproblem of more rows than LAPACK can count is refused before any memory is asked for; few modes are not. */
static void too_many_coordinates_are_refused(void **state)
{
    (void)state;
    static const struct {
        uint32_t pipes;
        int32_t kind;
    } scenes[2] = {{5470, DMB_MODES_UNDAMPED}, {2740, DMB_MODES_DAMPED}};
    for (int i = 0; i < 2; i++) {
        rig s;
        const dmb_pipe_def pipe = s1_pipe();
        dmb_modes_options options = dmb_modes_options_default();
        (void)lay_string(&s, &pipe, scenes[i].pipes, DMB_FREE_NONE, DMB_FREE_ALL);
        rig_start(&s, NULL);
        options.kind = scenes[i].kind;
        options.select = DMB_MODES_ALL;
        const modes_refusal refusal = refused_modes(&s, &options);
        assert_int_equal(refusal.status, DMB_ERR_TOO_LARGE);
        assert_non_null(strstr(refusal.text, "32766"));
        options.select = DMB_MODES_LOWEST;
        options.count = 1;
        dmb_modes *modes = find_modes(&s, &options);
        assert_int_equal(info_of(modes).dense, 0);
        dmb_modes_destroy(&modes);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(modes_are_orthonormal),
        cmocka_unit_test(sturm_counts_agree),
        cmocka_unit_test(too_many_coordinates_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
