#include "bake/cli/option_values.h"

#include <fmt/core.h>
#include <sys/resource.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <condition_variable>
#include <fstream>
#include <limits>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "bake/cli/messages.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;

template <class T>
std::optional<T> parse_whole(std::string_view text) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole ? std::optional(value) : std::nullopt;
}

/// Units that a length may have, and how many of them a metre has.
struct LengthUnit {
    std::string_view name;
    double per_metre;
};
constexpr LengthUnit kLengthUnits[] = {{"nm", 1e9}, {"um", 1e6}, {"mm", 1e3}, {"m", 1}};
constexpr double kMicrometresPerMetre = 1e6;

/// In metres; nothing where it is no length.
std::optional<double> parse_length(std::string_view text) {
    double per_metre = kMicrometresPerMetre;
    for (const LengthUnit& unit : kLengthUnits) {
        if (text.size() > unit.name.size() && text.ends_with(unit.name)) {
            per_metre = unit.per_metre;
            text.remove_suffix(unit.name.size());
            break;
        }
    }
    const auto value = parse_number(text);
    // Divided, not multiplied by 1e-9, so that 550nm is the number nearest to 5.5e-7.
    return value ? std::optional(*value / per_metre) : std::nullopt;
}

CLI::Validator make_check(std::function<std::string(std::string&)> check) {
    return CLI::Validator(std::move(check), "");  // no text of its own in --help
}

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

// The number in a file of one number; unlimited where there is none.
std::uint64_t read_number(const char* path) {
    std::ifstream file(path);
    std::uint64_t value = 0;
    return file >> value ? value : kUnlimited;
}

// What `ulimit -v` leaves beyond the address space already taken and what is only reserved: heaps
// of the libraries, and a stack for each thread.
std::uint64_t address_space_left(unsigned threads) {
    constexpr std::uint64_t kHeaps = 64u << 20, kStack = 16u << 20;
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
    const std::uint64_t pages = read_number("/proc/self/statm");  // its first number: all of them
    const std::uint64_t used =
        (pages == kUnlimited ? 0 : pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE))) +
        kHeaps + kStack * threads;
    return limit.rlim_cur > used ? limit.rlim_cur - used : 0;
}

}  // namespace

CLI::Validator real_number(double least, double most) {
    return make_check([=](std::string& text) {
        const auto value = parse_whole<double>(text);
        if (value && std::isfinite(*value) && *value >= least && *value <= most) {
            return std::string();
        }
        return fmt::format("'{}' is not a number from {:g} to {:g}", shorten(text), least, most);
    });
}

CLI::Validator number_above(double bound, double most) {
    return make_check([=](std::string& text) {
        const auto value = parse_whole<double>(text);
        if (value && std::isfinite(*value) && *value > bound && *value <= most) {
            return std::string();
        }
        return fmt::format("'{}' is not a number above {:g} and up to {:g}", shorten(text), bound,
                           most);
    });
}

CLI::Validator length(double least, double most) {
    return make_check([=](std::string& text) {
        const auto metres = parse_length(text);
        if (metres && *metres >= least && *metres <= most) {
            text = fmt::format("{}", *metres);
            return std::string();
        }
        return fmt::format(
            "'{}' is not a length from {:g} to {:g} micrometres (a number of micrometres, or one "
            "with a unit: nm, um, mm, m)",
            shorten(text), least * kMicrometresPerMetre, most * kMicrometresPerMetre);
    });
}

std::optional<double> parse_number(std::string_view text) {
    const auto value = parse_whole<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
    return make_check([=](std::string& text) {
        const auto value = parse_whole<std::uint64_t>(text);
        if (value && *value >= least && *value <= most) {
            text = std::to_string(*value);  // leading zeros would make it octal
            return std::string();
        }
        return fmt::format("'{}' is not a whole number from {} to {}", shorten(text), least, most);
    });
}

CLI::Validator file_name() {
    return make_check([](std::string& text) {
        return text.empty() ? std::string("the name is empty; give the path of a file") : "";
    });
}

CLI::Option* add_threads_option(CLI::App& command, unsigned& threads, const std::string& help) {
    return command.add_option("--threads", threads, help)
        ->transform(whole_number(0, 1024))
        ->option_text("T [0]");
}

CLI::Option* add_seed_option(CLI::App& command, std::uint64_t& seed, const std::string& help) {
    return command.add_option("--seed", seed, help)
        ->transform(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
        ->option_text("S [0]");
}

void add_asset_argument(CLI::App& command, std::string& path) {
    command.add_option("file", path, "the .opal file")->required()->option_text("FILE.opal");
}

CLI::Validator term_list() {
    return make_check([](std::string& text) {
        return text.empty() ? std::string("it names nothing; give all, or leave it out") : "";
    });
}

void group_options(CLI::App& command, const std::vector<OptionGroup>& groups,
                   const std::string& others) {
    for (CLI::Option* option : command.get_options()) {
        if (option->nonpositional() && option != command.get_help_ptr()) option->group(others);
    }
    for (const OptionGroup& group : groups) {
        for (const std::string& name : group.names) {
            command.get_option(name)->group(group.heading.empty() ? "Options" : group.heading);
        }
    }
}

namespace detail {

CLI::Validator one_of(std::vector<std::pair<std::string, std::string>> names) {
    return make_check([names = std::move(names)](std::string& text) {
        std::string list;
        for (const auto& [name, value] : names) {
            if (text == name) {
                text = value;
                return std::string();
            }
            list += (list.empty() ? "" : ", ") + name;
        }
        return fmt::format("'{}' is not one of {}", shorten(text), list);
    });
}

}  // namespace detail

void add_memory_option(CLI::App& command, std::uint64_t& limit) {
    command
        .add_option("--memory-limit", limit,
                    "refuse what is predicted to need more; default: what the machine has")
        ->transform(whole_number(1, std::numeric_limits<std::int64_t>::max()))
        ->option_text("BYTES");
}

std::uint64_t available_memory(unsigned threads) {
    const std::uint64_t machine = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                                  static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
    return std::min({machine, read_number("/sys/fs/cgroup/memory.max"),
                     read_number("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
                     address_space_left(threads)});
}

formats::Status check_memory(const std::string& file, const bake::MemoryPrediction& prediction,
                             std::uint64_t limit) {
    const auto most = static_cast<double>(limit);
    if (prediction.bytes() <= most) return formats::ok_status();
    const auto& largest = prediction.largest();
    return make_error(
        ErrorKind::resource, file, "",
        fmt::format("the bake needs about {}, {} of it for {}, and may take {}",
                    format_bytes(prediction.bytes()), format_bytes(largest.bytes), largest.name,
                    format_bytes(most)),
        "lower --quality or --coefficients, split the scene, or raise --memory-limit");
}

formats::Status check_threads(unsigned threads) {
    const unsigned count =
        threads != 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
    std::mutex mutex;
    std::condition_variable done;
    bool is_done = false;
    std::vector<std::thread> started;
    std::string fault;
    try {
        while (started.size() + 1 < count) {
            started.emplace_back([&] {
                std::unique_lock lock(mutex);
                done.wait(lock, [&] { return is_done; });
            });
        }
    } catch (const std::system_error& error) {
        fault = error.what();
    }
    {
        const std::lock_guard lock(mutex);
        is_done = true;
    }
    done.notify_all();
    for (std::thread& thread : started) {
        thread.join();
    }
    if (fault.empty()) {
        // TBB warns on the standard error, at every stage, of more threads than cores.
        static std::optional<tbb::global_control> allowed;
        allowed.emplace(tbb::global_control::max_allowed_parallelism,
                        std::max(count, std::thread::hardware_concurrency()));
        return formats::ok_status();
    }
    return make_error(ErrorKind::resource, "", "--threads",
                      fmt::format("{} threads cannot be started: {}", count, fault),
                      "lower --threads, or raise the limits of memory and of processes");
}

}  // namespace opaline::cli
