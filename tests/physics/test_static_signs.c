/* Negative eigenvalues that a static state reports, against a dense eigenvalue count of the library's own stiffness,
 * and against closed forms on fine meshes: a deep strip loaded across (lateral buckling) and Euler's column. Equations:
 * eq:signs.amount, eq:signs.bounds. */
#include "dense_signs.h"

typedef struct scene {
    rig s;
    dmb_id string;
    uint32_t pipes;
} scene;

/* One straight string, clamped at its rig end, of `pipes` pipes of `elements` elements each, loaded at its far end. */
static void open_string(scene *c, uint32_t pipes, const dmb_pipe_def *of, const double force[3])
{
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = *of;
    dmb_load_def load = dmb_load_def_default();
    rig_open(&c->s, 0.0, 0.0, 0.0);
    def.follows_hole = 0;
    def.start_free = DMB_FREE_NONE;
    pipe.string = c->string = add_string(&c->s, &def);
    pipe.length = of->length / pipes;
    (void)add_pipes(&c->s, &pipe, pipes);
    c->pipes = pipes;
    load.place = dmb_station(c->string, pipes - 1, 1.0);
    for (int i = 0; i < 3; i++) load.force[i] = force[i];
    (void)add_load(&c->s, &load);
    (void)rig_start(&c->s, NULL);
}

static dmb_static_report report_of(const scene *c, int32_t *status)
{
    dmb_static_report report = dmb_static_report_default();
    *status = dmb_analysis_static(c->s.sim, NULL, &report);
    must(&c->s, *status);
    return report;
}

/* Never 0 with status 0 where the count does not hold. */
static void check_status(const dmb_static_report *report, int32_t status)
{
    const int32_t wanted = report->negative > 0    ? DMB_NOTE_UNSTABLE
                           : report->negative == 0 ? DMB_OK
                                                   : DMB_NOTE_INCOMPLETE;
    assert_int_equal(status, wanted);
    assert_true(report->negative != 0 || report->unresolved == 0);
}

/* ---- Dense eigenvalues ------------------------------------------------------------------------------------------- */

#define TEN_EPS 2.220446049250313e-15

static dmb_pipe_def strip_pipe(uint32_t elements, double GJ, double EI)
{
    dmb_pipe_def pipe = beam_pipe(2.0, elements, 1e9, 1e9, GJ, EI);
    pipe.section_stiffness[5] = 1e5 * EI;
    return pipe;
}

/* Prandtl's load of a cantilever that is loaded across at its end, 4.0126 sqrt(EI GJ)/L^2. */
static double strip_load(double GJ, double EI)
{
    return 4.0126 * sqrt(EI * GJ) / 4.0;
}

static void counts_agree_with_dense_ones(void **state)
{
    (void)state;
    static const uint32_t meshes[] = {8, 16, 32, 64, 128, 8, 16, 32, 64, 24, 48, 96, 10, 20, 40, 12, 80};
    uint64_t seed = 29;
    uint32_t compared = 0, unstable = 0;
    for (uint32_t k = 0; k < sizeof meshes / sizeof meshes[0]; k++) {
        scene c;
        int32_t status;
        const double GJ = draw_between(&seed, 10.0, 200.0), EI = draw_between(&seed, 10.0, 200.0);
        const double part = draw_between(&seed, 0.3, 6.0), along = draw_between(&seed, -1.0, 1.0);
        const dmb_pipe_def pipe = strip_pipe(meshes[k], GJ, EI);
        const double force[3] = {along * EI, part * strip_load(GJ, EI), 0.0};
        open_string(&c, 1, &pipe, force);
        const dmb_static_report report = report_of(&c, &status);
        const dense_signs wanted = dense_signs_of(&c.s, TEN_EPS);
        check_status(&report, status);
        assert_int_equal(wanted.between, 0);
        assert_int_equal(report.negative, wanted.negative);
        assert_int_equal(report.unresolved, 0);
        compared++;
        unstable += wanted.negative > 0;
        rig_close(&c.s);
    }
    print_message("    %u of %u states are unstable\n", unstable, compared);
    assert_true(unstable > 4 && unstable < compared);
}

/* ---- Fine meshes ------------------------------------------------------------------------------------------------- */

static void strip_on_fine_meshes(void **state)
{
    (void)state;
    static const uint32_t meshes[] = {32, 128, 512, 1024};
    for (uint32_t k = 0; k < 4; k++)
        for (int above = 0; above < 2; above++) {
            scene c;
            int32_t status;
            const dmb_pipe_def pipe = strip_pipe(meshes[k], 60.0, 100.0);
            const double force[3] = {0.0, (above ? 1.5 : 0.95) * strip_load(60.0, 100.0), 0.0};
            open_string(&c, 1, &pipe, force);
            const dmb_static_report report = report_of(&c, &status);
            check_status(&report, status);
            assert_int_equal(report.negative, above);
            rig_close(&c.s);
        }
}

/* A bifurcation of the path, and buckling, on fine meshes. */
static void strip_path_on_fine_meshes(void **state)
{
    (void)state;
    static const uint32_t meshes[] = {128, 512};
    for (uint32_t k = 0; k < 2; k++) {
        scene c;
        int32_t status;
        const double small = 1e-3 * strip_load(60.0, 100.0), force[3] = {0.0, small, 0.0};
        const dmb_pipe_def pipe = strip_pipe(meshes[k], 60.0, 100.0);
        dmb_path_options options = dmb_path_options_default();
        dmb_path_report path = dmb_path_report_default();
        dmb_buckling *buckling = NULL;
        double factor = 0.0;
        open_string(&c, 1, &pipe, force);
        (void)report_of(&c, &status);
        options.factor_end = 1500.0;
        must(&c.s, dmb_analysis_path(c.s.sim, &options, &path));
        must(&c.s, dmb_analysis_buckling(c.s.sim, NULL, &buckling));
        must(&c.s, dmb_buckling_factor(buckling, 0, &factor));
        print_message("    %u elements: path %.6f, buckling %.6f\n", meshes[k], path.first_bifurcation, factor);
        check_relative("    bifurcation of the path", path.first_bifurcation + 1.0, 1000.0, 2e-4);
        check_relative("    buckling", factor + 1.0, 1000.0, 2e-4);
        dmb_buckling_destroy(&buckling);
        rig_close(&c.s);
    }
}

/* 100 m of tube in 1000 and 4096 elements; of the finest the count may be open, and is never 0 with status 0. */
static void column_on_fine_meshes(void **state)
{
    (void)state;
    const double I = PI / 64.0 * (pow(0.1, 4) - pow(0.08, 4)), euler = PI * PI * 2e11 * I / 4e4;
    static const uint32_t pipes[] = {1, 2, 4};
    static const double part[] = {0.98, 1.02, 1.5};
    for (uint32_t k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            scene c;
            int32_t status;
            dmb_pipe_def pipe = dmb_pipe_def_default();
            const double force[3] = {-part[i] * euler, 0.0, 0.0};
            pipe.length = 100.0;
            pipe.elements = k == 0 ? 1000 : 1024;
            pipe.outer_diameter = 0.1;
            pipe.inner_diameter = 0.08;
            pipe.young_modulus = 2e11;
            open_string(&c, pipes[k], &pipe, force);
            const dmb_static_report report = report_of(&c, &status);
            print_message("    %u elements at %.2f of Euler's load: %d negative, %d unresolved, bound %.2g N/m\n",
                          pipes[k] * pipe.elements, part[i], report.negative, report.unresolved, report.resolution);
            check_status(&report, status);
            if (k == 0 || report.negative >= 0) assert_int_equal(report.negative, i == 0 ? 0 : 2);
            rig_close(&c.s);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_agree_with_dense_ones),
        cmocka_unit_test(strip_on_fine_meshes),
        cmocka_unit_test(strip_path_on_fine_meshes),
        cmocka_unit_test(column_on_fine_meshes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
