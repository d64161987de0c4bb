/* Very flexible strings pulled round a bend in a narrow, stiff hole, by elements from one to ninety times the length
 * over which they bend: statics find them within 50 iterations, held against the polygon of their nodes. Its corners
 * turn by L/R, and without friction the tension is that of the last side, F cos(L/2R), so that the wall bears
 * |(F sin(L/R), w)| at each. Equations: eq:static.pull. */
#include <math.h>

#include "rig.h"

#define BEND 300.0 /* [m] */
#define LENGTH 100.0
#define MOST 50

typedef struct pulled {
    uint32_t pipes;
    double EI, clearance, stiffness, pull;
} pulled;

static dmb_id open_pulled(rig *s, const pulled *p)
{
    const double level = 0.5 * PI, survey[6] = {0.0, level, 0.0, LENGTH + 20.0, level, (LENGTH + 20.0) / BEND};
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    rig_open(s, 0.0, 0.0, -9.81);
    wall.survey = survey;
    wall.survey_count = 2;
    wall.diameter = pipe.outer_diameter + 2.0 * p->clearance;
    wall.stiffness = p->stiffness;
    (void)add_wall(s, &wall);
    string.start_free = DMB_FREE_NONE;
    pipe.string = add_string(s, &string);
    pipe.length = LENGTH / p->pipes;
    pipe.elements = 1;
    pipe.section_stiffness[4] = pipe.section_stiffness[5] = p->EI;
    (void)add_pipes(s, &pipe, p->pipes);
    load.frame = DMB_FRAME_HOLE;
    load.place = dmb_station(pipe.string, p->pipes - 1, 1.0);
    load.force[0] = p->pull;
    (void)add_load(s, &load);
    (void)rig_start(s, NULL);
    return pipe.string;
}

/* [N/m] */
static double weight_of_pipe(void)
{
    const dmb_pipe_def pipe = dmb_pipe_def_default();
    const double D = pipe.outer_diameter, d = pipe.inner_diameter;
    return 9.81 * pipe.density * 0.25 * PI * (D * D - d * d);
}

static void hold(const pulled *p)
{
    rig s;
    const dmb_id string = open_pulled(&s, p);
    const double L = LENGTH / p->pipes, along = sqrt(p->EI / p->pull);
    const dmb_static_report report = find_equilibrium(&s, NULL);
    print_message("    EI %g, clearance %g, wall %g, %g N, elements of %.3g m = %.1f sqrt(EI/T): %u iterations\n",
                  p->EI, p->clearance, p->stiffness, p->pull, L, L / along, report.iterations);
    assert_true(report.iterations <= MOST);
    assert_int_equal(report.negative, 0);
    const uint32_t middle = p->pipes / 2;
    dmb_contact c = dmb_contact_default();
    dmb_section section = dmb_section_default();
    must(&s, dmb_query_contact(s.sim, middle, &c));
    must(&s, dmb_query_section(s.sim, dmb_station(string, middle, 0.0), &section));
    const double across = weight_of_pipe() * L, inwards = p->pull * sin(L / BEND);
    /* with five elements their free end still bends the middle one */
    check_relative("force on the wall", c.normal_force, hypot(across, inwards), p->pipes < 10 ? 1e-2 : 1e-3);
    check_relative("tension", section.force[0], p->pull * cos(0.5 * L / BEND), 3e-4);
    rig_close(&s);
}

static void pulled_strings(void **state)
{
    const pulled all[] = {
        {5, 1e3, 50e-6, 1e9, 2e4},   {10, 1e3, 50e-6, 1e9, 2e4},  {20, 1e3, 50e-6, 1e9, 2e4},
        {30, 1e3, 50e-6, 1e9, 2e4},  {40, 1e3, 50e-6, 1e9, 2e4},  {60, 1e3, 50e-6, 1e9, 2e4},
        {80, 1e3, 50e-6, 1e9, 2e4},  {120, 1e3, 50e-6, 1e9, 2e4}, {480, 1e3, 50e-6, 1e9, 2e4},
        {10, 1e3, 500e-6, 1e9, 2e4}, {10, 1e3, 5e-6, 1e9, 2e4},   {10, 1e4, 50e-6, 1e7, 2e4},
        {10, 1e5, 10e-3, 1e8, 1e5},  {40, 1e4, 1e-3, 1e8, 1e5},
    };
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) hold(all + i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pulled_strings)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
