#include "controller.h"

#include <math.h>

#define SPEED 15.0          /* [rad/s] of rotation */
#define PUSH 8e3            /* [N] wanted at the rig end */
#define TORQUE_LIMIT 2500.0 /* [N m] while drilling */
#define RELIEVED 150.0      /* [N m] while the string winds down */
#define MOST_FEED 0.02      /* [m/s] */
#define FEED_PER_FORCE 4e-6 /* [m/s/N] */
#define PULL_SPEED (-0.05)  /* [m/s] */
#define MOST_PULL 55e3      /* [N] that rods and rig stand */
#define STALL_TIME 0.3      /* [s] */
#define CLEARANCE 0.05      /* [m] that the bit is drawn back by before it drills again */
#define FILTER 0.02         /* [s] */

const char *phase_name(phase p)
{
    static const char *const names[PHASES] = {"starting", "drilling", "winding down",
                                              "pulling",  "clearing", "given up"};
    return names[p];
}

static void smooth(double *kept, double seen)
{
    *kept += CYCLE / FILTER * (seen - *kept);
}

static void filter(readings *kept, const readings *seen)
{
    smooth(&kept->pressure, seen->pressure);
    smooth(&kept->torque, seen->torque);
    smooth(&kept->speed, seen->speed);
    smooth(&kept->hook, seen->hook);
    smooth(&kept->feed, seen->feed);
}

static void enter(controller *c, phase p)
{
    c->phase = p;
    c->since = c->stalled = 0.0;
    if (p == WINDING_DOWN) c->held = c->smooth.feed;
    if (p == PULLING) c->most = 0.0;
}

/* The pressure is at its limit and the head does not turn. */
static int is_stuck(controller *c)
{
    const int stalls = c->smooth.torque > 0.9 * TORQUE_LIMIT && c->smooth.speed < 0.2 * SPEED;
    c->stalled = stalls ? c->stalled + CYCLE : 0.0;
    return c->stalled > STALL_TIME;
}

/* The pull that had grown has gone again. */
static int came_free(controller *c)
{
    c->most = fmax(c->most, c->smooth.hook);
    return c->most > 15e3 && c->smooth.hook < 0.5 * c->most;
}

static void next_phase(controller *c)
{
    const readings *s = &c->smooth;
    if (c->phase == STARTING && c->since > 1.0 && s->speed > 0.8 * SPEED) enter(c, DRILLING);
    if (c->phase == DRILLING && is_stuck(c)) enter(c, WINDING_DOWN);
    if (c->phase == WINDING_DOWN && c->since > 0.5 && fabs(s->speed) < 0.3 && s->torque < 1.5 * RELIEVED)
        enter(c, PULLING);
    if (c->phase == PULLING && came_free(c)) enter(c, CLEARING);
    if (c->phase == PULLING && s->hook > MOST_PULL) enter(c, GIVEN_UP);
    if (c->phase == CLEARING && s->feed < c->held - CLEARANCE) enter(c, STARTING);
}

int controller_decide(controller *c, const readings *seen, commands *wanted)
{
    const phase before = c->phase;
    filter(&c->smooth, seen);
    c->since += CYCLE;
    next_phase(c);
    const int turns = c->phase == STARTING || c->phase == DRILLING;
    const double push = fmin(MOST_FEED, fmax(-MOST_FEED, FEED_PER_FORCE * (PUSH + c->smooth.hook)));
    wanted->speed = turns ? SPEED : 0.0;
    wanted->torque_limit = turns ? TORQUE_LIMIT : RELIEVED;
    wanted->feed_speed = c->phase == DRILLING ? push : c->phase == PULLING || c->phase == CLEARING ? PULL_SPEED : 0.0;
    return c->phase != before;
}
