#include "pushed_column.h"

#include <string.h>

pushed_column column_open(const column_choice *choice)
{
    pushed_column c;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def load = dmb_load_def_default();
    dmb_sim_options options = dmb_sim_options_default();
    memset(&c, 0, sizeof c);
    rig_open(&c.s, 0.0, 0.0, -choice->gravity);
    string.start_free = choice->start_free;
    pipe.string = c.string = add_string(&c.s, &string);
    (void)add_pipes(&c.s, &pipe, 10);
    load.place = dmb_station(c.string, 9, 1.0);
    load.force[0] = -choice->push;
    load.force[1] = choice->aside;
    c.load = add_load(&c.s, &load);
    if (choice->start_free == DMB_FREE_CYLINDRICAL)
        c.control = add_simple_drive(&c.s, DMB_DRIVE_CONTROL, c.string, DMB_RX, add_constant(&c.s, 0.0));
    options.allocator = choice->allocator;
    (void)rig_start(&c.s, &options);
    return c;
}

pushed_column column_beside_a_free_body(void)
{
    pushed_column c;
    dmb_string_def string = dmb_string_def_default();
    const dmb_body_def body = dmb_body_def_default();
    dmb_pipe_def pipe = s1_pipe();
    dmb_load_def load = dmb_load_def_default();
    memset(&c, 0, sizeof c);
    rig_open(&c.s, 0.0, 0.0, 0.0);
    string.start_free = DMB_FREE_NONE;
    pipe.string = c.string = add_string(&c.s, &string);
    (void)add_pipes(&c.s, &pipe, 4);
    (void)add_body(&c.s, &body);
    load.place = dmb_station(c.string, 3, 1.0);
    load.time_function = add_constant(&c.s, 0.0);
    load.force[0] = -1.0;
    c.load = add_load(&c.s, &load);
    (void)rig_start(&c.s, NULL);
    return c;
}

void column_close(pushed_column *c)
{
    rig_close(&c->s);
}

void must_say(const rig *s, const char *words)
{
    if (strstr(dmb_sim_message(s->sim), words) == NULL)
        fail_msg("'%s' does not say %s", dmb_sim_message(s->sim), words);
}
