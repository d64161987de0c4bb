/* Values that are none: ids of other models and other kinds, places off the string, times and durations that are not
 * numbers or lead nowhere, options out of bounds. All of them are refused, and the state stays as it was. */
#include <float.h>
#include <stdlib.h>

#include "whole_scene.h"

static struct {
    whole_parts parts, other_parts;
    dmb_model *model, *other;
    dmb_sim *sim;
    uint64_t hash;
} scene;

static int set_up(void **state)
{
    (void)state;
    memset(&scene, 0, sizeof scene);
    scene.model = whole_model(&scene.parts);
    scene.other = whole_model(&scene.other_parts);
    scene.sim = whole_sim(scene.model, NULL);
    whole_run(scene.sim, 5, 1e-3);
    scene.hash = whole_hash(scene.sim);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    dmb_sim_destroy(&scene.sim);
    dmb_model_destroy(&scene.model);
    dmb_model_destroy(&scene.other);
    return 0;
}

static void refused(const char *what, int32_t status, int32_t wanted)
{
    if (status != wanted) fail_msg("%s: %s, wanted %s", what, dmb_status_name(status), dmb_status_name(wanted));
    if (whole_hash(scene.sim) != scene.hash) fail_msg("%s: the state changed", what);
}

/* ---- Ids --------------------------------------------------------------------------------------------------------- */

enum { STRING, BODY, BIT, DRIVE, TIME_FUNCTION, WALL, JOINT, COUPLING, CONSTRAINT, KINDS };

static dmb_id id_of(const whole_parts *parts, int kind)
{
    const dmb_id ids[KINDS] = {parts->string, parts->body, parts->bit,  parts->feed, parts->step,
                               parts->wall,   parts->axle, parts->gear, parts->watch};
    return ids[kind];
}

/* One question with an id, and the kinds it takes. */
typedef struct question {
    const char *name;
    int32_t (*ask)(dmb_id id);
    int takes[KINDS];
} question;

static int32_t ask_pose(dmb_id id)
{
    dmb_pose answer = dmb_pose_default();
    return dmb_query_pose(scene.sim, dmb_station(id, 0, 0.0), &answer);
}
static int32_t ask_motion(dmb_id id)
{
    dmb_motion answer = dmb_motion_default();
    return dmb_query_motion(scene.sim, dmb_station(id, 0, 0.0), &answer);
}
static int32_t ask_rotation(dmb_id id)
{
    double answer;
    return dmb_query_rotation(scene.sim, dmb_station(id, 0, 0.0), &answer);
}
static int32_t ask_kinetic_energy(dmb_id id)
{
    double answer;
    return dmb_query_kinetic_energy(scene.sim, id, 0, &answer);
}
static int32_t ask_drive(dmb_id id)
{
    dmb_drive_state answer = dmb_drive_state_default();
    return dmb_query_drive(scene.sim, id, &answer);
}
static int32_t ask_bit(dmb_id id)
{
    dmb_bit_state answer = dmb_bit_state_default();
    return dmb_query_bit(scene.sim, id, &answer);
}
static int32_t ask_section(dmb_id id)
{
    dmb_section answer = dmb_section_default();
    return dmb_query_section(scene.sim, dmb_station(id, 0, 0.0), &answer);
}
static int32_t ask_reaction(dmb_id id)
{
    double answer[6];
    return dmb_query_reaction(scene.sim, id, answer);
}
static int32_t ask_joint(dmb_id id)
{
    dmb_joint_state answer = dmb_joint_state_default();
    return dmb_query_joint(scene.sim, id, &answer);
}
static int32_t ask_multipliers(dmb_id id)
{
    double answer[6];
    uint32_t count;
    return dmb_query_multipliers(scene.sim, id, answer, &count);
}
static int32_t record(dmb_id id, int32_t quantity)
{
    dmb_recorder recorder = dmb_recorder_default();
    dmb_output output;
    double table[2];
    memset(&output, 0, sizeof output);
    output.place = dmb_station(id, 0, 0.0);
    output.quantity = quantity;
    recorder.outputs = &output;
    recorder.output_count = 1;
    recorder.table = table;
    recorder.capacity = 1;
    const int32_t status = dmb_recorder_take(&recorder, scene.sim);
    assert_int_equal(recorder.row_count, status < 0 ? 0 : 1);
    return status;
}
static int32_t record_position(dmb_id id)
{
    return record(id, DMB_OUTPUT_POSITION_X);
}
static int32_t record_drive(dmb_id id)
{
    return record(id, DMB_OUTPUT_DRIVE_SPEED);
}
static int32_t record_bit(dmb_id id)
{
    return record(id, DMB_OUTPUT_BIT_WEIGHT);
}
static int32_t record_normal_force(dmb_id id)
{
    return record(id, DMB_OUTPUT_NORMAL_FORCE);
}

/*                                            string body bit drive time function wall joint coupling constraint */
static const question questions[] = {
    {"pose", ask_pose, {1, 1, 1, 0, 0, 0}},
    {"motion", ask_motion, {1, 1, 1, 0, 0, 0}},
    {"rotation", ask_rotation, {1, 1, 1, 0, 0, 0}},
    {"kinetic_energy", ask_kinetic_energy, {1, 1, 1, 0, 0, 0}},
    {"drive", ask_drive, {0, 0, 0, 1, 0, 0}},
    {"bit", ask_bit, {0, 0, 1, 0, 0, 0}},
    {"joint", ask_joint, {0, 0, 0, 0, 0, 0, 1}},
    {"multipliers", ask_multipliers, {0, 0, 0, 0, 0, 0, 1, 1, 1}}, /* of motion drives on joints too */
    {"record position", record_position, {1, 1, 1, 0, 0, 0}},
    {"record drive", record_drive, {0, 0, 0, 1, 0, 0}},
    {"record bit", record_bit, {0, 0, 1, 0, 0, 0}},
    {"record normal force", record_normal_force, {1, 1, 1, 0, 0, 0}},
};
enum { QUESTIONS = sizeof questions / sizeof questions[0] };

static void wrong_kind_of_id_is_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < QUESTIONS; i++) {
        for (int kind = 0; kind < KINDS; kind++) {
            const int32_t wanted = questions[i].takes[kind] ? DMB_OK : DMB_ERR_ID;
            refused(questions[i].name, questions[i].ask(id_of(&scene.parts, kind)), wanted);
        }
    }
}

/* Sections and reactions are of strings and bodies; what they say of the others is their own. */
static void sections_and_reactions_refuse_other_ids(void **state)
{
    static const int kinds[] = {DRIVE, TIME_FUNCTION, WALL, JOINT, COUPLING, CONSTRAINT};
    (void)state;
    refused("section", ask_section(scene.parts.string), DMB_OK);
    refused("section of a body", ask_section(scene.parts.body), DMB_ERR_UNSUPPORTED);
    refused("reaction", ask_reaction(scene.parts.string), DMB_OK);
    refused("reaction on a body", ask_reaction(scene.parts.body), DMB_OK);
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        refused("section", ask_section(id_of(&scene.parts, kinds[i])), DMB_ERR_ID);
        refused("reaction", ask_reaction(id_of(&scene.parts, kinds[i])), DMB_ERR_ID);
    }
}

static void all_refuse(dmb_id id)
{
    for (size_t i = 0; i < QUESTIONS; i++) refused(questions[i].name, questions[i].ask(id), DMB_ERR_ID);
    refused("section", ask_section(id), DMB_ERR_ID);
    refused("reaction", ask_reaction(id), DMB_ERR_ID);
    refused("set_drive", dmb_sim_set_drive(scene.sim, id, 1.0), DMB_ERR_ID);
    refused("set_joint", dmb_sim_set_joint(scene.sim, id, DMB_JOINT_OPEN), DMB_ERR_ID);
}

static void id_of_another_model_is_refused(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++) all_refuse(id_of(&scene.other_parts, kind));
}

static void made_up_ids_are_refused(void **state)
{
    const uint32_t own = scene.parts.string.generation;
    (void)state;
    all_refuse((dmb_id){0, 0});
    all_refuse((dmb_id){0, own});
    all_refuse((dmb_id){UINT32_MAX, own});
    all_refuse((dmb_id){scene.parts.string.index, 0});
    all_refuse((dmb_id){scene.parts.string.index, own + 1});
    for (uint32_t kind = 0; kind < 256; kind += 5) all_refuse((dmb_id){kind << 24 | 0xFFFFFFu, own});
    for (uint32_t kind = 0; kind < 12; kind++) all_refuse((dmb_id){kind << 24 | 100u, own});
}

/* Describing with ids of another model, or of another kind. */
static void definitions_refuse_strange_ids(void **state)
{
    whole_parts parts;
    dmb_model *model = whole_model_until(&parts, WHOLE_CALLS - 1);
    const dmb_id strange[] = {scene.parts.string, scene.parts.step, {7, 9}, {UINT32_MAX, UINT32_MAX}, parts.wall};
    (void)state;
    for (size_t i = 0; i < sizeof strange / sizeof strange[0]; i++) {
        dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_body_def body = dmb_body_def_default();
        dmb_bit_def bit = dmb_bit_def_default();
        dmb_drive_def drive = dmb_drive_def_default();
        dmb_load_def load = dmb_load_def_default();
        dmb_joint_def joint = dmb_joint_def_default();
        dmb_coupling_def coupling = dmb_coupling_def_default();
        dmb_constraint_def constraint = dmb_constraint_def_default();
        pipe.string = body.string = bit.string = strange[i];
        body.attach = DMB_ATTACH_END;
        refused("pipes", dmb_model_add_pipes(model, &pipe, 1, NULL), DMB_ERR_ID);
        refused("body", dmb_model_add_body(model, &body, NULL), DMB_ERR_ID);
        refused("bit", dmb_model_add_bit(model, &bit, NULL), DMB_ERR_ID);
        bit.string = (dmb_id){0, 0};
        bit.load = strange[i];
        refused("bit's load", dmb_model_add_bit(model, &bit, NULL), DMB_ERR_ID);
        drive.time_function = strange[i];
        refused("drive's time function", dmb_model_add_drive(model, &drive, NULL), DMB_ERR_ID);
        drive.time_function = parts.step;
        drive.part = strange[i];
        refused("drive's part", dmb_model_add_drive(model, &drive, NULL), DMB_ERR_ID);
        drive.part = parts.string;
        drive.excitation = strange[i];
        refused("drive's excitation", dmb_model_add_drive(model, &drive, NULL), DMB_ERR_ID);
        load.place = dmb_station(strange[i], 0, 1.0);
        refused("load's place", dmb_model_add_load(model, &load, NULL), DMB_ERR_ID);
        load.place = dmb_station(parts.string, 0, 1.0);
        load.time_function = strange[i];
        refused("load's time function", dmb_model_add_load(model, &load, NULL), DMB_ERR_ID);
        joint.place_b = dmb_station(parts.string, 0, 1.0);
        joint.place_a = dmb_station(strange[i], 0, 0.0);
        refused("joint's place a", dmb_model_add_joint(model, &joint, NULL), DMB_ERR_ID);
        joint.place_a = dmb_station(parts.string, 0, 0.0);
        joint.place_b = dmb_station(strange[i], 0, 0.0);
        refused("joint's place b", dmb_model_add_joint(model, &joint, NULL), DMB_ERR_ID);
        coupling.joint[0] = coupling.joint[1] = strange[i];
        refused("coupling's joint", dmb_model_add_coupling(model, &coupling, NULL), DMB_ERR_ID);
        constraint.place[0] = dmb_station(strange[i], 0, 0.0);
        refused("constraint's place", dmb_model_add_constraint(model, &constraint, NULL), DMB_ERR_ID);
        assert_true(dmb_model_message(model)[0] != '\0');
    }
    whole_must(model, dmb_model_clear_refused(model));
    whole_must(model, dmb_model_compile(model, NULL)); /* none of it has been taken */
    dmb_model_destroy(&model);
}

/* ---- Places ------------------------------------------------------------------------------------------------------ */

static int32_t ask_all_at(dmb_place place)
{
    dmb_pose pose = dmb_pose_default();
    dmb_motion motion = dmb_motion_default();
    dmb_section section = dmb_section_default();
    double angle = 7.0;
    const dmb_pose before = pose;
    const int32_t status = dmb_query_pose(scene.sim, place, &pose);
    if (status < 0) assert_memory_equal(&pose, &before, sizeof pose);
    assert_int_equal(dmb_query_motion(scene.sim, place, &motion), status);
    assert_int_equal(dmb_query_rotation(scene.sim, place, &angle), status);
    if (status < 0) assert_int_equal(dmb_query_section(scene.sim, place, &section), status);
    if (status < 0) assert_true(angle == 7.0);
    return status;
}

static void places_off_the_string_are_refused(void **state)
{
    static const double bad[] = {-1e-15, -1.0, 1.0 + 1e-15, 2.0, 1e300, -DBL_MAX};
    static const double strange[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    const dmb_id string = scene.parts.string, body = scene.parts.body;
    (void)state;
    for (uint32_t pipe = 0; pipe < WHOLE_PIPES; pipe++) {
        for (size_t i = 0; i < 6; i++)
            refused("fraction", ask_all_at(dmb_station(string, pipe, bad[i])), DMB_ERR_VALUE);
        for (size_t i = 0; i < 3; i++)
            refused("fraction", ask_all_at(dmb_station(string, pipe, strange[i])), DMB_ERR_NOT_FINITE);
        refused("fraction 0", ask_all_at(dmb_station(string, pipe, 0.0)), DMB_OK);
        refused("fraction -0", ask_all_at(dmb_station(string, pipe, -0.0)), DMB_OK);
        refused("fraction 1", ask_all_at(dmb_station(string, pipe, 1.0)), DMB_OK);
        refused("denormal fraction", ask_all_at(dmb_station(string, pipe, 4.9e-324)), DMB_OK);
    }
    refused("pipe", ask_all_at(dmb_station(string, WHOLE_PIPES, 0.5)), DMB_ERR_VALUE);
    refused("pipe", ask_all_at(dmb_station(string, UINT32_MAX, 0.5)), DMB_ERR_VALUE);
    refused("pipe of a body", ask_all_at(dmb_station(body, 1, 0.0)), DMB_ERR_VALUE);
    refused("fraction of a body", ask_all_at(dmb_station(body, 0, 0.5)), DMB_ERR_VALUE);
    refused("fraction of a body", ask_all_at(dmb_station(body, 0, (double)NAN)), DMB_ERR_NOT_FINITE);
}

static void other_numbers_of_questions_are_checked(void **state)
{
    dmb_contact contact = dmb_contact_default();
    dmb_motion motion = dmb_motion_default();
    dmb_model_info info = dmb_model_info_default();
    static const int32_t frames[] = {-1, DMB_FRAME_HOLE, 3, INT32_MAX, INT32_MIN};
    dmb_joint_state joint = dmb_joint_state_default();
    double energy = 3.0;
    (void)state;
    assert_int_equal(dmb_model_get_info(scene.model, &info), DMB_OK);
    refused("last site", dmb_query_contact(scene.sim, info.contact_points - 1, &contact), DMB_OK);
    refused("site", dmb_query_contact(scene.sim, info.contact_points, &contact), DMB_ERR_VALUE);
    refused("site", dmb_query_contact(scene.sim, UINT32_MAX, &contact), DMB_ERR_VALUE);
    refused("pipe", dmb_query_kinetic_energy(scene.sim, scene.parts.string, WHOLE_PIPES, &energy), DMB_ERR_VALUE);
    refused("pipe", dmb_query_kinetic_energy(scene.sim, scene.parts.body, 1, &energy), DMB_ERR_VALUE);
    assert_true(energy == 3.0);
    for (size_t i = 0; i < sizeof frames / sizeof frames[0]; i++) {
        motion.frame = frames[i];
        joint.frame = frames[i];
        refused("frame", dmb_query_joint(scene.sim, scene.parts.hinge, &joint), DMB_ERR_VALUE);
        refused("frame", dmb_query_motion(scene.sim, dmb_station(scene.parts.string, 0, 0.0), &motion), DMB_ERR_VALUE);
    }
}

/* ---- Durations and times ----------------------------------------------------------------------------------------- */

static void durations_that_lead_nowhere_are_refused(void **state)
{
    static const double strange[] = {(double)NAN, -(double)NAN, (double)INFINITY, -(double)INFINITY};
    static const double bad[] = {0.0, -0.0, -1.0, -1e-300, -DBL_MAX, 4.9e-324, DBL_MIN, 1e-25};
    (void)state;
    for (size_t i = 0; i < 4; i++) refused("duration", dmb_sim_step(scene.sim, strange[i], NULL), DMB_ERR_NOT_FINITE);
    for (size_t i = 0; i < 8; i++) refused("duration", dmb_sim_step(scene.sim, bad[i], NULL), DMB_ERR_VALUE);
    for (size_t i = 0; i < 4; i++) {
        refused("duration", dmb_sim_step(scene.sim, strange[i], NULL), DMB_ERR_NOT_FINITE);
        assert_non_null(strstr(dmb_sim_message(scene.sim), "duration"));
    }
}

/* Too long to be done: refused for good or failed, in bounded time, with the state as it was. */
static void endless_duration_ends(void **state)
{
    static const double durations[] = {1e300, DBL_MAX, 1e30};
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        const int32_t status = dmb_sim_step(scene.sim, durations[i], NULL);
        assert_true(status < 0);
        refused("duration", status, status);
        assert_true(dmb_sim_message(scene.sim)[0] != '\0');
    }
}

static void times_that_are_not_ahead_are_refused(void **state)
{
    static const double strange[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    const double now = dmb_sim_time(scene.sim);
    const double bad[] = {now, 0.0, -1.0, now - 1e-12, -DBL_MAX, 4.9e-324};
    (void)state;
    for (size_t i = 0; i < 3; i++) refused("time", dmb_sim_advance(scene.sim, strange[i], NULL), DMB_ERR_NOT_FINITE);
    for (size_t i = 0; i < 6; i++) {
        refused("time", dmb_sim_advance(scene.sim, bad[i], NULL), DMB_ERR_VALUE);
        assert_non_null(strstr(dmb_sim_message(scene.sim), "time"));
    }
}

/* ---- Drives ------------------------------------------------------------------------------------------------------ */

static void drives_are_set_to_numbers(void **state)
{
    (void)state;
    refused("infinity", dmb_sim_set_drive(scene.sim, scene.parts.turning, (double)INFINITY), DMB_ERR_NOT_FINITE);
    refused("-infinity", dmb_sim_set_drive(scene.sim, scene.parts.turning, -(double)INFINITY), DMB_ERR_NOT_FINITE);
    refused("too much", dmb_sim_set_drive(scene.sim, scene.parts.turning, 1.1e30), DMB_ERR_VALUE);
    refused("too much", dmb_sim_set_drive(scene.sim, scene.parts.turning, -DBL_MAX), DMB_ERR_VALUE);
    refused("motion", dmb_sim_set_drive(scene.sim, scene.parts.feed, 1.0), DMB_ERR_UNSUPPORTED);
    refused("motion", dmb_sim_set_drive(scene.sim, scene.parts.feed, (double)NAN), DMB_ERR_UNSUPPORTED);
    for (int kind = 0; kind < KINDS; kind++) {
        if (kind == DRIVE) continue;
        refused("id", dmb_sim_set_drive(scene.sim, id_of(&scene.parts, kind), 1.0), DMB_ERR_ID);
    }
    assert_true(dmb_sim_message(scene.sim)[0] != '\0');
}

static void joints_are_set_to_states(void **state)
{
    static const int32_t bad[] = {-1, 3, INT32_MIN, INT32_MAX};
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        refused("state", dmb_sim_set_joint(scene.sim, scene.parts.hinge, bad[i]), DMB_ERR_VALUE);
        assert_non_null(strstr(dmb_sim_message(scene.sim), "state"));
    }
    for (int kind = 0; kind < KINDS; kind++) {
        if (kind == JOINT) continue;
        refused("id", dmb_sim_set_joint(scene.sim, id_of(&scene.parts, kind), DMB_JOINT_OPEN), DMB_ERR_ID);
    }
}

static void motion_drive_on_a_joint_has_a_multiplier(void **state)
{
    double answer[6];
    uint32_t count = 0;
    (void)state;
    refused("motion", dmb_query_multipliers(scene.sim, scene.parts.winding, answer, &count), DMB_OK);
    assert_int_equal(count, 1);
    refused("motion", dmb_sim_set_drive(scene.sim, scene.parts.winding, 1.0), DMB_ERR_UNSUPPORTED);
}

/* A load beyond all bounds: the steps fail, or the answers stay finite. */
static void huge_drive_does_no_harm(void **state)
{
    static const double values[] = {1e30, -1e30, 1e15};
    (void)state;
    for (size_t i = 0; i < 3; i++) {
        dmb_energy energy = dmb_energy_default();
        assert_int_equal(dmb_sim_set_drive(scene.sim, scene.parts.pushing, values[i]), DMB_OK);
        scene.hash = whole_hash(scene.sim);
        const int32_t status = dmb_sim_step(scene.sim, 1e-3, NULL);
        if (status < 0) refused("huge drive", status, status);
        assert_int_equal(dmb_query_energy(scene.sim, &energy), DMB_OK);
        assert_true(isfinite(energy.kinetic) && isfinite(energy.drives));
    }
}

/* ---- Options ----------------------------------------------------------------------------------------------------- */

static int32_t create_with(const dmb_sim_options *options)
{
    dmb_sim *sim = scene.sim;
    const int32_t status = dmb_sim_create(scene.model, options, &sim);
    size_t size = 5;
    assert_int_equal(dmb_sim_memory_size(scene.model, options, &size) < 0, status < 0);
    if (status < 0) assert_null(sim);
    if (status < 0) assert_int_equal(size, 5);
    if (status >= 0) {
        int32_t stepped = dmb_sim_step(sim, 1e-4, NULL);
        assert_true(stepped >= 0 || dmb_sim_message(sim)[0] != '\0');
    }
    dmb_sim_destroy(&sim);
    return status;
}

static void refuses_number(size_t offset, double value)
{
    dmb_sim_options options = dmb_sim_options_default();
    const int32_t wanted = isfinite(value) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE;
    memcpy((unsigned char *)&options + offset, &value, sizeof value);
    const int32_t status = create_with(&options);
    if (status != wanted) fail_msg("option at %zu = %g: %s", offset, value, dmb_status_name(status));
}

static void option_numbers_out_of_bounds_are_refused(void **state)
{
    static const struct {
        size_t offset;
        double bad[4]; /* 7: none */
    } fields[] = {
        {offsetof(dmb_sim_options, spectral_radius), {-1.0, -1e-16, 1.0 + 1e-15, DBL_MAX}},
        {offsetof(dmb_sim_options, newton_tolerance), {4.9e-324, -1.0, 0.11, 9e-15}},
        {offsetof(dmb_sim_options, tolerance_translation), {0.0, -1.0, -DBL_MAX, -4.9e-324}},
        {offsetof(dmb_sim_options, tolerance_rotation), {0.0, -1.0, -DBL_MAX, -4.9e-324}},
        {offsetof(dmb_sim_options, step_min), {0.0, -1.0, 0.1, DBL_MAX}},
        {offsetof(dmb_sim_options, step_max), {0.0, -1.0, 1e-9, 1e-300}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        for (size_t k = 0; k < 4; k++) refuses_number(fields[i].offset, fields[i].bad[k]);
        refuses_number(fields[i].offset, (double)NAN);
        refuses_number(fields[i].offset, (double)INFINITY);
        refuses_number(fields[i].offset, -(double)INFINITY);
    }
}

static void refuses_count(size_t offset, uint32_t value)
{
    dmb_sim_options options = dmb_sim_options_default();
    memcpy((unsigned char *)&options + offset, &value, sizeof value);
    const int32_t status = create_with(&options);
    if (status != DMB_ERR_VALUE) fail_msg("option at %zu = %u: %s", offset, value, dmb_status_name(status));
}

static void option_counts_out_of_bounds_are_refused(void **state)
{
    (void)state;
    refuses_count(offsetof(dmb_sim_options, max_iterations), 0);
    refuses_count(offsetof(dmb_sim_options, max_iterations), 1001);
    refuses_count(offsetof(dmb_sim_options, max_iterations), UINT32_MAX);
    refuses_count(offsetof(dmb_sim_options, max_cuts), 31);
    refuses_count(offsetof(dmb_sim_options, max_cuts), UINT32_MAX);
    refuses_count(offsetof(dmb_sim_options, bounded_work), 2);
    refuses_count(offsetof(dmb_sim_options, bounded_work), UINT32_MAX);
    refuses_count(offsetof(dmb_sim_options, energy_ledger), 2);
    refuses_count(offsetof(dmb_sim_options, energy_ledger), UINT32_MAX);
    refuses_count(offsetof(dmb_sim_options, constraint_method), 2);
    refuses_count(offsetof(dmb_sim_options, constraint_method), UINT32_MAX);
}

/* The bounds themselves are taken. */
static void options_at_their_bounds_are_taken(void **state)
{
    dmb_sim_options least = dmb_sim_options_default(), most = dmb_sim_options_default();
    (void)state;
    least.max_iterations = 1;
    least.spectral_radius = 0.0;
    least.newton_tolerance = 1e-14; /* 0 is the default */
    least.tolerance_translation = least.tolerance_rotation = 4.9e-324;
    least.step_min = 4.9e-324;
    least.step_max = 1e-323;
    least.max_cuts = 0;
    least.energy_ledger = 0;
    most.max_iterations = 1000;
    most.spectral_radius = 1.0;
    most.newton_tolerance = 0.1;
    most.tolerance_translation = most.tolerance_rotation = DBL_MAX;
    most.step_min = 0.5 * DBL_MAX;
    most.step_max = DBL_MAX;
    most.max_cuts = 30;
    most.bounded_work = 1;
    assert_true(create_with(&least) >= 0);
    assert_true(create_with(&most) >= 0);
}

/* An allocator that lacks one of its functions. */
static void allocator_needs_both_functions(void **state)
{
    dmb_allocator allocator = dmb_allocator_default();
    dmb_sim_options options = dmb_sim_options_default();
    dmb_model_options model_options = dmb_model_options_default();
    dmb_model *model = scene.model;
    (void)state;
    options.allocator = &allocator;
    model_options.allocator = &allocator;
    allocator.release = NULL;
    assert_int_equal(create_with(&options), DMB_ERR_NULL);
    assert_int_equal(dmb_model_create(&model_options, &model), DMB_ERR_NULL);
    assert_null(model);
    allocator = dmb_allocator_default();
    allocator.allocate = NULL;
    assert_int_equal(create_with(&options), DMB_ERR_NULL);
    assert_int_equal(dmb_model_create(&model_options, &model), DMB_ERR_NULL);
}

static void static_options_out_of_bounds_are_refused(void **state)
{
    static const double bad_tolerances[] = {0.0, -1.0, (double)NAN, (double)INFINITY};
    static const double bad_speeds[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    dmb_static_options options;
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        options = dmb_static_options_default();
        options.tolerance = bad_tolerances[i];
        refused("tolerance", dmb_analysis_static(scene.sim, &options, NULL),
                isfinite(bad_tolerances[i]) ? DMB_ERR_VALUE : DMB_ERR_NOT_FINITE);
    }
    for (size_t i = 0; i < 3; i++) {
        options = dmb_static_options_default();
        options.slip_axial = bad_speeds[i];
        refused("slip_axial", dmb_analysis_static(scene.sim, &options, NULL), DMB_ERR_NOT_FINITE);
        options = dmb_static_options_default();
        options.slip_rotation = bad_speeds[i];
        refused("slip_rotation", dmb_analysis_static(scene.sim, &options, NULL), DMB_ERR_NOT_FINITE);
    }
    for (int field = 0; field < 2; field++) {
        for (int high = 0; high < 2; high++) {
            options = dmb_static_options_default();
            if (field == 1 && !high) continue; /* 0 is the library's choice */
            *(field == 0 ? &options.max_iterations : &options.load_steps) = high ? 10001u : 0u;
            refused("count", dmb_analysis_static(scene.sim, &options, NULL), DMB_ERR_VALUE);
        }
    }
    options = dmb_static_options_default();
    options.lay_on_wall = 2;
    refused("lay_on_wall", dmb_analysis_static(scene.sim, &options, NULL), DMB_ERR_VALUE);
    options.lay_on_wall = -1;
    refused("lay_on_wall", dmb_analysis_static(scene.sim, &options, NULL), DMB_ERR_VALUE);
}

/* ---- Compile options --------------------------------------------------------------------------------------------- */

static void compile_options_out_of_bounds_are_refused(void **state)
{
    static const int32_t features[] = {128, -1, INT32_MIN, INT32_MAX, 0x100}, kinds[] = {-2, 3, INT32_MIN, INT32_MAX};
    whole_parts parts;
    dmb_model *model = whole_model_until(&parts, WHOLE_CALLS - 1);
    dmb_compile_options options;
    (void)state;
    for (size_t i = 0; i < 5; i++) {
        options = dmb_compile_options_default();
        options.features = features[i];
        assert_int_equal(dmb_model_compile(model, &options), DMB_ERR_VALUE);
        assert_true(dmb_model_message(model)[0] != '\0');
    }
    for (size_t i = 0; i < 4; i++) {
        options = dmb_compile_options_default();
        options.pipe_kind = kinds[i];
        assert_int_equal(dmb_model_compile(model, &options), DMB_ERR_VALUE);
    }
    assert_int_equal(dmb_model_compile(model, NULL), DMB_OK);
    assert_int_equal(dmb_model_compile(model, NULL), DMB_ERR_ORDER);
    dmb_model_destroy(&model);
}

/* ---- Recorder and writers ---------------------------------------------------------------------------------------- */

static void recorders_that_are_none_are_refused(void **state)
{
    whole_answers a;
    dmb_recorder good;
    (void)state;
    whole_answers_init(&a, &scene.parts);
    good = a.recorder;
#define BAD(field, value, wanted)                                                \
    do {                                                                         \
        a.recorder = good;                                                       \
        a.recorder.field = (value);                                              \
        refused(#field, dmb_recorder_take(&a.recorder, scene.sim), wanted);      \
        assert_true(dmb_recorder_write_csv(&a.recorder, NULL, "/dev/null") < 0); \
    } while (0)
    BAD(output_count, 0, DMB_ERR_VALUE);
    BAD(output_count, 4097, DMB_ERR_VALUE);
    BAD(outputs, NULL, DMB_ERR_NULL);
    BAD(table, NULL, DMB_ERR_NULL);
    BAD(interval, -1.0, DMB_ERR_VALUE);
    BAD(interval, (double)NAN, DMB_ERR_NOT_FINITE);
    BAD(row_count, WHOLE_ROWS + 1, DMB_ERR_VALUE);
    BAD(capacity, UINT64_MAX, DMB_ERR_VALUE);
#undef BAD
    a.recorder = good;
    a.outputs[2].quantity = (DMB_OUTPUT_ENERGY_ERROR + 1);
    refused("quantity", dmb_recorder_take(&a.recorder, scene.sim), DMB_ERR_VALUE);
    a.outputs[2].quantity = -1;
    refused("quantity", dmb_recorder_take(&a.recorder, scene.sim), DMB_ERR_VALUE);
    assert_int_equal(a.recorder.row_count, 0);
}

static void full_recorder_says_so(void **state)
{
    whole_answers a;
    (void)state;
    whole_answers_init(&a, &scene.parts);
    for (int i = 0; i < WHOLE_ROWS; i++) assert_int_equal(dmb_recorder_take(&a.recorder, scene.sim), DMB_OK);
    assert_int_equal(dmb_recorder_take(&a.recorder, scene.sim), DMB_NOTE_FULL);
    assert_int_equal(a.recorder.row_count, WHOLE_ROWS);
}

static void writers_refuse_nonsense(void **state)
{
    static const double strange[] = {(double)NAN, (double)INFINITY};
    (void)state;
    refused("per_element", dmb_write_vtk_strings(scene.sim, 0, "/dev/null"), DMB_ERR_VALUE);
    refused("per_element", dmb_write_vtk_strings(scene.sim, 65, "/dev/null"), DMB_ERR_VALUE);
    refused("path", dmb_write_vtk_strings(scene.sim, 2, "/nonexistent/folder/file"), DMB_ERR_IO);
    refused("path", dmb_write_vtk_strings(scene.sim, 2, ""), DMB_ERR_IO);
    for (size_t i = 0; i < 2; i++) {
        const double x = strange[i];
        assert_int_equal(dmb_write_vtk_hole(scene.model, x, 1.0, 0.5, 8, "/dev/null"), DMB_ERR_NOT_FINITE);
        assert_int_equal(dmb_write_vtk_hole(scene.model, 0.0, x, 0.5, 8, "/dev/null"), DMB_ERR_NOT_FINITE);
        assert_int_equal(dmb_write_vtk_hole(scene.model, 0.0, 1.0, x, 8, "/dev/null"), DMB_ERR_NOT_FINITE);
    }
    assert_int_equal(dmb_write_vtk_hole(scene.model, 1.0, 1.0, 0.5, 8, "/dev/null"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(scene.model, 0.0, 1.0, 0.0, 8, "/dev/null"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(scene.model, 0.0, 1.0, -1.0, 8, "/dev/null"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(scene.model, 0.0, 1.0, 0.5, 2, "/dev/null"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(scene.model, 0.0, 1.0, 0.5, 361, "/dev/null"), DMB_ERR_VALUE);
    assert_int_equal(dmb_write_vtk_hole(scene.model, 0.0, 1e300, 1e-300, 8, "/dev/null"), DMB_ERR_TOO_LARGE);
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(wrong_kind_of_id_is_refused),
        TEST(sections_and_reactions_refuse_other_ids),
        TEST(id_of_another_model_is_refused),
        TEST(made_up_ids_are_refused),
        TEST(definitions_refuse_strange_ids),
        TEST(places_off_the_string_are_refused),
        TEST(other_numbers_of_questions_are_checked),
        TEST(durations_that_lead_nowhere_are_refused),
        TEST(endless_duration_ends),
        TEST(times_that_are_not_ahead_are_refused),
        TEST(drives_are_set_to_numbers),
        TEST(joints_are_set_to_states),
        TEST(motion_drive_on_a_joint_has_a_multiplier),
        TEST(huge_drive_does_no_harm),
        TEST(option_numbers_out_of_bounds_are_refused),
        TEST(option_counts_out_of_bounds_are_refused),
        TEST(options_at_their_bounds_are_taken),
        TEST(allocator_needs_both_functions),
        TEST(static_options_out_of_bounds_are_refused),
        TEST(compile_options_out_of_bounds_are_refused),
        TEST(recorders_that_are_none_are_refused),
        TEST(full_recorder_says_so),
        TEST(writers_refuse_nonsense),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
