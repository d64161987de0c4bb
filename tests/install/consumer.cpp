// A user's program in C++, built against the installed library through find_package.
#include <drillmbd/drillmbd.h>

#include <iostream>
#include <stdexcept>
#include <string>

namespace
{

void check(int32_t status, const dmb_model *model)
{
    if (status < 0) throw std::runtime_error(std::string(dmb_status_name(status)) + ": " + dmb_model_message(model));
}

void build_and_compile(dmb_model *model)
{
    dmb_wall_def wall = dmb_wall_def_default();
    dmb_pipe_def pipe = dmb_pipe_def_default();
    dmb_bit_def bit = dmb_bit_def_default();
    dmb_drive_def drive = dmb_drive_def_default();
    dmb_term turning = dmb_term_default();
    dmb_id string = {0, 0};

    check(dmb_model_add_wall(model, &wall, nullptr), model);
    check(dmb_model_add_pipes(model, &pipe, 4, &string), model);
    check(dmb_model_add_bit(model, &bit, nullptr), model);
    turning.h0 = 10.0;
    check(dmb_model_add_programme(model, &turning, 1, &drive.programme), model);
    drive.component = DMB_RX;
    check(dmb_model_add_drive(model, &drive, nullptr), model);
    check(dmb_model_compile(model, nullptr), model);

    dmb_model_info info = dmb_model_info_default();
    check(dmb_model_get_info(model, &info), model);
    if (info.pipes != 4 || info.prescribed != 1) throw std::runtime_error("unexpected counts");
}

} // namespace

int main()
{
    dmb_model *model = nullptr;
    int result = 0;
    if (dmb_model_create(nullptr, &model) < 0) return 1;
    try {
        build_and_compile(model);
    } catch (const std::exception &error) {
        std::cerr << error.what() << '\n';
        result = 1;
    }
    dmb_model_destroy(&model);
    return result;
}
