#include "model/section.h"

#include <string.h>

#include "math/quadrature.h"
#include "math/so3.h"

static double given_or(double given, double otherwise)
{
    return given > 0.0 ? given : otherwise;
}

/* Differences of powers as products, so that thin walls lose no digits. */
double dmb_ring_area(double outer, double inner)
{
    return 0.25 * DMB_PI * (outer - inner) * (outer + inner);
}

double dmb_ring_second_moment(double outer, double inner)
{
    return dmb_ring_area(outer, inner) * (outer * outer + inner * inner) / 16.0;
}

/* Stiffness and mass of a circular tube for what the description leaves at 0. Rows: strains (axial, shear y, shear z),
 * then twist and curvatures; G = E/(2 (1 + nu)), polar second moment 2 I. */
void dmb_section_of(const dmb_pipe_def *def, dmb_pipe_section *section)
{
    const double A = dmb_ring_area(def->outer_diameter, def->inner_diameter);
    const double I = dmb_ring_second_moment(def->outer_diameter, def->inner_diameter);
    const double E = def->young_modulus, G = E / (2.0 * (1.0 + def->poisson_ratio));
    const double GA = def->shear_factor * G * A;
    const double tube[6] = {E * A, GA, GA, G * 2.0 * I, E * I, E * I};
    for (int i = 0; i < 6; ++i) section->stiffness[i] = given_or(def->section_stiffness[i], tube[i]);
    section->mass = given_or(def->section_mass, def->density * A);
    section->inertia[0] = given_or(def->section_inertia[0], def->density * 2.0 * I);
    section->inertia[1] = given_or(def->section_inertia[1], def->density * I);
}

double dmb_pipe_body_length(const dmb_pipe_def *def)
{
    return def->length - def->joint_length;
}

double dmb_body_curvature(const dmb_pipe_def *def, double hole)
{
    return hole * (def->length / dmb_pipe_body_length(def));
}

double dmb_joint_diameter(const dmb_pipe_def *def)
{
    return def->joint_length > 0.0 ? given_or(def->joint_outer_diameter, def->outer_diameter) : 0.0;
}

void dmb_pipe_diameters(const dmb_pipe_def *def, int in_tool_joint, double diameters[2])
{
    diameters[0] = in_tool_joint ? given_or(def->joint_outer_diameter, def->outer_diameter) : def->outer_diameter;
    diameters[1] = in_tool_joint ? given_or(def->joint_inner_diameter, def->inner_diameter) : def->inner_diameter;
}

/* Across: slices of the section's own inertia along the length, m L^2/12 for their distance from the centre. */
void dmb_rigid_pipe_of(const dmb_pipe_def *def, dmb_rigid_part *part)
{
    const double length = dmb_pipe_body_length(def);
    dmb_pipe_section section;
    dmb_section_of(def, &section);
    part->mass = section.mass * length;
    part->inertia[0] = section.inertia[0] * length;
    part->inertia[1] = section.inertia[1] * length + part->mass * length * length / 12.0;
}

/* A hollow cylinder: m (D^2 + d^2)/8 about its axis; half of that and m L^2/12 across. */
static void cylinder(double outer, double inner, double length, const double given[2], dmb_rigid_part *part)
{
    const double about = part->mass * (outer * outer + inner * inner) / 8.0;
    part->inertia[0] = given_or(given[0], about);
    part->inertia[1] = given_or(given[1], 0.5 * about + part->mass * length * length / 12.0);
}

void dmb_ring_body_of(const dmb_stabiliser_def *def, double pipe_diameter, dmb_rigid_part *part)
{
    const double volume = dmb_ring_area(def->outer_diameter, pipe_diameter) * def->length;
    part->mass = given_or(def->mass, def->density * volume);
    cylinder(def->outer_diameter, pipe_diameter, def->length, def->inertia, part);
}

void dmb_joint_of(const dmb_pipe_def *def, dmb_rigid_part *part)
{
    const double outer = dmb_joint_diameter(def), length = def->joint_length;
    const double inner = given_or(def->joint_inner_diameter, def->inner_diameter);
    part->mass = part->inertia[0] = part->inertia[1] = 0.0;
    if (!(length > 0.0)) return;
    part->mass = given_or(def->joint_mass, def->density * dmb_ring_area(outer, inner) * length);
    cylinder(outer, inner, length, def->joint_inertia, part);
}

/* Where the gauge is 0 (no contact), the radius of the rock law is the size there is. */
void dmb_bit_body_of(const dmb_bit_def *def, dmb_rigid_part *part)
{
    const double radius = given_or(0.5 * def->diameter, def->radius);
    part->mass = def->mass;
    part->inertia[0] = given_or(def->inertia[0], 0.5 * def->mass * radius * radius);
    part->inertia[1] =
        given_or(def->inertia[1], def->mass * (3.0 * radius * radius + def->length * def->length) / 12.0);
}

double dmb_inner_area(const dmb_pipe_def *def, int in_tool_joint)
{
    double diameters[2];
    dmb_pipe_diameters(def, in_tool_joint, diameters);
    return dmb_ring_area(diameters[1], 0.0);
}

/* Weight in mud over weight in air. With equal muds 1 - rho_m/rho. With another mud inside, each metre displaces the
 * outer mud by the whole outer area and contains inner mud in the bore: the difference of the two densities acts on the
 * bore's area. */
double dmb_buoyancy_factor(const dmb_pipe_def *def, int in_tool_joint, const dmb_mud *mud)
{
    const double factor = 1.0 - mud->outside / def->density;
    dmb_pipe_section section;
    dmb_rigid_part joint;
    if (mud->inside < 0.0) return factor;
    dmb_section_of(def, &section);
    dmb_joint_of(def, &joint);
    const double mass = in_tool_joint ? joint.mass / def->joint_length : section.mass;
    return factor + (mud->inside - mud->outside) * dmb_inner_area(def, in_tool_joint) / mass;
}

double dmb_weighing_mass(const dmb_pipe_def *def, const dmb_mud *mud)
{
    dmb_rigid_part body, joint;
    dmb_rigid_pipe_of(def, &body);
    dmb_joint_of(def, &joint);
    if (mud->inside < 0.0) return dmb_buoyancy_factor(def, 0, mud) * (body.mass + joint.mass);
    const double of_joint = joint.mass > 0.0 ? dmb_buoyancy_factor(def, 1, mud) * joint.mass : 0.0;
    return dmb_buoyancy_factor(def, 0, mud) * body.mass + of_joint;
}

/* [m2] times what a cylinder displaces; added < 0: (D^2 + d^2)/(D^2 - d^2) of the annulus. */
static double moved_outside(double d, double added, double hole)
{
    const double factor = added < 0.0 ? (hole * hole + d * d) / ((hole - d) * (hole + d)) : added;
    return factor * dmb_ring_area(d, 0.0);
}

static double mud_at(const dmb_pipe_def *def, int in_tool_joint, const dmb_mud *mud, double added, double hole)
{
    double d[2];
    dmb_pipe_diameters(def, in_tool_joint, d);
    const double inside = mud->inside < 0.0 ? mud->outside : mud->inside;
    return inside * dmb_ring_area(d[1], 0.0) + mud->outside * moved_outside(d[0], added, hole);
}

/* [kg/m] of mud that moves sideways with a pipe (eq:mud.added-mass): that in the bore, and that displaced outside; the
 * tool joint's share is spread over the body, which has the elements. */
double dmb_mud_inertia(const dmb_pipe_def *def, const dmb_mud *mud, double added, double hole)
{
    const double body = dmb_pipe_body_length(def);
    double sum = mud_at(def, 0, mud, added, hole) * body;
    if (def->joint_length > 0.0) sum += mud_at(def, 1, mud, added, hole) * def->joint_length;
    return sum / body;
}

/* Slices along a length around x. */
static void add_slices(double mass, double x, double length, dmb_added_mass *sum)
{
    sum->across[0] += mass;
    sum->across[1] += mass * x;
    sum->across[2] += mass * (x * x + length * length / 12.0);
}

void dmb_rigid_pipe_mud(const dmb_pipe_def *def, const dmb_environment_def *e, double hole, double x,
                        dmb_added_mass *sum)
{
    const dmb_mud mud = {e->fluid_density, e->inner_density};
    const double length = dmb_pipe_body_length(def);
    add_slices(dmb_mud_inertia(def, &mud, e->added_mass, hole) * length, x, length, sum);
}

void dmb_ring_mud(const dmb_stabiliser_def *def, double pipe_diameter, const dmb_environment_def *e, double hole,
                  double x, dmb_added_mass *sum)
{
    const double added = e->added_mass;
    double across = def->added_mass[1];
    if (across < 0.0) across = 0.0;
    if (def->added_mass[1] < 0.0 && (added > 0.0 || added < 0.0))
        across = e->fluid_density * def->length *
                 (moved_outside(def->outer_diameter, added, hole) - moved_outside(pipe_diameter, added, hole));
    add_slices(across, x, def->length, sum);
    sum->along += def->added_mass[0];
}

void dmb_given_mud(const double mass[2], double x, dmb_added_mass *sum)
{
    add_slices(mass[1], x, 0.0, sum);
    sum->along += mass[0];
}

double dmb_shear_ratio(double EI, double GA, double length)
{
    return 12.0 * (EI / length) / (GA * length);
}

/* GA/(1 + GA L^2/(12 EI)), written with the ratio P = 12 EI/(GA L^2): GA P/(1 + P) */
double dmb_corrected_shear(double EI, double GA, double length)
{
    const double P = dmb_shear_ratio(EI, GA, length);
    return GA * (P / (1.0 + P));
}

/* b (eq:beam.axial-shear) and h (eq:beam.curvature-softening), s = 1 - (GA*)/GA = 1/(1 + P) */
static void sideways_strain(double EI, double GA, double length, double *coupling, double *bend)
{
    const double s = 1.0 / (1.0 + dmb_shear_ratio(EI, GA, length));
    *coupling = 2.0 * s * (1.0 - 0.4 * s) / length;
    *bend = s / 60.0;
}

/* ---- Mass -------------------------------------------------------------------------------------------------------- */

/* Shapes of sideways displacement (N) and of section rotation (G) at x = 0 .. 1, for u_A, theta_A, u_B, theta_B
 * (eq:beam.shapes). */
static void shapes(double x, double P, double L, double N[4], double G[4])
{
    const double q = 1.0 / (1.0 + P), x2 = x * x, x3 = x2 * x;
    N[0] = (1.0 - 3.0 * x2 + 2.0 * x3 + P * (1.0 - x)) * q;
    N[1] = L * (x - 2.0 * x2 + x3 + 0.5 * P * (x - x2)) * q;
    N[2] = (3.0 * x2 - 2.0 * x3 + P * x) * q;
    N[3] = L * (x3 - x2 - 0.5 * P * (x - x2)) * q;
    G[0] = 6.0 * (x2 - x) * q / L;
    G[1] = (1.0 - 4.0 * x + 3.0 * x2 + P * (1.0 - x)) * q;
    G[2] = -G[0];
    G[3] = (3.0 * x2 - 2.0 * x + P * x) * q;
}

/* Integral of rho A N_i N_j + rho I G_i G_j over the length. Degree 6: five Gauss points are exact. */
static void bending_mass(double mass, double rotary, double P, double L, double out[6])
{
    static const int row[6] = {0, 0, 0, 0, 1, 1}, column[6] = {0, 1, 2, 3, 1, 3};
    const dmb_gauss_rule *rule = dmb_gauss(5);
    for (int k = 0; k < 6; ++k) out[k] = 0.0;
    for (int i = 0; i < rule->count; ++i) {
        double N[4], G[4];
        shapes(rule->node[i], P, L, N, G);
        for (int k = 0; k < 6; ++k) {
            const double integrand = mass * N[row[k]] * N[column[k]] + rotary * G[row[k]] * G[column[k]];
            out[k] += L * rule->weight[i] * integrand;
        }
    }
}

void dmb_element_add_sideways(const dmb_pipe_def *def, double mass, dmb_element_type *type)
{
    dmb_pipe_section section;
    dmb_section_of(def, &section);
    type->mud_per_metre += mass;
    for (int p = 0; p < 2; ++p) {
        const double *K = section.stiffness;
        double more[6];
        bending_mass(mass, 0.0, dmb_shear_ratio(K[5 - p], K[1 + p], type->length), type->length, more);
        for (int k = 0; k < 6; ++k) type->mass.bending[p][k] += more[k];
    }
}

/* Along and around: (1 - s/2) consistent (1/3, 1/6) + s/2 lumped (1/2, 0) mass, 5/12 and 1/12 at s = 1. Straight shapes
 * are too stiff by EA h^2/12 times the integral of u''^2; the lumped part is too heavy by s rho A h^2/12 times that of
 * u'^2. Waves longer than a pipe have EA u'' = -w^2 rho A u in the element, and EA u'^2 = w^2 (rho A + mass of the
 * joints per length) u^2 on average: the two errors cancel if s is the element's fraction of the mass that moves with
 * the pipe, and frequencies are of fourth order (without joints: Goudreau 1970; blending of quadratures, Ainsworth,
 * Wajid 2010). */
static void straight_mass(double total, double share, double out[2])
{
    out[0] = total * (4.0 + share) / 12.0;
    out[1] = total * (2.0 - share) / 12.0;
}

void dmb_beam_mass_of(const dmb_pipe_section *section, double length, const double share[2], dmb_beam_mass *mass)
{
    const double *K = section->stiffness;
    straight_mass(section->mass * length, share[0], mass->axial);
    straight_mass(section->inertia[0] * length, share[1], mass->torsion);
    /* u_y is coupled with the moment about z, u_z with that about y */
    bending_mass(section->mass, section->inertia[1], dmb_shear_ratio(K[5], K[1], length), length, mass->bending[0]);
    bending_mass(section->mass, section->inertia[1], dmb_shear_ratio(K[4], K[2], length), length, mass->bending[1]);
}

/* [-] Fractions of a pipe without its joint in the mass and in the inertia about the axis that move with it. */
static void fractions_of(const dmb_pipe_def *def, const dmb_pipe_section *section, double share[2])
{
    const double length = dmb_pipe_body_length(def);
    dmb_rigid_part joint;
    dmb_joint_of(def, &joint);
    share[0] = section->mass * length / (section->mass * length + joint.mass);
    share[1] = section->inertia[0] * length / (section->inertia[0] * length + joint.inertia[0]);
}

/* ---- Type -------------------------------------------------------------------------------------------------------- */

double dmb_element_length(const dmb_pipe_def *def)
{
    return dmb_pipe_body_length(def) / def->elements;
}

void dmb_element_type_of(const dmb_pipe_def *def, const double arm[2], double damping_time, dmb_element_type *type)
{
    dmb_element_type_along(def, dmb_element_length(def), arm, damping_time, type);
}

/* Constants of an element of length L from those of its section. The shear stiffness is that of
 * eq:beam.shear-correction, so that linear statics are exact at the nodes. Stiffnesses are divided by L because they
 * multiply the change of the relative pose of the ends, not the strain per metre. */
void dmb_element_type_along(const dmb_pipe_def *def, double L, const double arm[2], double damping_time,
                            dmb_element_type *type)
{
    dmb_pipe_section section;
    const double *K = section.stiffness;
    double share[2];
    memset(type, 0, sizeof *type);
    dmb_section_of(def, &section);
    type->length = L;
    for (int i = 0; i < 6; ++i) {
        type->strain_stiffness[i] = K[i];
        type->stiffness[i] = K[i] / L;
    }
    type->stiffness[1] = dmb_corrected_shear(K[5], K[1], L) / L;
    type->stiffness[2] = dmb_corrected_shear(K[4], K[2], L) / L;
    sideways_strain(K[5], K[1], L, &type->coupling[0], &type->bend[0]);
    sideways_strain(K[4], K[2], L, &type->coupling[1], &type->bend[1]);
    type->damping_time = damping_time;
    type->rest[0] = L;
    for (int i = 0; i < 3; ++i) type->rest[3 + i] = L * def->curvature[i];
    type->arm[0] = arm[0];
    type->arm[1] = arm[1];
    fractions_of(def, &section, share);
    dmb_beam_mass_of(&section, L, share, &type->mass);
    type->mass_per_metre = section.mass;
}
