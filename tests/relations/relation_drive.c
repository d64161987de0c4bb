/* A static state that sliding friction twists does not depend on how the rig holds its torque: a motion drive, a load
 * drive with the torque that the motion drive gives, and a speed controller at its limit of the same torque. */
#include "relations.h"

enum { TOPIC_DRIVE = TOPIC_OF_RELATION + 80 };

static answers motion, other;

/* The drive that turns the rig end. */
static drive_data *turning(scene *s)
{
    for (uint32_t i = 0; i < s->drives; ++i)
        if (s->drive[i].def.component == DMB_RX && s->drive[i].part.kind == PART_STRING) return &s->drive[i];
    return NULL;
}

static int32_t rest(const scene *s, const dmb_static_options *options, uint32_t drive, answers *out, double *torque,
                    char message[256])
{
    built b;
    scene_view view = view_identity();
    dmb_drive_state state = dmb_drive_state_default();
    view.motion_only = 1;
    int32_t status = scene_open(s, 0, NULL, &b);
    if (status >= 0) status = dmb_analysis_static(b.sim, options, NULL);
    if (status >= 0) {
        answers_take(s, s, &view, &b, out);
        (void)dmb_query_drive(b.sim, b.drive[drive], &state);
        *torque = state.force;
    }
    memcpy(message, b.sim ? dmb_sim_message(b.sim) : b.message, 255);
    scene_close(&b);
    return status;
}

static void hold_alike(trial *t, const char *what)
{
    double difference[ANSWER_GROUPS];
    answers_difference(&motion, &other, difference);
    hold(t, what, difference[ANSWER_POSITION], 1e-10 * t->s.span);
}

static void check_driven(trial *t)
{
    static const int32_t kinds[] = {DMB_DRIVE_LOAD, DMB_DRIVE_CONTROL};
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_DRIVE);
    dmb_static_options options = dmb_static_options_default();
    drive_data *const drive = turning(&t->s);
    char message[256] = "";
    double torque = 0.0, again;
    if (drive == NULL) {
        left_out(t, "nothing turns the string");
        return;
    }
    for (uint32_t p = 0; p < t->s.string[0].pipes; ++p) t->s.string[0].pipe[p].elements = 1U << t->s.number % 3;
    const uint32_t number = (uint32_t)(drive - t->s.drive);
    options.slip_rotation = draw_number(&n, 1.0, 15.0);
    t->s.string[0].def.start_free |= DMB_FREE_RX;
    drive->def.kind = DMB_DRIVE_MOTION;
    int32_t status = rest(&t->s, &options, number, &motion, &torque, message);
    if (status < 0) {
        refused(t, status, message);
        return;
    }
    if (torque == 0.0) left_out(t, "a wall without friction");
    for (int k = 0; k < 2 && t->verdict == VERDICT_HELD; ++k) {
        drive->def.kind = kinds[k];
        drive->time_function.terms = 1;
        drive->time_function.term[0] = dmb_segment_default();
        drive->time_function.term[0].h0 = kinds[k] == DMB_DRIVE_LOAD ? torque : torque > 0.0 ? 1e3 : -1e3;
        drive->def.gain = 1e6;
        drive->def.limit_high = fabs(torque);
        drive->def.limit_low = -fabs(torque);
        status = rest(&t->s, &options, number, &other, &again, message);
        if (status < 0)
            refused(t, status, message);
        else
            hold_alike(t, k == 0 ? "places, load for motion" : "places, controller for motion");
    }
}

const relation relation_driven = {
    "driven",
    "statics with sliding friction, turned by motion, by a load and by a controller of equal torque",
    {FAMILY_HOLE | FAMILY_BENT,
     WISH_STILL | WISH_FLEXIBLE | WISH_NO_BIT | WISH_NO_JOINTS | WISH_NO_CONTROL | WISH_NO_LOADS | WISH_ROUND, 4},
    30,
    0.3,
    check_driven,
    0.0};
