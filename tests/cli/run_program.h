#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace opaline::tests {

struct Outcome {
    int exit_code = -1;  ///< 128 + signal number where a signal ended it
    std::string out, err;
};

using Arguments = std::vector<std::string>;
Arguments join(Arguments a, const Arguments& b);

/// Runs a program of the PATH and waits for it. `when_started` gets its process id; what it prints
/// is kept in files, so that it never waits for a reader.
Outcome run_any(const Arguments& command, const std::function<void(int)>& when_started = {});

/// Runs `opaline` with these arguments, and a cache of its own.
Outcome run_opaline(Arguments arguments, const std::function<void(int)>& when_started = {});

/// Names of everything in a folder, sorted.
std::vector<std::string> list_folder(const std::filesystem::path& folder);

std::string read_text(const std::filesystem::path& path);
std::size_t count_lines(const std::filesystem::path& path);

}  // namespace opaline::tests
