#include "force/mud_flow.h"

#include <math.h>

#include "math/elementary.h"
#include "math/quadrature.h"

#define PI 3.14159265358979323846
#define LN_10 2.30258509299404568402

/* ln x of x > 0 within 1e-9 .. 1e9: 16 times that of the fourth root of the root's root, 2 atanh((y - 1)/(y + 1)). */
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

/* ---- Laminar and turbulent --------------------------------------------------------------------------------------- */

/* (f_i/f_l)^12 */
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

/* [-] The Reynolds number 16/f_l of a laminar gradient: f = tau/(rho V^2/2), tau = G D_h/4. */
static double reynolds_of(double density, double speed, double hydraulic_diameter, double gradient)
{
    return gradient > 0.0 ? 32.0 * density * speed * speed / (gradient * hydraulic_diameter) : 0.0;
}

dmb_flow_loss dmb_bore_loss(const dmb_mud_flow *flow, double diameter)
{
    const double n = flow->exponent, speed = 4.0 * flow->rate / (PI * diameter * diameter);
    if (!(flow->rate > 0.0)) return (dmb_flow_loss){.gradient = 0.0};
    const double laminar =
        4.0 * flow->consistency / diameter * dmb_pow((3.0 * n + 1.0) / (4.0 * n) * 8.0 * speed / diameter, n);
    dmb_flow_loss loss = {.reynolds = reynolds_of(flow->inside, speed, diameter, laminar)};
    loss.gradient = laminar * dmb_pow(1.0 + turbulence(n, loss.reynolds), 1.0 / 12.0);
    return loss;
}

/* ---- Annulus ----------------------------------------------------------------------------------------------------- */

enum { PANELS = 24 };

/* Integral from `from` to lambda of |lambda^2/x - x|^m, either side: with x = lambda + (from - lambda) t^2 it is smooth
 * where the shear is zero. */
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

/* > 0: lambda is too large. */
static double mismatch(double lambda, double ratio, double m)
{
    return speed_at_zero_shear(lambda, ratio, m) - speed_at_zero_shear(lambda, 1.0, m);
}

/* By the rule of false position in the form of Illinois (Dowell, Jarratt 1971). */
double dmb_annulus_zero_shear(double exponent, double ratio)
{
    if (exponent >= 1.0) return sqrt((1.0 - ratio) * (1.0 + ratio) / (-2.0 * logarithm(ratio)));
    const double m = 1.0 / exponent;
    double low = sqrt(ratio), high = 0.5 * (1.0 + ratio), at_low, at_high; /* n -> 0 in the middle, else inwards */
    at_low = mismatch(low, ratio, m);
    at_high = mismatch(high, ratio, m);
    for (int i = 0; i < 100 && high - low > 1e-15; i++) {
        const double next = (low * at_high - high * at_low) / (at_high - at_low);
        if (!(next > low && next < high)) break;
        const double at = mismatch(next, ratio, m);
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

static double laminar_gradient(const dmb_mud_flow *flow, double hole_radius, double ratio, double lambda)
{
    const double n = flow->exponent, m = 1.0 / n, R = hole_radius;
    const double within = (lambda - ratio) * (lambda + ratio), beyond = (1.0 - lambda) * (1.0 + lambda);
    const double shape = dmb_pow(beyond, 1.0 + m) - dmb_pow(ratio, 1.0 - m) * dmb_pow(within, 1.0 + m);
    return 2.0 * flow->consistency / R * dmb_pow(flow->rate * (3.0 * n + 1.0) / (n * PI * R * R * R * shape), n);
}

/* 8 mu Q/(pi G R^4) of the eccentric annulus, n = 1, and S/(R^2 delta), by kappa and e/R. */
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

/* 1 - linear (eps/n) k^0.8454 - square eps^2 sqrt(n) k^0.1852 + cube eps^3 sqrt(n) k^0.2527 */
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

dmb_flow_loss dmb_annulus_loss_by(const dmb_mud_flow *flow, double pipe_diameter, double hole_diameter,
                                  const dmb_annulus_shape *shape)
{
    const double R = 0.5 * hole_diameter, ratio = pipe_diameter / hole_diameter, n = flow->exponent;
    const double gap = hole_diameter - pipe_diameter;
    if (!(flow->rate > 0.0)) return (dmb_flow_loss){.gradient = 0.0};
    const double laminar = laminar_gradient(flow, R, ratio, shape->lambda);
    const double speed = 4.0 * flow->rate / (PI * gap * (hole_diameter + pipe_diameter));
    dmb_flow_loss loss = {.reynolds = reynolds_of(flow->outside, speed, gap, laminar)};
    const double more = turbulence(n, loss.reynolds), share = more / (1.0 + more), steep = dmb_pow(ratio, 0.343);
    const double lambda = shape->lambda + share * ((steep + ratio) / (1.0 + steep) - shape->lambda);
    loss.gradient = laminar * dmb_pow(1.0 + more, 1.0 / 12.0);
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

/* ---- End --------------------------------------------------------------------------------------------------------- */

double dmb_nozzle_loss(const dmb_mud_flow *flow)
{
    const double speed = flow->rate / (DMB_FLOW_DISCHARGE * flow->nozzle_area);
    return flow->open ? 0.0 : 0.5 * flow->inside * speed * speed;
}

double dmb_nozzle_thrust(const dmb_mud_flow *flow)
{
    return flow->inside * flow->rate * flow->rate / flow->nozzle_area;
}
