// The C++ binding: owners that clean up and can be moved, failures as exceptions or statuses, a scene from end to end.
#include "drillmbd.hpp"
#include "expect.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <type_traits>
#include <utility>

namespace {

// The status with which a call throws; 0 if it does not.
template <typename Call>
std::int32_t thrown_by(Call call)
{
    try {
        call();
    } catch (const drillmbd::error &error) {
        EXPECT(std::string(error.what()).find(error.name()) == 0);
        return error.status();
    }
    return 0;
}

// ---- Blocks that are counted ----------------------------------------------------------------------------------------
struct counter {
    int live;
};

void *take(void *context, std::size_t size, std::size_t alignment)
{
    ++static_cast<counter *>(context)->live;
    void *block = nullptr;
    return posix_memalign(&block, alignment, size) == 0 ? block : nullptr;
}

void give(void *context, void *block, std::size_t, std::size_t)
{
    --static_cast<counter *>(context)->live;
    std::free(block);
}

dmb_allocator counting(counter &count)
{
    dmb_allocator allocator = dmb_allocator_default();
    allocator.context = &count;
    allocator.allocate = take;
    allocator.release = give;
    return allocator;
}

// ---- A scene --------------------------------------------------------------------------------------------------------
struct parts {
    drillmbd::string_id string;
    drillmbd::bit_id bit;
    drillmbd::drive_id feed, turning;
};

dmb_segment step_segment(double end, double value)
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_STEP;
    term.x1 = end;
    term.h1 = value;
    return term;
}

parts describe(drillmbd::model &model)
{
    parts made;
    dmb_drive_def drive = dmb_drive_def_default();
    model.set_environment(dmb_environment_def_default());
    model.add_wall(dmb_wall_def_default());
    made.string = model.add_pipes(dmb_pipe_def_default(), 5);
    made.bit = model.add_bit(dmb_bit_def_default());
    drive.time_function = model.add_time_function({step_segment(0.01, 0.04), step_segment(0.02, 0.01)});
    std::strcpy(drive.name, "feed");
    made.feed = model.add_drive(drive);
    drive = dmb_drive_def_default();
    drive.kind = DMB_DRIVE_LOAD;
    drive.component = DMB_RX;
    drive.time_function = model.add_time_function(step_segment(0.01, 20.0));
    made.turning = model.add_drive(drive);
    EXPECT(model.compile() == DMB_OK);
    return made;
}

void scene_from_end_to_end()
{
    drillmbd::model model;
    const parts made = describe(model);
    drillmbd::sim sim(model);
    dmb_step_report report = dmb_step_report_default();
    const dmb_place tip = dmb_station(made.string, 4, 1.0);
    for (int i = 0; i < 50; ++i) EXPECT(sim.step(1e-3, &report) >= 0);
    EXPECT(std::fabs(sim.time() - 0.05) < 1e-12);
    EXPECT(std::fabs(sim.drive(made.feed).speed - 0.05) < 1e-9);
    EXPECT(sim.pose(tip).displacement[0] > 1e-3);
    EXPECT(sim.pose(tip).position[2] < 0.0);
    EXPECT(std::fabs(sim.motion(tip).velocity[0] - 0.05) < 0.01);
    EXPECT(sim.motion(tip, DMB_FRAME_BODY).frame == DMB_FRAME_BODY);
    EXPECT(sim.rotation(tip) > 0.0);
    dmb_fatigue_options curve = dmb_fatigue_options_default();
    curve.curve_stress = 1e8;
    curve.slope = 3.0;
    drillmbd::fatigue fatigue = sim.fatigue(curve, {dmb_station(made.string, 2, 0.5)});
    fatigue.take(sim);
    EXPECT(fatigue.result().samples == 1);
    drillmbd::window window = sim.window({dmb_output{dmb_place{}, DMB_OUTPUT_BIT_SPEED, 0}});
    window.take(sim);
    EXPECT(window.result().mean == sim.output(DMB_OUTPUT_BIT_SPEED));
    EXPECT(thrown_by([&] { (void)sim.output(DMB_OUTPUT_JOINT_STATE); }) == DMB_ERR_ID);
    EXPECT(std::isfinite(sim.torque_drag({dmb_operation_default()}).at(0).hook_load));
    EXPECT(std::isfinite(sim.profile({DMB_PROFILE_TORQUE}, {0.5, 1.5}).at(1)));
    const std::vector<double> spread = sim.profile({DMB_PROFILE_DISTANCE, DMB_PROFILE_TORQUE}, 3, made.string);
    EXPECT(spread.size() == 6 && spread.at(0) == 0.0 && std::abs(spread.at(4) - 2.0 * spread.at(2)) < 1e-12);
    EXPECT(spread.at(3) == sim.profile({DMB_PROFILE_TORQUE}, {spread.at(2)}).at(0));
    const std::vector<double> extremes = sim.profile_extremes({DMB_PROFILE_DISTANCE, DMB_PROFILE_TORQUE}, 3);
    EXPECT(extremes.at(0) == spread.at(0) && extremes.at(2) == spread.at(4) && extremes.at(3) == spread.at(4));
    EXPECT(extremes.at(6) == std::max(spread.at(1), std::max(spread.at(3), spread.at(5))));
    EXPECT(std::isfinite(sim.section(dmb_station(made.string, 2, 0.5)).force[0]));
    EXPECT(sim.contact(0).number == 0);
    EXPECT(sim.contact_total().normal_force >= 0.0);
    EXPECT(sim.kinetic_energy(made.string, 2) > 0.0);
    EXPECT(sim.energy().kinetic > 0.0);
    EXPECT(std::fabs(sim.momentum().mass - model.info().mass) < 1e-9);
    EXPECT(std::isfinite(sim.reaction(made.string)[0]));
    EXPECT(sim.bit(made.bit).on_bottom == 0);
    EXPECT(sim.statistics().steps >= 50);
    EXPECT(model.info().pipes == 5);
    EXPECT(model.mesh_errors(made.string, 5).size() == 5);
}

void snapshots()
{
    drillmbd::model model;
    describe(model);
    drillmbd::sim sim(model), other(model);
    sim.advance(0.004);
    const std::vector<unsigned char> saved = sim.snapshot();
    const std::uint64_t hash = sim.hash();
    sim.step(1e-3);
    EXPECT(sim.hash() != hash);
    other.restore(saved);
    EXPECT(other.hash() == hash);
    other.step(1e-3);
    EXPECT(other.hash() == sim.hash());
    EXPECT(thrown_by([&] { sim.restore(std::vector<unsigned char>(10)); }) == DMB_ERR_VALUE);
}

// A, B, C, D by their shapes; D by an entry that does not lie on a row's start.
void matrices_have_shapes(drillmbd::sim &sim, const dmb_place &place)
{
    dmb_excitation pushes[2] = {dmb_excitation_default(), dmb_excitation_default()};
    dmb_output seen[3] = {};
    for (std::int32_t i = 0; i < 3; ++i) {
        pushes[i % 2].place = seen[i].place = place;
        pushes[i % 2].component = i;
        seen[i].quantity = DMB_OUTPUT_VIBRATION + i;
    }
    const drillmbd::state_space space = sim.state_space(pushes, seen);
    const std::size_t states = space.info().states;
    const auto a = space.dense(DMB_MATRIX_A), b = space.dense(DMB_MATRIX_B), c = space.dense(DMB_MATRIX_C),
               d = space.dense(DMB_MATRIX_D);
    EXPECT(a.rows == states && a.columns == states && a.values.size() == states * states);
    EXPECT(b.rows == states && b.columns == 2 && c.rows == 3 && c.columns == states && d.rows == 3 && d.columns == 2);
    EXPECT(b(1, 1) == b.values[3] && c(2, 0) == c.values[2 * states]);
    EXPECT(sim.state_space({}, {}).dense(DMB_MATRIX_B).values.empty());
}

void statics()
{
    drillmbd::model model;
    dmb_string_def string = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    string.start_free = DMB_FREE_NONE;
    model.add_wall(dmb_wall_def_default());
    pipe.string = model.add_string(string);
    model.add_pipes(pipe, 6);
    model.compile();
    drillmbd::sim sim(model);
    EXPECT(sim.static_start().residual < 1e-9);
    drillmbd::state_space space = sim.state_space({}, {});
    matrices_have_shapes(sim, dmb_station(pipe.string, 3, 0.5));
    EXPECT(!space.sparse(DMB_MATRIX_STIFFNESS).values.empty());
    EXPECT(sim.array(DMB_ARRAY_VELOCITY).size() == space.info().rows);
    EXPECT(sim.contact_total().normal_force > 100.0);
}

// Both rods in the plane y = 0, where the hinges keep them anyway.
std::int32_t in_plane(void *, double, std::uint32_t count, const double (*poses)[12], double *value, double *)
{
    for (std::uint32_t i = 0; i < count; ++i) value[i] = poses[i][1];
    return 0;
}

// A double pendulum, its rods joined by a hinge, geared to the first one, with a function that asks for nothing new.
void joints()
{
    drillmbd::model model;
    dmb_body_def body = dmb_body_def_default();
    dmb_joint_def joint = dmb_joint_def_default();
    dmb_coupling_def coupling = dmb_coupling_def_default();
    dmb_constraint_def constraint = dmb_constraint_def_default();
    body.position[0] = 0.5;
    const auto upper = model.add_body(body);
    body.position[0] = 1.5;
    const auto lower = model.add_body(body);
    joint.kind = DMB_JOINT_REVOLUTE;
    joint.match = 1;
    joint.axis_a[0] = 0.0;
    joint.axis_a[1] = 1.0;
    joint.place_b = dmb_station(upper, 0, 0.0);
    const auto hinge = model.add_joint(joint);
    joint.place_a = joint.place_b;
    joint.place_b = dmb_station(lower, 0, 0.0);
    joint.origin_a[0] = 0.5;
    const auto elbow = model.add_joint(joint);
    coupling.joint[0] = elbow;
    coupling.joint[1] = hinge;
    const auto gear = model.add_coupling(coupling);
    constraint.place_count = 2;
    constraint.place[0] = joint.place_a;
    constraint.place[1] = joint.place_b;
    constraint.row_count = 2;
    constraint.callback = in_plane;
    const auto plane = model.add_constraint(constraint);
    joint.place_b.part = dmb_id{0, 0};
    EXPECT(thrown_by([&] { model.add_joint(joint); }) == DMB_ERR_ID);
    model.clear_refused();
    EXPECT(model.compile() == DMB_OK);
    EXPECT(thrown_by([&] { model.add_constraint(constraint); }) == DMB_ERR_ORDER);
    EXPECT(model.info().constraint_rows == 13);
    drillmbd::sim sim(model);
    for (int i = 0; i < 20; ++i) sim.step(1e-3);
    EXPECT(sim.joint(hinge).constraint_rows == 5);
    EXPECT(sim.joint(hinge).speed[DMB_RX] > 0.0);
    EXPECT(std::fabs(sim.joint(hinge).speed[DMB_RX] - sim.joint(elbow).speed[DMB_RX]) < 1e-9);
    EXPECT(sim.joint(elbow, DMB_FRAME_BODY).frame == DMB_FRAME_BODY);
    EXPECT(sim.multipliers(gear).size() == 1);
    EXPECT(sim.multipliers(plane).size() == 2);
    EXPECT(sim.statistics().redundant == 2);
    EXPECT(sim.set_joint(elbow, DMB_JOINT_OPEN) >= 0);
    EXPECT(sim.multipliers(elbow).empty());
    EXPECT(sim.try_set_joint(hinge, 3) == DMB_ERR_VALUE);
    EXPECT(thrown_by([&] { sim.set_joint(drillmbd::joint_id(upper), DMB_JOINT_OPEN); }) == DMB_ERR_ID);
}

// ---- Owners ---------------------------------------------------------------------------------------------------------
void nothing_is_left_behind()
{
    counter count = {0};
    const dmb_allocator allocator = counting(count);
    dmb_model_options options = dmb_model_options_default();
    options.allocator = &allocator;
    {
        drillmbd::model model(options);
        describe(model);
        drillmbd::sim first(model), second(std::move(first));
        EXPECT(!first && second);
        first = drillmbd::sim(model);
        first = std::move(second);
        drillmbd::model moved(std::move(model));
        EXPECT(!model && moved && count.live > 0);
        moved.reset();
        EXPECT(first.step(1e-3) >= 0); // the sim holds what it needs
        dmb_sim *handle = first.release();
        dmb_sim_destroy(&handle);
    }
    EXPECT(count.live == 0);
    EXPECT(thrown_by([&] {
               drillmbd::model model(options);
               describe(model);
               drillmbd::sim sim(model);
               sim.step(-1.0);
           }) == DMB_ERR_VALUE);
    EXPECT(count.live == 0);
}

void all_in_a_pool()
{
    std::vector<unsigned char> memory(1 << 20);
    drillmbd::pool pool(memory.data(), memory.size());
    const std::size_t at_first = pool.peak();
    dmb_model_options options = dmb_model_options_default();
    options.allocator = pool.get();
    drillmbd::model inside(options), outside;
    describe(inside);
    describe(outside);
    drillmbd::sim first(inside), second(outside);
    first.step(1e-3);
    second.step(1e-3);
    EXPECT(first.hash() == second.hash());
    EXPECT(pool.peak() > at_first && pool.peak() <= memory.size());
    EXPECT(thrown_by([&] { drillmbd::pool small(memory.data(), 255); }) == DMB_ERR_VALUE);
    EXPECT(thrown_by([&] { drillmbd::pool none(nullptr, 4096); }) == DMB_ERR_NULL);
}

void sim_in_the_callers_block()
{
    drillmbd::model model;
    describe(model);
    const dmb_sim_options options = dmb_sim_options_default();
    std::vector<unsigned char> block(model.sim_memory_size());
    drillmbd::sim inside(model, options, block.data(), block.size()), outside(model, options);
    inside.step(1e-3);
    outside.step(1e-3);
    EXPECT(inside.hash() == outside.hash());
    EXPECT(thrown_by([&] { drillmbd::sim small(model, options, block.data(), 100); }) == DMB_ERR_VALUE);
    const unsigned char *at = reinterpret_cast<const unsigned char *>(inside.get());
    EXPECT(at >= block.data() && at < block.data() + block.size());
}

// ---- Modes ----------------------------------------------------------------------------------------------------------
void modes_of_a_string()
{
    drillmbd::model model;
    dmb_environment_def none = dmb_environment_def_default();
    none.gravity[2] = 0.0;
    model.set_environment(none);
    const auto string = model.add_pipes(dmb_pipe_def_default(), 4);
    model.compile();
    drillmbd::sim sim(model);
    drillmbd::modes modes = sim.modes();
    EXPECT(modes.size() == 10 && modes.info().rigid == 2);
    EXPECT(modes[0].rigid == 1 && modes[2].frequency > 1.0 && modes[3].frequency >= modes[2].frequency);
    const dmb_mode_shape tip = modes.shape(2, dmb_station(string, 3, 1.0));
    EXPECT(std::abs(tip.re[1]) + std::abs(tip.re[2]) > 0.1 && tip.im[1] == 0.0);
    const drillmbd::modes::energies all = modes.part(2, string), first = modes.part(2, string, 0);
    EXPECT(std::abs(all.kinetic / modes[2].kinetic - 1.0) < 1e-9 &&
           std::abs(all.strain / modes[2].strain - 1.0) < 1e-9);
    EXPECT(first.strain > 0.0 && first.strain < all.strain);
    modes.write_vtk(2, 0.1, 0.0, 2, "mode.vtp");
    EXPECT(std::remove("mode.vtp") == 0);
    EXPECT(thrown_by([&] { modes.write_vtk(2, 0.1, 0.0, 2, "no such folder/mode.vtp"); }) == DMB_ERR_IO);
    EXPECT(thrown_by([&] { (void)modes.part(2, string, 4); }) == DMB_ERR_VALUE);
    dmb_modes_options turning = dmb_modes_options_default();
    turning.kind = DMB_MODES_DAMPED;
    turning.axes = DMB_MODES_AXES_AT_REST;
    turning.spin = 20.0;
    const drillmbd::modes whirling = sim.modes(&turning);
    EXPECT(std::abs(whirling[2].whirl) > 0.9 && std::abs(whirling[2].whirl + whirling[3].whirl) < 1e-6);
    drillmbd::modes taken(std::move(modes));
    EXPECT(!modes && taken);
    dmb_modes_options options = dmb_modes_options_default();
    options.count = 1000;
    EXPECT(thrown_by([&] { (void)sim.modes(&options); }) == DMB_ERR_VALUE);
    EXPECT(thrown_by([&] { (void)taken[10]; }) == DMB_ERR_VALUE);
}

// ---- Frequency response ---------------------------------------------------------------------------------------------
void response_of_a_body()
{
    drillmbd::model model;
    dmb_environment_def none = dmb_environment_def_default();
    dmb_body_def def = dmb_body_def_default();
    none.gravity[2] = 0.0;
    def.mass = 2.0;
    model.set_environment(none);
    const auto body = model.add_body(def);
    model.compile();
    drillmbd::sim sim(model);
    dmb_excitation force = dmb_excitation_default();
    dmb_output move{dmb_place{}, DMB_OUTPUT_VIBRATION, 0};
    dmb_response_options options = dmb_response_options_default();
    force.place = move.place = dmb_station(body, 0, 0.0);
    move.quantity = DMB_OUTPUT_VIBRATION_ACCELERATION;
    force.amplitude = 3.0;
    options.points = 5;
    drillmbd::response response = sim.response({force}, {move}, &options);
    EXPECT(response.size() == 5 && response.frequencies().back() == 100.0);
    EXPECT(std::abs(response.transfer(0)[2] - 0.5) < 1e-12 && std::abs(response.transfer()[2] - 1.5) < 1e-12);
    drillmbd::response taken(std::move(response));
    EXPECT(!response && taken);
    options.frequency_low = 0.0;
    EXPECT(thrown_by([&] { (void)sim.response({force}, {move}, &options); }) == DMB_ERR_SINGULAR);
    EXPECT(thrown_by([&] { (void)taken.transfer(1); }) == DMB_ERR_VALUE);
}

// 3 N at 5 Hz on 2 kg: 1.5 m/s2, sine: the real part of -i e^(iwt).
void stepped_sine_of_a_body()
{
    drillmbd::model model;
    dmb_body_def def = dmb_body_def_default();
    dmb_drive_def push = dmb_drive_def_default();
    dmb_segment shake = dmb_segment_default();
    def.mass = 2.0;
    def.free_mask = DMB_FREE_X;
    shake.kind = DMB_SEGMENT_HARMONIC;
    shake.h1 = 3.0;
    shake.omega = 10.0 * 3.14159265358979323846;
    push.kind = DMB_DRIVE_LOAD;
    push.part = model.add_body(def);
    push.component = DMB_X;
    push.time_function = model.add_time_function({shake});
    model.add_drive(push);
    model.compile();
    drillmbd::sim sim(model);
    dmb_output rate{dmb_place{}, DMB_OUTPUT_VIBRATION, 0};
    rate.quantity = DMB_OUTPUT_VIBRATION_ACCELERATION;
    rate.place = dmb_station(push.part, 0, 0.0);
    dmb_output speed = rate;
    speed.quantity = DMB_OUTPUT_VIBRATION_VELOCITY;
    dmb_stepped_sine_options options = dmb_stepped_sine_options_default();
    options.harmonics = 2;
    const drillmbd::sine_response found = sim.sine(5.0, {rate, speed}, &options);
    EXPECT(found.status == DMB_OK && found.report.settled == 1 && found.report.windows == 3);
    EXPECT(found.amplitudes.size() == 2 && found.amplitudes[1].size() == 3);
    EXPECT(std::abs(found.amplitudes[0][1] - std::complex<double>(0.0, -1.5)) < 1e-12);
    EXPECT(std::abs(found.amplitudes[1][1] + 1.5 / shake.omega) < 1e-3 * 1.5 / shake.omega);
    EXPECT(std::abs(found.amplitudes[0][0]) < 1e-12 && std::abs(found.amplitudes[0][2]) < 1e-12);
    options.harmonics = 17;
    const std::uint64_t before = sim.hash();
    EXPECT(thrown_by([&] { (void)sim.sine(5.0, {rate}, &options); }) == DMB_ERR_VALUE);
    EXPECT(sim.hash() == before);
}

// m r w^2/(m w^2) = r: the same at every speed, above a limit and below another.
void speeds_of_a_body()
{
    drillmbd::model model;
    dmb_environment_def none = dmb_environment_def_default();
    dmb_body_def def = dmb_body_def_default();
    none.gravity[2] = 0.0;
    def.mass = 2.0;
    model.set_environment(none);
    dmb_order once = dmb_order_default();
    dmb_output move{dmb_place{}, DMB_OUTPUT_VIBRATION, 0};
    once.excitation.kind = DMB_EXCITATION_UNBALANCE;
    once.excitation.amplitude = 1e-3;
    once.excitation.place = move.place = dmb_station(model.add_body(def), 0, 0.0);
    model.compile();
    drillmbd::sim sim(model);
    dmb_speeds_options options = dmb_speeds_options_default();
    options.points = 7;
    const drillmbd::speed_bands found = sim.speeds({once}, {move}, {4e-4}, &options);
    EXPECT(found.status == DMB_NOTE_INCOMPLETE && found.bands.size() == 1 && found.severity.size() == 7);
    EXPECT(found.report.truncated == 3 && found.bands[0].truncated == 3 && found.report.silent_orders == 0);
    EXPECT(found.bands[0].low == 1.0 && found.bands[0].high == 30.0);
    EXPECT(std::abs(found.severity[3] - 1.25) < 1e-12);
    EXPECT(sim.speeds({once}, {move}, {6e-4}).bands.empty());
    EXPECT(thrown_by([&] { (void)sim.speeds({once}, {move}, {}); }) == DMB_ERR_VALUE);
    options.points = 1;
    EXPECT(thrown_by([&] { (void)sim.speeds({once}, {move}, {4e-4}, &options); }) == DMB_ERR_VALUE);
}

// ---- Buckling -------------------------------------------------------------------------------------------------------
// Each point can be asked; a visit ends the path, by its answer or by an exception, which comes out.
void paths_are_visited(drillmbd::sim &sim, const dmb_path_options &along, const dmb_place &tip, std::uint32_t points)
{
    std::uint32_t visited = 0;
    double pushed = 0.0;
    const auto look = [&](const drillmbd::sim &at, const dmb_path_point &point) {
        EXPECT(point.number == visited);
        pushed = at.pose(tip).position[0];
        return ++visited > points;
    };
    EXPECT(sim.path(along, look).points == points && visited == points + 1 && pushed < 10.0);
    visited = points - 2;
    EXPECT(sim.path(along, [&](const drillmbd::sim &, const dmb_path_point &) { return ++visited >= points; }).points ==
           1);
    std::string text;
    try {
        sim.path(along,
                 [](const drillmbd::sim &, const dmb_path_point &) -> bool { throw std::logic_error("far enough"); });
    } catch (const std::logic_error &error) {
        text = error.what();
    }
    EXPECT(text == "far enough");
}

void buckling_of_a_column()
{
    drillmbd::model model;
    dmb_environment_def none = dmb_environment_def_default();
    dmb_string_def clamped = dmb_string_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_load_def push = dmb_load_def_default();
    none.gravity[2] = 0.0;
    clamped.start_free = DMB_FREE_NONE;
    for (double &stiffness : pipe.section_stiffness) stiffness = 1e5;
    for (int i = 0; i < 3; i++) pipe.section_stiffness[i] = 1e12;
    model.set_environment(none);
    pipe.string = model.add_string(clamped);
    const auto string = model.add_pipes(pipe, 10);
    push.place = dmb_station(string, 9, 1.0);
    push.force[0] = -1.0;
    model.add_load(push);
    model.compile();
    drillmbd::sim sim(model);
    sim.static_start();
    const double euler = 9.869604401089358 * 1e5 / 400.0;
    dmb_buckling_options options = dmb_buckling_options_default();
    options.scale = DMB_SCALE_LOADS;
    drillmbd::buckling found = sim.buckling(&options);
    EXPECT(found.size() == 1 && std::abs(found[0] + 1.0 - euler) < 1e-4 * euler);
    const std::array<double, 6> tip = found.shape(0, push.place);
    EXPECT(std::abs(tip[0]) < 1e-6 && std::hypot(tip[1], tip[2]) > 0.9);
    drillmbd::buckling taken(std::move(found));
    EXPECT(!found && taken);
    EXPECT(thrown_by([&] { (void)taken[1]; }) == DMB_ERR_VALUE);
    dmb_path_options along = dmb_path_options_default();
    along.factor_end = 2.0 * euler;
    const dmb_path_report report = sim.path(&along);
    EXPECT(report.bifurcations == 1 && std::abs(report.first_bifurcation + 1.0 - euler) < 1e-4 * euler);
    paths_are_visited(sim, along, push.place, report.points);
    along.factor_end = 0.0;
    EXPECT(thrown_by([&] { sim.path(&along); }) == DMB_ERR_VALUE);
    EXPECT(thrown_by([&] { sim.path(along, [](const drillmbd::sim &, const dmb_path_point &) { return 0; }); }) ==
           DMB_ERR_VALUE);
}

// ---- Progress -------------------------------------------------------------------------------------------------------
void calls_are_told_and_ended()
{
    drillmbd::model model;
    describe(model);
    drillmbd::sim sim(model);
    int told = 0;
    std::int32_t status = DMB_OK;
    sim.with_progress([&](double fraction) { return ++told, fraction > 0.5; }, [&] { status = sim.advance(1.0); });
    EXPECT(status == DMB_NOTE_CANCELLED && told > 1 && sim.time() > 0.5 && sim.time() < 1.0);
    EXPECT(thrown_by([&] { sim.with_progress([](double) { return true; }, [&] { sim.static_start(); }); }) ==
           DMB_ERR_CANCELLED);
    for (int kind = 0; kind < 2; kind++) {
        std::string text;
        try {
            sim.with_progress([](double) -> bool { throw std::logic_error("enough"); },
                              [&] { kind == 0 ? (void)sim.advance(2.0) : (void)sim.static_start(); });
        } catch (const std::logic_error &error) {
            text = error.what();
        }
        EXPECT(text == "enough");
    }
    told = 0;
    sim.step(1e-3); // nobody is told any more
    EXPECT(told == 0);
}

// ---- Failures -------------------------------------------------------------------------------------------------------
void failures_throw()
{
    drillmbd::model model;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = -1.0;
    EXPECT(thrown_by([&] { model.add_pipes(pipe, 1); }) == DMB_ERR_VALUE);
    EXPECT(thrown_by([&] { drillmbd::sim sim(model); }) == DMB_ERR_ORDER);
    EXPECT(thrown_by([&] { (void)model.info(); }) == DMB_ERR_ORDER);
    dmb_body_def body = dmb_body_def_default();
    body.inertia[0] = 0.3;
    EXPECT(thrown_by([&] { model.add_body(body); }) == DMB_ERR_VALUE);
    EXPECT(std::string(model.message()).find("principal moments 0.3, 0.001, 0.001") != std::string::npos);
    const parts made = describe(model); // compiles: refusals that were thrown are handled
    dmb_sim_options wrong = dmb_sim_options_default();
    wrong.spectral_radius = 2.0;
    try {
        drillmbd::sim none(model, wrong);
        EXPECT(false);
    } catch (const drillmbd::error &error) {
        EXPECT(std::string(error.what()).find("spectral_radius = 2") != std::string::npos);
        EXPECT(std::string(model.message()).find("spectral_radius = 2") != std::string::npos);
    }
    drillmbd::sim sim(model);
    EXPECT(thrown_by([&] { (void)sim.pose(dmb_station(made.string, 9, 0.0)); }) == DMB_ERR_VALUE);
    EXPECT(thrown_by([&] { (void)sim.drive(drillmbd::drive_id(made.string)); }) == DMB_ERR_ID);
    EXPECT(thrown_by([&] { sim.set_drive(made.feed, 1.0); }) == DMB_ERR_UNSUPPORTED);
    EXPECT(thrown_by([&] { sim.advance(std::nan("")); }) == DMB_ERR_NOT_FINITE);
    try {
        sim.step(0.0);
        EXPECT(false);
    } catch (const std::runtime_error &error) {
        EXPECT(std::string(error.what()).find("duration") != std::string::npos);
    }
    sim.set_drive(made.turning, 3.0);
    EXPECT(sim.step(1e-3) >= 0);
}

void failures_return()
{
    drillmbd::model model(nullptr);
    drillmbd::sim sim(nullptr);
    static_assert(noexcept(sim.try_step(1e-3)), "try_ members throw nothing");
    EXPECT(!model && !sim);
    EXPECT(sim.try_step(1e-3) == DMB_ERR_NULL);
    EXPECT(std::isnan(sim.time()));
    EXPECT(drillmbd::sim::create(sim, model) == DMB_ERR_NULL);
    EXPECT(drillmbd::model::create(model) == DMB_OK);
    EXPECT(model.try_compile() == DMB_ERR_VALUE);
    EXPECT(*model.message() != '\0');
    describe(model);
    EXPECT(drillmbd::sim::create(sim, model) >= 0);
    EXPECT(sim.try_step(1e-3) >= 0);
    EXPECT(sim.try_advance(-1.0) == DMB_ERR_VALUE);
    EXPECT(sim.try_static_start() < 0);
    EXPECT(sim.try_restore(nullptr, 0) == DMB_ERR_NULL);
    std::vector<unsigned char> block(model.sim_memory_size());
    EXPECT(drillmbd::sim::create_in(sim, model, nullptr, block.data(), block.size()) >= 0);
    EXPECT(sim.try_step(1e-3) >= 0);
    sim.reset();
    EXPECT(!sim);
}

void parts_have_names()
{
    drillmbd::model model;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    std::strcpy(pipe.name, "collars");
    const auto string = model.add_pipes(pipe, 3);
    model.set_name(string, "main");
    EXPECT(drillmbd::string_id(model.find("main")) == string);
    EXPECT(model.find<drillmbd::string_id>("main") == string && string);
    EXPECT(drillmbd::string_id(model.part(dmb_id(string).index)) == string && !drillmbd::drive_id());
    EXPECT(model.name(string) == "main");
    const drillmbd::model::pipe_range found = model.find_pipes("collars");
    EXPECT(found.string == string && found.first == 0 && found.count == 3);
    EXPECT(thrown_by([&] { (void)model.find<drillmbd::drive_id>("main"); }) == DMB_ERR_ID);
    bool thrown = false;
    try {
        (void)model.find("nobody");
    } catch (const drillmbd::error &error) {
        thrown = error.status() == DMB_ERR_ID;
    }
    EXPECT(thrown);
}

// A model that is read again has the same record and the same run.
void records()
{
    drillmbd::model model;
    const parts made = describe(model);
    const std::vector<unsigned char> record = model.write();
    drillmbd::model again = drillmbd::model::read(record);
    EXPECT(again.write() == record);
    again.compile();
    drillmbd::sim sim(model), other(again);
    EXPECT(sim.steps(1e-3, 20) == other.steps(1e-3, 20) && sim.hash() == other.hash());
    EXPECT(other.drive(again.find<drillmbd::drive_id>("feed")).force == sim.drive(made.feed).force);
    std::vector<unsigned char> damaged = record;
    damaged[40] ^= 1;
    EXPECT(thrown_by([&] { (void)drillmbd::model::read(damaged); }) == DMB_ERR_VALUE);
    drillmbd::model kept(nullptr);
    EXPECT(drillmbd::model::try_read(kept, record) == DMB_OK && kept);
    EXPECT(drillmbd::model::try_read(kept, damaged) == DMB_ERR_VALUE && kept);
}

// Ids of one kind: not to be taken for those of another, and for all the fields of C.
void ids_have_kinds()
{
    static_assert(!std::is_convertible<drillmbd::body_id, drillmbd::joint_id>::value, "");
    static_assert(!std::is_assignable<drillmbd::drive_id &, drillmbd::bit_id>::value, "");
    static_assert(!std::is_convertible<dmb_id, drillmbd::joint_id>::value, "");
    static_assert(std::is_convertible<drillmbd::body_id, dmb_id>::value, "");
    static_assert(std::is_same<decltype(std::declval<drillmbd::model>().add_load(dmb_load_def_default())),
                               drillmbd::load_id>::value,
                  "");
}

void owners_are_moved_only()
{
    static_assert(!std::is_copy_constructible<drillmbd::model>::value, "");
    static_assert(!std::is_copy_assignable<drillmbd::sim>::value, "");
    static_assert(std::is_nothrow_move_constructible<drillmbd::sim>::value, "");
    static_assert(std::is_nothrow_move_assignable<drillmbd::model>::value, "");
}

// ---- Messages, spans, callbacks -------------------------------------------------------------------------------------
void errors_are_data()
{
    drillmbd::model model;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = -1.0;
    bool thrown = false;
    try {
        model.add_pipes(pipe, 3);
    } catch (const drillmbd::error &error) {
        thrown = true;
        EXPECT(error.status() == DMB_ERR_VALUE);
        EXPECT(!error.part().empty());
        EXPECT(error.field().find("length") != std::string::npos);
        EXPECT(error.value().find("-1") == 0);
        EXPECT(error.bound().find("be finite, >= ") == 0);
        EXPECT(error.data().value == -1.0 && error.data().low > 0.0 && error.data().high > error.data().low);
        EXPECT(std::string(error.what()).find(error.part() + ": " + error.field() + " = ") != std::string::npos);
    }
    EXPECT(thrown);
    try { // without a message of its own, the text of the last failing call
        dmb_id found;
        drillmbd::check(dmb_model_find(model.get(), DMB_PART_ANY, "nowhere", &found));
    } catch (const drillmbd::error &error) {
        EXPECT(std::string(error.what()).find("nowhere") != std::string::npos);
    }
    const drillmbd::error another(DMB_ERR_IO, "the file could not be written"); // none of the library
    EXPECT(another.part().empty() && another.field().empty() && another.bound().empty() && another.advice().empty());
    EXPECT(another.data().number == DMB_NONE && std::isnan(another.data().low));
}

std::size_t counted(drillmbd::span<const double> values) { return values.size(); }

void spans_of_all_kinds()
{
    const double array[] = {1.0, 2.0, 3.0};
    const std::array<double, 2> fixed = {{1.0, 2.0}};
    std::vector<double> vector(5);
    EXPECT(counted(array) == 3 && counted(fixed) == 2 && counted(vector) == 5);
    EXPECT(counted({1.0, 2.0}) == 2 && counted({}) == 0 && counted({array, 1}) == 1);
    const drillmbd::span<double> writable(vector);
    writable[4] = 7.0;
    EXPECT(vector[4] == 7.0 && writable.count() == 5 && writable.end() - writable.begin() == 5);
}

// A time function that is a function object: the sim turns as it says; where it throws the call fails and changes
// nothing. A log of two inputs that is replayed gives the same state; so does the pose of a point off a place, by its
// three axes.
void arrays_are_spans()
{
    drillmbd::model model;
    const std::int32_t targets[2] = {DMB_TARGET_LATERAL_DAMPING, DMB_TARGET_AXIAL_DAMPING};
    const auto string = model.add_pipes(dmb_pipe_def_default(), 2);
    drillmbd::input_id inputs[2];
    for (int i = 0; i < 2; i++) {
        dmb_input_def def = dmb_input_def_default();
        def.target = targets[i];
        def.name[0] = static_cast<char>('a' + i);
        inputs[i] = model.add_input(def);
    }
    model.compile();
    drillmbd::sim sim(model), again(model);
    dmb_input_record log[4];
    std::uint32_t next = 0;
    EXPECT(sim.try_record_inputs(log) == DMB_OK);
    EXPECT(sim.try_set_inputs(inputs, {5.0, 7.0}) >= 0);
    EXPECT(sim.try_set_inputs(inputs, {5.0}) == DMB_ERR_VALUE);
    EXPECT(dmb_sim_recorded_inputs(sim.get()) == 2);
    EXPECT(again.try_replay_inputs({log, 2}, next) >= 0 && next == 2);
    EXPECT(sim.try_step(1e-3) >= 0 && again.try_step(1e-3) >= 0);
    EXPECT(sim.hash() == again.hash());
    const dmb_place place = dmb_station(string, 0, 0.5);
    const dmb_pose pose = sim.pose(place), off = sim.pose_at(place, {0.0, 0.1, 0.0});
    for (int k = 0; k < 3; k++)
        EXPECT(std::fabs(off.position[k] - pose.position[k] - 0.1 * pose.rotation[3 * k + 1]) < 1e-12);
    EXPECT(std::isfinite(sim.motion_at(place, {0.0, 0.1, 0.0}).velocity[0]));
}

// A body that falls: f is its acceleration.
void a_state_has_a_rate()
{
    drillmbd::state_equation equation;
    {
        drillmbd::model model;
        model.add_body(dmb_body_def_default());
        model.compile();
        drillmbd::sim sim(model);
        equation = sim.state_equation();
    }
    double time = 1.0;
    std::vector<double> y = equation.origin(&time), rate(y.size());
    EXPECT(time == 0.0 && equation.count() == 6 && y.size() == 12 && equation.rows()[2] == 2);
    equation.rate(0.5, y, rate);
    EXPECT(std::fabs(rate[8] + 9.81) < 1e-12 && rate[2] == 0.0);
    EXPECT(dmb_sim_time(equation.at()) == 0.5);
    y[8] = -1.0;
    equation.begin(0.5, y);
    equation.rate(0.5, y, rate);
    EXPECT(rate[2] == -1.0);
    EXPECT(thrown_by([&] { equation.rate(0.5, {}, rate); }) == DMB_ERR_VALUE);
    y[0] = std::nan("");
    EXPECT(thrown_by([&] { equation.rate(0.5, y, rate); }) == DMB_ERR_NOT_FINITE);
}

void callbacks_do_not_throw_through_c()
{
    const auto speed = [](double time, double *out) {
        if (time > 0.05) throw std::runtime_error("the operator went home");
        out[0] = 2.0;
        out[1] = 0.0;
        out[2] = 2.0 * time;
    };
    drillmbd::model model;
    dmb_drive_def drive = dmb_drive_def_default();
    const auto string = model.add_pipes(dmb_pipe_def_default(), 2);
    drive.component = DMB_RX;
    drive.time_function =
        model.add_time_function(drillmbd::segment_of(speed, DMB_PROVIDES_RATE | DMB_PROVIDES_INTEGRAL));
    model.add_drive(drive);
    model.compile();
    drillmbd::sim sim(model);
    for (int i = 0; i < 40; ++i) sim.step(1e-3);
    EXPECT(std::fabs(sim.rotation(dmb_station(string, 0, 0.0)) - 0.08) < 1e-9);
    const std::uint64_t hash = sim.hash();
    EXPECT(thrown_by([&] { sim.step(0.02); }) == DMB_ERR_CALLBACK);
    EXPECT(sim.hash() == hash);
}

} // namespace

int main()
{
    try {
        scene_from_end_to_end();
        snapshots();
        statics();
        joints();
        nothing_is_left_behind();
        sim_in_the_callers_block();
        all_in_a_pool();
        modes_of_a_string();
        response_of_a_body();
        stepped_sine_of_a_body();
        speeds_of_a_body();
        buckling_of_a_column();
        calls_are_told_and_ended();
        failures_throw();
        failures_return();
        parts_have_names();
        records();
        ids_have_kinds();
        owners_are_moved_only();
        errors_are_data();
        spans_of_all_kinds();
        arrays_are_spans();
        a_state_has_a_rate();
        callbacks_do_not_throw_through_c();
    } catch (const std::exception &error) {
        std::cerr << "unexpected: " << error.what() << '\n';
        ++failures;
    }
    if (failures == 0) std::cout << "all as expected\n";
    return failures == 0 ? 0 : 1;
}
