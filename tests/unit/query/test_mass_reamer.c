/* Kinetic energy, part by part, of two strings: one with bit and head, one with a reamer on a ring of its, whose mass
 * is the ring's. */
#include "close.h"
#include "drillmbd/scene.h"
#include "rig.h"

typedef struct craft {
    rig s;
    dmb_id string[2], head, bit[2], ring, reamer;
} craft;

enum { PIPES = 3 };

static void add_one(craft *c, int i)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_bit_def bit = dmb_bit_def_default();
    string.start_free = DMB_FREE_ALL;
    string.start_depth = 10.0 + 40.0 * i;
    for (int k = 0; k < 6; k++) string.velocity[k] = 0.3 - 0.1 * k + 0.2 * i;
    string.velocity[3] = 8.0;
    c->string[i] = pipe.string = bit.string = add_string(&c->s, &string);
    pipe.elements = 2;
    (void)add_pipes(&c->s, &pipe, PIPES);
    bit.mass = 9.0 + i;
    must_model(&c->s, dmb_model_add_bit(c->s.model, &bit, &c->bit[i]));
}

static craft launch(void)
{
    craft c;
    dmb_wall_def wall = s1_hole();
    dmb_body_def head = dmb_body_def_default();
    dmb_stabiliser_def ring = dmb_stabiliser_def_default();
    dmb_bit_def reamer = dmb_bit_def_default();
    rig_open(&c.s, 0.0, 0.0, 0.0);
    (void)add_wall(&c.s, &wall);
    for (int i = 0; i < 2; i++) add_one(&c, i);
    head.string = c.string[0];
    head.attach = DMB_ATTACH_START;
    head.mass = 30.0;
    c.head = add_body(&c.s, &head);
    ring.string = c.string[1];
    ring.pipe = 1;
    ring.fraction = 0.5;
    ring.outer_diameter = 0.09;
    must_model(&c.s, dmb_model_add_stabiliser(c.s.model, &ring, &c.ring));
    reamer.stabiliser = c.ring;
    reamer.inner_radius = 0.03;
    reamer.radius = 0.045;
    must_model(&c.s, dmb_model_add_bit(c.s.model, &reamer, &c.reamer));
    (void)rig_start(&c.s, NULL);
    return c;
}

static double kinetic(const craft *c, dmb_id part, uint32_t pipe)
{
    double energy = (double)NAN;
    must(&c->s, dmb_query_kinetic_energy(c->s.sim, part, pipe, &energy));
    return energy;
}

/* Every part once: pipes hold half of head and bits, so the other halves are added, and a ring in the middle of a pipe
 * is a part beside it. */
static void pipes_of_both_strings_add_up(void **state)
{
    (void)state;
    craft c = launch();
    for (int run = 0; run < 2; run++) {
        double sum = 0.5 * (kinetic(&c, c.head, 0) + kinetic(&c, c.bit[0], 0) + kinetic(&c, c.bit[1], 0));
        sum += kinetic(&c, c.ring, 0);
        for (int i = 0; i < 2; i++)
            for (uint32_t k = 0; k < PIPES; k++) sum += kinetic(&c, c.string[i], k);
        const double whole = energy_of(&c.s).kinetic;
        CHECK_CLOSE(sum, whole, 1e-12 * whole);
        assert_true(kinetic(&c, c.ring, 0) > 0.0);
        CHECK_CLOSE(kinetic(&c, c.reamer, 0), 0.0, 0.0);
        take_steps(&c.s, 1e-4, 20);
    }
    rig_close(&c.s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pipes_of_both_strings_add_up)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
