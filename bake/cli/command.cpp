#include "bake/cli/command.h"

#include <CLI/CLI.hpp>

namespace opaline::cli {

bool Option::is_given() const {
    return option_ != nullptr && option_->count() > 0;
}

std::string Option::name() const {
    return option_->get_name();
}

const Option& Option::required() const {
    option_->required();
    return *this;
}

const Option& Option::excludes(const Option& other) const {
    option_->excludes(other.option_);
    return *this;
}

Option Command::add(const std::string& name, std::string placeholder, OptionValue value,
                    const std::string& help) const {
    using Count = OptionValue::Count;
    const Count count = value.count;
    const std::string shown = name.substr(name.find(',') + 1);
    CLI::Option* const option = app_->add_option(
        name,
        [shown, take = std::move(value.take)](const CLI::results_t& texts) {
            for (const std::string& text : texts) {
                if (const std::string fault = take(text); !fault.empty()) {
                    throw CLI::ValidationError(shown, fault);
                }
            }
            return true;
        },
        help);
    option->option_text(std::move(placeholder));
    if (count != Count::one) {
        option->expected(CLI::detail::expected_max_vector_size)->take_all();
        option->allow_extra_args(count == Count::rest);
    }
    if (count == Count::listed) option->delimiter(',');
    return Option(option);
}

Option Command::add(const std::string& name, OptionValue value, const std::string& help) const {
    std::string placeholder = value.placeholder;
    return add(name, std::move(placeholder), std::move(value), help);
}

Option Command::add_flag(const std::string& name, bool& flag, const std::string& help) const {
    return Option(app_->add_flag(name, flag, help));
}

Option Command::add_flag(const std::string& name, std::function<void()> raise,
                         const std::string& help) const {
    return Option(app_->add_flag_callback(name, std::move(raise), help));
}

Option Command::find(const std::string& name) const {
    return Option(app_->get_option(name));
}

void Command::group(const std::vector<OptionGroup>& groups, const std::string& others) const {
    for (CLI::Option* option : app_->get_options()) {
        if (option->nonpositional() && option != app_->get_help_ptr()) option->group(others);
    }
    for (const OptionGroup& group : groups) {
        for (const std::string& name : group.names) {
            app_->get_option(name)->group(group.heading.empty() ? "Options" : group.heading);
        }
    }
}

void Command::footer(const std::string& text) const {
    app_->footer(text);
}

Command add_command(Program& program, const std::string& name, const std::string& summary,
                    std::function<int()> job) {
    CLI::App* const command = program.app.add_subcommand(name, summary);
    command->callback([&program, job = std::move(job)] { program.job = job; });
    return Command(*command);
}

}  // namespace opaline::cli
