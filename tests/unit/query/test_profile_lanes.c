/* Section forces by lanes: the same bits at every width, in profiles that go forward, back and sparsely and in single
 * questions; loads of the ends of elements against those computed one by one (eq:beam.section-force). Each quantity
 * alone, for which only its own terms are computed, against all of them; extremes against the values of stations. */
#include <string.h>

#include "close.h"
#include "full_rig.h"
#include "rig.h"

#include "kernel/kernels.h"
#include "query/query.h"
#include "system/assemble/energy.h"

enum { STATIONS = 75, QUANTITIES = 7 };

static const int32_t asked[QUANTITIES] = {DMB_PROFILE_EFFECTIVE_FORCE, DMB_PROFILE_TORQUE,   DMB_PROFILE_SHEAR_Y,
                                          DMB_PROFILE_SHEAR_Z,         DMB_PROFILE_MOMENT_Y, DMB_PROFILE_MOMENT_Z,
                                          DMB_PROFILE_VON_MISES};

static void use_lanes(rig *s, uint32_t lanes)
{
    ((dmb_scene *)(uintptr_t)s->sim->scene)->kernels = dmb_kernels_of(lanes);
}

static dmb_pipe_def pipe_of(uint32_t elements, double joint, double damping)
{
    dmb_pipe_def pipe = s1_pipe();
    pipe.elements = elements;
    pipe.damping_time = damping;
    if (joint > 0.0) pipe.joint_length = joint, pipe.joint_outer_diameter = 0.085;
    return pipe;
}

/* A string held at the rig that falls and turns: lengths of elements, tool joints and damping differ along it; `rigid`:
 * a rigid pipe parts its elements. */
static rig swing(int rigid, double eccentricity)
{
    rig s;
    dmb_pipe_def pipe = pipe_of(2, 0.1, 1e-4), stiff = pipe_of(1, 0.0, 0.0), last = pipe_of(3, 0.0, 0.0);
    dmb_load_def load = dmb_load_def_default();
    rig_open(&s, 0.0, 1.0, -9.81);
    pipe.eccentricity = eccentricity;
    load.place.part = add_pipes(&s, &pipe, 9);
    stiff.kind = rigid ? DMB_PIPE_RIGID : DMB_PIPE_FLEXIBLE;
    (void)add_pipes(&s, &stiff, 1);
    (void)add_pipes(&s, &last, 4);
    load.place.pipe = 3;
    load.place.fraction = 0.475; /* too near a node for one of its own: inside the element */
    load.force[1] = 50.0;
    (void)add_load(&s, &load);
    (void)rig_start(&s, NULL);
    take_steps(&s, 2e-3, 40);
    return s;
}

static void ask(const rig *s, uint32_t count, const double *distance, double *values)
{
    dmb_profile profile = dmb_profile_default();
    profile.station_count = count;
    profile.distance = distance;
    profile.quantities = asked;
    profile.quantity_count = QUANTITIES;
    profile.values = values;
    must(s, dmb_query_profile(s->sim, &profile));
}

static const double whole = 14 * 1.5;

static double distance_of(int k)
{
    return whole * k / (STATIONS - 1);
}

static void check_orders(const rig *s, double (*forward)[QUANTITIES])
{
    double distance[STATIONS], back[STATIONS][QUANTITIES], one[QUANTITIES];
    for (int k = 0; k < STATIONS; k++) distance[k] = distance_of(STATIONS - 1 - k);
    ask(s, STATIONS, distance, back[0]);
    for (int k = 0; k < STATIONS; k++) {
        ask(s, 1, distance + k, one);
        assert_memory_equal(back[k], forward[STATIONS - 1 - k], sizeof one);
        assert_memory_equal(one, back[k], sizeof one);
    }
}

static void all_widths_and_orders_have_the_same_bits(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        rig s = swing(kind & 1, kind & 2 ? 0.002 : 0.0);
        double first[STATIONS][QUANTITIES], now[STATIONS][QUANTITIES], distance[STATIONS];
        for (int k = 0; k < STATIONS; k++) distance[k] = distance_of(k);
        use_lanes(&s, 1);
        ask(&s, STATIONS, distance, first[0]);
        for (uint32_t lanes = 1; lanes <= 8; lanes *= 2) {
            if (dmb_kernels_of(lanes) == NULL) continue;
            use_lanes(&s, lanes);
            ask(&s, STATIONS, distance, now[0]);
            assert_memory_equal(first, now, sizeof now);
            check_orders(&s, now);
        }
        rig_close(&s);
    }
}

static void profiles_agree_with_questions(void **state)
{
    (void)state;
    rig s = swing(1, 0.002);
    const dmb_id string = dmb_model_id(s.model, DMB_PART_STRING, 0);
    for (uint32_t pipe = 0; pipe < 14; pipe++)
        for (int k = 0; k < 4 && pipe != 9; k++) {
            const dmb_place place = dmb_station(string, pipe, 0.05 + 0.3 * k);
            const double distance = 1.5 * (pipe + 0.05 + 0.3 * k);
            dmb_section section = dmb_section_default();
            double found[QUANTITIES];
            must(&s, dmb_query_section(s.sim, place, &section));
            ask(&s, 1, &distance, found);
            CHECK_CLOSE(found[0], section.force[0], 1e-9 * fabs(section.force[0]) + 1e-6);
            CHECK_CLOSE(found[4], section.force[4], 1e-9 * fabs(section.force[4]) + 1e-6);
        }
    rig_close(&s);
}

/* The loads of both ends against the sums of element, inertia and weight that are computed without lanes. */
static void end_loads_match_those_of_one_element(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        rig s = swing(kind, 0.0);
        const dmb_scene *scene = s.sim->scene;
        for (uint32_t e = 0; e < scene->element_count; e++) {
            const uint32_t a = scene->element_node[e], row = scene->layout.row[a];
            dmb_beam_args args = {.count = 1,
                                  .types = scene->types,
                                  .type = scene->element_type + e,
                                  .span = scene->element_span + 3 * e,
                                  .displacement = s.sim->now.displacement + 3 * a,
                                  .quaternion = s.sim->now.quaternion + 4 * a,
                                  .velocity = s.sim->now.velocity + row,
                                  .acceleration = s.sim->now.acceleration + row,
                                  .dynamic = 1,
                                  .damped = scene->damped,
                                  .arms = scene->arms,
                                  .gravity = scene->gravity};
            dmb_end_loads found;
            double load[12];
            assert_int_equal(scene->kernels->end_loads(&args, &found), 0);
            dmb_element_end_loads(scene, &s.sim->now, e, load);
            for (int i = 0; i < 12; i++) CHECK_CLOSE(found.load[i], load[i], 1e-6);
        }
        rig_close(&s);
    }
}

static void each_alone_is_as_with_all(void **state)
{
    enum { ALL = DMB_PROFILE_QUANTITIES };
    (void)state;
    for (int kind = 0; kind < 16; kind++) {
        const full_rig_choice choice = {.friction_law = DMB_FRICTION_COULOMB,
                                        .curved = kind & 1,
                                        .rings_only = (kind & 3) == 2,
                                        .sections = (kind >> 2) * 4};
        static double all[STATIONS][ALL], one[STATIONS];
        int32_t quantities[ALL];
        dmb_profile profile = dmb_profile_default();
        rig s;
        full_rig_open(&s, &choice);
        take_divided_steps(&s, 2e-4, 5);
        for (int32_t q = 0; q < ALL; q++) quantities[q] = q;
        profile.station_count = STATIONS;
        profile.quantities = quantities;
        profile.quantity_count = ALL;
        profile.values = all[0];
        must(&s, dmb_query_profile(s.sim, &profile));
        profile.quantity_count = 1;
        profile.values = one;
        for (int32_t q = 0; q < ALL; q++) {
            profile.quantities = &q;
            must(&s, dmb_query_profile(s.sim, &profile));
            for (int k = 0; k < STATIONS; k++) assert_memory_equal(one + k, all[k] + q, sizeof *one);
        }
        rig_close(&s);
    }
}

/* The first of equal values, NaN of rigid pipes left out. */
static void check_extremes(const double *values, const double *distance, const double extremes[4])
{
    int least = -1, largest = -1;
    for (int k = 0; k < STATIONS; k++) {
        const double value = values[QUANTITIES * k];
        if (isnan(value)) continue;
        if (least < 0 || value < values[QUANTITIES * least]) least = k;
        if (largest < 0 || value > values[QUANTITIES * largest]) largest = k;
    }
    const double wanted[4] = {values[QUANTITIES * least], distance[least], values[QUANTITIES * largest],
                              distance[largest]};
    assert_memory_equal(extremes, wanted, sizeof wanted);
}

static void extremes_are_those_of_the_stations(void **state)
{
    (void)state;
    for (int back = 0; back < 2; back++) {
        rig s = swing(1, 0.002);
        double distance[STATIONS], values[STATIONS][QUANTITIES], extremes[QUANTITIES + 1][4];
        int32_t quantities[QUANTITIES + 1] = {0};
        dmb_profile profile = dmb_profile_default();
        for (int k = 0; k < STATIONS; k++) distance[k] = distance_of(back ? STATIONS - 1 - k : k);
        for (int q = 0; q < QUANTITIES; q++) quantities[q] = asked[q];
        quantities[QUANTITIES] = DMB_PROFILE_YIELD_SHARE; /* not known: no value */
        profile.station_count = STATIONS;
        profile.distance = distance;
        profile.quantities = quantities;
        profile.quantity_count = QUANTITIES + 1;
        must(&s, dmb_query_profile_extremes(s.sim, &profile, extremes[0]));
        ask(&s, STATIONS, distance, values[0]);
        for (int q = 0; q < QUANTITIES; q++) check_extremes(values[0] + q, distance, extremes[q]);
        for (int i = 0; i < 4; i++) assert_true(isnan(extremes[QUANTITIES][i]));
        profile.distance = NULL;
        profile.quantities = asked;
        profile.quantity_count = 1;
        must(&s, dmb_query_profile_extremes(s.sim, &profile, extremes[0]));
        if (!back) check_extremes(values[0], distance, extremes[0]);
        rig_close(&s);
    }
}

static void extremes_that_are_refused_are_left(void **state)
{
    (void)state;
    rig s = swing(0, 0.0);
    double extremes[4] = {1.0, 2.0, 3.0, 4.0}, distance[2] = {0.5, 1e3};
    dmb_profile profile = dmb_profile_default();
    profile.quantities = asked;
    profile.quantity_count = 1;
    profile.station_count = 2;
    profile.distance = distance;
    assert_int_equal(dmb_query_profile_extremes(s.sim, &profile, extremes), DMB_ERR_VALUE);
    assert_int_equal(dmb_query_profile_extremes(s.sim, &profile, NULL), DMB_ERR_NULL);
    profile.quantities = NULL;
    assert_int_equal(dmb_query_profile_extremes(s.sim, &profile, extremes), DMB_ERR_NULL);
    for (int i = 0; i < 4; i++) assert_true(extremes[i] == i + 1.0);
    rig_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_widths_and_orders_have_the_same_bits),
                                       cmocka_unit_test(profiles_agree_with_questions),
                                       cmocka_unit_test(end_loads_match_those_of_one_element),
                                       cmocka_unit_test(each_alone_is_as_with_all),
                                       cmocka_unit_test(extremes_are_those_of_the_stations),
                                       cmocka_unit_test(extremes_that_are_refused_are_left)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
