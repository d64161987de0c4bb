/* How does a hole grow rod by rod?
 *
 * A rig holds only so much feed: it drills one rod's length, stops, lets go of the string, puts a rod in between and
 * drills on. Every number of rods is a model of its own, described by one function; dmb_sim_transfer_state takes the
 * state from one to the next: shape and speed of the string, cut rock, contacts, drives, time and energy ledger. At the
 * end the string is pulled out by two rods, which are taken off. */
#include <drillmbd/drillmbd.h>
#include <stdio.h>

#include "command_line.h"

#define ROD 1.0                   /* [m] */
#define FEED 0.1                  /* [m/s] */
#define ROTATION 20.0             /* [rad/s] */
#define RAMP 1.0                  /* [s] to get up to speed and to stop */
#define REST 1.0                  /* [s] between rods */
#define STEP 1e-3                 /* [s] */
#define STAGE (ROD / FEED + RAMP) /* [s] to feed one rod: the ramps go half as far as full speed */

typedef struct rig {
    dmb_model *model;
    dmb_sim *sim;
    dmb_id bit, motor;
} rig;

/* Speed of a drive in one stage: up, and down at its end. */
static int32_t add_drive(dmb_model *model, int32_t component, double begin, double speed, dmb_id *id)
{
    dmb_segment terms[2] = {dmb_segment_default(), dmb_segment_default()};
    dmb_drive_def drive = dmb_drive_def_default();
    for (int i = 0; i < 2; ++i) {
        terms[i].kind = DMB_SEGMENT_STEP5;
        terms[i].x0 = begin + (i == 0 ? 0.0 : STAGE - RAMP);
        terms[i].x1 = terms[i].x0 + RAMP;
        terms[i].h1 = i == 0 ? speed : -speed;
    }
    drive.component = component;
    const int32_t status = dmb_model_add_time_function(model, terms, 2, &drive.time_function);
    return status < 0 ? status : dmb_model_add_drive(model, &drive, id);
}

/* A string of n rods from the rig at depth 0, with what the rig does from `begin` on. */
static int32_t describe(rig *r, uint32_t n, double begin, double feed)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_body_def head = dmb_body_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    rod.length = ROD;
    rod.damping_time = 1e-3;
    head.attach = DMB_ATTACH_START;
    head.mass = 100.0;
    bit.rock_law = DMB_ROCK_RATE;
    bit.intrinsic_energy = 1e6; /* coal */
    bit.contact_strength = 1e6;
    int32_t status = dmb_model_create(NULL, &r->model);
    if (status >= 0) status = dmb_model_add_wall(r->model, &wall, NULL);
    if (status >= 0) status = dmb_model_add_pipes(r->model, &rod, n, NULL);
    if (status >= 0) status = dmb_model_add_body(r->model, &head, NULL);
    if (status >= 0) status = dmb_model_add_bit(r->model, &bit, &r->bit);
    if (status >= 0) status = add_drive(r->model, DMB_X, begin, feed, NULL);
    if (status >= 0) status = add_drive(r->model, DMB_RX, begin, ROTATION, &r->motor);
    if (status >= 0) status = dmb_model_compile(r->model, NULL);
    return status < 0 ? status : dmb_sim_create(r->model, NULL, &r->sim);
}

/* The string goes on as one of n rods; what is left of the old one is given back. */
static int32_t change_rods(rig *r, uint32_t n, double feed)
{
    rig next = {0};
    int32_t status = describe(&next, n, dmb_sim_time(r->sim), feed);
    if (status >= 0) status = dmb_sim_transfer_state(next.sim, r->sim);
    dmb_sim_destroy(&r->sim);
    dmb_model_destroy(&r->model);
    *r = next;
    return status;
}

static int32_t run(rig *r, double until)
{
    int32_t status = DMB_OK;
    while (status >= 0 && dmb_sim_time(r->sim) < until - 0.5 * STEP) status = dmb_sim_step(r->sim, STEP, NULL);
    return status;
}

/* Torque and wall force at full speed, the others when the string has come to rest again. */
static int32_t feed_one_rod(rig *r, uint32_t n, const char *what)
{
    dmb_drive_state motor = dmb_drive_state_default();
    dmb_contact_total wall = dmb_contact_total_default();
    dmb_energy energy = dmb_energy_default();
    dmb_pose bit = dmb_pose_default();
    double angle = 0.0;
    const double begin = dmb_sim_time(r->sim);
    int32_t status = run(r, begin + STAGE - RAMP);
    if (status >= 0) status = dmb_query_drive(r->sim, r->motor, &motor);
    if (status >= 0) status = dmb_query_contact_total(r->sim, &wall);
    if (status >= 0) status = run(r, begin + STAGE + REST);
    if (status >= 0) status = dmb_query_pose(r->sim, dmb_station(r->bit, 0, 0.0), &bit);
    if (status >= 0) status = dmb_query_rotation(r->sim, dmb_station(r->bit, 0, 0.0), &angle);
    if (status >= 0) status = dmb_query_energy(r->sim, &energy);
    if (status >= 0)
        printf("%-8s %5u %9.3f s %9.4f m %9.2f turns %9.2f N m %8.1f N %9.5f %%\n", what, n, dmb_sim_time(r->sim),
               bit.depth, angle / 6.283185307179586, motor.force, wall.normal_force, 100.0 * energy.error);
    return status;
}

/* Drills with 3 to 6 rods, then pulls back by a rod and takes it off, twice. */
static int32_t work(rig *r)
{
    dmb_pose bit = dmb_pose_default();
    int32_t status = feed_one_rod(r, 3, "drill");
    for (uint32_t n = 4; n <= 6 && status >= 0; ++n) {
        status = change_rods(r, n, FEED);
        if (status >= 0) status = feed_one_rod(r, n, "drill");
    }
    for (uint32_t n = 6; n > 4 && status >= 0; --n) {
        status = change_rods(r, n, -FEED); /* as many at first: only what the rig does is new */
        if (status >= 0) status = feed_one_rod(r, n, "pull out");
    }
    if (status >= 0) status = change_rods(r, 4, 0.0);
    if (status >= 0) status = dmb_query_pose(r->sim, dmb_station(r->bit, 0, 0.0), &bit);
    if (status >= 0) printf("left in the hole: 4 rods, bit at %.4f m\n", bit.depth);
    return status;
}

int main(int count, char **words)
{
    if (count > 1) return command_line(count, words, "How does a hole grow rod by rod?", NULL, 0);
    rig r = {0};
    int32_t status = describe(&r, 3, 0.0, FEED);
    if (status >= 0) status = dmb_analysis_static(r.sim, NULL, NULL);
    printf("          rods      time         bit    rotation        torque    on wall  energy lost\n");
    if (status >= 0) status = work(&r);
    if (status < 0)
        fprintf(stderr, "%s: %s%s\n", dmb_status_text(status), dmb_model_message(r.model), dmb_sim_message(r.sim));
    dmb_sim_destroy(&r.sim);
    dmb_model_destroy(&r.model);
    return status < 0;
}
