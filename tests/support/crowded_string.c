#include "crowded_string.h"

enum { PIPES = 4 };

crowded_string crowded_string_default(void)
{
    const crowded_string c = {.mu = 0.3, .stiffness = 1e6, .ring_diameter = 0.09, .inner_density = 1300.0};
    return c;
}

static void add_hole(rig *s, const crowded_string *c)
{
    dmb_environment_def mud = dmb_environment_def_default();
    dmb_wall_def wall = s1_hole();
    mud.gravity[2] = -9.81;
    mud.fluid_density = 1100.0;
    mud.inner_density = c->inner_density;
    mud.added_mass = 1.0;
    mud.lateral_damping = 20.0;
    must_model(s, dmb_model_set_environment(s->model, &mud));
    wall.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    wall.stiffness = c->stiffness;
    wall.damping = 3e3;
    wall.friction_law = DMB_FRICTION_COULOMB;
    wall.mu_dynamic = wall.mu_static = c->mu;
    wall.smoothing_speed = 0.05;
    add_wall(s, &wall);
}

static void add_held(rig *s, crowded_string *c)
{
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_stuck_def stuck = dmb_stuck_def_default();
    ring.string = c->string;
    ring.pipe = 1;
    ring.fraction = 0.35;
    ring.outer_diameter = c->ring_diameter;
    ring.mass = 6.0;
    must_model(s, dmb_model_add_stabiliser(s->model, &ring, &c->ring));
    stuck.place = dmb_station(c->string, PIPES - 1, 1.0);
    stuck.stiffness[0] = 1e6; /* soft: a stiffer one takes digits of differences */
    stuck.stiffness[1] = 1e4;
    stuck.damping[0] = 1e3;
    stuck.damping[1] = 10.0;
    must_model(s, dmb_model_add_stuck(s->model, &stuck, &c->stuck));
}

void add_crowded_string(rig *s, crowded_string *c)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_drive_def turn = dmb_drive_def_default();
    add_hole(s, c);
    string.start_free = DMB_FREE_RX;
    c->string = add_string(s, &string);
    pipe.string = c->string;
    pipe.elements = 2;
    pipe.contact_points = 3;
    pipe.damping_time = 1e-4;
    add_pipes(s, &pipe, PIPES);
    add_held(s, c);
    turn.part = c->string;
    turn.component = DMB_RX;
    turn.kind = DMB_DRIVE_CONTROL;
    turn.gain = 20.0;
    turn.integral_gain = 400.0;
    turn.time_function = add_constant(s, 0.0);
    c->drive = add_drive(s, &turn);
}
