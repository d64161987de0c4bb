#include "model/section.h"

#include "math/so3.h"

static double given_or(double given, double otherwise)
{
    return given > 0.0 ? given : otherwise;
}

/* Differences of powers as products: no digits are lost for thin walls. */
static double ring_area(double outer, double inner)
{
    return 0.25 * DMB_PI * (outer - inner) * (outer + inner);
}

static double ring_second_moment(double outer, double inner)
{
    return ring_area(outer, inner) * (outer * outer + inner * inner) / 16.0;
}

void dmb_section_of(const dmb_pipe_def *def, dmb_pipe_section *section)
{
    const double A = ring_area(def->outer_diameter, def->inner_diameter);
    const double I = ring_second_moment(def->outer_diameter, def->inner_diameter);
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

double dmb_joint_diameter(const dmb_pipe_def *def)
{
    return def->joint_length > 0.0 ? given_or(def->joint_outer_diameter, def->outer_diameter) : 0.0;
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
void dmb_joint_of(const dmb_pipe_def *def, dmb_rigid_part *part)
{
    const double outer = dmb_joint_diameter(def), length = def->joint_length;
    const double inner = given_or(def->joint_inner_diameter, def->inner_diameter);
    part->mass = part->inertia[0] = part->inertia[1] = 0.0;
    if (!(length > 0.0)) return;
    part->mass = given_or(def->joint_mass, def->density * ring_area(outer, inner) * length);
    const double about = part->mass * (outer * outer + inner * inner) / 8.0;
    part->inertia[0] = given_or(def->joint_inertia[0], about);
    part->inertia[1] = given_or(def->joint_inertia[1], 0.5 * about + part->mass * length * length / 12.0);
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

double dmb_buoyancy_factor(const dmb_pipe_def *def, double fluid_density)
{
    return 1.0 - fluid_density / def->density;
}
