/* Pressure losses of circulating mud (formulas and sources: mud_flow.h).
 *
 *     function               flow                                              equation
 *     --------------------   -----------------------------------------------   ------------------------------------
 *     dmb_bore_loss          pipe, with or without a yield stress              eq:mud.pipe, eq:mud.pipe-yield
 *     laminar_gradient       concentric annulus, power law                     eq:mud.zero-shear, eq:mud.annulus
 *     with_yield             annulus, yield stress, from the slot              eq:mud.slot, eq:mud.annulus-yield
 *     turbulence             transition and turbulence                         eq:mud.turbulent
 *     newtonian              eccentric annulus, exponent 1                     eq:mud.eccentric
 *     correlation            eccentric annulus, other exponents                eq:mud.eccentric-power
 *
 * Powers and logarithms are the library's own, so that results have the same bits on every processor. */
#include "force/mud_flow.h"

#include <math.h>
#include <stdbool.h>

#include "math/elementary.h"
#include "math/quadrature.h"

#define PI 3.14159265358979323846
#define LN_10 2.30258509299404568402

/* ln x for 1e-9 <= x <= 1e9: 16 times ln of y = x^(1/16), which is 2 atanh((y - 1)/(y + 1)). */
static double logarithm(double x)
{
    const double y = sqrt(sqrt(sqrt(sqrt(x)))), t = (y - 1.0) / (y + 1.0);
    double sum = 0.0;
    for (int k = 61; k >= 1; k -= 2) sum = sum * t * t + 1.0 / k;
    return 32.0 * t * sum;
}

static double eighth_power(double x)
{
    const double x2 = x * x, x4 = x2 * x2;
    return x4 * x4;
}

/* ---- Roots ------------------------------------------------------------------------------------------------------- */

/* A function with one change of sign, from minus to plus. */
typedef double (*rising)(double x, const void *context);

/* Root between low and high to a relative width, by the Illinois form of regula falsi (Dowell, Jarratt 1971). */
static double root_between(rising function, const void *context, double low, double high, double width)
{
    double at_low = function(low, context), at_high = function(high, context);
    for (int i = 0; i < 100 && high - low > width * high; i++) {
        const double next = (low * at_high - high * at_low) / (at_high - at_low);
        if (!(next > low)) return low;
        if (!(next < high)) return high;
        const double at = function(next, context);
        if (at > 0.0) {
            high = next;
            at_high = at;
            at_low *= 0.5;
        } else {
            low = next;
            at_low = at;
            at_high *= 0.5;
        }
    }
    return 0.5 * (low + high);
}

/* ---- Laminar and turbulent --------------------------------------------------------------------------------------- */

/* (f_i/f_l)^12 of eq:mud.turbulent. The laminar gradient times the 12th root of 1 plus this is that of the whole. */
static double turbulence(double n, double reynolds)
{
    const double critical = 3470.0 - 1370.0 * n, log_n = logarithm(n) / LN_10;
    if (!(reynolds > 1.0)) return 0.0;
    const double b = (1.75 - log_n) / 7.0, share = reynolds / critical;
    const double transition = share * share;
    const double beyond = (log_n + 3.93) / 50.0 * dmb_pow(reynolds, 1.0 - b) / 16.0;
    const double between = 1.0 / sqrt(sqrt(sqrt(1.0 / eighth_power(transition) + 1.0 / eighth_power(beyond))));
    return eighth_power(between) * between * between * between * between;
}

/* [-] Reynolds number 16/f_l of a laminar gradient: f = tau/(rho V^2/2), tau = G D_h/4. */
static double reynolds_of(double density, double speed, double hydraulic_diameter, double gradient)
{
    return gradient > 0.0 ? 32.0 * density * speed * speed / (gradient * hydraulic_diameter) : 0.0;
}

/* ---- Yield stress ------------------------------------------------------------------------------------------------ */

/* A pipe or a slot in which a fluid with a yield stress flows at a given speed. */
typedef struct duct {
    const dmb_mud_flow *flow;
    double width; /* [m] radius d/2 or gap H: the pressure gradient is 2 tau_w/width in both */
    double speed; /* [m/s] mean */
    bool slot;
} duct;

/* [m/s] Mean speed at a wall stress above the yield stress (eq:mud.pipe-yield, eq:mud.slot). */
static double speed_at(const duct *d, double wall)
{
    const double n = d->flow->exponent, phi = d->flow->yield_stress / wall, free = 1.0 - phi;
    if (!(free > 0.0)) return 0.0;
    const double common = n * dmb_pow(wall / d->flow->consistency, 1.0 / n) * dmb_pow(free, 1.0 + 1.0 / n);
    if (d->slot) return 0.5 * d->width * common / (2.0 * n + 1.0) * (1.0 + phi * n / (n + 1.0));
    return d->width * common *
           (free * free / (3.0 * n + 1.0) + 2.0 * phi * free / (2.0 * n + 1.0) + phi * phi / (n + 1.0));
}

/* The n-th powers are compared, because their slope is finite at yield. */
static double excess_speed(double wall, const void *context)
{
    const duct *d = context;
    return dmb_pow(speed_at(d, wall), d->flow->exponent) - dmb_pow(d->speed, d->flow->exponent);
}

/* [Pa] Wall stress at the duct's speed; without_yield: wall stress of the power law. */
static double wall_stress(const duct *d, double without_yield)
{
    const double low = fmax(d->flow->yield_stress, without_yield);
    double high = without_yield + 2.0 * d->flow->yield_stress;
    if (!(d->flow->yield_stress > 0.0)) return without_yield;
    for (int i = 0; i < 60 && speed_at(d, high) < d->speed; i++) high *= 2.0;
    return root_between(excess_speed, d, low, high, 1e-14);
}

/* [-] n' = d ln tau_w/d ln V. */
static double local_exponent(const duct *d, double wall)
{
    const double yield = d->flow->yield_stress, n = d->flow->exponent;
    if (!(yield > 0.0) || !(wall > yield)) return yield > 0.0 ? DMB_FLOW_EXPONENT_MIN : n;
    const double rate = dmb_pow((wall - yield) / d->flow->consistency, 1.0 / n), scale = rate * d->width / d->speed;
    return fmax(DMB_FLOW_EXPONENT_MIN, 1.0 / (d->slot ? 0.5 * scale - 2.0 : scale - 3.0));
}

/* ---- Pipe -------------------------------------------------------------------------------------------------------- */

dmb_flow_loss dmb_bore_loss(const dmb_mud_flow *flow, double diameter)
{
    const double n = flow->exponent, speed = 4.0 * flow->rate / (PI * diameter * diameter);
    if (!(flow->rate > 0.0)) return (dmb_flow_loss){.gradient = 0.0};
    const duct pipe = {flow, 0.5 * diameter, speed, false};
    const double wall =
        wall_stress(&pipe, flow->consistency * dmb_pow((3.0 * n + 1.0) / (4.0 * n) * 8.0 * speed / diameter, n));
    const double laminar = 4.0 / diameter * wall;
    dmb_flow_loss loss = {.reynolds = reynolds_of(flow->inside, speed, diameter, laminar)};
    loss.gradient = laminar * dmb_pow(1.0 + turbulence(local_exponent(&pipe, wall), loss.reynolds), 1.0 / 12.0);
    return loss;
}

/* ---- Annulus ----------------------------------------------------------------------------------------------------- */

enum { PANELS = 24 };

/* Integral from `from` to lambda of |lambda^2/x - x|^m, for either side: with x = lambda + (from - lambda) t^2 the
 * integrand is smooth at zero shear. */
static double speed_at_zero_shear(double lambda, double from, double m)
{
    const dmb_gauss_rule *rule = dmb_gauss(5);
    const double span = from - lambda;
    double sum = 0.0;
    for (int p = 0; p < PANELS; p++)
        for (int k = 0; k < rule->count; k++) {
            const double t = (p + rule->node[k]) / PANELS, x = lambda + span * t * t;
            sum += rule->weight[k] * dmb_pow(fabs(lambda - x) * (lambda + x) / x, m) * t;
        }
    return 2.0 * fabs(span) * sum / PANELS;
}

typedef struct zero_shear {
    double ratio, power;
} zero_shear;

/* > 0: lambda is too large. */
static double mismatch(double lambda, const void *context)
{
    const zero_shear *z = context;
    return speed_at_zero_shear(lambda, z->ratio, z->power) - speed_at_zero_shear(lambda, 1.0, z->power);
}

/* The root is in the middle of the annulus for n -> 0 and further inwards for larger n. */
double dmb_annulus_zero_shear(double exponent, double ratio)
{
    const zero_shear z = {ratio, 1.0 / exponent};
    if (exponent >= 1.0) return sqrt((1.0 - ratio) * (1.0 + ratio) / (-2.0 * logarithm(ratio)));
    return root_between(mismatch, &z, sqrt(ratio), 0.5 * (1.0 + ratio), 1e-15);
}

static double laminar_gradient(const dmb_mud_flow *flow, double hole_radius, double ratio, double lambda)
{
    const double n = flow->exponent, m = 1.0 / n, R = hole_radius;
    const double within = (lambda - ratio) * (lambda + ratio), beyond = (1.0 - lambda) * (1.0 + lambda);
    const double shape = dmb_pow(beyond, 1.0 + m) - dmb_pow(ratio, 1.0 - m) * dmb_pow(within, 1.0 + m);
    return 2.0 * flow->consistency / R * dmb_pow(flow->rate * (3.0 * n + 1.0) / (n * PI * R * R * R * shape), n);
}

/* 8 mu Q/(pi G R^4) of the eccentric annulus for n = 1, and S/(R^2 delta), as functions of kappa and e/R
 * (eq:mud.eccentric). */
static double newtonian(double k, double e, double *pull)
{
    const double P = 0.5 * ((1.0 - k) * (1.0 + k) + e * e), S = sqrt((P - e) * (P + e)), far = P - e * e + S;
    const double E = far / (k * (P + S)), delta = logarithm(E), q = e * e * k / ((P + S) * far);
    double sum = 0.0, qk = q, Ek = E;
    for (int i = 1; i < 1000 && qk > 0.0; i++, qk *= q, Ek *= E) {
        const double term = i * qk / (Ek - 1.0 / Ek);
        sum += term;
        if (term < 1e-18 * sum) break;
    }
    *pull = S / delta;
    return 1.0 - k * k * k * k - 4.0 * S * S / delta - 16.0 * S * S * sum;
}

/* 1 - linear (eps/n) k^0.8454 - square eps^2 sqrt(n) k^0.1852 + cube eps^3 sqrt(n) k^0.2527 (eq:mud.eccentric-power) */
static double correlation(double n, double k, double e, double linear, double square, double cube)
{
    const double root = sqrt(n);
    return 1.0 - linear * e / n * dmb_pow(k, 0.8454) - square * e * e * root * dmb_pow(k, 0.1852) +
           cube * e * e * e * root * dmb_pow(k, 0.2527);
}

dmb_annulus_shape dmb_annulus_shape_of(const dmb_mud_flow *flow, double ratio)
{
    const double n = flow->exponent, eps = flow->eccentricity;
    dmb_annulus_shape shape = {dmb_annulus_zero_shear(n, ratio), 1.0, 1.0, 1.0};
    double pull, middle;
    if (!(eps > 0.0)) return shape;
    const double concentric = newtonian(ratio, 0.0, &middle);
    shape.laminar = concentric / newtonian(ratio, eps * (1.0 - ratio), &pull);
    if (n < 1.0) shape.laminar = correlation(n, ratio, eps, 0.072, 1.5, 0.96);
    shape.turbulent = correlation(n, ratio, eps, 0.048, 2.0 / 3.0, 0.285);
    shape.pull = pull / middle;
    return shape;
}

/* Laminar flow of an annulus with yield stress. */
typedef struct yielding {
    double gradient; /* [Pa/m] */
    double lambda;   /* [-] radius of zero shear over the hole radius */
    double exponent; /* [-] local exponent n' */
} yielding;

/* Correction for yield stress of the gradient and lambda of the power law (eq:mud.annulus-yield). */
static yielding with_yield(const duct *slot, double gradient, double ratio, double lambda)
{
    const double n = slot->flow->exponent, H = slot->width;
    yielding answer = {gradient, lambda, n};
    if (!(slot->flow->yield_stress > 0.0)) return answer;
    const double plain = slot->flow->consistency * dmb_pow((2.0 * n + 1.0) / n * 2.0 * slot->speed / H, n);
    const double wall = wall_stress(slot, plain), phi = slot->flow->yield_stress / wall;
    const double more = 0.5 * H * gradient / plain - 1.0;
    answer.gradient = 2.0 * wall / H * (1.0 + more * (1.0 - phi) * (1.0 + 0.5 * phi));
    answer.lambda = sqrt(ratio + (lambda * lambda - ratio) * (1.0 - phi) * (1.0 + 0.35 * phi));
    answer.exponent = local_exponent(slot, wall);
    return answer;
}

dmb_flow_loss dmb_annulus_loss_by(const dmb_mud_flow *flow, double pipe_diameter, double hole_diameter,
                                  const dmb_annulus_shape *shape)
{
    const double R = 0.5 * hole_diameter, ratio = pipe_diameter / hole_diameter;
    const double gap = hole_diameter - pipe_diameter;
    if (!(flow->rate > 0.0)) return (dmb_flow_loss){.gradient = 0.0};
    const double speed = 4.0 * flow->rate / (PI * gap * (hole_diameter + pipe_diameter));
    const duct slot = {flow, 0.5 * gap, speed, true};
    const yielding laminar = with_yield(&slot, laminar_gradient(flow, R, ratio, shape->lambda), ratio, shape->lambda);
    dmb_flow_loss loss = {.reynolds = reynolds_of(flow->outside, speed, gap, laminar.gradient)};
    const double more = turbulence(laminar.exponent, loss.reynolds), share = more / (1.0 + more),
                 steep = dmb_pow(ratio, 0.343);
    const double lambda = laminar.lambda + share * ((steep + ratio) / (1.0 + steep) - laminar.lambda);
    loss.gradient = laminar.gradient * dmb_pow(1.0 + more, 1.0 / 12.0);
    if (flow->eccentricity > 0.0) loss.gradient *= shape->laminar + share * (shape->turbulent - shape->laminar);
    loss.pull = PI * lambda * lambda * R * R * loss.gradient;
    if (flow->eccentricity > 0.0) loss.pull *= shape->pull;
    return loss;
}

dmb_flow_loss dmb_annulus_loss(const dmb_mud_flow *flow, double pipe_diameter, double hole_diameter)
{
    const dmb_annulus_shape shape = dmb_annulus_shape_of(flow, pipe_diameter / hole_diameter);
    return dmb_annulus_loss_by(flow, pipe_diameter, hole_diameter, &shape);
}

/* ---- End of the string ------------------------------------------------------------------------------------------- */

double dmb_nozzle_loss(const dmb_mud_flow *flow)
{
    const double speed = flow->rate / (DMB_FLOW_DISCHARGE * flow->nozzle_area);
    return flow->open ? 0.0 : 0.5 * flow->inside * speed * speed;
}

double dmb_nozzle_thrust(const dmb_mud_flow *flow)
{
    return flow->inside * flow->rate * flow->rate / flow->nozzle_area;
}
