// opaline_properties COUNT FIRST: judges the scenes of so many seeds, each in a process of its own,
// and shrinks those that fail; opaline_properties SCENE: one that a line of it, or a seed, names.
// Prints a line for each fault; exits 1 where there is one.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "tests/properties/coverage.h"
#include "tests/properties/physics.h"
#include "tests/properties/shrink.h"

namespace opaline::tests {
namespace {

constexpr rlim_t kMostSeconds = 100;      // of the processor for a scene; then it hangs
constexpr unsigned kMostPatience = 3000;  // of the clock, for locks

std::string judge(const SceneWords& scene) {
    try {
        const auto fault = find_fault(scene);
        return fault ? fault->property + ": " + fault->detail : "";
    } catch (const std::exception& e) {
        return std::string("throws: ") + e.what();
    }
}

// The answer of a process of its own, or how that ended.
std::string answer_apart(const SceneWords& scene, std::string (*ask)(const SceneWords&)) {
    std::array<int, 2> pipe_ends{};
    if (::pipe(pipe_ends.data()) != 0) std::abort();
    const pid_t child = ::fork();
    if (child == 0) {
        const rlimit limit{kMostSeconds, kMostSeconds};
        ::setrlimit(RLIMIT_CPU, &limit);
        ::alarm(kMostPatience);
        const std::string answer = ask(scene);
        const bool is_sent = ::write(pipe_ends[1], answer.data(), answer.size()) >= 0;
        std::_Exit(is_sent ? 0 : 1);
    }
    ::close(pipe_ends[1]);
    std::string answer;
    std::array<char, 4096> buffer{};
    for (ssize_t got = 0; (got = ::read(pipe_ends[0], buffer.data(), buffer.size())) > 0;) {
        answer.append(buffer.data(), static_cast<std::size_t>(got));
    }
    ::close(pipe_ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (!WIFSIGNALED(status)) return answer;
    const int signal = WTERMSIG(status);
    return signal == SIGALRM || signal == SIGXCPU || signal == SIGKILL
               ? "hangs: for minutes"
               : "crash: signal " + std::to_string(signal);
}

// The fault of a scene, crashes and hangs among them; empty: none.
std::string judge_apart(const SceneWords& scene) {
    return answer_apart(scene, judge);
}

std::string property_of(const std::string& fault) {
    return fault.substr(0, fault.find(':'));
}

bool judge_seed(std::uint64_t seed) {
    const SceneWords scene = random_scene(seed);
    const std::string fault = judge_apart(scene);
    if (fault.empty()) return true;
    std::printf("seed %llu: %s\n  %s\n", static_cast<unsigned long long>(seed), fault.c_str(),
                describe(scene).c_str());
    std::fflush(stdout);
    const SceneWords least = shrink(scene, [&](const SceneWords& smaller) {
        return property_of(judge_apart(smaller)) == property_of(fault);
    });
    std::printf("  %s\n  %s\n", judge_apart(least).c_str(), describe(least).c_str());
    std::fflush(stdout);
    return false;
}

// Whether the stated error covers what path tracing finds; empty: there is nothing to compare.
std::string compare_errors(const SceneWords& scene) {
    const auto beside = compare_with_reference(scene);
    if (!beside) return "";
    std::array<char, 200> line{};
    std::snprintf(line.data(), line.size(), "%s: errs by %.3f (from %.3f), states up to %.3f",
                  beside->covers() ? "covered" : "missed", beside->found, beside->found_least,
                  beside->stated_most);
    return line.data();
}

int compare_seeds(std::uint64_t scenes, std::uint64_t first) {
    for (std::uint64_t seed = first; seed < first + scenes; ++seed) {
        const SceneWords scene = random_scene(seed);
        const std::string answer = answer_apart(scene, compare_errors);
        if (answer.empty()) continue;
        std::printf("%s: seed %llu: %s\n", answer.c_str(), static_cast<unsigned long long>(seed),
                    describe(scene).c_str());
        std::fflush(stdout);
    }
    return 0;
}

int run(int count, char** argument) {
    const std::string first_word = count > 1 ? argument[1] : "";
    if (count == 4 && first_word == "coverage")
        return compare_seeds(std::strtoull(argument[2], nullptr, 10),
                             std::strtoull(argument[3], nullptr, 10));
    if (count == 2) {
        const SceneWords scene = first_word.find(';') == first_word.npos
                                     ? random_scene(std::stoull(first_word))
                                     : parse_scene(first_word);
        std::printf("%s\n", describe(scene).c_str());
        std::fflush(stdout);  // before what may hang
        std::printf("%s", inspect(scene).c_str());
        std::fflush(stdout);
        const std::string fault = judge_apart(scene);
        std::printf("%s\n", fault.empty() ? "right" : fault.c_str());
        return fault.empty() ? 0 : 1;
    }
    if (count != 3) {
        std::fprintf(stderr, "usage: %s [coverage] COUNT FIRST_SEED, or a scene's line or seed\n",
                     argument[0]);
        return 2;
    }
    int faults = 0;
    const std::uint64_t first = std::strtoull(argument[2], nullptr, 10);
    const std::uint64_t scenes = std::strtoull(argument[1], nullptr, 10);
    for (std::uint64_t seed = first; seed < first + scenes; ++seed) {
        faults += judge_seed(seed) ? 0 : 1;
    }
    std::printf("%llu scenes, %d with a fault\n", static_cast<unsigned long long>(scenes), faults);
    return faults > 0 ? 1 : 0;
}

}  // namespace
}  // namespace opaline::tests

int main(int count, char** argument) {
    try {
        return opaline::tests::run(count, argument);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 2;
    }
}
