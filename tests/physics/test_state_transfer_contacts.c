/* Places at the wall that a state transfer takes along: of two strings with rings, points along their elements, bodies
 * at their ends and free bodies beside them. Forces there stay, and free bodies go on by themselves. Axial-torsional
 * pipes that are described off the line they are on are refused. */
#include <string.h>

#include "rig.h"

typedef struct scene {
    rig r;
    dmb_id string[2], ring[2], end[2], block[2];
} scene;

static void add_block(scene *s, int i)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 4.0;
    for (int k = 0; k < 3; k++) body.inertia[k] = 0.02 + 0.01 * k;
    body.contact_diameter = 0.08;
    body.contact_length = 0.1;
    body.position[0] = 100.0 + 5.0 * i;
    body.position[2] = -0.007;
    body.velocity[0] = 0.2 - 0.5 * i;
    body.velocity[3] = 2.0;
    s->block[i] = add_body(&s->r, &body);
}

static void add_one(scene *s, int i, uint32_t pipes, double depth)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_body_def body = dmb_body_def_default();
    string.start_free = DMB_FREE_ALL;
    string.start_depth = depth;
    string.offset[1] = -0.009;
    string.velocity[0] = 0.1 + 0.2 * i;
    string.velocity[3] = 3.0;
    s->string[i] = add_string(&s->r, &string);
    pipe.string = s->string[i];
    pipe.elements = 2;
    pipe.contact_points = 3 + 2 * (uint32_t)i;
    (void)add_pipes(&s->r, &pipe, pipes);
    ring.string = s->string[i];
    ring.pipe = pipes - 1;
    ring.outer_diameter = 0.092;
    must_model(&s->r, dmb_model_add_stabiliser(s->r.model, &ring, &s->ring[i]));
    body.string = s->string[i];
    body.attach = i ? DMB_ATTACH_START : DMB_ATTACH_END;
    body.mass = 2.0;
    body.contact_diameter = 0.09;
    body.contact_length = 0.1;
    s->end[i] = add_body(&s->r, &body);
}

/* Accelerations begin anew, as a start has them. */
static void check_blocks(const scene *from, const scene *to)
{
    for (int i = 0; i < 2; i++) {
        const dmb_place there = dmb_station(from->block[i], 0, 0.0), here = dmb_station(to->block[i], 0, 0.0);
        const dmb_motion a = motion_at(&from->r, there, DMB_FRAME_WORLD), b = motion_at(&to->r, here, DMB_FRAME_WORLD);
        const dmb_pose x = pose_at(&from->r, there), y = pose_at(&to->r, here);
        check_below("bodies beside the strings, apart [m]", largest_difference(3, x.position, y.position), 1e-7);
        check_below("    in their speeds [m/s, rad/s]", largest_difference(6, a.velocity, b.velocity), 1e-4);
    }
}

/* `pipes` in the first string, one less in the second. */
static scene open_scene(int32_t friction_law, uint32_t pipes)
{
    scene s;
    dmb_wall_def wall = s1_hole();
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, -9.81);
    wall.stiffness = 1e6;
    wall.friction_law = friction_law;
    (void)add_wall(&s.r, &wall);
    add_block(&s, 0);
    add_one(&s, 0, pipes, 20.0 - 1.5 * pipes);
    add_one(&s, 1, pipes - 1, 50.0 - 1.5 * pipes);
    add_block(&s, 1);
    (void)rig_start(&s.r, NULL);
    return s;
}

static int same_id(dmb_id a, dmb_id b)
{
    return a.index == b.index;
}

/* The contact of `to` that is that of `from`: of the same part, of a pipe by its number from the far end. Points along
 * elements come in their order. */
static int matching(const scene *from, const scene *to, uint32_t added, uint32_t sites, const dmb_contact *was,
                    uint32_t *after, dmb_contact *out)
{
    for (; *after < sites; (*after)++) {
        dmb_contact contact = dmb_contact_default();
        must(&to->r, dmb_query_contact(to->r.sim, *after, &contact));
        if (!same_id(contact.part, was->part)) continue;
        const int moved = same_id(was->part, from->string[0]) || same_id(was->part, from->string[1]);
        if (contact.pipe != was->pipe + (moved ? added : 0)) continue;
        *out = contact;
        (*after)++;
        return 1;
    }
    return 0;
}

static uint32_t sites_of(const scene *s)
{
    dmb_model_info info = dmb_model_info_default();
    must_model(&s->r, dmb_model_get_info(s->r.model, &info));
    return info.contact_points;
}

static void check_contacts(const scene *from, const scene *to, uint32_t added)
{
    uint32_t after = 0, found = 0, closed = 0;
    double worst = 0.0;
    for (uint32_t i = 0; i < sites_of(from); i++) {
        dmb_contact was = dmb_contact_default(), is;
        must(&from->r, dmb_query_contact(from->r.sim, i, &was));
        if (was.pipe == UINT32_MAX || (added && same_id(was.part, from->end[1])))
            continue; /* the rig end, where it was */
        const uint32_t begin = after;
        if (!matching(from, to, added, sites_of(to), &was, &after, &is)) {
            after = begin;
            continue;
        }
        found++;
        closed += (uint32_t)was.closed;
        worst = fmax(worst, fabs(was.normal_force - is.normal_force));
        worst = fmax(worst, largest_difference(2, was.friction, is.friction));
        assert_int_equal(was.sticks, is.sticks);
        assert_int_equal(was.closed, is.closed);
    }
    tell("places that go on", found);
    assert_true(found >= sites_of(from) - 6 && closed > 8);
    check_below("forces at the wall [N]", worst, 1e-6);
}

static void places_go_on(void **state)
{
    static const int32_t laws[2] = {DMB_FRICTION_BRISTLE, DMB_FRICTION_STRIBECK};
    (void)state;
    for (int k = 0; k < 2; k++)
        for (uint32_t added = 0; added < 2; added++) {
            scene from = open_scene(laws[k], 4), to = open_scene(laws[k], 4 + added);
            take_divided_steps(&from.r, 1e-3, 60);
            must(&to.r, dmb_sim_transfer_state(to.r.sim, from.r.sim));
            check_contacts(&from, &to, added);
            take_divided_steps(&from.r, 1e-3, 20);
            take_divided_steps(&to.r, 1e-3, 20);
            check_blocks(&from, &to);
            rig_close(&from.r);
            rig_close(&to.r);
        }
}

/* ---- Off the line ------------------------------------------------------------------------------------------------ */

static scene on_line(uint32_t pipes, double y, double angle)
{
    scene s;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    memset(&s, 0, sizeof s);
    rig_open(&s.r, 0.0, 0.0, 0.0);
    string.follows_hole = 0;
    string.start_free = DMB_FREE_CYLINDRICAL;
    string.position[1] = y;
    string.rotation[2] = angle;
    string.velocity[0] = 1.0;
    s.string[0] = add_string(&s.r, &string);
    pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
    (void)add_pipes(&s.r, &pipe, pipes);
    (void)rig_start(&s.r, NULL);
    return s;
}

static void off_the_line(void **state)
{
    static const double across[3] = {1e-3, 0.0, -4.0}, angle[3] = {0.0, 1e-3, 0.5};
    (void)state;
    scene from = on_line(3, 0.0, 0.0);
    take_steps(&from.r, 1e-3, 5);
    for (int i = 0; i < 3; i++) {
        scene to = on_line(4, across[i], angle[i]);
        const uint64_t before = rig_hash(&to.r);
        assert_int_equal(dmb_sim_transfer_state(to.r.sim, from.r.sim), DMB_ERR_VALUE);
        print_message("    %s\n", dmb_sim_message(to.r.sim));
        assert_non_null(strstr(dmb_sim_message(to.r.sim), "axial-torsional pipes are described off the line"));
        assert_true(rig_hash(&to.r) == before);
        rig_close(&to.r);
    }
    scene to = on_line(4, 0.0, 0.0);
    assert_true(dmb_sim_transfer_state(to.r.sim, from.r.sim) >= 0);
    rig_close(&to.r);
    rig_close(&from.r);
}

/* Of two strings the first is off the line: nothing of either is taken. */
static void the_first_of_two_off_the_line(void **state)
{
    rig s[2];
    (void)state;
    for (int i = 0; i < 2; i++) {
        rig_open(&s[i], 0.0, 0.0, 0.0);
        for (int k = 0; k < 2; k++) {
            dmb_string_def string = dmb_string_def_default();
            dmb_pipe_def pipe = s1_pipe();
            string.follows_hole = 0;
            string.start_free = DMB_FREE_CYLINDRICAL;
            string.position[1] = 3.0 * k + (i > 0 && k == 0 ? 1e-3 : 0.0);
            string.velocity[0] = 1.0;
            pipe.string = add_string(&s[i], &string);
            pipe.kind = DMB_PIPE_AXIAL_TORSIONAL;
            (void)add_pipes(&s[i], &pipe, 3 + (uint32_t)i);
        }
        (void)rig_start(&s[i], NULL);
    }
    take_steps(&s[0], 1e-3, 5);
    const uint64_t before = rig_hash(&s[1]);
    assert_int_equal(dmb_sim_transfer_state(s[1].sim, s[0].sim), DMB_ERR_VALUE);
    assert_non_null(strstr(dmb_sim_message(s[1].sim), "axial-torsional pipes are described off the line"));
    assert_true(rig_hash(&s[1]) == before);
    for (int i = 0; i < 2; i++) rig_close(&s[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(places_go_on), cmocka_unit_test(off_the_line),
                                       cmocka_unit_test(the_first_of_two_off_the_line)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
