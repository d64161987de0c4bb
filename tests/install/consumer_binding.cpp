// A user's program in C++ with the binding drillmbd.hpp, which is on the include path of the target: a short string is
// described, compiled, run for ten steps, and a wrong part is refused with a message.
#include <drillmbd/drillmbd.hpp>

#include <iostream>
#include <string>

int main()
{
    try {
        drillmbd::model model;
        dmb_wall_def wall = dmb_wall_def_default();
        wall.diameter = 0.094;
        model.add_wall(wall);
        model.add_pipes(dmb_pipe_def_default(), 3);
        model.compile();
        drillmbd::sim sim(model);
        for (int i = 0; i < 10; i++) sim.step(1e-3);
        if (!(sim.time() > 0.0099 && sim.time() < 0.0101)) return 1;
    } catch (const drillmbd::error &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    try {
        drillmbd::model model;
        dmb_pipe_def pipe = dmb_pipe_def_default();
        pipe.inner_diameter = 2.0 * pipe.outer_diameter;
        model.add_pipes(pipe, 1);
    } catch (const drillmbd::error &error) {
        return std::string(error.what()).find("inner_diameter") != std::string::npos ? 0 : 1;
    }
    return 1;
}
