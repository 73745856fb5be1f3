#include "bake/cli/progress.h"

#include <unistd.h>

#include <fmt/core.h>

#include <chrono>
#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"

namespace opaline::cli {
namespace {

// A signal handler can reach nothing but a global.
std::atomic<bool> interrupt_caught = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int number) {
    interrupt_caught.store(true);
    std::signal(number, SIG_DFL);
}

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

struct Bar {
    std::string stage;
    Clock::time_point start, last;
};

bool is_due(Bar& bar, const bake::Progress& progress) {
    const Clock::time_point now = Clock::now();
    if (bar.stage != progress.stage) {
        bar = {std::string(progress.stage), now, {}};
    }
    const bool due =
        now - bar.last > std::chrono::milliseconds(100) || progress.done == progress.total;
    bar.last = due ? now : bar.last;
    return due;
}

void print_bar(const Bar& bar, const bake::Progress& progress) {
    constexpr std::size_t kWidth = 32;
    const double share = progress.total > 0 ? static_cast<double>(progress.done) /
                                                  static_cast<double>(progress.total)
                                            : 1.0;
    const double seconds = std::chrono::duration<double>(bar.last - bar.start).count();
    const auto filled = static_cast<std::size_t>(share * kWidth);
    const std::string left =
        share > 0 && share < 1 ? format_seconds(seconds * (1 - share) / share) + " left" : "";
    print_to_stderr(fmt::format("\r{:<10} [{}{}] {:3.0f} % {:<16}{}", printable(bar.stage),
                                std::string(filled, '#'), std::string(kWidth - filled, '.'),
                                share * 100, left, progress.done == progress.total ? "\n" : ""));
}

std::string write_line(const Json& line) {
    return line.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace

const std::atomic<bool>& catch_interrupts() {
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        if (std::signal(number, on_signal) == SIG_IGN) {
            std::signal(number, SIG_IGN);
        }
    }
    return interrupt_caught;
}

void add_progress_option(const Command& command, ProgressStyle& style) {
    command.add("--progress",
                one_of(style, {{"auto", ProgressStyle::automatic},
                               {"json", ProgressStyle::json},
                               {"none", ProgressStyle::none}}),
                "auto: a bar on a terminal; json: JSON lines on stderr, with event, stage, done, "
                "total, seconds and eta_seconds, 22 a stage at most; none");
}

std::string ProgressLines::next(const bake::Progress& progress, double seconds_now) {
    constexpr double kStep = 0.05;
    Stage& stage = stages_[std::string(progress.stage)];
    const double share = progress.total > 0 ? static_cast<double>(progress.done) /
                                                  static_cast<double>(progress.total)
                                            : 1.0;
    const bool begins = !stage.is_open, ends = progress.done >= progress.total;
    if (begins && seconds_now < stage.next) return {};
    if (begins) stage = {.begin = seconds_now, .is_open = true};
    if (!begins && !ends && share < stage.last_share + kStep) return {};
    stage.last_share = share;
    stage.is_open = !ends;
    if (ends) stage.next = seconds_now + 1;
    const double seconds = seconds_now - stage.begin;
    Json line{{"stage", progress.stage}, {"event", ends ? "end" : begins ? "begin" : "step"},
              {"done", progress.done},   {"total", progress.total},
              {"seconds", seconds},      {"eta_seconds", nullptr}};
    if (ends) {
        line["eta_seconds"] = 0;
    } else if (seconds > 0 && share > 0) {
        line["eta_seconds"] = seconds * (1 - share) / share;
    }
    std::string text;
    // A stage that is told of once has begun as well.
    if (begins && ends) {
        Json first = line;
        first["event"] = "begin";
        first["done"] = 0;
        first["eta_seconds"] = nullptr;
        text = write_line(first);
    }
    return text + write_line(line);
}

std::function<void(const bake::Progress&)> make_progress_printer(ProgressStyle style,
                                                                 const std::string& job) {
    if (style == ProgressStyle::none ||
        (style == ProgressStyle::automatic && (message_options().quiet || isatty(2) == 0))) {
        return {};
    }
    if (style == ProgressStyle::json) {
        const auto print = [lines = std::make_shared<ProgressLines>(),
                            start = Clock::now()](const bake::Progress& progress) {
            const std::chrono::duration<double> now = Clock::now() - start;
            print_to_stderr(lines->next(progress, now.count()));
        };
        print({job, 0, 1});
        return print;
    }
    return [job, bar = std::make_shared<Bar>()](const bake::Progress& progress) {
        if (progress.stage != job && is_due(*bar, progress)) print_bar(*bar, progress);
    };
}

}  // namespace opaline::cli
