/* Actuators: what lies between the command of a drive and its force (a hydraulic rotation head and its valves).
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
 * (eq:drive.lag) exact for a constant r, of second order else, stable for any h; r1 is u1 or as near as R lets it come.
 * Pure. */
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

/* [N, N m] f of a motion drive on its way through an actuator: command, after the delay, within the rate, after the
 * lag.
 */
typedef struct dmb_actuator_flow {
    double command, delayed, limited, force;
} dmb_actuator_flow;

/* y(x) of a table whose x increase, straight between its points and constant beyond, and its slope. */
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

/* Force of a controller by its error, in the place of a gain: a mud motor's torque by w0 - w. */
typedef struct dmb_gain_table {
    double error[DMB_GAIN_POINTS], force[DMB_GAIN_POINTS]; /* [m/s, rad/s], [N, N m] */
    uint32_t points;
    uint32_t reserved;
} dmb_gain_table;

static inline double dmb_gain_force(const dmb_gain_table *table, double error, double *slope)
{
    return dmb_curve_value(table->error, table->force, table->points, error, slope);
}

/* A force within the curve; *slope, by the speed, becomes that of the curve where the curve limits it. */
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

/* End of a step h from `from` with the delayed command going from u0 to flow->delayed; into limited and force of flow,
 * returns d force/d delayed. from->limited counts only with a rate limit, u0 only without. */
double dmb_actuator_follow(const dmb_actuator_law *law, double h, double u0, const dmb_actuator_flow *from,
                           dmb_actuator_flow *flow);

/* ---- The delay line: commands at times that increase, two of one time at a jump; the oldest samples come first. ----
 */

typedef struct dmb_delay_line {
    double *time, *value; /* shape (DMB_DELAY_SAMPLES) */
} dmb_delay_line;

/* The command at a time, the value before a jump there or the one after it; that of the oldest sample before it, of the
 * newest one after it. */
double dmb_delay_before(const dmb_delay_line *line, double time);
double dmb_delay_after(const dmb_delay_line *line, double time);
/* [s] The first jump in the line later than `time`; INFINITY: none. */
double dmb_delay_next_jump(const dmb_delay_line *line, double time);
/* From now on the command has always been this one. */
void dmb_delay_fill(const dmb_delay_line *line, double time, double value);
/* A step has gone from begin, with the command `start` after what was set there, to `time`. Samples nearer than
 * delay/DMB_DELAY_PARTS to their predecessor are replaced by the newest, except jumps and breakpoints: two breakpoints
 * within that time are kept exactly. */
void dmb_delay_push(const dmb_delay_line *line, double delay, double begin, double start, double time, double value);

#endif
