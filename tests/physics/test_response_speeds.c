/* Speeds to avoid: bands of a Jeffcott rotor that is shaken at two orders of its speed against its closed form.
 * Equations: eq:response.severity. */
#include <stdio.h>
#include <string.h>

#include "harmonic.h"

/* k 1e6 N/m, m 50 kg, damping ratio 0.02; 5e-3 kg m at the speed W, 60 N at 2 W; 1 mm allowed. */
static double severity_of(double W)
{
    const double k = 1e6, m = 50.0, c = 2.0 * 0.02 * sqrt(k * m);
    const double once = 5e-3 * W * W / cabs(k - m * W * W + i_ * W * c);
    const double twice = 60.0 / cabs(k - 4.0 * m * W * W + 2.0 * i_ * W * c);
    return (once + twice) / 1e-3;
}

/* The speed between two others at which the severity is 1. */
static double edge(double below, double above)
{
    for (int i = 0; i < 200; i++) {
        const double middle = 0.5 * (below + above);
        if (severity_of(middle) > 1.0)
            above = middle;
        else
            below = middle;
    }
    return above;
}

/* Golden section. */
static double worst_between(double a, double b)
{
    const double g = 0.5 * (sqrt(5.0) - 1.0);
    for (int i = 0; i < 100; i++) {
        const double c = b - g * (b - a), d = a + g * (b - a);
        if (severity_of(c) > severity_of(d))
            b = d;
        else
            a = c;
    }
    return 0.5 * (a + b);
}

static dmb_place open_measured_rotor(rig *s)
{
    rig_open(s, 0.0, 0.0, 0.0);
    dmb_body_def disc = dmb_body_def_default();
    disc.mass = 50.0;
    disc.free_mask = DMB_FREE_Y;
    dmb_joint_def shaft = dmb_joint_def_default();
    shaft.kind = DMB_JOINT_FREE;
    shaft.place_b = dmb_station(add_body(s, &disc), 0, 0.0);
    shaft.stiffness[1] = 1e6;
    shaft.damping[1] = 2.0 * 0.02 * sqrt(1e6 * 50.0);
    must_model(s, dmb_model_add_joint(s->model, &shaft, NULL));
    (void)rig_start(s, NULL);
    return shaft.place_b;
}

enum { BANDS = 4, GRID = 60 };

static int32_t find_bands(const rig *s, dmb_place place, double margin, uint32_t *count, dmb_speed_band *bands,
                          double *severity)
{
    const double limit = 1e-3;
    dmb_speeds_options options = dmb_speeds_options_default();
    dmb_order orders[2] = {dmb_order_default(), dmb_order_default()};
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, place, DMB_Y);
    orders[0].excitation = force_at(place, DMB_Y);
    orders[0].excitation.kind = DMB_EXCITATION_UNBALANCE;
    orders[0].excitation.amplitude = 5e-3;
    orders[1].order = 2.0;
    orders[1].excitation = force_at(place, DMB_Y);
    orders[1].excitation.amplitude = 60.0;
    options.points = GRID;
    options.speed_low = 30.0;
    options.speed_high = 300.0;
    options.margin = margin;
    for (uint32_t i = 0; i < *count; i++) bands[i] = dmb_speed_band_default();
    const int32_t status = dmb_analysis_speeds(s->sim, &options, orders, 2, &output, &limit, 1, bands, count, severity);
    must(s, status);
    return status;
}

/* Edges and the share of the other order come from straight lines between points 4.6 rad/s apart. */
static void bands_of_a_rotor(void **state)
{
    (void)state;
    const double natural = sqrt(1e6 / 50.0), start[2] = {0.5 * natural, natural}, far[3] = {40.0, 100.0, 299.0};
    uint32_t count = BANDS;
    dmb_speed_band bands[BANDS];
    double severity[GRID];
    rig s;
    const dmb_place place = open_measured_rotor(&s);
    assert_int_equal(find_bands(&s, place, 0.0, &count, bands, severity), DMB_OK);
    assert_int_equal(count, 2);
    for (uint32_t i = 0; i < 2; i++) {
        const double worst = worst_between(0.95 * start[i], 1.05 * start[i]);
        check_relative(i == 0 ? "band of order 2: low end" : "band of order 1: low end", bands[i].low,
                       edge(far[i], worst), 2e-3);
        check_relative("    high end", bands[i].high, edge(far[i + 1], worst), 2e-3);
        check_relative("    worst speed", bands[i].speed, worst, 1e-4);
        check_relative("    severity there", bands[i].severity, severity_of(worst), 1e-4);
        check_relative("    its frequency", bands[i].frequency, (i == 0 ? 2.0 : 1.0) * bands[i].speed / (2.0 * PI),
                       1e-14);
        assert_int_equal(bands[i].order, 1 - i);
        assert_int_equal(bands[i].output, 0);
    }
    double most = 0.0, least = 1e9;
    for (int i = 0; i < GRID; i++) most = fmax(most, severity[i]), least = fmin(least, severity[i]);
    check_relative("largest severity of the table", most, bands[1].severity, 1e-14);
    check_relative("    first one", severity[0], severity_of(30.0), 1e-12);
    assert_true(least > 0.0 && least < 0.5);
    rig_close(&s);
}

/* A margin widens and joins; room for one band of two is told. */
static void margins_and_room(void **state)
{
    (void)state;
    uint32_t count = BANDS;
    dmb_speed_band bands[BANDS], narrow[BANDS];
    rig s;
    const dmb_place place = open_measured_rotor(&s);
    (void)find_bands(&s, place, 0.0, &count, narrow, NULL);
    count = BANDS;
    assert_int_equal(find_bands(&s, place, 0.1, &count, bands, NULL), DMB_OK);
    assert_int_equal(count, 2);
    check_relative("with a margin of 0.1: low end", bands[0].low, 0.9 * narrow[0].low, 1e-14);
    check_relative("    high end", bands[1].high, 1.1 * narrow[1].high, 1e-14);
    count = BANDS;
    assert_int_equal(find_bands(&s, place, 0.4, &count, bands, NULL), DMB_OK);
    assert_int_equal(count, 1);
    check_relative("with 0.4 they are one: severity", bands[0].severity, narrow[1].severity, 1e-14);
    check_relative("    high end", bands[0].high, 1.4 * narrow[1].high, 1e-14);
    count = 1;
    assert_int_equal(find_bands(&s, place, 0.0, &count, bands, NULL), DMB_NOTE_FULL);
    assert_int_equal(count, 1);
    check_relative("room for one: the lowest", bands[0].speed, narrow[0].speed, 1e-14);
    rig_close(&s);
}

/* Orders 2, 1.3 and 1: three peaks, at half the natural speed, at it over 1.3, and at it. With a margin the last two
 * are one band, of the higher peak, whichever that is, and count as one where there is room for the first alone. Of two
 * outputs the one that is worse over its limit is told. */
static void bands_that_run_into_each_other(void **state)
{
    (void)state;
    const double natural = sqrt(1e6 / 50.0), limits[2] = {1e-3, 2.5e-5 * natural};
    rig s;
    const dmb_place place = open_measured_rotor(&s);
    for (int k = 0; k < 8; k++) {
        const int higher = k % 2, wide = k / 2 % 2, room = k / 4 ? 1 : BANDS;
        dmb_speeds_options options = dmb_speeds_options_default();
        dmb_speeds_report report = dmb_speeds_report_default();
        dmb_order orders[3] = {dmb_order_default(), dmb_order_default(), dmb_order_default()};
        dmb_speed_band bands[BANDS];
        const dmb_output outputs[2] = {output_at(DMB_OUTPUT_VIBRATION, place, DMB_Y),
                                       output_at(DMB_OUTPUT_VIBRATION_VELOCITY, place, DMB_Y)};
        uint32_t count = (uint32_t)room;
        for (int i = 0; i < BANDS; i++) bands[i] = dmb_speed_band_default();
        for (int i = 0; i < 3; i++) {
            orders[i].order = i == 0 ? 2.0 : i == 1 ? 1.3 : 1.0;
            orders[i].excitation = force_at(place, DMB_Y);
            orders[i].excitation.amplitude = i == 0 ? 60.0 : i == 1 + higher ? 100.0 : 80.0;
        }
        options.points = 400;
        options.speed_low = 30.0;
        options.speed_high = 300.0;
        options.threshold = 45.0; /* of the velocity, the worse one: 40 times its share of the displacement */
        options.margin = wide ? 0.12 : 0.0;
        options.report = &report;
        const int32_t status = dmb_analysis_speeds(s.sim, &options, orders, 3, outputs, limits, 2, bands, &count, NULL);
        must(&s, status);
        const uint32_t found = wide ? 2 : 3;
        assert_int_equal(report.bands, found);
        assert_int_equal(status, room == 1 ? DMB_NOTE_FULL : DMB_OK);
        assert_int_equal(count, room == 1 ? 1 : found);
        check_relative("first of the bands", bands[0].speed, 0.5 * natural, 2e-3);
        for (uint32_t i = 0; i < count; i++) assert_int_equal(bands[i].output, 1);
        if (room == 1) continue;
        check_relative("last of them", bands[found - 1].speed, wide && !higher ? natural / 1.3 : natural, 2e-3);
        assert_int_equal(bands[found - 1].order, wide && !higher ? 1 : 2);
        if (wide) assert_true(bands[1].low < natural / 1.3 && bands[1].high > natural);
    }
    rig_close(&s);
}

/* ---- What an answer lacks ---------------------------------------------------------------------------------------- */

enum { UNDAMPED = 1, SILENT = 2, HELD_OUTPUT = 4 };

/* A disc on a spring, natural speed 141 rad/s: with or without its damper, its force, an output that can move. */
static int32_t ask(int flags, double eta, double low, double high, dmb_speeds_report *report, dmb_speed_band *band,
                   char *message, size_t size)
{
    rig s;
    dmb_body_def disc = dmb_body_def_default();
    dmb_joint_def shaft = dmb_joint_def_default();
    dmb_speeds_options options = dmb_speeds_options_default();
    dmb_order order = dmb_order_default();
    const double limit = 1e-3;
    uint32_t count = 1;
    rig_open(&s, 0.0, 0.0, 0.0);
    disc.mass = 50.0;
    disc.free_mask = DMB_FREE_Y;
    shaft.kind = DMB_JOINT_FREE;
    shaft.place_b = dmb_station(add_body(&s, &disc), 0, 0.0);
    shaft.stiffness[1] = 1e6;
    shaft.damping[1] = flags & UNDAMPED ? 0.0 : 100.0;
    must_model(&s, dmb_model_add_joint(s.model, &shaft, NULL));
    (void)rig_start(&s, NULL);
    const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, shaft.place_b, flags & HELD_OUTPUT ? DMB_Z : DMB_Y);
    order.excitation = force_at(shaft.place_b, DMB_Y);
    order.excitation.amplitude = flags & SILENT ? 0.0 : 200.0;
    options.points = 61;
    options.speed_low = low;
    options.speed_high = high;
    options.structural_damping = eta;
    options.report = report;
    *report = dmb_speeds_report_default();
    *band = dmb_speed_band_default();
    const int32_t status = dmb_analysis_speeds(s.sim, &options, &order, 1, &output, &limit, 1, band, &count, NULL);
    must(&s, status);
    (void)snprintf(message, size, "%s", dmb_sim_message(s.sim));
    rig_close(&s);
    return status;
}

static void answers_that_lack_something(void **state)
{
    static const struct {
        int flags;
        double eta, low, high;
        int32_t status, undamped, cut;
        uint32_t silent, bands;
        const char *text;
    } cases[] = {
        {0, 0.0, 30.0, 300.0, DMB_OK, 0, 0, 0, 1, ""},
        {UNDAMPED, 0.0, 30.0, 300.0, DMB_NOTE_INCOMPLETE, 1, 0, 0, 1, "nothing damps"},
        {UNDAMPED, 0.02, 30.0, 300.0, DMB_OK, 0, 0, 0, 1, ""},
        {SILENT, 0.0, 30.0, 300.0, DMB_NOTE_INCOMPLETE, 0, 0, 1, 0, "order 0 (1) moves no output"},
        {HELD_OUTPUT, 0.0, 30.0, 300.0, DMB_NOTE_INCOMPLETE, 0, 0, 1, 0, "order 0 (1) moves no output"},
        {0, 0.0, 140.0, 300.0, DMB_NOTE_INCOMPLETE, 0, 1, 0, 1, "beyond speed_low of 140 .. 300"},
        {0, 0.0, 30.0, 141.0, DMB_NOTE_INCOMPLETE, 0, 2, 0, 1, "beyond speed_high of 30 .. 141"},
        {0, 0.0, 140.0, 142.0, DMB_NOTE_INCOMPLETE, 0, 3, 0, 1, "beyond both"},
        {UNDAMPED | SILENT, 0.0, 30.0, 300.0, DMB_NOTE_INCOMPLETE, 1, 0, 1, 0, "nothing damps"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        dmb_speeds_report report;
        dmb_speed_band band;
        char message[256];
        const int32_t status =
            ask(cases[i].flags, cases[i].eta, cases[i].low, cases[i].high, &report, &band, message, sizeof message);
        if (status != cases[i].status || report.undamped != cases[i].undamped || report.truncated != cases[i].cut ||
            report.silent_orders != cases[i].silent || report.bands != cases[i].bands ||
            band.truncated != cases[i].cut || strstr(message, cases[i].text) == NULL)
            fail_msg("case %zu: status %d, undamped %d, cut %d, %u silent, %u bands, band cut %d: %s", i, status,
                     report.undamped, report.truncated, report.silent_orders, report.bands, band.truncated, message);
    }
}

/* Gyroscopic terms of a string that turns are no damping. */
static void gyroscopic_terms_do_not_damp(void **state)
{
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        rig s;
        dmb_string_def string = dmb_string_def_default();
        dmb_pipe_def pipe = dmb_pipe_def_default();
        dmb_speeds_options options = dmb_speeds_options_default();
        dmb_speeds_report report = dmb_speeds_report_default();
        dmb_order order = dmb_order_default();
        dmb_speed_band band = dmb_speed_band_default();
        const double limit = 1.0;
        uint32_t count = 1;
        rig_open(&s, 0.0, 0.0, 0.0);
        string.follows_hole = 0;
        string.start_free = DMB_FREE_RX;
        string.velocity[3] = 20.0;
        pipe.string = add_string(&s, &string);
        pipe.damping_time = damped ? 1e-4 : 0.0;
        const dmb_id id = add_pipes(&s, &pipe, 4);
        (void)rig_start(&s, NULL);
        const dmb_output output = output_at(DMB_OUTPUT_VIBRATION, dmb_station(id, 3, 1.0), DMB_Y);
        order.excitation = force_at(dmb_station(id, 3, 1.0), DMB_Y);
        options.report = &report;
        options.points = 5;
        must(&s, dmb_analysis_speeds(s.sim, &options, &order, 1, &output, &limit, 1, &band, &count, NULL));
        assert_int_equal(report.undamped, !damped);
        rig_close(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bands_of_a_rotor),
        cmocka_unit_test(margins_and_room),
        cmocka_unit_test(bands_that_run_into_each_other),
        cmocka_unit_test(answers_that_lack_something),
        cmocka_unit_test(gyroscopic_terms_do_not_damp),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
