// The torque of a turning string in C++: rods that turn up to 120 rpm on the wall, and a value that is refused, with
// its field, value and bound.
#include <cstring>
#include <drillmbd/drillmbd.hpp>
#include <iomanip>
#include <iostream>
#include <string>

namespace
{

const double rpm = 3.14159265358979323846 / 30.0;
const char usage[] = "Usage: steady_torque\n"
                     "30 rods of 3 m turn in a hole of 94 mm; prints the torque at the rig twice a second.\n";

drillmbd::model describe()
{
    drillmbd::model model;
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def rod = dmb_pipe_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    wall.diameter = 0.094;
    wall.mu_dynamic = 0.25;
    model.add_wall(wall);
    rod.length = 3.0;
    model.add_pipes(rod, 30);
    dmb_segment turning = dmb_segment_default();
    turning.kind = DMB_SEGMENT_STEP5;
    turning.h1 = 120.0 * rpm;
    drive.component = DMB_RX;
    drive.time_function = model.add_time_function(turning);
    std::strcpy(drive.name, "table");
    model.add_drive(drive);
    drive = dmb_drive_def_default(); // held along the hole
    model.add_drive(drive);
    model.compile();
    return model;
}

void refused()
{
    drillmbd::model model;
    dmb_pipe_def rod = dmb_pipe_def_default();
    rod.inner_diameter = 0.08;
    try {
        model.add_pipes(rod, 1);
    } catch (const drillmbd::error &error) {
        std::cout << "refused: " << error.field() << " = " << error.value() << ", must " << error.bound() << '\n';
    }
}

void run()
{
    const drillmbd::model model = describe();
    const auto table = model.find<drillmbd::drive_id>("table");
    drillmbd::sim sim(model);
    sim.static_start();
    for (int i = 1; i <= 4; ++i) {
        sim.with_progress([&](double) { return false; }, [&] { sim.advance(0.5 * i); }); // true would end it
        const dmb_drive_state at_rig = sim.drive(table);
        std::cout << std::fixed << std::setprecision(1) << sim.time() << " s: " << at_rig.speed / rpm << " rpm, "
                  << at_rig.force << " N m\n";
    }
}
} // namespace

int main(int count, char **words)
{
    if (count > 1) {
        const std::string word = words[1];
        const bool help = word == "--help" || word == "-h";
        (help ? std::cout : std::cerr << "steady_torque: " << word << ": it takes no arguments\n") << usage;
        return help ? 0 : 2;
    }
    try {
        refused();
        run();
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return 0;
}
