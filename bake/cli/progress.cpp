#include "bake/cli/progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"

namespace opaline::cli {
namespace {

using Clock = std::chrono::steady_clock;

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
    fmt::print(stderr, "\r{:<10} [{}{}] {:3.0f} % {:<16}", printable(bar.stage),
               std::string(filled, '#'), std::string(kWidth - filled, '.'), share * 100, left);
    if (progress.done == progress.total) {
        fmt::print(stderr, "\n");
    }
    std::fflush(stderr);
}

void print_json(const bake::Progress& progress) {
    const nlohmann::ordered_json line{
        {"stage", progress.stage}, {"done", progress.done}, {"total", progress.total}};
    fmt::print(stderr, "{}\n",
               line.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace

void add_progress_option(CLI::App& command, ProgressStyle& style) {
    command
        .add_option("--progress", style,
                    "auto: a bar on a terminal; json: a line of JSON a step on stderr; none")
        ->transform(one_of<ProgressStyle>({{"auto", ProgressStyle::automatic},
                                           {"json", ProgressStyle::json},
                                           {"none", ProgressStyle::none}}))
        ->option_text("auto|json|none [auto]");
}

std::function<void(const bake::Progress&)> make_progress_printer(ProgressStyle style) {
    if (style == ProgressStyle::none ||
        (style == ProgressStyle::automatic && (message_options().quiet || isatty(2) == 0))) {
        return {};
    }
    return [style, bar = std::make_shared<Bar>()](const bake::Progress& progress) {
        if (!is_due(*bar, progress)) {
            return;
        }
        if (style == ProgressStyle::json) {
            print_json(progress);
        } else {
            print_bar(*bar, progress);
        }
    };
}

}  // namespace opaline::cli
