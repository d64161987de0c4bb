/* Fingerprint of a scene by FNV-1a with 64 bits (Fowler, Noll, Vo), which detects mistakes, not forgery.
 *
 * Its purpose is to refuse a snapshot of another model. Hashed are the numbers that steps read, in the order of the
 * arrays, so the same description compiled in another process has the same value. Not hashed are addresses and stamps,
 * names, and the content of callbacks, of which only the declared numbers are known: whoever restores has to give the
 * same functions. Numbers of parts come first, so that two lists of different lengths cannot be read as each other's.
 */
#include "run/run.h"

#include <stddef.h>
#include <string.h>

/* Hashes member by member, without padding and pointers. */
#define DMB_NUMBERS(hash, array) dmb_fnv_numbers((hash), (array), sizeof(array) / sizeof(double))

static uint64_t add_counts(uint64_t h, const dmb_scene *s)
{
    const uint32_t counts[] = {s->node_count,
                               s->row_count,
                               s->element_count,
                               s->type_count,
                               s->rigid_mass_count,
                               s->site_count,
                               s->axial_torsional_site_count,
                               s->drive_count,
                               s->load_count,
                               s->bit_count,
                               s->time_function_count,
                               s->string_count,
                               s->pipe_count,
                               s->body_count,
                               s->history_count,
                               s->free_count,
                               s->prescribed_count,
                               s->chain_count,
                               s->batch_count,
                               s->joint_count,
                               s->coupling_count,
                               s->callback_count,
                               s->constraint_count};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; ++i) h = dmb_fnv_word(h, counts[i]);
    h = dmb_fnv_word(h, (uint32_t)s->features);
    h = DMB_NUMBERS(h, s->gravity);
    h = dmb_fnv_number(h, s->mass);
    return dmb_fnv_number(h, s->length);
}

static uint64_t add_nodes(uint64_t h, const dmb_scene *s)
{
    const size_t n = s->node_count;
    h = dmb_fnv_numbers(h, s->reference_position, 3 * n);
    h = dmb_fnv_numbers(h, s->reference_quaternion, 4 * n);
    h = dmb_fnv_numbers(h, s->weight_mass, n);
    h = dmb_fnv_numbers(h, s->weight_moment, 3 * n);
    h = dmb_fnv_numbers(h, s->node_damping, 5 * n);
    h = dmb_fnv_block(h, s->solved_row, s->row_count);
    return dmb_fnv_block(h, s->layout.size, n);
}

/* Of a bent element the mass alone: its other constants follow from those of the section and the rest shape. */
static uint64_t add_type(uint64_t h, const dmb_element_type *t)
{
    h = dmb_fnv_number(h, t->length);
    h = DMB_NUMBERS(h, t->stiffness);
    h = DMB_NUMBERS(h, t->rest);
    h = DMB_NUMBERS(h, t->arm);
    h = dmb_fnv_number(h, t->damping_time);
    h = DMB_NUMBERS(h, t->mass.axial);
    h = DMB_NUMBERS(h, t->mass.torsion);
    h = DMB_NUMBERS(h, t->mass.bending[0]);
    h = DMB_NUMBERS(h, t->mass.bending[1]);
    return dmb_element_is_curved(t) ? dmb_fnv_number(h, t->curved.mass) : h;
}

static uint64_t add_elements(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->type_count; ++i) h = add_type(h, &s->types[i]);
    for (uint32_t i = 0; i < s->element_count; ++i) h = dmb_fnv_word(h, s->element_type[i]);
    for (uint32_t i = 0; i < s->rigid_mass_count; ++i) {
        const dmb_rigid_mass *rigid_mass = &s->rigid_masses[i];
        h = dmb_fnv_word(h, rigid_mass->node);
        h = dmb_fnv_number(h, rigid_mass->mass);
        h = DMB_NUMBERS(h, rigid_mass->moment);
        h = DMB_NUMBERS(h, rigid_mass->inertia);
    }
    for (uint32_t i = 0; i < s->added_mass_count; ++i) {
        h = dmb_fnv_word(h, s->added_masses[i].node);
        h = dmb_fnv_number(h, s->added_masses[i].along);
        h = DMB_NUMBERS(h, s->added_masses[i].across);
    }
    return h;
}

/* The laws as compiled: mu follows from the restitution of the description. A parameter that is missing here lets a
 * snapshot into a model in which it differs; those of friction are all members from the first to the table. */
static uint64_t add_laws(uint64_t h, const dmb_normal_law *n, const dmb_friction_law *f)
{
    enum { FIRST = offsetof(dmb_friction_law, mu_static), END = offsetof(dmb_friction_law, table_speed) };
    const double normal[] = {n->stiffness, n->exponent, n->damping, n->impact_depth, n->mu, n->impact_floor};
    double friction[(END - FIRST) / sizeof(double)];
    memcpy(friction, (const char *)f + FIRST, sizeof friction);
    h = dmb_fnv_word(h, (uint32_t)n->kind);
    h = dmb_fnv_word(h, (uint32_t)f->kind);
    if (f->kind == DMB_FRICTION_CALLBACK) h = dmb_fnv_word(h, f->states); /* its function cannot be hashed */
    for (int i = 0; i < f->points; ++i) {
        h = dmb_fnv_number(h, f->table_speed[i]);
        h = dmb_fnv_number(h, f->table_mu[i]);
    }
    h = DMB_NUMBERS(h, normal);
    return DMB_NUMBERS(h, friction);
}

/* Stations by depth and tangent: points and curvatures follow from them by eq:hole.arc. Cutters change the radius of
 * stations in a run, hence what determines their paths (face and length of bits) belongs to the wall. */
static uint64_t add_wall(uint64_t h, const dmb_scene *s)
{
    if (!s->has_hole) return dmb_fnv_word(h, 0);
    h = add_laws(h, &s->normal_law, &s->friction_law);
    h = DMB_NUMBERS(h, s->hole.origin);
    h = DMB_NUMBERS(h, s->hole.direction);
    h = dmb_fnv_number(h, s->hole.radius);
    for (uint32_t i = 0; i < s->hole.stations; ++i) {
        h = dmb_fnv_number(h, s->hole.station[i].depth);
        h = DMB_NUMBERS(h, s->hole.station[i].tangent);
    }
    for (uint32_t i = 0; i < s->hole.pieces; ++i) {
        h = dmb_fnv_number(h, s->hole.piece[i].depth);
        h = DMB_NUMBERS(h, s->hole.piece[i].value);
        h = DMB_NUMBERS(h, s->hole.piece[i].slope);
    }
    if (s->hole.cuts > 0) {
        h = dmb_fnv_word(h, s->hole.cuts);
        h = dmb_fnv_number(h, s->hole.cut_start);
        h = dmb_fnv_number(h, s->hole.cut_spacing);
        for (uint32_t i = 0; i < s->bit_count; ++i) {
            h = dmb_fnv_number(h, s->bits[i].face);
            h = dmb_fnv_number(h, s->bits[i].length);
        }
    }
    for (uint32_t i = 0; i < s->site_count; ++i) {
        h = dmb_fnv_number(h, s->sites[i].clearance);
        h = dmb_fnv_number(h, s->sites[i].length);
        h = dmb_fnv_number(h, s->sites[i].offset);
        h = dmb_fnv_number(h, s->sites[i].radius);
    }
    for (uint32_t i = 0; i < s->inside_count; ++i) h = dmb_fnv_number(h, s->inside[i].fraction);
    for (uint32_t i = 0; i < s->axial_torsional_site_count; ++i) {
        h = dmb_fnv_number(h, s->axial_torsional_sites[i].length);
        h = dmb_fnv_number(h, s->axial_torsional_sites[i].radius);
    }
    return h;
}

static uint64_t add_segment(uint64_t h, const dmb_segment *t)
{
    const double numbers[] = {t->x0, t->x1, t->h0, t->h1, t->omega, t->phase};
    const double swing[] = {t->share, t->order};
    h = dmb_fnv_word(h, (uint32_t)t->kind);
    h = DMB_NUMBERS(h, numbers);
    h = dmb_fnv_numbers(h, t->table_time, t->table_count);
    h = dmb_fnv_numbers(h, t->table_value, t->table_count);
    if (t->kind != DMB_SEGMENT_PER_REVOLUTION) return h;
    h = dmb_fnv_word(h, t->of.index);
    return DMB_NUMBERS(h, swing);
}

static uint64_t add_time_functions(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->time_function_count; ++i) {
        const dmb_time_function *time_function = &s->time_functions[i];
        h = dmb_fnv_word(h, time_function->count);
        for (uint32_t k = 0; k < time_function->count; ++k) h = add_segment(h, &time_function->segments[k]);
    }
    return h;
}

static uint64_t add_drives(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->drive_count; ++i) {
        const dmb_scene_drive *drive = &s->drives[i];
        const double numbers[] = {drive->gain, drive->integral_gain, drive->limit_low, drive->limit_high};
        h = dmb_fnv_word(h, drive->row);
        h = dmb_fnv_word(h, drive->joint);
        h = dmb_fnv_word(h, (uint32_t)drive->component);
        h = dmb_fnv_word(h, (uint32_t)drive->kind);
        h = dmb_fnv_word(h, drive->time_function);
        h = dmb_fnv_word(h, drive->excitation);
        h = DMB_NUMBERS(h, numbers);
    }
    for (uint32_t i = 0; i < s->actuator_count; ++i) {
        const dmb_actuator_law *law = &s->actuators[i];
        const double numbers[] = {law->delay, law->rate_limit, law->lag, law->drag[0], law->drag[1]};
        h = DMB_NUMBERS(h, numbers);
        h = dmb_fnv_numbers(h, law->speed, law->points);
        h = dmb_fnv_numbers(h, law->force, law->points);
    }
    for (uint32_t i = 0; i < s->gain_table_count; ++i) {
        h = dmb_fnv_numbers(h, s->gain_tables[i].error, s->gain_tables[i].points);
        h = dmb_fnv_numbers(h, s->gain_tables[i].force, s->gain_tables[i].points);
    }
    return h;
}

static uint64_t add_point(uint64_t h, const dmb_scene_point *point)
{
    h = DMB_NUMBERS(h, point->x);
    h = dmb_fnv_number(h, point->fraction);
    h = dmb_fnv_word(h, point->node);
    return dmb_fnv_word(h, point->element);
}

static uint64_t add_loads(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->load_count; ++i) {
        const dmb_scene_load *load = &s->loads[i];
        h = dmb_fnv_word(h, load->node);
        h = dmb_fnv_word(h, (uint32_t)load->frame);
        h = dmb_fnv_word(h, load->time_function);
        h = dmb_fnv_number(h, load->arm);
        h = DMB_NUMBERS(h, load->force);
        h = DMB_NUMBERS(h, load->moment);
        if (load->point != DMB_NONE) h = add_point(h, &s->load_points[load->point]);
    }
    return h;
}

/* Numbers of laws that a bit does not have are left out: steps do not read them, and bits that differ in them alone
 * move alike. */
static uint64_t add_bits(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->bit_count; ++i) {
        const dmb_scene_bit *bit = &s->bits[i];
        const dmb_bit_rock_law *law = &bit->law;
        const double numbers[] = {law->radius,           law->intrinsic_energy, law->cutting_ratio,
                                  law->contact_strength, law->wear_length,      law->contact_friction,
                                  law->intrusion_depth,  bit->bottom,           bit->arm};
        const double side[] = {bit->side.resistance, bit->side.cosine, bit->side.sine};
        h = dmb_fnv_word(h, (uint32_t)law->kind);
        h = dmb_fnv_word(h, law->blades);
        h = dmb_fnv_word(h, bit->load);
        h = dmb_fnv_word(h, bit->history_capacity);
        h = DMB_NUMBERS(h, numbers);
        if (bit->side.resistance > 0.0) h = DMB_NUMBERS(h, side);
        if (bit->law.inner_radius > 0.0) h = dmb_fnv_number(h, bit->law.inner_radius);
        if (bit->reamer) h = dmb_fnv_word(h, bit->node);
    }
    return h;
}

static uint64_t add_springs(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->spring_count; ++i) {
        const dmb_scene_spring *spring = &s->springs[i];
        const dmb_spring_law *law = &spring->law;
        const double numbers[] = {spring->free_length, law->stiffness, law->damping, law->preload};
        h = add_point(h, &spring->a);
        h = add_point(h, &spring->b);
        h = DMB_NUMBERS(h, spring->span);
        h = DMB_NUMBERS(h, numbers);
        h = dmb_fnv_word(h, (uint32_t)law->acts);
        h = dmb_fnv_word(h, law->count);
    }
    for (uint32_t i = 0; i < s->spring_point_count; ++i) {
        const dmb_spring_point *point = &s->spring_points[i];
        const double numbers[] = {point->elongation, point->force, point->slope[0], point->slope[1]};
        h = DMB_NUMBERS(h, numbers);
    }
    return h;
}

static uint64_t add_stuck(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->stuck_count; ++i) {
        h = add_point(h, &s->stuck[i].point);
        h = DMB_NUMBERS(h, s->stuck[i].stiffness);
        h = DMB_NUMBERS(h, s->stuck[i].damping);
        h = DMB_NUMBERS(h, s->stuck[i].release);
    }
    return h;
}

/* As for constraints, the content of callbacks cannot be hashed. */
static uint64_t add_forces(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->force_count; ++i) {
        const dmb_scene_force *force = &s->forces[i];
        h = dmb_fnv_word(h, force->count);
        h = dmb_fnv_word(h, (uint32_t)force->frame);
        h = dmb_fnv_word(h, (uint32_t)force->provides);
        h = dmb_fnv_word(h, force->states);
        h = dmb_fnv_number(h, force->pose_step);
        h = dmb_fnv_number(h, force->speed_step);
        for (uint32_t k = 0; k < force->count; ++k) {
            h = add_point(h, &force->point[k]);
            h = dmb_fnv_word(h, force->joint[k]);
            h = dmb_fnv_word(h, (uint32_t)force->component[k]);
        }
    }
    return h;
}

/* Without an input of the flow rate steps read the forces of the flow on elements and nodes only, and two muds with the
 * same forces are the same scene. */
static uint64_t add_flow(uint64_t h, const dmb_scene *s)
{
    if (s->flow_count == 0) return h;
    h = dmb_fnv_numbers(h, s->flow_element, s->element_count);
    h = dmb_fnv_number(h, dmb_nozzle_thrust(&s->flow));
    if (s->has_flow_input) { /* with an input of the flow rate, these depend on it */
        const double mud[] = {s->flow.consistency, s->flow.exponent, s->flow.yield_stress, s->flow.eccentricity,
                              s->flow.nozzle_area, s->flow.inside,   s->flow.outside};
        h = DMB_NUMBERS(h, mud);
        for (uint32_t i = 0; i < s->flow_count; ++i) {
            h = DMB_NUMBERS(h, s->flow_pieces[i].diameter);
            h = dmb_fnv_number(h, s->flow_pieces[i].hole);
        }
    }
    return dmb_fnv_numbers(h, s->flow_node, 2 * (size_t)s->node_count);
}

static uint64_t add_frame(uint64_t h, const dmb_scene_frame *frame)
{
    h = dmb_fnv_word(h, frame->node);
    h = DMB_NUMBERS(h, frame->x);
    return DMB_NUMBERS(h, frame->M);
}

/* Members of dmb_joint_law are all numbers. */
static uint64_t add_joint_laws(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->law_count; ++i) {
        const dmb_joint_law *law = &s->laws[i];
        const double numbers[] = {law->stiffness, law->damping,        law->rest,
                                  law->friction,  law->friction_speed, law->stop_low,
                                  law->stop_high, law->stop_stiffness, law->stop_damping};
        h = DMB_NUMBERS(h, numbers);
    }
    return h;
}

static uint64_t add_joints(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->joint_count; ++i) {
        const dmb_scene_joint *joint = &s->joints[i];
        h = add_frame(h, &joint->a);
        h = add_frame(h, &joint->b);
        h = DMB_NUMBERS(h, joint->span);
        h = dmb_fnv_number(h, joint->length);
        h = DMB_NUMBERS(h, joint->initial_position);
        h = DMB_NUMBERS(h, joint->initial_speed);
        h = dmb_fnv_word(h, (uint32_t)joint->kind);
        h = dmb_fnv_word(h, (uint32_t)joint->state);
        h = dmb_fnv_word(h, (uint32_t)joint->initial_mask);
        h = dmb_fnv_word(h, joint->law);
    }
    return add_joint_laws(h, s);
}

/* factor[0] is 1 in every coupling; the others are minus the ratios of the description. */
static uint64_t add_couplings(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->coupling_count; ++i) {
        const dmb_scene_coupling *coupling = &s->couplings[i];
        for (uint32_t k = 1; k < coupling->count; ++k) h = dmb_fnv_number(h, -coupling->factor[k]);
        for (uint32_t k = 0; k < coupling->count; ++k) {
            h = dmb_fnv_word(h, coupling->joint[k]);
            h = dmb_fnv_word(h, (uint32_t)coupling->component[k]);
        }
    }
    return h;
}

/* The content of the caller's functions cannot be derived from their addresses. */
static uint64_t add_callbacks(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->callback_count; ++i) {
        const dmb_scene_callback *callback = &s->callbacks[i];
        h = dmb_fnv_word(h, callback->rows);
        h = dmb_fnv_word(h, callback->count);
        h = dmb_fnv_word(h, (uint32_t)callback->kind);
        h = dmb_fnv_word(h, (uint32_t)callback->provides);
        for (uint32_t k = 0; k < callback->count; ++k) h = add_frame(h, &callback->place[k]);
    }
    return h;
}

/* Constraints and components are derived from other parts; their order is hashed nevertheless. */
static uint64_t add_constraints(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->constraint_count; ++i) {
        const dmb_constraint *constraint = &s->constraints[i];
        h = dmb_fnv_word(h, (uint32_t)constraint->kind);
        h = dmb_fnv_word(h, constraint->index);
        h = dmb_fnv_word(h, constraint->cluster);
    }
    return h;
}

static uint64_t add_inputs(uint64_t h, const dmb_scene *s)
{
    for (uint32_t i = 0; i < s->input_count; ++i) {
        const dmb_scene_input *input = &s->inputs[i];
        const double numbers[] = {input->initial, input->low, input->high, input->rate_limit, input->slope_limit};
        h = dmb_fnv_word(h, (uint32_t)input->target);
        h = dmb_fnv_word(h, input->index);
        h = DMB_NUMBERS(h, numbers);
    }
    for (uint32_t i = 0; i < s->event_count; ++i) {
        const dmb_scene_event *event = &s->events[i];
        const double numbers[] = {event->level, event->hold, event->tolerance, event->output.place.fraction};
        h = dmb_fnv_word(h, (uint32_t)event->direction);
        h = dmb_fnv_word(h, (uint32_t)event->output.quantity);
        h = dmb_fnv_word(h, event->output.place.part.index);
        h = dmb_fnv_word(h, event->output.place.pipe);
        h = DMB_NUMBERS(h, numbers);
    }
    return h;
}

/* The order of the calls is part of the value: a change of it refuses all snapshots of before. */
uint64_t dmb_scene_fingerprint(const dmb_scene *scene)
{
    uint64_t h = add_counts(DMB_FNV_START, scene);
    h = add_nodes(h, scene);
    h = add_elements(h, scene);
    h = add_wall(h, scene);
    h = add_time_functions(h, scene);
    h = add_drives(h, scene);
    h = add_loads(h, scene);
    h = add_bits(h, scene);
    h = add_joints(h, scene);
    h = add_couplings(h, scene);
    h = add_callbacks(h, scene);
    h = add_inputs(h, scene);
    h = add_springs(h, scene);
    h = add_forces(h, scene);
    h = add_stuck(h, scene);
    h = add_flow(h, scene);
    return add_constraints(h, scene);
}

/* Options that decide the bits of a step; threads and progress, which do not, are left out. */
uint64_t dmb_options_fingerprint(const dmb_sim_options *options)
{
    const double numbers[] = {options->spectral_radius,    options->newton_tolerance, options->tolerance_translation,
                              options->tolerance_rotation, options->step_min,         options->step_max};
    uint64_t h = dmb_fnv_word(DMB_FNV_START, options->max_iterations);
    h = dmb_fnv_word(h, options->max_cuts);
    h = dmb_fnv_word(h, (uint32_t)options->bounded_work);
    h = dmb_fnv_word(h, (uint32_t)options->energy_ledger);
    h = dmb_fnv_word(h, (uint32_t)options->constraint_method);
    return DMB_NUMBERS(h, numbers);
}
