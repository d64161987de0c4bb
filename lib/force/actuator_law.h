/* Actuators: the dynamics between the command of a drive and its force (a hydraulic rotation head and its valves).
 *
 *     u(t) = c(t - T)                           delay
 *     |r'| <= R, r follows u                    rate limit
 *     tau f' = r - f                            lag
 *     F = min(max(f, -m(-v)), m(v)) - d(v) v    torque-speed curve m, drag d, another one where v < 0 (back-spin)
 *                                               (eq:drive.actuator)
 *
 * Over a step h in which r is a straight line the lag has the solution
 *
 *     f1 = E f0 + (1 - E) r0 + w (r1 - r0),   E = exp(-h/tau),   w = 1 - (1 - E) tau/h,
 *
 * (eq:drive.lag) exact for a constant r, of second order else, stable for any h; r1 is u1, or the value nearest to u1
 * that R permits. Pure. */
#ifndef DMB_FORCE_ACTUATOR_LAW_H
#define DMB_FORCE_ACTUATOR_LAW_H

#include <float.h>
#include <stddef.h>
#include <stdint.h>

enum { DMB_CURVE_POINTS = 8, DMB_GAIN_POINTS = 16, DMB_DELAY_SAMPLES = 800, DMB_DELAY_PARTS = 256 };

typedef struct dmb_actuator_law {
    double delay;                                            /* [s] T; 0: none */
    double rate_limit;                                       /* [N/s, N m/s] R; 0: none */
    double lag;                                              /* [s] tau; 0: none */
    double drag[2];                                          /* [N s/m, N m s] at speeds > 0, < 0 */
    double speed[DMB_CURVE_POINTS], force[DMB_CURVE_POINTS]; /* the curve, constant beyond its ends */
    uint32_t points;                                         /* [-] 0: no curve */
    uint32_t line;                                           /* number of its delay line */
} dmb_actuator_law;

/* [N, N m] Signal of a motion drive through its actuator: command, value after the delay, after the rate limit, and
 * after the lag. */
typedef struct dmb_actuator_flow {
    double command, delayed, limited, force;
} dmb_actuator_flow;

/* Value y(x) and slope of a table with increasing x: linear between its points, constant beyond its ends. */
static inline double dmb_curve_value(const double *x, const double *y, uint32_t points, double at, double *slope)
{
    const uint32_t last = points - 1;
    uint32_t i = 0;
    *slope = 0.0;
    if (at <= x[0]) return y[0];
    if (at >= x[last]) return y[last];
    while (at > x[i + 1]) i++;
    *slope = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    return y[i] + *slope * (at - x[i]);
}

/* [N, N m] m(v) and its slope. */
static inline double dmb_actuator_most(const dmb_actuator_law *law, double speed, double *slope)
{
    return dmb_curve_value(law->speed, law->force, law->points, speed, slope);
}

/* Force of a controller as a function of its error, used instead of a gain: torque of a mud motor over w0 - w. */
typedef struct dmb_gain_table {
    double error[DMB_GAIN_POINTS], force[DMB_GAIN_POINTS]; /* [m/s, rad/s], [N, N m] */
    uint32_t points;
    uint32_t reserved;
} dmb_gain_table;

static inline double dmb_gain_force(const dmb_gain_table *table, double error, double *slope)
{
    return dmb_curve_value(table->error, table->force, table->points, error, slope);
}

/* Returns the force limited by the torque-speed curve. Where the curve limits it, *slope [per unit of speed] becomes
 * the slope of the curve. */
static inline double dmb_actuator_within(const dmb_actuator_law *law, double force, double speed, double *slope)
{
    double up, down;
    if (law->points == 0) return force;
    const double high = dmb_actuator_most(law, speed, &up), low = -dmb_actuator_most(law, -speed, &down);
    if (force > high) {
        *slope = up;
        return high;
    }
    if (force < low) {
        *slope = down; /* d(-m(-v))/dv = m'(-v) */
        return low;
    }
    return force;
}

/* Computes the end of a step h from `from`, in which the delayed command changes from u0 to flow->delayed. Writes
 * limited and force of flow, returns d force/d delayed. from->limited is used only with a rate limit, u0 only without.
 */
double dmb_actuator_follow(const dmb_actuator_law *law, double h, double u0, const dmb_actuator_flow *from,
                           dmb_actuator_flow *flow);

/* ---- The delay line: commands at increasing times, two at the same time at a jump; oldest samples first. --------- */

typedef struct dmb_delay_line {
    double *time, *value; /* shape (DMB_DELAY_SAMPLES) */
} dmb_delay_line;

/* Command at a time: the value before a jump there, or the one after it. Before the oldest sample its value holds,
 * after the newest one that of the newest. */
double dmb_delay_before(const dmb_delay_line *line, double time);
double dmb_delay_after(const dmb_delay_line *line, double time);
/* [s] Time of the first jump in the line later than `time`; INFINITY if there is none. */
double dmb_delay_next_jump(const dmb_delay_line *line, double time);
/* Sets the whole history of the command to `value`. */
void dmb_delay_fill(const dmb_delay_line *line, double time, double value);
/* Stores a step from begin to `time` at which the command is `value`; `start` is the command at begin after any change
 * made there. Samples nearer than delay/DMB_DELAY_PARTS to their predecessor are replaced by the newest, except jumps
 * and breakpoints: two breakpoints within that time are kept exactly. */
void dmb_delay_push(const dmb_delay_line *line, double delay, double begin, double start, double time, double value);

#endif
