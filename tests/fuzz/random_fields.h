/* Fields of definitions that not every random scene has, out of bytes. */
#ifndef DMB_TESTS_RANDOM_FIELDS_H
#define DMB_TESTS_RANDOM_FIELDS_H

#include "drillmbd/drillmbd.h"
#include "random_bytes.h"

/* Few letters, so that two parts may have one name, which is refused. */
static inline void draw_name(byte_source *s, char name[24])
{
    if (draw_chance(s, 60)) name[0] = (char)('a' + draw_below(s, 12));
}

static inline void draw_more_environment(byte_source *s, dmb_environment_def *def)
{
    if (draw_chance(s, 80)) def->inner_density = draw_number(s, 0.0, 2000.0);
    if (draw_chance(s, 80)) def->added_mass = draw_chance(s, 128) ? -1.0 : draw_number(s, 0.0, 3.0);
    if (draw_chance(s, 60)) {
        def->flow_rate = draw_size(s, 1e-6, 1e-1);
        def->consistency = draw_size(s, 1e-4, 1.0);
        def->flow_exponent = draw_number(s, 0.2, 1.0);
        def->yield_stress = draw_chance(s, 80) ? draw_size(s, 0.1, 20.0) : 0.0;
        def->nozzle_area = draw_chance(s, 128) ? draw_size(s, 1e-6, 1e-2) : 0.0;
        def->flow_eccentricity = draw_chance(s, 100) ? draw_number(s, 0.0, 0.95) : 0.0;
    }
    draw_spoil(s, &def->inner_density, 7);
}

static inline void draw_more_wall(byte_source *s, dmb_wall_def *wall)
{
    draw_name(s, wall->name);
    if (draw_chance(s, 80)) {
        wall->cut_spacing = draw_size(s, 0.02, 3.0);
        wall->cut_end = draw_number(s, 0.0, 20.0);
    }
    if (draw_chance(s, 60)) {
        wall->direction[2] = draw_number(s, -3.0, 3.0);
        wall->origin[draw_below(s, 3)] = draw_number(s, -5.0, 5.0);
    }
    wall->bristle_stiffness = draw_size(s, 1e2, 1e6);
    wall->bristle_damping = draw_chance(s, 128) ? draw_size(s, 1e-3, 1e2) : 0.0;
    wall->impact_depth = draw_size(s, 1e-6, 1e-2);
    wall->approach_speed = draw_size(s, 1e-4, 1.0);
    draw_spoil(s, &wall->cut_spacing, 3);
}

static inline void draw_more_pipe(byte_source *s, dmb_pipe_def *pipe)
{
    draw_name(s, pipe->name);
    if (draw_chance(s, 80) && pipe->kind == DMB_PIPE_FLEXIBLE)
        pipe->contact_points = 3 + draw_below(s, 4); /* one too many */
    if (draw_chance(s, 80)) pipe->yield_strength = draw_size(s, 1e6, 1e9);
    if (draw_chance(s, 60)) {
        for (int i = 0; i < 6; i++) pipe->section_stiffness[i] = draw_chance(s, 60) ? 0.0 : draw_size(s, 1e2, 1e9);
        pipe->section_mass = draw_size(s, 0.1, 100.0);
        pipe->section_inertia[0] = draw_size(s, 1e-4, 0.1);
        pipe->section_inertia[1] = pipe->section_inertia[0];
    }
    if (draw_chance(s, 60)) {
        pipe->joint_length = draw_number(s, 0.0, 1.0) * pipe->length;
        pipe->joint_outer_diameter = draw_number(s, 0.05, 0.1);
        pipe->joint_mass = draw_chance(s, 128) ? draw_size(s, 0.1, 50.0) : 0.0;
        pipe->joint_inertia[0] = pipe->joint_inertia[1] = draw_chance(s, 128) ? draw_size(s, 1e-4, 1.0) : 0.0;
    }
}

static inline void draw_more_body(byte_source *s, dmb_body_def *body)
{
    draw_name(s, body->name);
    if (draw_chance(s, 80)) body->free_mask = DMB_FREE_NONE | DMB_FREE_X * (int32_t)draw_below(s, 64);
    if (draw_chance(s, 80)) body->centre[draw_below(s, 3)] = draw_number(s, -0.5, 0.5);
    if (draw_chance(s, 80)) body->rotation[draw_below(s, 3)] = draw_number(s, -4.0, 4.0);
    if (draw_chance(s, 80)) body->inertia[3 + draw_below(s, 3)] = draw_number(s, -1e-3, 1e-3);
    if (draw_chance(s, 80)) body->displaced_volume = draw_size(s, 1e-5, 1e-1);
    if (draw_chance(s, 80)) body->added_mass[draw_below(s, 2)] = draw_size(s, 1e-3, 10.0);
    draw_spoil(s, &body->displaced_volume, 3);
}

static inline void draw_more_bit(byte_source *s, dmb_bit_def *bit)
{
    draw_name(s, bit->name);
    if (draw_chance(s, 100)) {
        bit->side_cutting = draw_size(s, 1e-3, 1e3);
        bit->walk_angle = draw_number(s, -1.5, 1.5);
        bit->diameter = 0.0;
    }
    if (draw_chance(s, 60)) bit->inner_radius = draw_number(s, 0.0, 0.05);
    if (draw_chance(s, 60)) bit->wear_length = draw_size(s, 1e-5, 1e-2);
    if (draw_chance(s, 60)) bit->displaced_volume = draw_size(s, 1e-5, 1e-1);
    if (draw_chance(s, 60)) bit->added_mass[draw_below(s, 2)] = draw_size(s, 1e-3, 10.0);
    draw_spoil(s, &bit->side_cutting, 2);
}

static inline void draw_curve(byte_source *s, dmb_drive_def *drive)
{
    drive->curve_count = draw_below(s, 10); /* one too many */
    for (uint32_t i = 0; i < drive->curve_count && i < 8; i++) {
        drive->curve_speed[i] = (i > 0 ? drive->curve_speed[i - 1] : 0.0) + draw_size(s, 1e-3, 10.0);
        drive->curve_force[i] = draw_size(s, 1.0, 1e4);
    }
}

static inline void draw_gains(byte_source *s, dmb_drive_def *drive)
{
    drive->gain = 0.0;
    drive->gain_count = 2 + draw_below(s, 16); /* one too many */
    for (uint32_t i = 0; i < drive->gain_count && i < 16; i++) {
        drive->gain_error[i] = (i > 0 ? drive->gain_error[i - 1] : -5.0) + draw_size(s, 1e-3, 10.0);
        drive->gain_force[i] = draw_number(s, -1e4, 1e4);
    }
}

static inline void draw_more_drive(byte_source *s, dmb_drive_def *drive)
{
    draw_name(s, drive->name);
    if (draw_chance(s, 60)) drive->inertia = draw_size(s, 1e-3, 10.0);
    if (draw_chance(s, 80)) drive->limit_low = -draw_size(s, 1.0, 1e5);
    if (draw_chance(s, 80)) drive->limit_high = draw_size(s, 1.0, 1e5);
    if (!draw_chance(s, drive->kind == DMB_DRIVE_MOTION ? 10 : 100)) return;
    if (draw_chance(s, 60)) drive->delay = draw_size(s, 1e-6, 1e-1);
    if (draw_chance(s, 60)) drive->force_rate = draw_size(s, 1e2, 1e8);
    if (draw_chance(s, 60)) drive->lag = draw_size(s, 1e-6, 1e-1);
    if (draw_chance(s, 60)) drive->drag = draw_size(s, 1e-2, 1e3);
    if (draw_chance(s, 60)) drive->back_drag = draw_size(s, 1e-2, 1e3);
    if (draw_chance(s, 60)) draw_curve(s, drive);
    if (draw_chance(s, 60) && drive->kind == DMB_DRIVE_CONTROL) draw_gains(s, drive);
    draw_spoil(s, &drive->delay, 6);
}

static inline void draw_more_joint(byte_source *s, dmb_joint_def *joint)
{
    draw_name(s, joint->name);
    if (draw_chance(s, 60)) joint->origin_a[draw_below(s, 3)] = draw_number(s, -1.0, 1.0);
    if (draw_chance(s, 60)) joint->normal_a[draw_below(s, 3)] = draw_number(s, -1.0, 1.0);
    if (draw_chance(s, 60)) joint->rest[draw_below(s, 6)] = draw_number(s, -1.0, 1.0);
    if (draw_chance(s, 60)) {
        joint->initial_mask = DMB_FREE_NONE | DMB_FREE_X * (int32_t)draw_below(s, 64);
        joint->initial_position[draw_below(s, 6)] = draw_number(s, -0.5, 0.5);
        joint->initial_speed[draw_below(s, 6)] = draw_number(s, -1.0, 1.0);
    }
}

static inline void draw_more_load(byte_source *s, dmb_load_def *load)
{
    draw_name(s, load->name);
    if (draw_chance(s, 100)) load->offset[draw_below(s, 3)] = draw_number(s, -0.2, 0.2);
    if (load->place.part.index >> 24 != DMB_PART_STRING)
        load->place.fraction = 0.0;
    else if (draw_chance(s, 60))
        load->place.fraction = draw_number(s, 0.0, 1.0);
}

#endif
