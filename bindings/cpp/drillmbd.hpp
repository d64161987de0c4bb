// libdrillmbd for C++11 and later: owners of models and sims that clean up after themselves, failures as exceptions.
// Everything else is the C interface: its structs, ids, constants and units; see drillmbd/scene.h, run.h, ask.h.
//
//     drillmbd::model model;
//     dmb_wall_def wall = dmb_wall_def_default();
//     model.add_wall(wall);
//     drillmbd::string_id string = model.add_pipes(dmb_pipe_def_default(), 100);
//     model.compile();
//     drillmbd::sim sim(model);
//     while (sim.time() < 40.0) sim.step(1e-3);
//     dmb_pose pose = sim.pose(dmb_station(string, 99, 1.0));
//
// A member that fails throws drillmbd::error; one that is done returns its result, or the status where that may be a
// note (> 0). The members named try_ and the create functions throw nothing and return the status instead; without
// exceptions in the compiler they are the only ones, next to the C functions on get(). Owners are one pointer wide, and
// the members are inline calls of C functions. Since C++17 a status or a result that is not used is a warning.
#ifndef DRILLMBD_DRILLMBD_HPP
#define DRILLMBD_DRILLMBD_HPP

#include <drillmbd/drillmbd.h>

#include <complex>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <type_traits>
#include <utility>

#if defined(__cplusplus) && __cplusplus >= 201703L
#define DRILLMBD_NODISCARD [[nodiscard]]
#else
#define DRILLMBD_NODISCARD
#endif

#if defined(__cpp_exceptions) || defined(__EXCEPTIONS) || defined(_CPPUNWIND)
#define DRILLMBD_EXCEPTIONS 1
#include <algorithm>
#include <array>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>
#endif

namespace drillmbd {

// Several values of the caller side by side: made of a vector, an array, a list in braces, std::span, or a pointer with
// a number. It owns nothing: the values live at least as long as the call.
template <typename T>
class span {
public:
    // Of nothing.
    span() noexcept : data_(nullptr), size_(0) {}
    // Of a pointer with a number.
    span(T *data, std::size_t size) noexcept : data_(data), size_(size) {}
    // Of an array.
    template <std::size_t N>
    span(T (&array)[N]) noexcept : data_(array), size_(N)
    {
    }
    // Of a list in braces, within the call that it is written in.
    span(std::initializer_list<typename std::remove_const<T>::type> list) noexcept : span()
    {
        data_ = list.begin();
        size_ = list.size();
    }
    // Of any container with data() and size().
    template <typename Container, typename = typename std::enable_if<std::is_convertible<
                                      decltype(std::declval<Container &>().data()), T *>::value>::type>
    span(Container &&container) noexcept : data_(container.data()), size_(container.size())
    {
    }
    // The first of them.
    DRILLMBD_NODISCARD T *data() const noexcept { return data_; }
    // Number of values.
    DRILLMBD_NODISCARD std::size_t size() const noexcept { return size_; }
    // As the C functions count; larger numbers are refused by them.
    DRILLMBD_NODISCARD std::uint32_t count() const noexcept
    {
        return size_ < UINT32_MAX ? static_cast<std::uint32_t>(size_) : UINT32_MAX;
    }
    // For loops over them.
    DRILLMBD_NODISCARD T *begin() const noexcept { return data_; }
    // Behind the last.
    DRILLMBD_NODISCARD T *end() const noexcept { return data_ + size_; }
    // Value i, which is not checked.
    DRILLMBD_NODISCARD T &operator[](std::size_t i) const noexcept { return data_[i]; }

private:
    T *data_;
    std::size_t size_;
};

#if defined(DRILLMBD_EXCEPTIONS)
// A call that was refused or failed, with nothing changed. The text of the exception is "DMB_ERR_VALUE: pipe 3: length
// = -1, must be ...". A refused value is known with its part, field, range and remedy (data(), the library's
// dmb_last_error).
class error : public std::runtime_error {
public:
    // Of a status < 0 and the message of who failed; without one the text of the status.
    explicit error(std::int32_t failed, const char *message = nullptr) : error(last(failed, message), failed, message)
    {
    }
    // DMB_ERR_...
    DRILLMBD_NODISCARD std::int32_t status() const noexcept { return status_; }
    // Name of the status, "DMB_ERR_VALUE".
    DRILLMBD_NODISCARD const char *name() const noexcept { return dmb_status_name(status_); }
    // The details of the failure: numbers of part and component, value, low, high. Defaults where the
    // failure is none of the library.
    DRILLMBD_NODISCARD const dmb_error &data() const noexcept { return data_; }
    // Such as "pipe 3"; as the others empty where the failure has no such part.
    DRILLMBD_NODISCARD std::string part() const { return data_.part; }
    // Such as "length".
    DRILLMBD_NODISCARD std::string field() const { return data_.field; }
    // Such as "-1".
    DRILLMBD_NODISCARD std::string value() const { return data_.given; }
    // Such as "be > 0".
    DRILLMBD_NODISCARD std::string bound() const { return data_.bound; }
    // Such as "give ...".
    DRILLMBD_NODISCARD std::string advice() const { return data_.advice; }

private:
    error(const dmb_error &data, std::int32_t failed, const char *message)
        : std::runtime_error(std::string(dmb_status_name(failed)) + ": " + text_of(data, failed, message)),
          status_(failed), data_(data)
    {
    }
    // The thread's last failing call, if it is the one that failed.
    static dmb_error last(std::int32_t failed, const char *message)
    {
        dmb_error data{};
        dmb_error_init(&data, sizeof data);
        const bool same = dmb_last_error(&data) >= 0 && data.status == failed &&
                          (message == nullptr || *message == '\0' || std::strcmp(data.message, message) == 0);
        if (!same) dmb_error_init(&data, sizeof data);
        return data;
    }
    static std::string text_of(const dmb_error &data, std::int32_t failed, const char *message)
    {
        if (message != nullptr && *message != '\0') return message;
        return data.message[0] != '\0' ? data.message : dmb_status_text(failed);
    }
    std::int32_t status_;
    dmb_error data_;
};

// Throws for a failure; hands back 0 and notes.
inline std::int32_t check(std::int32_t status, const char *message = nullptr)
{
    if (status < 0) throw error(status, message);
    return status;
}
#endif

// ---- Callbacks ------------------------------------------------------------------------------------------------------
#if defined(DRILLMBD_EXCEPTIONS)
// A function object as a callback: it has the arguments of the C function, without the context, and returns its number
// or nothing. The caller keeps it alive as long as models and sims that call it. An exception does not get into C: the
// call fails with DMB_ERR_CALLBACK; paths, which have no such failure, have sim::path with a visit. Not for threads:
// sims on several threads call one object at once.
template <typename Function, typename Result, typename... Arguments>
struct guarded {
    // The C function, whose context is the function object.
    static Result call(void *context, Arguments... arguments) noexcept
    {
        return run(std::is_void<decltype((*static_cast<Function *>(context))(arguments...))>(), context, arguments...);
    }

private:
    static Result run(std::true_type, void *context, Arguments... arguments) noexcept
    {
        try {
            (*static_cast<Function *>(context))(arguments...);
            return Result();
        } catch (...) {
            return failed(std::is_void<Result>());
        }
    }
    static Result run(std::false_type, void *context, Arguments... arguments) noexcept
    {
        try {
            return (*static_cast<Function *>(context))(arguments...);
        } catch (...) {
            return failed(std::is_void<Result>());
        }
    }
    static void failed(std::true_type) noexcept {}
    static Result failed(std::false_type) noexcept { return static_cast<Result>(-1); }
};

// Puts a function object into a field for a C function and the one for its context.
template <typename Function, typename Result, typename... Arguments>
void bind(Result (*&slot)(void *, Arguments...), void *&context, Function &function) noexcept
{
    slot = &guarded<Function, Result, Arguments...>::call;
    context = const_cast<void *>(static_cast<const void *>(&function));
}

// Of dmb_constraint_def, dmb_force_def.
template <typename Def, typename Function>
void set_callback(Def &def, Function &function) noexcept
{
    static_assert(!std::is_same<Def, dmb_path_options>::value, "a path would take an exception for its end: sim::path");
    bind(def.callback, def.callback_context, function);
}
// A term that is function(time, out): out[0] its value, out[1] and out[2] as `provides` says.
template <typename Function>
DRILLMBD_NODISCARD dmb_segment segment_of(Function &function, std::int32_t provides = 0) noexcept
{
    dmb_segment term = dmb_segment_default();
    term.kind = DMB_SEGMENT_CALLBACK;
    term.provides = provides;
    bind(term.callback, term.callback_context, function);
    return term;
}
#endif

// ---- Memory ---------------------------------------------------------------------------------------------------------
#if defined(DRILLMBD_EXCEPTIONS)
// An allocator in the caller's memory, for the options of models and sims: `options.allocator = pool.get();`. Memory
// and pool have to outlive the objects in it. Copies speak of the same memory.
class pool {
public:
    pool(void *memory, std::size_t size) : allocator_()
    {
        check(dmb_pool_allocator(memory, size, &allocator_),
              memory == nullptr
                  ? "pool: memory = NULL, must be a block of the caller's; give one"
                  : "pool: size [byte] must be at least 256 and end within the addresses; give more memory");
    }
    // For the options of models and sims.
    DRILLMBD_NODISCARD const dmb_allocator *get() const noexcept { return &allocator_; }
    // [byte] in use at most, the pool's own 64 included.
    DRILLMBD_NODISCARD std::size_t peak() const noexcept { return dmb_pool_peak(&allocator_); }

private:
    dmb_allocator allocator_;
};
#endif

// ---- Owners ---------------------------------------------------------------------------------------------------------
// Owns an object of the library. It is moved, not copied.
template <typename T, void (*destroy)(T **)>
class owner {
public:
    owner(owner &&other) noexcept : handle_(other.release()) {}
    owner &operator=(owner &&other) noexcept
    {
        if (this != &other) reset(other.release());
        return *this;
    }
    owner(const owner &) = delete;
    owner &operator=(const owner &) = delete;

    // The handle for C functions, or NULL; it stays the owner's.
    DRILLMBD_NODISCARD T *get() const noexcept { return handle_; }
    // True if it owns an object.
    explicit operator bool() const noexcept { return handle_ != nullptr; }
    // The handle, now the caller's to destroy.
    DRILLMBD_NODISCARD T *release() noexcept
    {
        T *given = handle_;
        handle_ = nullptr;
        return given;
    }
    // Destroys the object and takes over a handle, or nothing.
    void reset(T *handle = nullptr) noexcept
    {
        destroy(&handle_);
        handle_ = handle;
    }

protected:
    explicit owner(T *handle = nullptr) noexcept : handle_(handle) {}
    ~owner() { destroy(&handle_); }
    T *handle_;
};

// ---- Ids ------------------------------------------------------------------------------------------------------------
// The id of a part of one kind. A part of another kind in its place does not compile; fields of definitions and C
// functions take it as a dmb_id. A dmb_id becomes one by name, drive_id(id), which the library checks at its use.
template <std::int32_t Kind>
class part_id {
public:
    enum : std::int32_t { kind = Kind }; // DMB_PART_...
    // The id that names nothing.
    part_id() noexcept : id_{0, 0} {}
    // Of an id from C.
    explicit part_id(dmb_id id) noexcept : id_(id) {}
    // For fields of definitions and C functions.
    operator dmb_id() const noexcept { return id_; }
    // True if it names a part.
    explicit operator bool() const noexcept { return id_.generation != 0; }

private:
    dmb_id id_;
};
// True if both name the same part of the same model, or nothing.
template <std::int32_t Kind>
DRILLMBD_NODISCARD bool operator==(part_id<Kind> a, part_id<Kind> b) noexcept
{
    return dmb_id_equal(a, b) != 0;
}
// The opposite of ==.
template <std::int32_t Kind>
DRILLMBD_NODISCARD bool operator!=(part_id<Kind> a, part_id<Kind> b) noexcept
{
    return !(a == b);
}
using time_function_id = part_id<DMB_PART_TIME_FUNCTION>;
using wall_id = part_id<DMB_PART_WALL>;
using string_id = part_id<DMB_PART_STRING>;
using body_id = part_id<DMB_PART_BODY>;
using bit_id = part_id<DMB_PART_BIT>;
using drive_id = part_id<DMB_PART_DRIVE>;
using load_id = part_id<DMB_PART_LOAD>;
using joint_id = part_id<DMB_PART_JOINT>;
using coupling_id = part_id<DMB_PART_COUPLING>;
using constraint_id = part_id<DMB_PART_CONSTRAINT>;
using spring_id = part_id<DMB_PART_SPRING>;
using force_id = part_id<DMB_PART_FORCE>;
using stabiliser_id = part_id<DMB_PART_STABILISER>;
using stuck_id = part_id<DMB_PART_STUCK>;
using input_id = part_id<DMB_PART_INPUT>;
using event_id = part_id<DMB_PART_EVENT>;

// ---- Model ----------------------------------------------------------------------------------------------------------
// A description of a rig, its string and its hole, and the scene that it is compiled to.
class model : public owner<dmb_model, dmb_model_destroy> {
public:
    // An owner of nothing.
    explicit model(std::nullptr_t) noexcept {}

    // Makes a model in out; a previous one is destroyed. Returns the status.
    DRILLMBD_NODISCARD static std::int32_t create(model &out, const dmb_model_options *options = nullptr) noexcept
    {
        dmb_model *made = nullptr;
        const std::int32_t status = dmb_model_create(options, &made);
        if (status >= 0) out.reset(made);
        return status;
    }

    // Makes the model of a scene record in out; a previous one is destroyed. Returns the status.
    DRILLMBD_NODISCARD static std::int32_t try_read(model &out, span<const unsigned char> record,
                                                    const dmb_model_options *options = nullptr) noexcept
    {
        dmb_model *made = nullptr;
        const std::int32_t status = dmb_model_read(record.data(), record.size(), options, &made);
        if (status >= 0) out.reset(made);
        return status;
    }

    // Of the last call on this model that failed; of a sim::create of it in this thread too.
    DRILLMBD_NODISCARD const char *message() const noexcept { return dmb_model_message(handle_); }
    // Continues without the parts that were refused: compile fails otherwise.
    void clear_refused() noexcept { (void)dmb_model_clear_refused(handle_); }
    DRILLMBD_NODISCARD std::int32_t try_compile(const dmb_compile_options *options = nullptr) noexcept
    {
        return dmb_model_compile(handle_, options);
    }

#if defined(DRILLMBD_EXCEPTIONS)
    model() { check(dmb_model_create(nullptr, &handle_)); }
    explicit model(const dmb_model_options &options) { check(dmb_model_create(&options, &handle_)); }

    void set_environment(const dmb_environment_def &def) { described(dmb_model_set_environment(handle_, &def)); }
    time_function_id add_time_function(const dmb_segment *terms, std::uint32_t count)
    {
        dmb_id id = {0, 0};
        described(dmb_model_add_time_function(handle_, terms, count, &id));
        return time_function_id(id);
    }
    // `from` before start, `to` after end, smooth between.
    time_function_id add_ramp(double from, double to, double start, double end)
    {
        dmb_id id = {0, 0};
        described(dmb_model_add_ramp(handle_, from, to, start, end, &id));
        return time_function_id(id);
    }
    time_function_id add_time_function(const dmb_segment &term) { return add_time_function(&term, 1); }
    time_function_id add_time_function(std::initializer_list<dmb_segment> terms)
    {
        return add_time_function(terms.begin(), static_cast<std::uint32_t>(terms.size()));
    }
    string_id add_pipes(const dmb_pipe_def &def, std::uint32_t count)
    {
        dmb_id id = {0, 0};
        described(dmb_model_add_pipes(handle_, &def, count, &id));
        return string_id(id);
    }
    wall_id add_wall(const dmb_wall_def &def) { return add<wall_id>(dmb_model_add_wall, def); }
    void add_hole_sections(const dmb_hole_section *sections, std::uint32_t count)
    {
        described(dmb_model_add_hole_sections(handle_, sections, count));
    }
    string_id add_string(const dmb_string_def &def) { return add<string_id>(dmb_model_add_string, def); }
    body_id add_body(const dmb_body_def &def) { return add<body_id>(dmb_model_add_body, def); }
    bit_id add_bit(const dmb_bit_def &def) { return add<bit_id>(dmb_model_add_bit, def); }
    stabiliser_id add_stabiliser(const dmb_stabiliser_def &def)
    {
        return add<stabiliser_id>(dmb_model_add_stabiliser, def);
    }
    joint_id add_joint(const dmb_joint_def &def) { return add<joint_id>(dmb_model_add_joint, def); }
    coupling_id add_coupling(const dmb_coupling_def &def) { return add<coupling_id>(dmb_model_add_coupling, def); }
    constraint_id add_constraint(const dmb_constraint_def &def)
    {
        return add<constraint_id>(dmb_model_add_constraint, def);
    }
    drive_id add_drive(const dmb_drive_def &def) { return add<drive_id>(dmb_model_add_drive, def); }
    load_id add_load(const dmb_load_def &def) { return add<load_id>(dmb_model_add_load, def); }
    event_id add_event(const dmb_event_def &def) { return add<event_id>(dmb_model_add_event, def); }
    input_id add_input(const dmb_input_def &def) { return add<input_id>(dmb_model_add_input, def); }
    spring_id add_spring(const dmb_spring_def &def) { return add<spring_id>(dmb_model_add_spring, def); }
    force_id add_force(const dmb_force_def &def) { return add<force_id>(dmb_model_add_force, def); }
    double set_motor(const dmb_motor &motor, dmb_drive_def &drive)
    {
        double speed = 0.0;
        done(dmb_motor_drive(&motor, &drive, &speed));
        return speed;
    }
    stuck_id add_stuck(const dmb_stuck_def &def) { return add<stuck_id>(dmb_model_add_stuck, def); }
    // Parts of a sub.
    struct sub_parts {
        body_id body;      // the sub itself
        string_id section; // the string to add the next pipes to
        joint_id before;   // joins the string to the body
        joint_id after;    // joins the body to the section
        dmb_place end;     // of the string, that `before` joins to the body
    };
    // A body behind the pipes of a string so far, and a section behind the body.
    sub_parts add_sub(const dmb_sub_def &def)
    {
        dmb_sub made = dmb_sub_default();
        described(dmb_model_add_sub(handle_, &def, &made));
        return {body_id(made.body), string_id(made.section), joint_id(made.before), joint_id(made.after), made.end};
    }
    void place_at_end(string_id string, double length, dmb_body_def *body, dmb_string_def *section = nullptr)
    {
        described(dmb_model_place_at_end(handle_, string, length, body, section));
    }
    void set_name(dmb_id part, const char *name) { done(dmb_model_set_name(handle_, part, name)); }
    // The part of that name, as in model.find<drive_id>("table"); throws where there is none.
    template <typename Id>
    DRILLMBD_NODISCARD Id find(const char *name) const
    {
        return Id(find(name, Id::kind));
    }
    // The same of a kind that is known later; without one it also throws where parts of several kinds have the name.
    DRILLMBD_NODISCARD dmb_id find(const char *name, std::int32_t kind = DMB_PART_ANY) const
    {
        dmb_id id = {0, 0};
        check(dmb_model_find(handle_, kind, name, &id));
        return id;
    }
    // The part whose id has that index, as another model of the same description gave it out.
    DRILLMBD_NODISCARD dmb_id part(std::uint32_t index) const
    {
        dmb_id id = {0, 0};
        check(dmb_model_part(handle_, index, &id));
        return id;
    }
    DRILLMBD_NODISCARD std::string name(dmb_id part) const
    {
        char text[DMB_NAME_SIZE];
        check(dmb_model_get_name(handle_, part, text, DMB_NAME_SIZE));
        return text;
    }
    // The pipes added under that name.
    struct pipe_range {
        string_id string;    // that has them
        std::uint32_t first; // number of the first, from the rig end on
        std::uint32_t count; // [-] of them
    };
    DRILLMBD_NODISCARD pipe_range find_pipes(const char *name) const
    {
        dmb_id string = {0, 0};
        pipe_range found = {string_id(), 0, 0};
        check(dmb_model_find_pipes(handle_, name, &string, &found.first, &found.count));
        found.string = string_id(string);
        return found;
    }
    std::int32_t compile(const dmb_compile_options *options = nullptr) { return done(try_compile(options)); }

    // The scene record: the description as bytes that are the same on all machines.
    DRILLMBD_NODISCARD std::vector<unsigned char> write() const
    {
        std::size_t size = 0;
        check(dmb_model_write(handle_, nullptr, 0, &size));
        std::vector<unsigned char> record(size);
        check(dmb_model_write(handle_, record.data(), size, &size));
        return record;
    }
    // The model of a scene record, open for changes before compile; find gives its parts by their names.
    DRILLMBD_NODISCARD static model read(span<const unsigned char> record, const dmb_model_options *options = nullptr)
    {
        model made(nullptr);
        check(try_read(made, record, options));
        return made;
    }

    DRILLMBD_NODISCARD dmb_model_info info() const
    {
        dmb_model_info answer = dmb_model_info_default();
        check(dmb_model_get_info(handle_, &answer));
        return answer;
    }
    // Estimated discretisation error by pipe of a string that has `pipes` pipes at most.
    DRILLMBD_NODISCARD std::vector<double> mesh_errors(string_id string, std::uint32_t pipes) const
    {
        std::vector<double> errors(pipes);
        check(dmb_analysis_mesh(handle_, string, errors.data(), pipes));
        return errors;
    }
    DRILLMBD_NODISCARD dmb_hole_point hole(double depth) const
    {
        dmb_hole_point answer = dmb_hole_point_default();
        check(dmb_query_hole(handle_, depth, &answer));
        return answer;
    }
    DRILLMBD_NODISCARD std::size_t sim_memory_size(const dmb_sim_options *options = nullptr) const
    {
        std::size_t size = 0;
        check(dmb_sim_memory_size(handle_, options, &size));
        return size;
    }
    void write_vtk_hole(double depth0, double depth1, double spacing, std::uint32_t around, const char *path) const
    {
        check(dmb_write_vtk_hole(handle_, depth0, depth1, spacing, around, path));
    }

private:
    std::int32_t done(std::int32_t status) const { return check(status, message()); }
    // Of a call that describes: its refusal is an exception, which compile need not repeat.
    void described(std::int32_t status)
    {
        if (status >= 0) return;
        const error thrown(status, message());
        clear_refused();
        throw thrown;
    }
    template <typename Id, typename Def>
    Id add(std::int32_t (*function)(dmb_model *, const Def *, dmb_id *), const Def &def)
    {
        dmb_id id = {0, 0};
        described(function(handle_, &def, &id));
        return Id(id);
    }
#endif
};

// ---- Buckling -------------------------------------------------------------------------------------------------------
// Result of sim::buckling.
class buckling : public owner<dmb_buckling, dmb_buckling_destroy> {
public:
    explicit buckling(dmb_buckling *handle = nullptr) noexcept : owner(handle) {}

    DRILLMBD_NODISCARD std::uint32_t size() const noexcept { return dmb_buckling_count(handle_); }

#if defined(DRILLMBD_EXCEPTIONS)
    DRILLMBD_NODISCARD dmb_buckling_info info() const
    {
        dmb_buckling_info answer = dmb_buckling_info_default();
        check(dmb_buckling_get_info(handle_, &answer));
        return answer;
    }
    DRILLMBD_NODISCARD double operator[](std::uint32_t mode) const
    {
        double factor = 0.0;
        check(dmb_buckling_factor(handle_, mode, &factor));
        return factor;
    }
    // [m, rad] displacement and rotation of a section, world frame.
    DRILLMBD_NODISCARD std::array<double, 6> shape(std::uint32_t mode, dmb_place place) const
    {
        std::array<double, 6> answer{};
        check(dmb_buckling_shape(handle_, mode, place, answer.data()));
        return answer;
    }
#endif
};

// ---- Modes ----------------------------------------------------------------------------------------------------------
// Result of sim::modes.
class modes : public owner<dmb_modes, dmb_modes_destroy> {
public:
    // Of a part in one mode.
    struct energies {
        double kinetic; // [J]
        double strain;  // [J]
    };

    explicit modes(dmb_modes *handle = nullptr) noexcept : owner(handle) {}

#if defined(DRILLMBD_EXCEPTIONS)
    DRILLMBD_NODISCARD dmb_modes_info info() const
    {
        dmb_modes_info answer = dmb_modes_info_default();
        check(dmb_modes_get_info(handle_, &answer));
        return answer;
    }
    DRILLMBD_NODISCARD std::uint32_t size() const { return info().count; }
    DRILLMBD_NODISCARD dmb_mode operator[](std::uint32_t index) const
    {
        dmb_mode answer = dmb_mode_default();
        check(dmb_modes_get(handle_, index, &answer));
        return answer;
    }
    DRILLMBD_NODISCARD dmb_mode_shape shape(std::uint32_t index, const dmb_place &place,
                                            std::int32_t frame = DMB_FRAME_WORLD) const
    {
        dmb_mode_shape answer = dmb_mode_shape_default();
        answer.frame = frame;
        check(dmb_modes_shape(handle_, index, place, &answer));
        return answer;
    }
    // [J] in a pipe of a string, in a whole string (pipe DMB_NONE), or (pipe 0) in a body or bit.
    DRILLMBD_NODISCARD energies part(std::uint32_t index, dmb_id part, std::uint32_t pipe = DMB_NONE) const
    {
        energies answer{};
        check(dmb_modes_part(handle_, index, part, pipe, &answer.kinetic, &answer.strain));
        return answer;
    }
    void write_vtk(std::uint32_t index, double scale, double phase, std::uint32_t per_element, const char *path) const
    {
        check(dmb_write_vtk_mode(handle_, index, scale, phase, per_element, path));
    }
#endif
};

// Fatigue of places during a run.
class fatigue : public owner<dmb_fatigue, dmb_fatigue_destroy> {
public:
    explicit fatigue(dmb_fatigue *handle = nullptr) noexcept : owner(handle) {}

#if defined(DRILLMBD_EXCEPTIONS)
    // A sample of a sim as it is now.
    void take(const owner<dmb_sim, dmb_sim_destroy> &at) { check(dmb_fatigue_take(handle_, at.get())); }
    DRILLMBD_NODISCARD dmb_fatigue_result result(std::uint32_t place = 0) const
    {
        dmb_fatigue_result answer = dmb_fatigue_result_default();
        check(dmb_fatigue_get(handle_, place, &answer));
        return answer;
    }
#endif
};

// A window over outputs.
class window : public owner<dmb_window, dmb_window_destroy> {
public:
    explicit window(dmb_window *handle = nullptr) noexcept : owner(handle) {}

#if defined(DRILLMBD_EXCEPTIONS)
    // A sample of a sim as it is now.
    void take(const owner<dmb_sim, dmb_sim_destroy> &at) { check(dmb_window_take(handle_, at.get())); }
    void reset_samples() { check(dmb_window_reset(handle_)); }
    DRILLMBD_NODISCARD dmb_window_result result(std::uint32_t output = 0) const
    {
        dmb_window_result answer = dmb_window_result_default();
        check(dmb_window_get(handle_, output, &answer));
        return answer;
    }
#endif
};

// The linearised scene as matrices.
class state_space : public owner<dmb_state_space, dmb_state_space_destroy> {
public:
    explicit state_space(dmb_state_space *handle = nullptr) noexcept : owner(handle) {}

#if defined(DRILLMBD_EXCEPTIONS)
    // Entries of a sparse matrix.
    struct triplets {
        std::vector<std::uint32_t> rows;    // of each entry
        std::vector<std::uint32_t> columns; // of each entry
        std::vector<double> values;         // of each entry
    };
    DRILLMBD_NODISCARD dmb_state_space_info info() const
    {
        dmb_state_space_info answer = dmb_state_space_info_default();
        check(dmb_state_space_get_info(handle_, &answer));
        return answer;
    }
    // A dense matrix, row by row.
    struct matrix {
        std::size_t rows;           // [-]
        std::size_t columns;        // [-]
        std::vector<double> values; // shape (rows, columns)
        // The entry of a row and a column, which are not checked.
        double operator()(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
    };
    // DMB_MATRIX_A .. _D: A has shape (states, states), B (states, inputs), C (outputs, states), D (outputs, inputs).
    DRILLMBD_NODISCARD matrix dense(std::int32_t which) const
    {
        const dmb_state_space_info of = info();
        matrix answer{which < DMB_MATRIX_C ? of.states : of.outputs, which % 2 == 0 ? of.states : of.inputs, {}};
        answer.values.resize(answer.rows * answer.columns + 1); // data() is no null pointer where a side is 0
        check(dmb_state_space_dense(handle_, which, answer.values.data()));
        answer.values.pop_back();
        return answer;
    }
    // DMB_MATRIX_MASS .. _COORDINATES.
    DRILLMBD_NODISCARD triplets sparse(std::int32_t which) const
    {
        std::uint64_t count = 0;
        check(dmb_state_space_sparse(handle_, which, nullptr, nullptr, nullptr, &count));
        triplets answer{std::vector<std::uint32_t>(count), std::vector<std::uint32_t>(count),
                        std::vector<double>(count)};
        if (count > 0)
            check(dmb_state_space_sparse(handle_, which, answer.rows.data(), answer.columns.data(),
                                         answer.values.data(), &count));
        return answer;
    }
#endif
};

// y' = f(t, y) of a scene, in independent coordinates: n positions, then n velocities. It may outlive its sim.
class state_equation : public owner<dmb_state_equation, dmb_state_equation_destroy> {
public:
    explicit state_equation(dmb_state_equation *handle = nullptr) noexcept : owner(handle) {}

    // n, half the length of y.
    DRILLMBD_NODISCARD std::uint32_t count() const noexcept { return dmb_state_equation_count(handle_); }
    // In the state of the last rate or begin, for queries alone; NULL where that failed.
    DRILLMBD_NODISCARD const dmb_sim *at() const noexcept { return dmb_state_equation_sim(handle_); }
#if defined(DRILLMBD_EXCEPTIONS)
    DRILLMBD_NODISCARD std::vector<std::uint32_t> rows() const
    {
        std::vector<std::uint32_t> answer(count());
        check(dmb_state_equation_rows(handle_, answer.data()));
        return answer;
    }
    // y of the origin, and its time [s].
    DRILLMBD_NODISCARD std::vector<double> origin(double *time = nullptr) const
    {
        std::vector<double> answer(2 * static_cast<std::size_t>(count()));
        check(dmb_state_equation_origin(handle_, time, answer.data()));
        return answer;
    }
    // rate = f(time, y), both of length 2 n.
    void rate(double time, span<const double> y, span<double> rate)
    {
        need(y.size());
        need(rate.size());
        check(dmb_state_equation_rate(handle_, time, y.data(), rate.data()));
    }
    // The state becomes the origin, and y its numbers.
    void begin(double time, span<double> y)
    {
        need(y.size());
        check(dmb_state_equation_begin(handle_, time, y.data()));
    }
#endif

private:
#if defined(DRILLMBD_EXCEPTIONS)
    void need(std::size_t size) const
    {
        if (size != 2 * static_cast<std::size_t>(count()))
            throw error(DMB_ERR_VALUE, "state equation: y and rate must have 2 count() numbers");
    }
#endif
};

// Derivatives of a sim by parameters, along a run. The sim must outlive it and is moved by its step and advance.
class sensitivity : public owner<dmb_sensitivity, dmb_sensitivity_destroy> {
public:
    explicit sensitivity(dmb_sensitivity *handle = nullptr) noexcept : owner(handle) {}

#if defined(DRILLMBD_EXCEPTIONS)
    // Steps so far in which the parameter was not smooth.
    DRILLMBD_NODISCARD std::uint64_t kinks(std::uint32_t parameter = 0) const
    {
        std::uint64_t answer = 0;
        check(dmb_sensitivity_kinks(handle_, parameter, &answer));
        return answer;
    }
    std::int32_t step(double duration) { return check(dmb_sensitivity_step(handle_, duration, nullptr)); }
    std::int32_t advance(double time) { return check(dmb_sensitivity_advance(handle_, time, nullptr)); }
    // values: one for each output; derivatives: that times the number of parameters of the caller.
    void outputs(span<const dmb_output> asked, span<double> values, span<double> derivatives) const
    {
        if (values.size() < asked.size() || derivatives.size() < asked.size())
            throw error(DMB_ERR_VALUE, "values and derivatives must have room for each output that is asked for");
        check(dmb_sensitivity_outputs(handle_, asked.data(), asked.count(), values.data(), derivatives.data()));
    }
#endif
};

// Result of sim::response.
class response : public owner<dmb_response, dmb_response_destroy> {
public:
    explicit response(dmb_response *handle = nullptr) noexcept : owner(handle) {}

#if defined(DRILLMBD_EXCEPTIONS)
    // Number of frequencies.
    DRILLMBD_NODISCARD std::uint32_t size() const
    {
        std::uint32_t shape[3];
        check(dmb_response_dimensions(handle_, shape));
        return shape[0];
    }
    DRILLMBD_NODISCARD std::vector<double> frequencies() const
    {
        std::vector<double> answer(size());
        check(dmb_response_frequencies(handle_, answer.data()));
        return answer;
    }
    // Output per unit of an input, or for all of them together, at each frequency.
    DRILLMBD_NODISCARD std::vector<std::complex<double>> transfer(std::uint32_t input = DMB_COMBINED,
                                                                  std::uint32_t output = 0) const
    {
        std::vector<std::complex<double>> answer(size());
        check(dmb_response_transfer(handle_, input, output, reinterpret_cast<double *>(answer.data())));
        return answer;
    }
    // sim: for the names of parts in its heads.
    void write_csv(const char *path, const dmb_sim *sim = nullptr) const
    {
        check(dmb_response_write_csv(handle_, sim, path));
    }
#endif
};

#if defined(DRILLMBD_EXCEPTIONS)
// Result of sim::sine.
struct sine_response {
    std::int32_t status;            // DMB_OK, or DMB_NOTE_STOPPED: not settled
    dmb_stepped_sine_report report; // how it settled
    // Of each output its mean and then its harmonics.
    std::vector<std::vector<std::complex<double>>> amplitudes;
};

// Result of sim::speeds.
struct speed_bands {
    std::int32_t status; // DMB_OK; DMB_NOTE_FULL: there are more bands than there was room for; DMB_NOTE_INCOMPLETE
    std::vector<dmb_speed_band> bands; // ascending, as dmb_analysis_speeds gives them
    std::vector<double> severity;      // at the speeds of the grid
    dmb_speeds_report report;          // orders that excite nothing, no damping, bands truncated at an end of the range
};
#endif

// ---- Sim ------------------------------------------------------------------------------------------------------------
// A simulation of a compiled model, which has to outlive it.
class sim : public owner<dmb_sim, dmb_sim_destroy> {
public:
    // An owner of nothing.
    explicit sim(std::nullptr_t) noexcept {}

    // Makes a sim in out; a previous one is destroyed. Returns the status, which may be a note.
    DRILLMBD_NODISCARD static std::int32_t create(sim &out, const model &of,
                                                  const dmb_sim_options *options = nullptr) noexcept
    {
        dmb_sim *made = nullptr;
        const std::int32_t status = dmb_sim_create(of.get(), options, &made);
        if (status >= 0) out.reset(made);
        return status;
    }
    // The same in the caller's block, which has to outlive the sim.
    DRILLMBD_NODISCARD static std::int32_t create_in(sim &out, const model &of, const dmb_sim_options *options,
                                                     void *block, std::size_t size) noexcept
    {
        dmb_sim *made = nullptr;
        const std::int32_t status = dmb_sim_create_in(of.get(), options, block, size, &made);
        if (status >= 0) out.reset(made);
        return status;
    }

    DRILLMBD_NODISCARD const char *message() const noexcept { return dmb_sim_message(handle_); }
    DRILLMBD_NODISCARD double time() const noexcept { return dmb_sim_time(handle_); } // [s]; NaN without a sim

    DRILLMBD_NODISCARD std::int32_t try_step(double duration, dmb_step_report *report = nullptr) noexcept
    {
        return dmb_sim_step(handle_, duration, report);
    }
    DRILLMBD_NODISCARD std::int32_t try_steps(double duration, std::uint32_t count, std::uint32_t *done = nullptr,
                                              dmb_step_report *report = nullptr) noexcept
    {
        return dmb_sim_steps(handle_, duration, count, done, report);
    }
    DRILLMBD_NODISCARD std::int32_t try_advance(double to, dmb_step_report *report = nullptr) noexcept
    {
        return dmb_sim_advance(handle_, to, report);
    }
    DRILLMBD_NODISCARD std::int32_t try_advance_to_event(double to, dmb_event_report *event = nullptr,
                                                         dmb_step_report *report = nullptr) noexcept
    {
        return dmb_sim_advance_to_event(handle_, to, event, report);
    }
    DRILLMBD_NODISCARD std::int32_t try_steps_to_event(double duration, std::uint32_t count,
                                                       std::uint32_t *done = nullptr, dmb_event_report *event = nullptr,
                                                       dmb_step_report *report = nullptr) noexcept
    {
        return dmb_sim_steps_to_event(handle_, duration, count, done, event, report);
    }
    DRILLMBD_NODISCARD std::int32_t try_set_drive(drive_id drive, double value) noexcept
    {
        return dmb_sim_set_drive(handle_, drive, value);
    }
    DRILLMBD_NODISCARD std::int32_t try_set_input(input_id input, double value) noexcept
    {
        return dmb_sim_set_input(handle_, input, value);
    }
    // As many values as inputs, else DMB_ERR_VALUE.
    DRILLMBD_NODISCARD std::int32_t try_set_inputs(span<const input_id> inputs, span<const double> values) noexcept
    {
        if (inputs.size() != values.size()) return DMB_ERR_VALUE;
        return dmb_sim_set_inputs(handle_, reinterpret_cast<const dmb_id *>(inputs.data()), values.data(),
                                  inputs.count());
    }
    // The records live as long as the sim, or until other ones are given.
    DRILLMBD_NODISCARD std::int32_t try_record_inputs(span<dmb_input_record> records) noexcept
    {
        return dmb_sim_record_inputs(handle_, records.data(), records.count());
    }
    DRILLMBD_NODISCARD std::int32_t try_replay_inputs(span<const dmb_input_record> records,
                                                      std::uint32_t &next) noexcept
    {
        return dmb_sim_replay_inputs(handle_, records.data(), records.count(), &next);
    }
    DRILLMBD_NODISCARD std::int32_t try_set_joint(joint_id joint, std::int32_t state) noexcept
    {
        return dmb_sim_set_joint(handle_, joint, state);
    }
    DRILLMBD_NODISCARD std::int32_t try_transfer_state(const sim &from) noexcept
    {
        return dmb_sim_transfer_state(handle_, from.get());
    }
    DRILLMBD_NODISCARD std::int32_t try_static_start(const dmb_static_options *options = nullptr,
                                                     dmb_static_report *report = nullptr) noexcept
    {
        return dmb_analysis_static(handle_, options, report);
    }
    // function(context, fraction) is called during long calls from now on and may end them; see dmb_sim_set_progress.
    DRILLMBD_NODISCARD std::int32_t try_set_progress(dmb_progress_fn function, void *context = nullptr) noexcept
    {
        return dmb_sim_set_progress(handle_, function, context);
    }
    DRILLMBD_NODISCARD std::int32_t try_restore(const void *block, std::size_t size) noexcept
    {
        return dmb_sim_restore(handle_, block, size);
    }

#if defined(DRILLMBD_EXCEPTIONS)
    explicit sim(const model &of) { begun(of, dmb_sim_create(of.get(), nullptr, &handle_)); }
    sim(const model &of, const dmb_sim_options &options) { begun(of, dmb_sim_create(of.get(), &options, &handle_)); }
    // In the caller's block, which has to outlive the sim.
    sim(const model &of, const dmb_sim_options &options, void *block, std::size_t size)
    {
        begun(of, dmb_sim_create_in(of.get(), &options, block, size, &handle_));
    }

    // Does call(), which makes calls of this sim; progress(fraction) is called during them and ends one by returning
    // true: it throws an error of DMB_ERR_CANCELLED, or advance returns DMB_NOTE_CANCELLED. An exception of progress
    // ends it too and comes out of here.
    template <typename Progress, typename Call>
    void with_progress(Progress progress, Call call)
    {
        teller<Progress> heard(*this, progress);
        try {
            call();
        } catch (...) {
            if (heard.thrown) std::rethrow_exception(heard.thrown);
            throw;
        }
        if (heard.thrown) std::rethrow_exception(heard.thrown);
    }

    std::int32_t step(double duration, dmb_step_report *report = nullptr) { return done(try_step(duration, report)); }
    std::int32_t steps(double duration, std::uint32_t count, std::uint32_t *finished = nullptr,
                       dmb_step_report *report = nullptr)
    {
        return done(try_steps(duration, count, finished, report));
    }
    std::int32_t advance(double to, dmb_step_report *report = nullptr) { return done(try_advance(to, report)); }
    // Bit i of `events` of the result: event number i is reported.
    dmb_event_report advance_to_event(double to, dmb_step_report *report = nullptr)
    {
        dmb_event_report event = dmb_event_report_default();
        done(try_advance_to_event(to, &event, report));
        return event;
    }
    // At most `count` equal steps; `crossing` of the result: time of the first event within the last of them.
    dmb_event_report steps_to_event(double duration, std::uint32_t count, std::uint32_t *finished = nullptr,
                                    dmb_step_report *report = nullptr)
    {
        dmb_event_report event = dmb_event_report_default();
        done(try_steps_to_event(duration, count, finished, &event, report));
        return event;
    }
    void set_drive(drive_id which, double value) { done(try_set_drive(which, value)); }
    // The status may be the note that a bound was taken instead (drillmbd/scene.h).
    std::int32_t set_input(input_id which, double value) { return done(try_set_input(which, value)); }
    DRILLMBD_NODISCARD dmb_input_state input(input_id which) const
    {
        dmb_input_state state = dmb_input_state_default();
        check(dmb_sim_get_input(handle_, which, &state));
        return state;
    }
    // The status may be the note that speeds were projected.
    std::int32_t set_joint(joint_id which, std::int32_t state) { return done(try_set_joint(which, state)); }
    // Continues from the state of `from`, a sim of another model: pipes may have come or gone at the rig end.
    std::int32_t transfer_state(const sim &from) { return done(try_transfer_state(from)); }
    dmb_static_report static_start(const dmb_static_options *options = nullptr)
    {
        dmb_static_report report = dmb_static_report_default();
        done(try_static_start(options, &report));
        return report;
    }

    DRILLMBD_NODISCARD drillmbd::buckling buckling(const dmb_buckling_options *options = nullptr)
    {
        dmb_buckling *found = nullptr;
        done(dmb_analysis_buckling(handle_, options, &found));
        return drillmbd::buckling(found);
    }

    dmb_path_report path(const dmb_path_options *options = nullptr)
    {
        dmb_path_report report = dmb_path_report_default();
        done(dmb_analysis_path(handle_, options, &report));
        return report;
    }
    // The same with visit(at, point) at each point: `at`, a const sim &, is there and may be queried until
    // visit returns; true ends the path. An exception of visit ends it too and comes out of here.
    template <typename Visit>
    dmb_path_report path(const dmb_path_options &options, Visit visit)
    {
        dmb_path_report report = dmb_path_report_default();
        visitor<Visit> visited = {visit, std::exception_ptr()};
        dmb_path_options used = options;
        used.callback = &visitor<Visit>::call;
        used.callback_context = &visited;
        const std::int32_t status = dmb_analysis_path(handle_, &used, &report);
        if (visited.thrown) std::rethrow_exception(visited.thrown);
        done(status);
        return report;
    }

    DRILLMBD_NODISCARD drillmbd::response response(span<const dmb_excitation> inputs, span<const dmb_output> outputs,
                                                   const dmb_response_options *options = nullptr)
    {
        dmb_response *found = nullptr;
        done(dmb_analysis_response(handle_, options, inputs.data(), inputs.count(), outputs.data(), outputs.count(),
                                   &found));
        return drillmbd::response(found);
    }
    // Runs on until the Fourier amplitudes at a frequency [Hz] have settled.
    DRILLMBD_NODISCARD sine_response sine(double frequency, span<const dmb_output> outputs,
                                          const dmb_stepped_sine_options *options = nullptr)
    {
        const dmb_stepped_sine_options used = options != nullptr ? *options : dmb_stepped_sine_options_default();
        const std::size_t width = 1 + std::min<std::size_t>(used.harmonics, 16); // more are refused
        std::vector<std::complex<double>> numbers(width * outputs.size());
        sine_response answer;
        answer.report = dmb_stepped_sine_report_default();
        answer.status = done(dmb_analysis_stepped_sine(handle_, frequency, &used, outputs.data(), outputs.count(),
                                                       reinterpret_cast<double *>(numbers.data()), &answer.report));
        for (std::size_t i = 0; i < numbers.size(); i += width)
            answer.amplitudes.emplace_back(numbers.data() + i, numbers.data() + i + width);
        return answer;
    }
    // Bands of rotary speed to avoid, `room` of them at most; limits: amplitudes that are allowed, one for each output.
    DRILLMBD_NODISCARD speed_bands speeds(span<const dmb_order> orders, span<const dmb_output> outputs,
                                          span<const double> limits, const dmb_speeds_options *options = nullptr,
                                          std::uint32_t room = 64)
    {
        dmb_speeds_options used = options != nullptr ? *options : dmb_speeds_options_default();
        if (limits.size() != outputs.size()) throw error(DMB_ERR_VALUE, "limits: one for each output");
        speed_bands answer;
        answer.report = dmb_speeds_report_default();
        used.report = &answer.report;
        answer.bands.assign(room, dmb_speed_band_default());
        answer.severity.resize(std::min<std::size_t>(used.points, 100000)); // more are refused
        answer.status =
            done(dmb_analysis_speeds(handle_, &used, orders.data(), orders.count(), outputs.data(), limits.data(),
                                     outputs.count(), answer.bands.data(), &room, answer.severity.data()));
        answer.bands.resize(room);
        return answer;
    }
    // Rows of every depth and operation, operation by operation within each depth.
    DRILLMBD_NODISCARD std::vector<dmb_torque_drag_row> torque_drag(span<const dmb_operation> operations,
                                                                    const dmb_torque_drag_options *options = nullptr)
    {
        const std::size_t depths = options != nullptr && options->depths != nullptr ? options->depth_count : 1;
        std::vector<dmb_torque_drag_row> rows(depths * operations.size(), dmb_torque_drag_row_default());
        done(dmb_analysis_torque_drag(handle_, options, operations.data(), operations.count(), rows.data()));
        return rows;
    }
    // Pressures of the mud with the string's far end at a measured depth [m]; trip speed [m/s].
    DRILLMBD_NODISCARD dmb_hydraulics hydraulics(double depth, double trip_speed = 0.0)
    {
        dmb_hydraulics answer = dmb_hydraulics_default();
        done(dmb_analysis_hydraulics(handle_, depth, trip_speed, &answer));
        return answer;
    }
    DRILLMBD_NODISCARD drillmbd::sensitivity sensitivity(span<const dmb_parameter> parameters)
    {
        dmb_sensitivity *made = nullptr;
        done(dmb_sensitivity_create(handle_, parameters.data(), parameters.count(), &made));
        return drillmbd::sensitivity(made);
    }
    DRILLMBD_NODISCARD drillmbd::state_equation state_equation()
    {
        dmb_state_equation *made = nullptr;
        done(dmb_state_equation_create(handle_, &made));
        return drillmbd::state_equation(made);
    }
    DRILLMBD_NODISCARD drillmbd::fatigue fatigue(const dmb_fatigue_options &options, span<const dmb_place> places)
    {
        dmb_fatigue *made = nullptr;
        done(dmb_fatigue_create(handle_, &options, places.data(), places.count(), &made));
        return drillmbd::fatigue(made);
    }
    DRILLMBD_NODISCARD drillmbd::window window(span<const dmb_output> outputs,
                                               const dmb_window_options *options = nullptr)
    {
        dmb_window *made = nullptr;
        done(dmb_window_create(handle_, options, outputs.data(), outputs.count(), &made));
        return drillmbd::window(made);
    }
    DRILLMBD_NODISCARD drillmbd::state_space state_space(span<const dmb_excitation> inputs,
                                                         span<const dmb_output> outputs,
                                                         const dmb_state_space_options *options = nullptr)
    {
        dmb_state_space *made = nullptr;
        done(dmb_analysis_state_space(handle_, options, inputs.data(), inputs.count(), outputs.data(), outputs.count(),
                                      &made));
        return drillmbd::state_space(made);
    }
    // DMB_ARRAY_VELOCITY .. _RESIDUAL.
    DRILLMBD_NODISCARD std::vector<double> array(std::int32_t which)
    {
        std::uint64_t count = 0;
        done(dmb_analysis_array(handle_, which, nullptr, &count));
        std::vector<double> answer(count);
        if (count > 0) done(dmb_analysis_array(handle_, which, answer.data(), &count));
        return answer;
    }
    DRILLMBD_NODISCARD drillmbd::modes modes(const dmb_modes_options *options = nullptr)
    {
        dmb_modes *found = nullptr;
        done(dmb_analysis_modes(handle_, options, &found));
        return drillmbd::modes(found);
    }

    DRILLMBD_NODISCARD std::vector<unsigned char> snapshot() const
    {
        std::size_t size = 0;
        check(dmb_sim_snapshot_size(handle_, &size));
        std::vector<unsigned char> block(size);
        check(dmb_sim_snapshot(handle_, block.data(), size));
        return block;
    }
    void restore(span<const unsigned char> block) { done(try_restore(block.data(), block.size())); }
    DRILLMBD_NODISCARD std::uint64_t hash() const
    {
        std::uint64_t found = 0;
        check(dmb_sim_hash(handle_, &found));
        return found;
    }

    DRILLMBD_NODISCARD dmb_pose pose(const dmb_place &place) const
    {
        return ask(dmb_query_pose, dmb_pose_default(), place);
    }
    DRILLMBD_NODISCARD dmb_motion motion(const dmb_place &place, std::int32_t frame = DMB_FRAME_WORLD) const
    {
        dmb_motion answer = dmb_motion_default();
        answer.frame = frame;
        return ask(dmb_query_motion, answer, place);
    }
    DRILLMBD_NODISCARD dmb_section section(const dmb_place &place) const
    {
        return ask(dmb_query_section, dmb_section_default(), place);
    }
    // Quantities DMB_PROFILE_... at distances [m] along a string ({}: its first), station by station in one vector.
    DRILLMBD_NODISCARD std::vector<double> profile(span<const std::int32_t> quantities, span<const double> distance,
                                                   string_id string = string_id()) const
    {
        return profile_at(quantities, distance.count(), distance.data(), string);
    }
    // The same at a number of stations spread evenly from the rig end to the far end. A template, so that {2.0} is a
    // distance.
    template <typename Count, typename = typename std::enable_if<std::is_integral<Count>::value>::type>
    DRILLMBD_NODISCARD std::vector<double> profile(span<const std::int32_t> quantities, Count stations,
                                                   string_id string = string_id()) const
    {
        return profile_at(quantities, static_cast<std::uint32_t>(stations), nullptr, string);
    }
    // Of each quantity over so many stations spread evenly: least value, its distance [m], largest value, its distance;
    // NaN where no station has a value.
    DRILLMBD_NODISCARD std::vector<double> profile_extremes(span<const std::int32_t> quantities, std::uint32_t stations,
                                                            string_id string = string_id()) const
    {
        std::vector<double> extremes(4 * quantities.size());
        const dmb_profile request = profile_of(quantities, stations, nullptr, string);
        check(dmb_query_profile_extremes(handle_, &request, extremes.data()));
        return extremes;
    }
    DRILLMBD_NODISCARD double rotation(const dmb_place &place) const { return ask(dmb_query_rotation, 0.0, place); }
    DRILLMBD_NODISCARD dmb_contact contact(std::uint32_t site) const
    {
        return ask(dmb_query_contact, dmb_contact_default(), site);
    }
    DRILLMBD_NODISCARD dmb_contact_total contact_total() const
    {
        return ask(dmb_query_contact_total, dmb_contact_total_default());
    }
    // The hole as cutters have left it up to now.
    DRILLMBD_NODISCARD dmb_hole_point hole(double depth) const
    {
        dmb_hole_point answer = dmb_hole_point_default();
        check(dmb_query_hole_now(handle_, depth, &answer));
        return answer;
    }
    DRILLMBD_NODISCARD double kinetic_energy(dmb_id part, std::uint32_t pipe = 0) const
    {
        return ask(dmb_query_kinetic_energy, 0.0, part, pipe);
    }
    DRILLMBD_NODISCARD dmb_energy energy() const { return ask(dmb_query_energy, dmb_energy_default()); }
    DRILLMBD_NODISCARD dmb_momentum momentum() const { return ask(dmb_query_momentum, dmb_momentum_default()); }
    DRILLMBD_NODISCARD dmb_drive_state drive(drive_id which) const
    {
        return ask(dmb_query_drive, dmb_drive_state_default(), which);
    }
    DRILLMBD_NODISCARD std::array<double, 6> reaction(dmb_id part) const
    {
        std::array<double, 6> answer;
        check(dmb_query_reaction(handle_, part, answer.data()));
        return answer;
    }
    DRILLMBD_NODISCARD dmb_joint_state joint(joint_id which, std::int32_t frame = DMB_FRAME_WORLD) const
    {
        dmb_joint_state answer = dmb_joint_state_default();
        answer.frame = frame;
        return ask(dmb_query_joint, answer, which);
    }
    DRILLMBD_NODISCARD dmb_flow_state flow() const { return ask(dmb_query_flow, dmb_flow_state_default()); }
    DRILLMBD_NODISCARD dmb_stuck_state stuck(stuck_id which) const
    {
        return ask(dmb_query_stuck, dmb_stuck_state_default(), which);
    }
    DRILLMBD_NODISCARD dmb_spring_state spring(spring_id which) const
    {
        return ask(dmb_query_spring, dmb_spring_state_default(), which);
    }
    // Pose of a point off a place, offset [m] in the axes of the place.
    DRILLMBD_NODISCARD dmb_pose pose_at(const dmb_place &place, const std::array<double, 3> &offset) const
    {
        dmb_pose answer = dmb_pose_default();
        check(dmb_query_pose_at(handle_, place, offset.data(), &answer));
        return answer;
    }
    DRILLMBD_NODISCARD dmb_motion motion_at(const dmb_place &place, const std::array<double, 3> &offset,
                                            std::int32_t frame = DMB_FRAME_WORLD) const
    {
        dmb_motion answer = dmb_motion_default();
        answer.frame = frame;
        check(dmb_query_motion_at(handle_, place, offset.data(), &answer));
        return answer;
    }
    // Of a joint, coupling, constraint or joint drive, one for each row.
    DRILLMBD_NODISCARD std::vector<double> multipliers(dmb_id part) const
    {
        std::vector<double> answer(6);
        std::uint32_t count = 0;
        check(dmb_query_multipliers(handle_, part, answer.data(), &count));
        answer.resize(count);
        return answer;
    }
    DRILLMBD_NODISCARD dmb_bit_state bit(bit_id which) const
    {
        return ask(dmb_query_bit, dmb_bit_state_default(), which);
    }
    DRILLMBD_NODISCARD dmb_statistics statistics() const { return ask(dmb_query_statistics, dmb_statistics_default()); }
    DRILLMBD_NODISCARD dmb_check_report model_check() const
    {
        return ask(dmb_analysis_check, dmb_check_report_default());
    }
    DRILLMBD_NODISCARD std::string model_check_text() const
    {
        std::size_t needed = 0;
        check(dmb_analysis_check_text(handle_, nullptr, 0, &needed));
        std::string text(needed, '\0');
        check(dmb_analysis_check_text(handle_, &text[0], needed, nullptr));
        text.resize(needed - 1);
        return text;
    }
    // A output DMB_OUTPUT_... at a place; {}: the first string, or none.
    DRILLMBD_NODISCARD double output(std::int32_t quantity, const dmb_place &place = dmb_place{}) const
    {
        const dmb_output asked = {place, quantity, 0};
        double value = 0.0;
        check(dmb_query_output(handle_, &asked, &value));
        return value;
    }
    std::int32_t record(dmb_profile_recorder &recorder) const
    {
        return check(dmb_profile_recorder_take(&recorder, handle_));
    }
    std::int32_t record(dmb_recorder &recorder) const { return check(dmb_recorder_take(&recorder, handle_)); }
    void write_vtk(std::uint32_t per_element, const char *path) const
    {
        check(dmb_write_vtk_strings(handle_, per_element, path));
    }

private:
    static dmb_profile profile_of(span<const std::int32_t> quantities, std::uint32_t stations, const double *distance,
                                  string_id string)
    {
        dmb_profile request = dmb_profile_default();
        request.string = string;
        request.station_count = stations;
        request.distance = distance;
        request.quantity_count = quantities.count();
        request.quantities = quantities.data();
        return request;
    }
    std::vector<double> profile_at(span<const std::int32_t> quantities, std::uint32_t stations, const double *distance,
                                   string_id string) const
    {
        std::vector<double> values(quantities.size() * stations);
        dmb_profile request = profile_of(quantities, stations, distance, string);
        request.values = values.data();
        check(dmb_query_profile(handle_, &request));
        return values;
    }
    // A function object as a C function, while it lives; its exceptions must not unwind through C.
    template <typename Progress>
    struct teller {
        teller(sim &of, Progress &function) : progress(function), owner(of)
        {
            owner.done(dmb_sim_set_progress(owner.handle_, &teller::call, this));
        }
        ~teller() { (void)dmb_sim_set_progress(owner.handle_, nullptr, nullptr); }
        teller(const teller &) = delete;
        teller &operator=(const teller &) = delete;
        static std::int32_t call(void *context, double fraction) noexcept
        {
            teller *self = static_cast<teller *>(context);
            try {
                return self->progress(fraction) ? 1 : 0;
            } catch (...) {
                self->thrown = std::current_exception();
                return 1;
            }
        }
        Progress &progress;
        sim &owner;
        std::exception_ptr thrown;
    };
    // Of the points of a path.
    template <typename Visit>
    struct visitor {
        static std::int32_t call(void *context, const dmb_sim *at, const dmb_path_point *point) noexcept
        {
            visitor *self = static_cast<visitor *>(context);
            sim seen(nullptr);
            seen.handle_ = const_cast<dmb_sim *>(at); // visit sees it as const
            std::int32_t ends = 1;
            try {
                ends = self->visit(static_cast<const sim &>(seen), *point) ? 1 : 0;
            } catch (...) {
                self->thrown = std::current_exception();
            }
            seen.handle_ = nullptr;
            return ends;
        }
        Visit &visit;
        std::exception_ptr thrown;
    };
    // The model says why a create failed.
    static void begun(const model &of, std::int32_t status) { check(status, of.message()); }
    std::int32_t done(std::int32_t status) const { return check(status, message()); }
    template <typename Function, typename Answer, typename... Arguments>
    DRILLMBD_NODISCARD Answer ask(Function function, Answer answer, Arguments... arguments) const
    {
        check(function(handle_, arguments..., &answer));
        return answer;
    }
#endif
};

static_assert(sizeof(model) == sizeof(dmb_model *) && sizeof(sim) == sizeof(dmb_sim *), "owners are one pointer wide");
static_assert(sizeof(part_id<0>) == sizeof(dmb_id), "an array of ids of one kind is an array of dmb_id");

} // namespace drillmbd

#endif
