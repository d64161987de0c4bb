/* Events of a string that rattles in a curved hole: where a shorter step towards the crossing does not converge, as
 * when a contact closes shortly before it, the event is found all the same, for every level, restitution and law. */
#include <stdio.h>

#include "rig.h"

static const double depths[9] = {0.0, 1.5, 0.3, 4.0, 1.4, 0.3, 20.0, 1.3, 0.4};
static const double times[3] = {0.0, 0.02, 0.1}, speeds[3] = {0.5, 4.5, 8.5};

static void describe(rig *r, int32_t law, double restitution, double level)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_event_def event = dmb_event_def_default();
    dmb_segment table = dmb_segment_default();
    rig_open(r, 0.0, 0.0, -9.81);
    wall.survey_count = 3;
    wall.survey = depths;
    wall.normal_law = law;
    wall.restitution = restitution;
    add_wall(r, &wall);
    pipe.eccentricity = 1e-3;
    drive.part = add_pipes(r, &pipe, 5);
    drive.component = DMB_RX;
    drive.kind = DMB_DRIVE_CONTROL;
    drive.gain = 300.0;
    table.kind = DMB_SEGMENT_TABLE;
    table.table_count = 3;
    table.table_time = times;
    table.table_value = speeds;
    drive.time_function = add_time_function(r, &table, 1);
    add_drive(r, &drive);
    event.name[0] = 'f';
    event.output.quantity = DMB_OUTPUT_BIT_SPEED;
    event.level = level;
    must_model(r, dmb_model_add_event(r->model, &event, NULL));
    rig_start(r, NULL);
}

/* [rad/s] of the bit. */
static double bit_speed(const rig *r)
{
    dmb_output output = {.quantity = DMB_OUTPUT_BIT_SPEED};
    double speed = 0.0;
    must(r, dmb_query_output(r->sim, &output, &speed));
    return speed;
}

static int crossings(int32_t law, double restitution, double level)
{
    rig r;
    int found = 0;
    describe(&r, law, restitution, level);
    for (int32_t status = DMB_NOTE_EVENT; status == DMB_NOTE_EVENT;) {
        dmb_event_report report = dmb_event_report_default();
        status = dmb_sim_advance_to_event(r.sim, 0.05, &report, NULL);
        if (status < 0) fail_msg("law %d, restitution %g: %s", (int)law, restitution, dmb_sim_message(r.sim));
        if (status != DMB_NOTE_EVENT) break;
        found++;
        assert_true(report.located <= 1e-9);
        assert_true(bit_speed(&r) >= level);
        assert_true(bit_speed(&r) < level + 1e-4);
    }
    assert_true(dmb_sim_time(r.sim) == 0.05);
    rig_close(&r);
    return found;
}

static void events_of_a_rattling_string(void **state)
{
    (void)state;
    int found = 0;
    for (int e = 2; e < 9; e += 2)
        for (int level = 3; level < 7; level++) {
            found += crossings(DMB_NORMAL_EXACT, 0.1 * e, level);
            found += crossings(DMB_NORMAL_HUNT_CROSSLEY, 0.1 * e, level);
        }
    printf("    %d events located\n", found);
    assert_true(found >= 32);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(events_of_a_rattling_string)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
