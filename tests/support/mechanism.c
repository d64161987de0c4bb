#include "mechanism.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const dmb_id ground_id = {0, 0};

/* ---- Parts ------------------------------------------------------------------------------------------------------- */

dmb_body_def bar_body(const bar *def)
{
    const double dx = def->to[0] - def->from[0], dz = def->to[1] - def->from[1];
    dmb_body_def body = dmb_body_def_default();
    body.mass = def->mass;
    body.inertia[1] = body.inertia[2] = def->mass * (dx * dx + dz * dz) / 12.0;
    body.inertia[0] = 1e-3 * body.inertia[1];
    body.position[0] = 0.5 * (def->from[0] + def->to[0]);
    body.position[2] = 0.5 * (def->from[1] + def->to[1]);
    body.rotation[1] = -atan2(dz, dx);
    return body;
}

dmb_id add_bar(rig *s, const bar *def)
{
    const dmb_body_def body = bar_body(def);
    return add_body(s, &body);
}

pin pin_ground(double x, double z)
{
    const pin p = {ground_id, x, z};
    return p;
}

pin pin_on(dmb_id part, double x)
{
    const pin p = {part, x, 0.0};
    return p;
}

dmb_joint_def hinge_of(const char *name, int32_t kind, pin a, pin b)
{
    dmb_joint_def def = dmb_joint_def_default();
    (void)snprintf(def.name, sizeof def.name, "%s", name);
    def.kind = kind;
    def.place_a = dmb_station(a.part, 0, 0.0);
    def.place_b = dmb_station(b.part, 0, 0.0);
    def.origin_a[0] = a.x;
    def.origin_a[2] = a.z;
    def.origin_b[0] = b.x;
    def.origin_b[2] = b.z;
    def.axis_a[0] = def.axis_b[0] = 0.0;
    def.axis_a[1] = def.axis_b[1] = -1.0;
    def.normal_a[0] = def.normal_b[0] = 1.0;
    return def;
}

dmb_id add_hinge(rig *s, const char *name, int32_t kind, pin a, pin b)
{
    const dmb_joint_def def = hinge_of(name, kind, a, b);
    return add_joint(s, &def);
}

/* ---- Ask --------------------------------------------------------------------------------------------------------- */

dmb_joint_state joint_at(const rig *s, dmb_id joint)
{
    dmb_joint_state state = dmb_joint_state_default();
    must(s, dmb_query_joint(s->sim, joint, &state));
    return state;
}

uint32_t multipliers_of(const rig *s, dmb_id part, double multipliers[6])
{
    uint32_t count = 0;
    must(s, dmb_query_multipliers(s->sim, part, multipliers, &count));
    return count;
}

double motion_difference(const rig *a, const rig *b, const dmb_id *parts_a, const dmb_id *parts_b, uint32_t count)
{
    double most = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const dmb_place at = dmb_station(parts_a[i], 0, 0.0), bt = dmb_station(parts_b[i], 0, 0.0);
        const dmb_pose pa = pose_at(a, at), pb = pose_at(b, bt);
        const dmb_motion va = motion_at(a, at, DMB_FRAME_WORLD), vb = motion_at(b, bt, DMB_FRAME_WORLD);
        most = fmax(most, largest_difference(3, pa.position, pb.position));
        most = fmax(most, largest_difference(9, pa.rotation, pb.rotation));
        most = fmax(most, largest_difference(6, va.velocity, vb.velocity));
    }
    return most;
}

dmb_sim_options sharp_options(double spectral_radius, double tolerance)
{
    dmb_sim_options options = dmb_sim_options_default();
    options.spectral_radius = spectral_radius;
    options.newton_tolerance = tolerance;
    return options;
}

/* ---- Refusals ---------------------------------------------------------------------------------------------------- */

static void keep_text(void *context, int32_t level, const char *text)
{
    refusal *kept = (refusal *)context;
    (void)level;
    (void)snprintf(kept->text, sizeof kept->text, "%s", text);
}

static refusal create(rig *s, const dmb_sim_options *options)
{
    refusal kept;
    dmb_sim_options with = options == NULL ? dmb_sim_options_default() : *options;
    memset(&kept, 0, sizeof kept);
    with.log = keep_text;
    with.log_context = &kept;
    must_model(s, dmb_model_compile(s->model, NULL));
    kept.status = dmb_sim_create(s->model, &with, &s->sim);
    return kept;
}

int32_t mechanism_start(rig *s, const dmb_sim_options *options)
{
    const refusal said = create(s, options);
    if (said.status < 0) fail_msg("dmb_sim_create: %s: %s", dmb_status_name(said.status), said.text);
    return said.status;
}

refusal refused_start(rig *s)
{
    return create(s, NULL);
}

double energy_now(const rig *s)
{
    const dmb_energy e = energy_of(s);
    return e.kinetic + e.strain;
}

double largest_energy(const rig *s, double h, uint32_t steps)
{
    const double before = energy_now(s);
    double most = 0.0;
    for (uint32_t i = 0; i < steps; i++) {
        const int32_t status = dmb_sim_step(s->sim, h, NULL);
        assert_true(status == DMB_OK || status == DMB_NOTE_STEP_CUT);
        most = fmax(most, energy_now(s) / before);
    }
    return most;
}
