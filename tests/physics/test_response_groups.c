/* A frequency response has the same bits at a frequency whether it is asked for alone or among others, which are solved
 * side by side: excitations of every kind, more of them than one pass takes, reactions, and points that a refinement
 * adds, without and with joints. Each frequency alone is solved by the scalar factors. */
#include <stdlib.h>
#include <string.h>

#include "harmonic.h"
#include "rig.h"

enum { FREQUENCIES = 19, FORCES = 17, EXCITATIONS = FORCES + 2, OUTPUTS = 5 };

/* A body that hangs from a place on a universal joint with springs. */
static dmb_place add_hanging(rig *s, dmb_place from, double x)
{
    dmb_body_def link = dmb_body_def_default();
    link.mass = 2.0;
    link.inertia[0] = link.inertia[1] = link.inertia[2] = 0.1;
    link.position[0] = x;
    const dmb_id body = add_body(s, &link);
    dmb_joint_def joint = joint_between(DMB_JOINT_UNIVERSAL, from, dmb_station(body, 0, 0.0));
    joint.stiffness[4] = joint.stiffness[5] = 300.0;
    joint.damping[4] = 0.5;
    (void)add_joint(s, &joint);
    return dmb_station(body, 0, 0.0);
}

/* Beyond the end of the string a second one on a universal joint and three bodies behind it, all of them jointed;
 * beside them a string without joints. */
static void add_jointed(rig *s, dmb_pipe_def pipe)
{
    dmb_string_def def = dmb_string_def_default();
    dmb_place end = dmb_station(pipe.string, 9, 1.0);
    def.start_free = DMB_FREE_ALL;
    def.position[0] = 10.0 * pipe.length;
    dmb_joint_def joint = joint_between(DMB_JOINT_UNIVERSAL, end, end);
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 4);
    joint.place_b = dmb_station(pipe.string, 0, 0.0);
    joint.stiffness[4] = 2e3;
    joint.damping[5] = 3.0;
    (void)add_joint(s, &joint);
    end = dmb_station(pipe.string, 3, 1.0);
    for (int i = 0; i < 3; i++) end = add_hanging(s, end, 14.0 * pipe.length);
    def.start_free = DMB_FREE_NONE;
    def.position[0] = 0.0;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 3);
}

/* Ten pipes at rest on the wall of their hole, fed and turned by motion drives. */
static dmb_id open_string(rig *s, int32_t kind, int jointed, dmb_id drives[2])
{
    rig_open(s, 0.0, 0.0, -9.81);
    dmb_wall_def hole = s1_hole();
    dmb_string_def def = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    hole.normal_law = DMB_NORMAL_KELVIN_VOIGT;
    hole.damping = 3e3;
    hole.friction_law = DMB_FRICTION_COULOMB;
    hole.smoothing_speed = 1e-2;
    (void)add_wall(s, &hole);
    def.start_free = DMB_FREE_X | DMB_FREE_RX;
    pipe.kind = kind;
    pipe.damping_time = 2e-3;
    pipe.string = add_string(s, &def);
    (void)add_pipes(s, &pipe, 10);
    if (jointed) add_jointed(s, pipe);
    const dmb_id still = add_constant(s, 0.0);
    drives[0] = add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_X, still);
    drives[1] = add_simple_drive(s, DMB_DRIVE_MOTION, pipe.string, DMB_RX, still);
    (void)rig_start(s, NULL);
    (void)find_equilibrium(s, NULL);
    return pipe.string;
}

typedef struct question {
    dmb_response_options options;
    dmb_excitation excitations[EXCITATIONS];
    dmb_output outputs[OUTPUTS];
} question;

/* Axial-torsional strings have no sideways motion. */
static question question_of(dmb_id string, const dmb_id drives[2], int32_t path)
{
    question q;
    const dmb_place whole = dmb_station(string, 0, 0.0);
    q.options = dmb_response_options_default();
    q.options.structural_damping = 0.01;
    for (uint32_t i = 0; i < FORCES; i++) {
        q.excitations[i] = dmb_excitation_default();
        q.excitations[i].place = dmb_station(string, i % 10, 1.0);
        q.excitations[i].component = path ? 3 * ((int32_t)i % 2) : (int32_t)i % 6;
    }
    for (int i = 0; i < 2; i++) q.excitations[FORCES + i] = input_of(DMB_EXCITATION_DRIVE, drives[i], DMB_X);
    q.outputs[0] = output_at(DMB_OUTPUT_VIBRATION, dmb_station(string, 9, 1.0), path ? DMB_X : DMB_Z);
    q.outputs[1] = output_at(DMB_OUTPUT_VIBRATION_VELOCITY, dmb_station(string, 4, 1.0), DMB_RX);
    q.outputs[2] = output_at(DMB_OUTPUT_REACTION, whole, DMB_X);
    q.outputs[2].place.part = string;
    q.outputs[3] = q.outputs[2];
    q.outputs[3].quantity += DMB_RX;
    q.outputs[4] = output_at(DMB_OUTPUT_SECTION_FORCE, dmb_station(string, 5, 0.5), DMB_X);
    return q;
}

static dmb_response *ask(const rig *s, const question *q)
{
    dmb_response *response = NULL;
    must(s, dmb_analysis_response(s->sim, &q->options, q->excitations, EXCITATIONS, q->outputs, OUTPUTS, &response));
    return response;
}

/* Values of one point that differ from those of a response of this frequency alone. */
static int differences(const rig *s, const question *q, const dmb_response *all, uint32_t points, uint32_t point,
                       double frequency)
{
    double alone[2], *among = malloc(2 * points * sizeof *among);
    question one = *q;
    int count = 0;
    one.options.frequencies = &frequency;
    one.options.points = 1;
    one.options.refinement = 0;
    dmb_response *single = ask(s, &one);
    assert_non_null(among);
    for (uint32_t i = 0; i < EXCITATIONS; i++)
        for (uint32_t k = 0; k < OUTPUTS; k++) {
            must(s, dmb_response_transfer(all, i, k, among));
            must(s, dmb_response_transfer(single, i, k, alone));
            count += memcmp(among + 2 * (size_t)point, alone, sizeof alone) != 0;
        }
    dmb_response_destroy(&single);
    free(among);
    return count;
}

static void alone_and_among_others(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        const int path = kind == 1;
        rig s;
        dmb_id drives[2];
        uint32_t shape[3];
        const dmb_id string = open_string(&s, path ? DMB_PIPE_AXIAL_TORSIONAL : DMB_PIPE_FLEXIBLE, kind == 2, drives);
        question q = question_of(string, drives, path);
        q.options.points = FREQUENCIES;
        q.options.refinement = 2;
        q.options.frequency_high = 250.0;
        dmb_response *all = ask(&s, &q);
        must(&s, dmb_response_dimensions(all, shape));
        double *frequency = malloc(shape[0] * sizeof *frequency);
        assert_non_null(frequency);
        must(&s, dmb_response_frequencies(all, frequency));
        assert_true(shape[0] > FREQUENCIES);
        for (uint32_t i = 0; i < shape[0]; i++)
            assert_int_equal(differences(&s, &q, all, shape[0], i, frequency[i]), 0);
        print_message("%u points of %d excitations: the bits of each alone\n", shape[0], EXCITATIONS);
        dmb_response_destroy(&all);
        free(frequency);
        rig_close(&s);
    }
}

/* At frequency 0 a motion drive has no displacement to respond to, whichever place the excitation has. */
static void one_frequency_of_a_group_is_refused(void **state)
{
    (void)state;
    rig s;
    dmb_id drives[2];
    dmb_response *response = NULL;
    const dmb_id string = open_string(&s, DMB_PIPE_FLEXIBLE, 0, drives);
    question q = question_of(string, drives, 0);
    q.options.frequency_low = 0.0;
    q.options.points = FREQUENCIES;
    assert_int_equal(
        dmb_analysis_response(s.sim, &q.options, q.excitations, EXCITATIONS, q.outputs, OUTPUTS, &response),
        DMB_ERR_SINGULAR);
    assert_null(response);
    assert_non_null(strstr(dmb_sim_message(s.sim), "excitation 17: at frequency 0"));
    must(&s, dmb_analysis_response(s.sim, &q.options, q.excitations, FORCES, q.outputs, OUTPUTS, &response));
    dmb_response_destroy(&response);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(alone_and_among_others),
                                       cmocka_unit_test(one_frequency_of_a_group_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
