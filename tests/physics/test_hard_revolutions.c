/* Hard case 5 on the wall: 300 s at 200 rpm, 1000 revolutions, of pipes that lie in their hole and rub on it.
 * Rotations stay orthonormal to 1e-14, angles are counted exactly, and nothing depends on the number of turns. Checks
 * eq:kinematics.relative-pose. */
#include "rig.h"

enum { PIPES = 8, STEPS_A_TURN = 60, MEAN_TURNS = 20 };
static const double speed = 200.0 / 60.0 * 2.0 * PI;

static double off_orthonormal(const double R[9])
{
    double most = 0.0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            most = fmax(most, fabs(R[i] * R[k] + R[3 + i] * R[3 + k] + R[6 + i] * R[6 + k] - (i == k)));
    return most;
}

/* Turned at the rig end, with 200 rpm from the start. Mud ends the rocking from side to side that friction keeps up. */
static dmb_id open_string(rig *s, dmb_id *drive)
{
    dmb_wall_def wall = s1_hole();
    dmb_pipe_def pipe = s1_pipe();
    dmb_string_def string = dmb_string_def_default();
    dmb_environment_def environment = dmb_environment_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    rig_open(s, 0.0, 0.0, -9.81);
    environment.lateral_damping = 100.0;
    must_model(s, dmb_model_set_environment(s->model, &environment));
    (void)add_wall(s, &wall);
    string.start_free = DMB_FREE_RX;
    string.velocity[3] = speed;
    pipe.damping_time = 1e-3;
    pipe.string = add_string(s, &string);
    (void)add_pipes(s, &pipe, PIPES);
    *drive = add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, add_constant(s, speed));
    options.newton_tolerance = 1e-12;
    (void)rig_start(s, &options);
    (void)find_equilibrium(s, NULL);
    return pipe.string;
}

/* A step may be divided: at the start friction sets in at once. */
static void turn(const rig *s, uint32_t turns)
{
    for (uint32_t i = 0; i < turns * STEPS_A_TURN; i++) must(s, dmb_sim_step(s->sim, 0.3 / STEPS_A_TURN, NULL));
}

/* Mean torque and wall force over MEAN_TURNS revolutions. */
static void mean_of(const rig *s, dmb_id drive, double mean[2])
{
    mean[0] = mean[1] = 0.0;
    for (int i = 0; i < MEAN_TURNS * STEPS_A_TURN; i++) {
        dmb_drive_state state = dmb_drive_state_default();
        must(s, dmb_sim_step(s->sim, 0.3 / STEPS_A_TURN, NULL));
        must(s, dmb_query_drive(s->sim, drive, &state));
        mean[0] += state.force / (MEAN_TURNS * STEPS_A_TURN);
        mean[1] += contacts_of(s).normal_force / (MEAN_TURNS * STEPS_A_TURN);
    }
}

static void thousand_revolutions_on_the_wall(void **state)
{
    rig s;
    dmb_id drive;
    double early[2], late[2], worst = 0.0;
    (void)state;
    const dmb_id string = open_string(&s, &drive);
    turn(&s, 100 - MEAN_TURNS);
    mean_of(&s, drive, early);
    turn(&s, 900 - MEAN_TURNS);
    mean_of(&s, drive, late);
    for (uint32_t i = 0; i < PIPES; i++)
        worst = fmax(worst, off_orthonormal(pose_at(&s, dmb_station(string, i, 1.0)).rotation));
    print_message("rejected %llu of %llu steps\n", (unsigned long long)statistics_of(&s).rejected,
                  (unsigned long long)statistics_of(&s).steps);
    print_message("torque %.6f N m, wall force %.4f N, twist %.3e rad\n", late[0], late[1],
                  rotation_at(&s, dmb_station(string, 0, 0.0)) - rotation_at(&s, dmb_station(string, PIPES - 1, 1.0)));
    check_relative("rig end turned by 1000 revolutions", rotation_at(&s, dmb_station(string, 0, 0.0)), 2000.0 * PI,
                   1e-12);
    check_close("far end with it [rad]", rotation_at(&s, dmb_station(string, PIPES - 1, 1.0)), 2000.0 * PI, 1e-2);
    check_relative("mean torque after 1000 revolutions over that after 100", late[0], early[0], 1e-6);
    check_relative("mean wall force likewise", late[1], early[1], 1e-6);
    check_below("rotations off orthonormal", worst, 1e-14);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(thousand_revolutions_on_the_wall)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
