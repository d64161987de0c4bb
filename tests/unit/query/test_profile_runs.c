/* Profiles of strings of several runs of pipes, two in one hole: places of stations, in any order and layout; the site
 * at the wall that a station of a rigid pipe, a tool joint or a ring takes its numbers from; refusals. */
#include <string.h>

#include "close.h"
#include "rig.h"

enum { RUNS = 3, STATIONS = 19 };
#define ANY UINT32_MAX

typedef struct scene {
    rig s;
    dmb_id string[2], ring[2];
    double start[2]; /* [m] depth of the rig ends */
} scene;

static const uint32_t pipes_of_run[RUNS] = {2, 3, 2};
static const double length_of_run[RUNS] = {1.5, 0.8, 2.0};
static const double whole = 2 * 1.5 + 3 * 0.8 + 2 * 2.0;

/* Flexible, rigid, and flexible pipes, the last with tool joints, along the low side of the hole. */
static void add_one(scene *c, int i)
{
    static const int32_t kinds[RUNS] = {DMB_PIPE_FLEXIBLE, DMB_PIPE_RIGID, DMB_PIPE_FLEXIBLE};
    dmb_string_def string = dmb_string_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    string.start_depth = c->start[i] = 10.0 + 30.0 * i;
    string.offset[1] = -0.0105;
    c->string[i] = add_string(&c->s, &string);
    for (int k = 0; k < RUNS; k++) {
        dmb_pipe_def pipe = s1_pipe();
        pipe.string = c->string[i];
        pipe.kind = kinds[k];
        pipe.length = length_of_run[k];
        pipe.elements = 2;
        pipe.contact_points = k == 2 ? 3 : 0;
        if (k == 2) pipe.joint_length = 0.3, pipe.joint_outer_diameter = 0.08;
        (void)add_pipes(&c->s, &pipe, pipes_of_run[k]);
    }
    ring.string = c->string[i];
    ring.pipe = 5;
    ring.fraction = 0.25;
    ring.outer_diameter = 0.088;
    must_model(&c->s, dmb_model_add_stabiliser(c->s.model, &ring, &c->ring[i]));
}

static scene lie(void)
{
    scene c;
    dmb_wall_def wall = s1_hole();
    wall.stiffness = 1e7;
    rig_open(&c.s, 0.0, 0.0, -9.81);
    (void)add_wall(&c.s, &wall);
    for (int i = 0; i < 2; i++) add_one(&c, i);
    (void)rig_start(&c.s, NULL);
    find_equilibrium(&c.s, NULL);
    return c;
}

/* Pipe and fraction at a distance, pipe by pipe; a boundary belongs to the pipe behind it, where the sum is exact. */
static dmb_place place_of(const scene *c, int i, double distance)
{
    uint32_t pipe = 0;
    for (int k = 0; k < RUNS; k++)
        for (uint32_t p = 0; p < pipes_of_run[k]; p++, pipe++) {
            if (distance < length_of_run[k] || (k == RUNS - 1 && p + 1 == pipes_of_run[k]))
                return dmb_station(c->string[i], pipe, fmin(distance / length_of_run[k], 1.0));
            distance -= length_of_run[k];
        }
    return dmb_station(c->string[i], pipe, 0.0);
}

/* Stations off the boundaries of pipes, back and forth. */
static void stations(double distance[STATIONS])
{
    for (int k = 0; k < STATIONS; k++) distance[k] = whole * ((7 * k) % STATIONS + 0.37) / STATIONS;
}

static void places_in_any_order(void **state)
{
    static const int32_t asked[3] = {DMB_PROFILE_DISTANCE, DMB_PROFILE_X, DMB_PROFILE_ROTATION};
    (void)state;
    scene c = lie();
    double distance[STATIONS], by_station[STATIONS][3], by_quantity[3][STATIONS];
    stations(distance);
    for (int i = 0; i < 2; i++) {
        dmb_profile profile = dmb_profile_default();
        profile.string = c.string[i];
        profile.station_count = STATIONS;
        profile.distance = distance;
        profile.quantities = asked;
        profile.quantity_count = 3;
        profile.values = &by_station[0][0];
        must(&c.s, dmb_query_profile(c.s.sim, &profile));
        profile.values = &by_quantity[0][0];
        profile.station_stride = 1;
        profile.quantity_stride = STATIONS;
        must(&c.s, dmb_query_profile(c.s.sim, &profile));
        for (int k = 0; k < STATIONS; k++) {
            const dmb_place place = place_of(&c, i, distance[k]);
            CHECK_CLOSE(by_station[k][0], distance[k], 0.0);
            CHECK_CLOSE(by_station[k][1], pose_at(&c.s, place).position[0], 1e-12);
            CHECK_CLOSE(by_station[k][2], rotation_at(&c.s, place), 1e-12);
            for (int q = 0; q < 3; q++) CHECK_CLOSE(by_quantity[q][k], by_station[k][q], 0.0);
            dmb_output output = {place, DMB_OUTPUT_PROFILE + DMB_PROFILE_DISTANCE, 0};
            double value = (double)NAN;
            must(&c.s, dmb_query_output(c.s.sim, &output, &value));
            CHECK_CLOSE(value, distance[k], 1e-14 * whole);
        }
    }
    rig_close(&c.s);
}

/* Number k of the contacts of a part that are of a pipe, or of ANY; two elements have two. */
static dmb_contact contact_of(const scene *c, dmb_id part, uint32_t pipe, int k)
{
    for (uint32_t i = 0;; i++) {
        dmb_contact contact = dmb_contact_default();
        must(&c->s, dmb_query_contact(c->s.sim, i, &contact));
        if (contact.part.index == part.index && (pipe == ANY || contact.pipe == pipe) && k-- == 0) return contact;
    }
}

static double asked_at(const scene *c, int i, int32_t quantity, double distance)
{
    dmb_profile profile = dmb_profile_default();
    double value = (double)NAN;
    profile.string = c->string[i];
    profile.distance = &distance;
    profile.quantities = &quantity;
    profile.quantity_count = 1;
    profile.values = &value;
    must(&c->s, dmb_query_profile(c->s.sim, &profile));
    return value;
}

static void check_site(const scene *c, int i, double distance, const dmb_contact *contact)
{
    CHECK_CLOSE(asked_at(c, i, DMB_PROFILE_GAP, distance), contact->gap, 0.0);
    CHECK_CLOSE(asked_at(c, i, DMB_PROFILE_NORMAL_FORCE, distance), contact->normal_force / contact->length,
                1e-12 * fabs(contact->normal_force));
}

/* A rigid pipe carries the site at its end nearest to the station; a ring those on its length; a tool joint that at the
 * end of its pipe. */
static void sites_of_stations(void **state)
{
    (void)state;
    scene c = lie();
    for (int i = 0; i < 2; i++) {
        const dmb_contact before = contact_of(&c, c.string[i], 2, 0), behind = contact_of(&c, c.string[i], 3, 0);
        const dmb_contact ring = contact_of(&c, c.ring[i], ANY, 0), end = contact_of(&c, c.string[i], 6, 1);
        const double third = 2 * 1.5 + 0.8, middle = 2 * 1.5 + 3 * 0.8 + 0.25 * 2.0;
        check_site(&c, i, third + 0.2 * 0.8, &before); /* pipe 3 begins where pipe 2 ends */
        check_site(&c, i, third + 0.8 * 0.8, &behind);
        check_site(&c, i, middle - 0.14, &ring);
        check_site(&c, i, middle + 0.14, &ring);
        assert_true(asked_at(&c, i, DMB_PROFILE_GAP, middle - 0.16) != ring.gap);
        assert_true(asked_at(&c, i, DMB_PROFILE_GAP, middle + 0.16) != ring.gap);
        check_site(&c, i, whole - 0.1, &end);
        assert_true(isnan(asked_at(&c, i, DMB_PROFILE_BENDING_MOMENT, third)));
        assert_true(isfinite(asked_at(&c, i, DMB_PROFILE_BENDING_MOMENT, 1.0)));
    }
    rig_close(&c.s);
}

static void layouts_are_refused(void **state)
{
    static const struct {
        uint64_t station, quantity;
    } overlapping[] = {{1, 1}, {1, 0}, {0, 1}, {2, 1}, {1, STATIONS - 1}, {2, 2}, {UINT64_MAX, 1}, {1, UINT64_MAX}};
    static const int32_t asked[3] = {DMB_PROFILE_DISTANCE, DMB_PROFILE_X, DMB_PROFILE_ROTATION};
    (void)state;
    scene c = lie();
    double values[3 * STATIONS];
    for (int k = 0; k < 3 * STATIONS; k++) values[k] = 7.0;
    dmb_profile profile = dmb_profile_default();
    profile.station_count = STATIONS;
    profile.quantities = asked;
    profile.quantity_count = 3;
    profile.values = values;
    for (size_t i = 0; i < sizeof overlapping / sizeof overlapping[0]; i++) {
        profile.station_stride = overlapping[i].station;
        profile.quantity_stride = overlapping[i].quantity;
        if (dmb_query_profile(c.s.sim, &profile) != DMB_ERR_VALUE) fail_msg("layout %zu", i);
    }
    profile.station_stride = profile.quantity_stride = 0;
    profile.string = c.ring[0];
    assert_int_equal(dmb_query_profile(c.s.sim, &profile), DMB_ERR_ID);
    profile.string = (dmb_id){0, 7};
    assert_int_equal(dmb_query_profile(c.s.sim, &profile), DMB_ERR_ID);
    for (int k = 0; k < 3 * STATIONS; k++) CHECK_CLOSE(values[k], 7.0, 0.0);
    rig_close(&c.s);
}

/* The length of a string is a rounded sum: what is left of it behind its first run may be longer than the last run. */
static void the_end_is_on_the_last_pipe(void **state)
{
    static const double first[4] = {0.7, 1.1, 1.3, 2.3};
    static const int32_t asked[2] = {DMB_PROFILE_DISTANCE, DMB_PROFILE_X};
    int beyond = 0;
    (void)state;
    for (int k = 0; k < 4; k++)
        for (uint32_t count = 1; count < 7; count++) {
            rig s;
            dmb_string_def string = dmb_string_def_default();
            dmb_pipe_def pipe = s1_pipe();
            dmb_profile profile = dmb_profile_default();
            double values[3][2];
            rig_open(&s, 0.0, 0.0, 0.0);
            string.follows_hole = 0;
            profile.string = pipe.string = add_string(&s, &string);
            for (int run = 0; run < 2; run++) {
                pipe.length = run == 0 ? first[k] : 0.1;
                (void)add_pipes(&s, &pipe, run == 0 ? count : 4);
            }
            (void)rig_start(&s, NULL);
            profile.station_count = 3;
            profile.quantities = asked;
            profile.quantity_count = 2;
            profile.values = &values[0][0];
            must(&s, dmb_query_profile(s.sim, &profile));
            CHECK_CLOSE(values[2][1], pose_at(&s, dmb_station(pipe.string, count + 3, 1.0)).position[0], 1e-14);
            CHECK_CLOSE(values[2][0], values[2][1], 1e-14);
            beyond += values[2][0] - count * first[k] > 4 * 0.1;
            rig_close(&s);
        }
    assert_true(beyond > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(places_in_any_order), cmocka_unit_test(sites_of_stations),
                                       cmocka_unit_test(layouts_are_refused),
                                       cmocka_unit_test(the_end_is_on_the_last_pipe)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
