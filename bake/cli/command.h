#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

// Only command.cpp, program.cpp and usage_errors.cpp include CLI11, which takes seconds to compile.
namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace opaline::cli {

/// Exit codes (README.md of the project).
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitNo = 1;  ///< the job ran and the answer is no
inline constexpr int kExitUsage = 2;
inline constexpr int kExitBadInput = 3;
inline constexpr int kExitResource = 4;
inline constexpr int kExitInterrupted = 130;

/// Where the value of an option goes (option_values.h).
struct OptionValue {
    /// Takes a value as it was typed. Returns what is wrong with it; empty: nothing.
    std::function<std::string(const std::string&)> take;
    enum class Count {
        one,
        repeated,  ///< the option may be given often, with one value each time
        listed,    ///< the same, and there may be commas between values
        rest       ///< of arguments: all that follow
    } count = Count::one;
    std::string placeholder = "TEXT";  ///< in help texts
};

/// An option or argument of a command; by default none.
class Option {
  public:
    Option() = default;
    explicit Option(CLI::Option* option) : option_(option) {}

    bool is_given() const;
    std::string name() const;  ///< "--output"
    const Option& required() const;
    const Option& excludes(const Option& other) const;

  private:
    CLI::Option* option_ = nullptr;
};

/// Options under one heading of a command's help.
struct OptionGroup {
    std::string heading;             ///< empty: the first, without a heading of its own
    std::vector<std::string> names;  ///< "--name", of options that the command has
};

/// A command of the program while its options are added. What values refer to must outlive the
/// parsing.
class Command {
  public:
    explicit Command(CLI::App& app) : app_(&app) {}

    /// "-o,--output", or the name of an argument; `placeholder` stands for the value in help texts.
    Option add(const std::string& name, std::string placeholder, OptionValue value,
               const std::string& help) const;
    /// With the placeholder of the value.
    Option add(const std::string& name, OptionValue value, const std::string& help) const;
    Option add_flag(const std::string& name, bool& flag, const std::string& help) const;
    Option add_flag(const std::string& name, std::function<void()> raise,
                    const std::string& help) const;
    Option find(const std::string& name) const;

    /// Puts options under headings in the order of the groups; those in none under `others`.
    void group(const std::vector<OptionGroup>& groups, const std::string& others) const;
    /// What help texts end with.
    void footer(const std::string& text) const;

  private:
    CLI::App* app_;
};

/// The commands, as they are added.
struct Program {
    CLI::App& app;
    std::function<int()> job = {};  ///< of the command that was chosen; returns the exit code
};

Command add_command(Program& program, const std::string& name, const std::string& summary,
                    std::function<int()> job);

/// A command, and its options where parsing puts them. `run` returns the exit code.
template <class Options>
std::pair<Command, Options&> add_command(Program& program, const std::string& name,
                                         const std::string& summary, int (*run)(const Options&)) {
    auto options = std::make_shared<Options>();
    return {add_command(program, name, summary, [options, run] { return run(*options); }),
            *options};
}

/// Each adds one command, its options and its help to the program.
void add_bake_command(Program& program);
void add_plan_command(Program& program);
void add_info_command(Program& program);
void add_verify_command(Program& program);
void add_relight_command(Program& program);
void add_render_command(Program& program);
void add_view_command(Program& program);  // in view/
void add_export_web_command(Program& program);
void add_export_gltf_command(Program& program);
void add_reference_command(Program& program);
void add_compare_command(Program& program);
void add_mie_command(Program& program);
void add_phase_command(Program& program);
void add_slab_command(Program& program);
void add_sweep_command(Program& program);
void add_example_command(Program& program);

}  // namespace opaline::cli
