/* Parts described on the axis of a hole are on it, also where the hole turns back or crosses itself. */
#include "random_hole.h"
#include "relations.h"

enum { TOPIC_HOLE_PARTS = TOPIC_OF_RELATION + 60, SUPPORTS = 3 };

#define DESCRIBED_GAP 1e-9 /* [m] that the gap of a place on a node may be off */
/* [-] of curvature times the square of its length: how far an element, with its shear, is off an axis whose curvature
 * jumps between its ends. */
#define DESCRIBED_BEND 0.05

typedef struct in_hole {
    random_hole hole;
    dmb_model *model;
    dmb_sim *sim;
    dmb_id string, ball;
    uint32_t pipes, elements, contact_points;
    double start, length; /* [m] */
    double ball_depth, ball_at[3];
    int32_t with_ball;
} in_hole;

#define HOLE 0.1 /* [m] diameters */
#define PIPE 0.073
#define BALL 0.05

static void draw(trial *t, in_hole *s)
{
    static const uint32_t elements[] = {1, 2, 4};
    stream n = stream_of(t->s.seed, t->s.number, TOPIC_HOLE_PARTS);
    memset(s, 0, sizeof *s);
    random_hole_draw(1 + t->s.seed * 1000003 + t->s.number, (int)(t->s.number % RANDOM_HOLE_SHAPES), &s->hole);
    const double end = s->hole.survey[s->hole.stations - 1][0];
    s->start = draw_number(&n, 0.0, 20.0);
    s->length = draw_number(&n, 2.0, 10.0);
    s->elements = elements[draw_count(&n, 0, 2)];
    s->contact_points = draw_chance(&n, 0.3) ? draw_count(&n, 3, 5) : 0;
    s->pipes = (uint32_t)((end - s->start) / s->length);
    s->ball_depth = draw_number(&n, 0.0, end);
}

static int32_t add_string_of(in_hole *s)
{
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.start_depth = s->start;
    string.start_free = DMB_FREE_NONE;
    pipe.length = s->length;
    pipe.elements = s->elements;
    if (s->contact_points > 0) pipe.contact_points = s->contact_points;
    pipe.outer_diameter = PIPE;
    pipe.inner_diameter = 0.061;
    const int32_t status = dmb_model_add_string(s->model, &string, &s->string);
    pipe.string = s->string;
    return status < 0 ? status : dmb_model_add_pipes(s->model, &pipe, s->pipes, NULL);
}

static int32_t add_ball(in_hole *s)
{
    dmb_body_def body = dmb_body_def_default();
    body.mass = 1.0;
    for (int i = 0; i < 3; ++i) {
        body.inertia[i] = 0.01;
        body.position[i] = s->ball_at[i];
    }
    body.contact_diameter = BALL;
    body.contact_length = 0.1;
    return dmb_model_add_body(s->model, &body, &s->ball);
}

/* Supports on the axis that the string stands on already. */
static int32_t add_supports(in_hole *s)
{
    int32_t status = DMB_OK;
    for (uint32_t i = 1; i <= SUPPORTS && status >= 0; ++i) {
        dmb_joint_def joint = dmb_joint_def_default();
        joint.kind = DMB_JOINT_POINT_ON_HOLE;
        joint.place_b = dmb_station(s->string, i * (s->pipes - 1) / SUPPORTS, 1.0);
        status = dmb_model_add_joint(s->model, &joint, NULL);
    }
    return status;
}

static int32_t open_hole(in_hole *s)
{
    dmb_wall_def wall = dmb_wall_def_default();
    wall.diameter = HOLE;
    wall.survey = s->hole.survey[0];
    wall.survey_count = s->hole.stations;
    int32_t status = dmb_model_create(NULL, &s->model);
    if (status >= 0) status = dmb_model_add_wall(s->model, &wall, NULL);
    if (status >= 0) status = add_string_of(s);
    if (status >= 0) status = s->with_ball ? add_ball(s) : add_supports(s);
    if (status >= 0) status = dmb_model_compile(s->model, NULL);
    return status < 0 ? status : dmb_sim_create(s->model, NULL, &s->sim);
}

static void close_hole(in_hole *s)
{
    dmb_sim_destroy(&s->sim);
    dmb_model_destroy(&s->model);
}

static int is_of(dmb_id a, dmb_id b)
{
    return a.index == b.index && a.generation == b.generation;
}

static void hold_gaps(trial *t, const in_hole *s)
{
    dmb_model_info info = dmb_model_info_default();
    (void)dmb_model_get_info(s->model, &info);
    for (uint32_t i = 0; i < info.contact_points; ++i) {
        dmb_contact contact = dmb_contact_default();
        (void)dmb_query_contact(s->sim, i, &contact);
        const int ball = s->with_ball && is_of(contact.part, s->ball);
        const double clearance = 0.5 * (HOLE - (ball ? BALL : PIPE));
        const double element = s->length / s->elements;
        hold(t, ball ? "gap of a ball on the axis" : "gap of a string on the axis", fabs(contact.gap - clearance),
             s->contact_points > 0 && !ball ? DESCRIBED_BEND * s->hole.curvature * element * element : DESCRIBED_GAP);
    }
}

/* Measured depths along the string; a section inside an element is on the axis but for how the hole bends in it. */
static void hold_depths(trial *t, const in_hole *s)
{
    for (uint32_t k = 0; k < s->pipes; ++k)
        for (int i = 0; i < 4; ++i) {
            dmb_pose pose = dmb_pose_default();
            (void)dmb_query_pose(s->sim, dmb_station(s->string, k, i / 3.0), &pose);
            const double want = s->start + (k + i / 3.0) * s->length;
            hold(t, "measured depth along a string", fabs(pose.depth - want), i % 3 == 0 ? 1e-7 : 0.01 * s->length);
        }
}

/* Nothing was moved to close the supports. */
static void hold_supports(trial *t, const in_hole *s)
{
    dmb_statistics counts = dmb_statistics_default();
    (void)dmb_query_statistics(s->sim, &counts);
    hold(t, "moved by supports on the axis [m]", counts.assembly[0], 1e-8);
    hold(t, "turned by supports on the axis [rad]", counts.assembly[1], 1e-8);
}

static void find_ball(in_hole *s)
{
    dmb_hole_point at = dmb_hole_point_default();
    (void)dmb_query_hole(s->model, s->ball_depth, &at);
    memcpy(s->ball_at, at.position, sizeof s->ball_at);
}

static void check_followed(trial *t)
{
    static in_hole s;
    draw(t, &s);
    for (s.with_ball = 0; s.with_ball < 2 && t->verdict == VERDICT_HELD; ++s.with_ball) {
        const int32_t status = open_hole(&s);
        if (status < 0) {
            refused(t, status, dmb_model_message(s.model));
        } else {
            hold_gaps(t, &s);
            hold_depths(t, &s);
            if (!s.with_ball) hold_supports(t, &s);
            find_ball(&s);
        }
        close_hole(&s);
    }
}

const relation relation_followed = {"followed",
                                    "a string, supports and a ball described on the axis of a hole that turns back",
                                    {FAMILY_BENT, WISH_FLEXIBLE, 0},
                                    60,
                                    1.0,
                                    check_followed,
                                    0.0};
