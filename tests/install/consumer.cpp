// A user's program in C++11 with the header for C++, built against the installed library and against its sources.
#include <drillmbd/drillmbd.hpp>

#include <iostream>
#include <stdexcept>

namespace
{

void build_and_run()
{
    drillmbd::model model;
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_segment turning = dmb_segment_default();

    model.add_wall(dmb_wall_def_default());
    const auto string = model.add_pipes(dmb_pipe_def_default(), 4);
    model.add_bit(dmb_bit_def_default());
    turning.h0 = 10.0;
    drive.time_function = model.add_time_function(turning);
    drive.component = DMB_RX;
    model.add_drive(drive);
    model.compile();

    const dmb_model_info info = model.info();
    if (info.pipes != 4 || info.prescribed != 1) throw std::runtime_error("unexpected counts");
    drillmbd::sim sim(model);
    sim.step(1e-3);
    if (!(sim.rotation(dmb_station(string, 0, 0.0)) > 9e-3)) throw std::runtime_error("it does not turn");
}

bool refuses()
{
    drillmbd::model model;
    dmb_pipe_def pipe = dmb_pipe_def_default();
    pipe.length = -1.0;
    try {
        model.add_pipes(pipe, 1);
    } catch (const drillmbd::error &error) {
        return error.status() == DMB_ERR_VALUE;
    }
    return false;
}

} // namespace

int main()
{
    try {
        build_and_run();
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return refuses() ? 0 : 1;
}
