#include "options.h"

#include "../command_line.h"

/* ---- Names ------------------------------------------------------------------------------------------------------- */

static const char *const systems[] = {[DMB_PIPE_FLEXIBLE] = "flexible",
                                      [DMB_PIPE_AXIAL_TORSIONAL] = "axial-torsional",
                                      [DMB_PIPE_RIGID] = "rigid",
                                      [3] = NULL};
static const char *const couples[] = {[RIG_NO_COUPLING] = "none",
                                      [RIG_CONTACT] = "contact",
                                      [RIG_FRICTION] = "friction",
                                      [RIG_VIBRATION] = "vibration",
                                      [4] = NULL};

const char *rig_system_name(const rig_variant *variant)
{
    return systems[variant->pipe_kind];
}

const char *rig_couple_name(const rig_variant *variant)
{
    return couples[variant->couple];
}

/* ---- Options ----------------------------------------------------------------------------------------------------- */

rig_options rig_options_default(void)
{
    const rig_options options = {.variant = {DMB_PIPE_FLEXIBLE, RIG_VIBRATION},
                                 .all = 1,
                                 .threads = 1,
                                 .pipes = 100,
                                 .elements = 1,
                                 .seed = 1,
                                 .length = 1.0,
                                 .bit = 0.0,
                                 .step = 1e-3,
                                 .end = 40.0,
                                 .rate = 200.0,
                                 .cycle = rig_cycle_full()};
    return options;
}

typedef struct flags {
    int32_t system, couple;
    int system_given, couple_given, all, quick;
    double bit_mm;
} flags;

static int read_all(int count, char **words, rig_options *o, flags *f)
{
    static const char about[] = "Drills 100 m into a coal seam and pulls the string out again: a rig head, flexible "
                                "pipes, a bit and the wall of "
                                "the hole, over the 40 s cycle start - drill - stop - rest - reverse start - pull out.";
    const command_option table[] = {
        {.help = "The model:"},
        {.name = "system",
         .letter = 's',
         .value = "KIND",
         .help = "pipes (flexible)",
         .choice = &f->system,
         .choices = systems,
         .given = &f->system_given},
        {.name = "couple",
         .letter = 'c',
         .value = "KIND",
         .choice = &f->couple,
         .choices = couples,
         .given = &f->couple_given,
         .help = "contact: the string meets the wall; friction: and rubs on it; vibration (default): and is excited by "
                 "eccentric "
                 "pipes and the drive; none: no wall, no weight and no load on the bit"},
        {.name = "all",
         .given = &f->all,
         .help = "run the four variants that the pictures show: rigid, and flexible with contact, friction and "
                 "vibration; so it is "
                 "unless --system or --couple say otherwise"},
        {.name = "pipes", .value = "N", .help = "number of pipes (100)", .low = 1.0, .high = 1e6, .whole = &o->pipes},
        {.name = "length",
         .value = "METRES",
         .help = "length of one pipe (1)",
         .low = 0.05,
         .high = 100.0,
         .number = &o->length},
        {.name = "bit",
         .value = "MM",
         .low = 0.0,
         .high = 94.0,
         .number = &f->bit_mm,
         .help =
             "diameter at which the bit meets the wall; 0 (default): the coal breaks out around it and it does not"},
        {.name = "seed",
         .value = "N",
         .help = "of the random angles of the eccentric masses (1)",
         .low = 0.0,
         .high = 4294967295.0,
         .whole = &o->seed},
        {.help = "The computation:"},
        {.name = "elements",
         .value = "N",
         .help = "elements in one pipe (1)",
         .low = 1.0,
         .high = 1024.0,
         .whole = &o->elements},
        {.name = "step", .value = "S", .help = "time step (1e-3)", .low = 1e-7, .high = 0.1, .number = &o->step},
        {.name = "time",
         .value = "S",
         .help = "stop at this time (end of the cycle)",
         .low = 1e-3,
         .high = 1e4,
         .number = &o->end},
        {.name = "drop",
         .help = "start straight on the axis of the hole instead of at rest on its low side",
         .given = &o->dropped},
        {.name = "quick",
         .help = "a cycle of 8 s instead of 40 s: same ramps, 2 s of drilling and of pulling out",
         .given = &f->quick},
        {.name = "threads",
         .value = "N",
         .help = "that run variants side by side (1)",
         .low = 1.0,
         .high = 64.0,
         .whole = &o->threads},
        {.help = "The output:"},
        {.name = "output",
         .letter = 'o',
         .value = "FOLDER",
         .help = "folder for tables and ParaView files (./gas_drainage_rig)",
         .text = &o->output},
        {.name = "rate",
         .value = "HZ",
         .help = "rows a second in the tables (200)",
         .low = 1.0,
         .high = 1e5,
         .number = &o->rate},
        {.name = "quiet", .letter = 'q', .help = "no progress bar", .given = &o->quiet}};
    return command_line(count, words, about, table, sizeof table / sizeof *table);
}

rig_options rig_options_read(int count, char **words)
{
    rig_options options = rig_options_default();
    flags f = {.system = options.variant.pipe_kind, .couple = options.variant.couple};
    options.end = 0.0;
    options.output = "gas_drainage_rig";
    const int stop = read_all(count, words, &options, &f);
    if (stop >= 0) exit(stop);
    options.variant.pipe_kind = f.system;
    options.variant.couple = f.couple;
    options.all = f.all || !(f.system_given || f.couple_given);
    options.bit = 1e-3 * f.bit_mm;
    if (f.quick) options.cycle = rig_cycle_quick();
    if (!(options.end > 0.0)) options.end = options.cycle.time[RIG_STAGES];
    return options;
}
