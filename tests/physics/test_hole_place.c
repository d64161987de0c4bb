/* Places of parts along a hole that turns back or crosses itself: gaps, measured depths, advances of bits, frames of
 * loads, after motion, state transfers and subs too. Equations: eq:hole.foot. */
#include <string.h>

#include "random_hole.h"
#include "rig.h"

#define HOLE 0.1
#define PIPE 0.073
#define GAP (0.5 * (HOLE - PIPE))

static random_hole shape;

static void open_in(rig *s, double g)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = HOLE;
    wall.survey = shape.survey[0];
    wall.survey_count = shape.stations;
    rig_open(s, 0.0, 0.0, -g);
    (void)add_wall(s, &wall);
}

static dmb_pipe_def pipe_of(dmb_id string, uint32_t elements)
{
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.string = string;
    pipe.length = 9.0;
    pipe.elements = elements;
    pipe.outer_diameter = PIPE;
    pipe.inner_diameter = 0.061;
    return pipe;
}

/* A U of 180 deg in the vertical plane and the level plane, and a loop that crosses itself. */
static void make_turn(double total, double rate, int level)
{
    const double deg = PI / 180.0;
    double depth = 50.0, angle = 0.0;
    shape.stations = 0;
    for (int i = 0; i < 2; i++) {
        double *row = shape.survey[shape.stations++];
        row[0] = 50.0 * i;
        row[1] = level ? 90.0 * deg : 0.0;
        row[2] = 0.0;
    }
    while (angle < total - 1e-9) {
        double *row = shape.survey[shape.stations++];
        angle = fmin(total, angle + rate / 3.0);
        row[0] = depth += 10.0;
        row[1] = level ? 90.0 * deg : angle * deg;
        row[2] = level ? fmod(angle, 360.0) * deg : 0.0;
    }
    double *row = shape.survey[shape.stations++];
    row[0] = depth + 150.0;
    row[1] = row[-2];
    row[2] = row[-1];
}

static double end_depth(void)
{
    return shape.survey[shape.stations - 1][0];
}

static dmb_contact contact_at(const rig *s, uint32_t site)
{
    dmb_contact contact = dmb_contact_default();
    must(s, dmb_query_contact(s->sim, site, &contact));
    return contact;
}

static uint32_t sites_of(const rig *s)
{
    dmb_model_info info = dmb_model_info_default();
    must_model(s, dmb_model_get_info(s->model, &info));
    return info.contact_points;
}

/* Largest deviation of any gap from what is described. */
static double worst_gap(const rig *s, double clearance)
{
    double worst = 0.0;
    for (uint32_t i = 0; i < sites_of(s); i++) worst = fmax(worst, fabs(contact_at(s, i).gap - clearance));
    return worst;
}

/* ---- Bits and loads ---------------------------------------------------------------------------------------------- */

static dmb_id add_moving_string(rig *s, double start, uint32_t pipes, double speed)
{
    dmb_string_def string = dmb_string_def_default();
    string.start_depth = start;
    string.start_free = DMB_FREE_CYLINDRICAL;
    const dmb_id id = add_string(s, &string);
    const dmb_pipe_def pipe = pipe_of(id, 1);
    (void)add_pipes(s, &pipe, pipes);
    const dmb_id push = add_constant(s, speed);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, id, DMB_X, push);
    (void)add_simple_drive(s, DMB_DRIVE_MOTION, id, DMB_RX, add_constant(s, 0.0));
    return id;
}

/* A string that is pushed 4 m through a U of 15 deg per 30 m: the bit advances by as much along the hole, within the
 * play of the string, and every place is found within it. */
static void bit_advances_along_the_hole(void **state)
{
    (void)state;
    for (int level = 0; level < 2; level++) {
        dmb_bit_def bit = dmb_bit_def_default();
        dmb_bit_state now = dmb_bit_state_default();
        double worst = 0.0;
        rig s;
        make_turn(180.0, 15.0, level);
        open_in(&s, 0.0);
        const uint32_t pipes = (uint32_t)((end_depth() - 40.0) / 9.0);
        const dmb_id string = add_moving_string(&s, 0.0, pipes, 1.0);
        bit.string = string;
        bit.mass = 20.0;
        bit.diameter = 0.09;
        dmb_id id;
        must_model(&s, dmb_model_add_bit(s.model, &bit, &id));
        (void)rig_start(&s, NULL);
        check_below("deviation of gaps at time 0 [m]", worst_gap(&s, GAP) - (GAP - 0.5 * (HOLE - 0.09)), 1e-9);
        take_divided_steps(&s, 0.04, 100);
        must(&s, dmb_query_bit(s.sim, id, &now));
        check_close("advance of the bit [m]", now.advance, 4.0, 0.3);
        for (uint32_t k = 0; k < pipes; k += 3) {
            const dmb_pose pose = pose_at(&s, dmb_station(string, k, 0.4));
            worst = fmax(worst, fabs(pose.depth - 9.0 * (k + 0.4) - 4.0));
        }
        check_below("measured depth of a section, play taken up [m]", worst, 0.3);
        rig_close(&s);
    }
}

/* A force along the hole's frame at the far end of a turn is along its tangent there. */
static void loads_in_the_frame_of_the_hole(void **state)
{
    const double want[2] = {100.0, 40.0};
    (void)state;
    make_turn(300.0, 15.0, 1);
    for (int contact = 0; contact < 2; contact++) {
        dmb_load_def load = dmb_load_def_default();
        dmb_string_def string = dmb_string_def_default();
        dmb_hole_point at = dmb_hole_point_default();
        dmb_compile_options options = dmb_compile_options_default();
        rig s;
        open_in(&s, 0.0);
        string.start_free = DMB_FREE_NONE;
        const dmb_id id = add_string(&s, &string);
        const dmb_pipe_def pipe = pipe_of(id, 1);
        const uint32_t pipes = (uint32_t)(end_depth() / 9.0);
        (void)add_pipes(&s, &pipe, pipes);
        load.place = dmb_station(id, pipes - 1, 1.0);
        load.frame = DMB_FRAME_HOLE;
        load.force[0] = want[0];
        load.force[2] = want[1];
        (void)add_load(&s, &load);
        if (!contact) options.features = DMB_FEATURE_ALL & ~DMB_FEATURE_CONTACT;
        (void)rig_start_with(&s, &options, NULL);
        must_model(&s, dmb_query_hole(s.model, 9.0 * pipes, &at));
        const dmb_motion motion = motion_at(&s, load.place, DMB_FRAME_WORLD);
        double along = 0.0;
        for (int i = 0; i < 3; i++) along += at.tangent[i] * motion.acceleration[i];
        if (!(along > 0.0)) fail_msg("the load pushes the end back, acceleration %g m/s2", along);
        check_relative("direction of the load", motion.acceleration[2] / along > 0.0 ? 1.0 : 0.0, 1.0, 0.0);
        rig_close(&s);
    }
}

/* ---- Subs, state transfers --------------------------------------------------------------------------------------- */

/* Sections and the body between them stand on the axis behind a turn of 270 deg; the loop of 360 deg and more crosses
 * its own beginning. */
static void sections_behind_a_sub(void **state)
{
    const double turns[] = {180.0, 270.0, 400.0};
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        dmb_string_def string = dmb_string_def_default();
        dmb_body_def body = dmb_body_def_default();
        dmb_sub_def def = dmb_sub_def_default();
        dmb_sub sub = dmb_sub_default();
        rig s;
        make_turn(turns[i], 15.0, 1);
        open_in(&s, 9.81);
        string.start_free = DMB_FREE_NONE;
        const dmb_id id = add_string(&s, &string);
        dmb_pipe_def pipe = pipe_of(id, 2);
        const uint32_t pipes = (uint32_t)((end_depth() - 60.0) / 9.0);
        (void)add_pipes(&s, &pipe, pipes);
        body.mass = 100.0;
        for (int k = 0; k < 3; k++) body.inertia[k] = 1.0;
        body.contact_diameter = PIPE;
        body.contact_length = 0.5;
        def.string = id;
        def.length = 1.0;
        def.body = &body;
        must_model(&s, dmb_model_add_sub(s.model, &def, &sub));
        pipe.string = sub.section;
        (void)add_pipes(&s, &pipe, 4);
        (void)rig_start(&s, NULL);
        check_below("deviation of gaps [m]", worst_gap(&s, GAP), 1e-9);
        check_close("measured depth of the body [m]", pose_at(&s, dmb_station(sub.body, 0, 0.0)).depth, 9.0 * pipes,
                    1e-6);
        check_close("measured depth behind the sub [m]", pose_at(&s, dmb_station(sub.section, 3, 1.0)).depth,
                    9.0 * pipes + 1.0 + 36.0, 1e-6);
        rig_close(&s);
    }
}

/* A string pushed on by two pipes (one in the level turn) goes on with as many pipes more, of which none has a place
 * from before. */
static void pipes_added_in_a_turn(void **state)
{
    (void)state;
    for (int level = 0; level < 2; level++) {
        rig before, after;
        double worst = 0.0;
        make_turn(180.0, 15.0, level);
        open_in(&before, 0.0);
        const uint32_t pipes = (uint32_t)((end_depth() - 40.0) / 9.0), more = level ? 1 : 2;
        (void)add_moving_string(&before, 0.0, pipes, 2.0);
        (void)rig_start(&before, NULL);
        take_divided_steps(&before, 0.045, 100 * more);
        open_in(&after, 0.0);
        const dmb_id longer = add_moving_string(&after, 0.0, pipes + more, 2.0);
        (void)rig_start(&after, NULL);
        must(&after, dmb_sim_transfer_state(after.sim, before.sim));
        for (uint32_t i = 0; i < sites_of(&after); i++)
            if (!(fabs(contact_at(&after, i).gap) < 2.0 * GAP))
                fail_msg("site %u: gap %g", i, contact_at(&after, i).gap);
        for (uint32_t k = 0; k < pipes + more; k++)
            worst = fmax(worst, fabs(pose_at(&after, dmb_station(longer, k, 0.5)).depth - 9.0 * (k + 0.5)));
        check_below("measured depth of a pipe, play taken up [m]", worst, 0.3);
        take_divided_steps(&after, 0.02, 20);
        rig_close(&after);
        rig_close(&before);
    }
}

/* A well that starts 20 deg off the vertical one way and builds to horizontal the other way, as public surveys do. */
static void a_nudged_well_comes_to_rest(void **state)
{
    const double deg = PI / 180.0;
    const double survey[4][3] = {{0.0, 20.0 * deg, 0.0},
                                 {100.0, 20.0 * deg, 0.0},
                                 {320.0, 90.0 * deg, 180.0 * deg},
                                 {1020.0, 90.0 * deg, 180.0 * deg}};
    rig s;
    (void)state;
    shape.stations = 4;
    memcpy(shape.survey, survey, sizeof survey);
    open_in(&s, 9.81);
    (void)add_moving_string(&s, 0.0, 110, 0.0);
    (void)rig_start(&s, NULL);
    check_below("deviation of gaps [m]", worst_gap(&s, GAP), 1e-9);
    check_below("energy in the wall [J]", energy_of(&s).contact, 1e-12);
    const dmb_static_report report = find_equilibrium(&s, NULL);
    check_below("equilibrium: deepest in the wall [m]", contacts_of(&s).deepest, 0.1 * GAP);
    check_below("equilibrium: negative eigenvalues", report.negative, 0.0);
    rig_close(&s);
}

/* ---- Axial-torsional pipes --------------------------------------------------------------------------------------- */

/* Through the vertical, from one azimuth to the opposite one. */
static void make_drop(double from)
{
    const double deg = PI / 180.0;
    double depth = 50.0;
    shape.stations = 0;
    for (double angle = from, at = 0.0; angle > -from - 0.5; angle -= at > 0.0 ? 1.0 : 0.0) {
        double *row = shape.survey[shape.stations++];
        row[0] = at;
        row[1] = fabs(angle) * deg;
        row[2] = angle < 0.0 ? PI : 0.0;
        at = depth;
        depth += 10.0;
    }
}

/* They stand on the axis everywhere, and neither they nor flexible pipes between them are twisted where the horizontal
 * across the hole turns over. A spatial hole turns that horizontal, too. */
static void bars_pass_the_vertical(void **state)
{
    (void)state;
    for (int i = 0; i < 6; i++) {
        const int mixed = i % 2;
        dmb_string_def string = dmb_string_def_default();
        double off = 0.0, turned = 0.0, before[9] = {0.0};
        rig s;
        if (i < 4)
            make_drop(i < 2 ? 10.0 : 7.5);
        else
            random_hole_draw(2026, 3, &shape);
        open_in(&s, 0.0);
        const dmb_id id = add_string(&s, &string);
        dmb_pipe_def pipe = pipe_of(id, 1);
        const uint32_t pipes = (uint32_t)(end_depth() / 9.0);
        for (uint32_t k = 0; k < pipes; k++) {
            pipe.kind = mixed && (k / 4) % 2 ? DMB_PIPE_FLEXIBLE : DMB_PIPE_AXIAL_TORSIONAL;
            (void)add_pipes(&s, &pipe, 1);
        }
        (void)add_simple_drive(&s, DMB_DRIVE_MOTION, id, DMB_X, add_constant(&s, 1.0));
        (void)add_simple_drive(&s, DMB_DRIVE_MOTION, id, DMB_RX, add_constant(&s, 0.0));
        (void)rig_start(&s, NULL);
        for (int round = 0; round < (mixed ? 1 : 2); round++) {
            for (uint32_t k = 0; k < pipes; k++)
                for (int q = 0; q < 4; q++) {
                    dmb_hole_point at = dmb_hole_point_default();
                    double trace = 0.0;
                    const dmb_pose pose = pose_at(&s, dmb_station(id, k, q / 4.0));
                    must_model(&s, dmb_query_hole(s.model, pose.depth, &at));
                    if (!mixed) off = fmax(off, largest_difference(3, pose.position, at.position));
                    for (int n = 0; n < 9; n++) trace += pose.rotation[n] * before[n];
                    if (k + (uint32_t)q > 0) turned = fmax(turned, acos(fmin(1.0, 0.5 * (trace - 1.0))));
                    memcpy(before, pose.rotation, sizeof before);
                }
            if (!mixed) take_divided_steps(&s, 0.1, 10);
        }
        if (!mixed) check_below("off the axis [m]", off, 1e-9);
        check_below("turned from section to section [rad]", turned, 0.025);
        rig_close(&s);
    }
}

/* ---- What does not follow the hole ------------------------------------------------------------------------------- */

/* A rod on the axis of a straight piece behind a loop, where the beginning of the hole passes it closely. */
static void a_rod_of_its_own_is_found_over_its_length(void **state)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_hole_point at = dmb_hole_point_default();
    double depth = 0.0, apart = 1e9;
    rig s;
    (void)state;
    make_turn(400.0, 15.0, 1);
    open_in(&s, 0.0);
    const dmb_id all = add_string(&s, &string);
    const dmb_pipe_def pipe = pipe_of(all, 1);
    (void)add_pipes(&s, &pipe, 1);
    (void)rig_start(&s, NULL);
    /* the place of the last straight piece that is nearest to the first one */
    for (int i = 0; i < 1000; i++) {
        const double here = end_depth() - 140.0 + 0.1 * i;
        must_model(&s, dmb_query_hole(s.model, here, &at));
        if (fabs(at.position[1]) < apart) apart = fabs(at.position[1]), depth = here;
    }
    must_model(&s, dmb_query_hole(s.model, depth, &at));
    rig_close(&s);
    open_in(&s, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_NONE;
    memcpy(string.position, at.position, sizeof at.position);
    string.rotation[2] = atan2(at.tangent[1], at.tangent[0]);
    const dmb_id rod = add_string(&s, &string);
    const dmb_pipe_def rods = pipe_of(rod, 1);
    (void)add_pipes(&s, &rods, 3);
    (void)rig_start(&s, NULL);
    check_below("deviation of gaps [m]", worst_gap(&s, GAP), 1e-9);
    check_close("measured depth [m]", pose_at(&s, dmb_station(rod, 2, 1.0)).depth, depth + 27.0, 1e-6);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bit_advances_along_the_hole),
        cmocka_unit_test(loads_in_the_frame_of_the_hole),
        cmocka_unit_test(sections_behind_a_sub),
        cmocka_unit_test(pipes_added_in_a_turn),
        cmocka_unit_test(a_nudged_well_comes_to_rest),
        cmocka_unit_test(bars_pass_the_vertical),
        cmocka_unit_test(a_rod_of_its_own_is_found_over_its_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
