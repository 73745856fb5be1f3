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

/// Runs `opaline` with these arguments in this process.
Outcome run_opaline(Arguments arguments);

/// The same with a cache folder of the test's choice.
Outcome run_with_cache(const std::filesystem::path& cache, const Arguments& arguments);

/// The same; it must succeed.
Outcome run_well(Arguments arguments);

/// It must end with this code, print nothing, and say an error that holds `part`.
void expect_refused(const Arguments& arguments, int exit_code, const std::string& part);

/// Starts the program itself: for signals, and what belongs to a process.
Outcome start_opaline(Arguments arguments, const std::function<void(int)>& when_started = {});

/// Names of everything in a folder, sorted.
std::vector<std::string> list_folder(const std::filesystem::path& folder);

std::string read_text(const std::filesystem::path& path);
std::size_t count_lines(const std::filesystem::path& path);

}  // namespace opaline::tests
