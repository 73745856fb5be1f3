// opaline_properties COUNT FIRST: judges the scenes of so many seeds, each in a process of its own,
// and shrinks those that fail; opaline_properties SCENE: one that a line of it, or a seed, names.
// Prints a line for each fault; exits 1 where there is one.
#include <unistd.h>

#include <sys/resource.h>
#include <sys/wait.h>
#include <array>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "bake/base/context.h"
#include "bake/check/check_model.h"
#include "bake/effects/effects.h"
#include "bake/pipeline/volume_stages.h"
#include "tests/properties/build_scene.h"
#include "tests/properties/physics.h"
#include "tests/properties/shown.h"
#include "tests/properties/things.h"

namespace opaline::tests {
namespace {

/// How far a bake errs beside path tracing, and how far it states that it errs.
struct StatedBeside {
    double found = 0;        ///< relative RMS at receivers, under the published lights
    double found_least = 0;  ///< lower end of its interval
    double stated_most = 0;  ///< upper end of the stated error's interval
    bool covers() const { return found_least <= stated_most; }
};

/// Nothing where path tracing has nothing to compare: no receiver, no light, or a bake that fails.
std::optional<StatedBeside> compare_with_reference(const SceneWords& words) {
    const BuiltScene built = build_scene(words);
    const auto baked = bake_coarsely(built.scene, 1);
    if (!baked || built.scene.primitives.empty() || baked->error.rms_relative == 0)
        return std::nullopt;
    bake::ModelCheckOptions options;
    options.receivers = 48;
    options.noise = 0.02;
    options.max_events = 1000000;
    options.simulated = bake::held_light(bake::all_effects(), baked->plan);
    options.lit_by_volumes = bake::lights_surfaces(baked->plan);
    options.volumes_see_surfaces = bake::sees_surfaces(baked->plan);
    bake::Context context;
    context.threads = 1;
    const auto checked = bake::check_model(built.scene, baked->asset.view(), options, context);
    if (!checked || checked->receivers_checked == 0 || checked->by_light.empty())
        return std::nullopt;
    return StatedBeside{checked->rms_relative, checked->ci95[0], baked->error.ci95[1]};
}

using Fails = std::function<bool(const SceneWords&)>;

bool drop_things(SceneWords& scene, const Fails& fails) {
    bool has_dropped = false;
    for (std::size_t i = scene.things.size(); i-- > 0 && scene.things.size() > 1;) {
        SceneWords fewer = scene;
        fewer.things.erase(fewer.things.begin() + static_cast<std::ptrdiff_t>(i));
        if (!fails(fewer)) continue;
        scene = std::move(fewer);
        has_dropped = true;
    }
    return has_dropped;
}

template <class T>
bool simplify(SceneWords& scene, const Fails& fails, T& (*attribute)(SceneWords&, std::size_t),
              std::size_t thing, const T& plain) {
    SceneWords plainer = scene;
    if (attribute(plainer, thing) == plain) return false;
    attribute(plainer, thing) = plain;
    if (!fails(plainer)) return false;
    scene = std::move(plainer);
    return true;
}

bool make_plain(SceneWords& scene, const Fails& fails) {
    bool any = false;
    using Words = SceneWords;
    any |= simplify<double>(
        scene, fails, [](Words& s, std::size_t) -> double& { return s.distance; }, 0, 0);
    any |= simplify<double>(
        scene, fails, [](Words& s, std::size_t) -> double& { return s.scale; }, 0, 1);
    any |= simplify<bool>(
        scene, fails, [](Words& s, std::size_t) -> bool& { return s.turned; }, 0, false);
    any |= simplify<Again>(
        scene, fails, [](Words& s, std::size_t) -> Again& { return s.again; }, 0, Again::never);
    for (std::size_t i = 0; i < scene.things.size(); ++i) {
        any |= simplify<Flaw>(
            scene, fails, [](Words& s, std::size_t t) -> Flaw& { return s.things[t].flaw; }, i,
            Flaw::none);
        any |= simplify<bool>(
            scene, fails, [](Words& s, std::size_t t) -> bool& { return s.things[t].mirrored; }, i,
            false);
        any |= simplify<Place>(
            scene, fails, [](Words& s, std::size_t t) -> Place& { return s.things[t].place; }, i,
            Place::apart);
        any |= simplify<int>(
            scene, fails, [](Words& s, std::size_t t) -> int& { return s.things[t].side; }, i, 0);
        any |= simplify<Shape>(
            scene, fails, [](Words& s, std::size_t t) -> Shape& { return s.things[t].shape; }, i,
            Shape::box);
        const Thing plain;
        any |= simplify<double>(
            scene, fails, [](Words& s, std::size_t t) -> double& { return s.things[t].size; }, i,
            plain.size);
        any |= simplify<double>(
            scene, fails, [](Words& s, std::size_t t) -> double& { return s.things[t].albedo; }, i,
            plain.albedo);
        any |= simplify<double>(
            scene, fails, [](Words& s, std::size_t t) -> double& { return s.things[t].depth; }, i,
            plain.depth);
        any |= simplify<double>(
            scene, fails, [](Words& s, std::size_t t) -> double& { return s.things[t].g; }, i,
            plain.g);
        any |= simplify<double>(
            scene, fails, [](Words& s, std::size_t t) -> double& { return s.things[t].eta; }, i,
            plain.eta);
        any |= simplify<double>(
            scene, fails, [](Words& s, std::size_t t) -> double& { return s.things[t].roughness; },
            i, plain.roughness);
        any |= simplify<ThingKind>(
            scene, fails, [](Words& s, std::size_t t) -> ThingKind& { return s.things[t].kind; }, i,
            ThingKind::opaque);
    }
    return any;
}

/// The scene with as few things, and these as plain, as still fail: things are dropped, then
/// attributes set to those of Thing{}, as long as either succeeds.
SceneWords shrink(SceneWords scene, const Fails& fails) {
    // Each step that succeeds makes it smaller or plainer, so that this ends.
    while (drop_things(scene, fails) || make_plain(scene, fails)) {
    }
    return scene;
}

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
