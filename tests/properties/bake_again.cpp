#include "tests/properties/bake_again.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "formats/opal/atomic_file.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/write_opal.h"
#include "tests/properties/change_scene.h"
#include "tests/properties/shown.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

std::string file_bytes(const formats::Asset& asset) {
    const TemporaryFolder folder;
    auto file = formats::AtomicFile::create(folder / "a.opal");
    if (!file || !formats::write_opal(asset.view(), std::move(*file))) return "";
    const auto bytes = formats::FileBytes::open(folder / "a.opal").value();
    return {reinterpret_cast<const char*>(bytes.bytes().data()), bytes.bytes().size()};
}

// What two bakes show at one place.
struct SeenTwice {
    double first = 0, again = 0;
};

// Of the vertices that are seen, by primitive of the first bake, and along lines.
struct Comparison {
    std::vector<std::vector<SeenTwice>> vertices;
    std::vector<SeenTwice> lines;
};

Comparison compare(const BuiltScene& built, const ChangedScene& changed, const Shown& first,
                   const Shown& again) {
    Comparison pairs;
    pairs.vertices.resize(first.vertices.size());
    for (std::size_t p = 0; p < again.vertices.size(); ++p) {
        for (std::size_t v = 0; v < again.vertices[p].size(); ++v) {
            const ChangedScene::Vertex from = changed.before[p][v];
            if (!built.exposed[from.primitive][from.vertex]) continue;
            pairs.vertices[from.primitive].push_back(
                {first.vertices[from.primitive][from.vertex], again.vertices[p][v]});
        }
    }
    for (std::size_t i = 0; i < first.through_volumes.size(); ++i) {
        pairs.lines.push_back({first.through_volumes[i], again.through_volumes[i]});
    }
    return pairs;
}

// Root mean squares of the first, and of what is not allowed: of all that differs, or of all that
// is brighter again.
struct Apart {
    double seen = 0, off = 0, count = 0;

    void add(SeenTwice pair, bool only_brighter) {
        const double off_by = pair.again - pair.first;
        seen += pair.first * pair.first;
        off += only_brighter && off_by < 0 ? 0 : off_by * off_by;
        count += 1;
    }
    double relative() const { return off > 0 ? std::sqrt(off / seen) : 0; }
};

Apart measure(const Comparison& pairs, bool only_brighter) {
    Apart apart;
    for (const auto& primitive : pairs.vertices) {
        for (const SeenTwice pair : primitive) {
            apart.add(pair, only_brighter);
        }
    }
    for (const SeenTwice pair : pairs.lines) {
        apart.add(pair, only_brighter);
    }
    return apart;
}

// Where the order and the place of things stay, bakes draw the same rays again: what then differs
// is roundings, and what few rays change by them.
double allowed(Again again, double stated) {
    const bool same_rays = again == Again::scaled || again == Again::unwelded;
    constexpr double kRoundings = 0.02, kNoise = 0.09;
    return same_rays ? std::max(0.1 * stated, kRoundings) : 1.5 * std::max(stated, kNoise);
}

std::vector<LineOfSight> changed_lines(std::vector<LineOfSight> lines, const ChangedScene& by) {
    for (LineOfSight& line : lines) {
        line = {by.scale * (by.turn * line.from), by.turn * line.along};
    }
    return lines;
}

template <class Judge>
std::optional<Fault> for_each_light(const BuiltScene& built, const bake::BakeResult& baked,
                                    Again again, Judge&& judge) {
    const ChangedScene changed = change_scene(built.scene, again);
    const auto second = bake_coarsely(changed.scene, 1);
    if (!second) return Fault{"bakes again", second.error().diagnostics.front().fault};
    const auto lines = lines_through_volumes(built.scene);
    const auto lines_again = changed_lines(lines, changed);
    for (const LightOfAll& light : {even_light(false), half_sky(false), no_sky(true)}) {
        const Shown first = show(baked, built.scene.origin, lines, light);
        const Shown shown =
            show(*second, changed.scene.origin, lines_again, turned(light, changed.turn));
        if (auto fault = judge(light, compare(built, changed, first, shown),
                               std::hypot(stated_of(baked), stated_of(*second))))
            return fault;
    }
    return std::nullopt;
}

}  // namespace

std::optional<Fault> find_fault_again(const BuiltScene& built, const bake::BakeResult& baked,
                                      Again again) {
    if (again == Again::never) return std::nullopt;
    if (again == Again::threads) {
        const auto three = bake_coarsely(built.scene, 3);
        if (three && file_bytes(baked.asset) == file_bytes(three->asset)) return std::nullopt;
        return Fault{"threads", "1 and 3 threads make different bytes"};
    }
    const bool only_brighter = again == Again::darker;
    return for_each_light(built, baked, again,
                          [&](const LightOfAll& light, const Comparison& pairs,
                              double stated) -> std::optional<Fault> {
                              const Apart apart = measure(pairs, only_brighter);
                              if (apart.relative() < allowed(again, stated)) return std::nullopt;
                              return Fault{
                                  only_brighter ? "darker" : "again",
                                  fmt::format("RMS {:.3f} off under {} light, {:.3f} stated",
                                              apart.relative(), light.name, stated)};
                          });
}

std::string describe_again(const BuiltScene& built, const bake::BakeResult& baked, Again again) {
    if (again == Again::never || again == Again::threads) return "";
    std::string text;
    const auto fault =
        for_each_light(built, baked, again,
                       [&](const LightOfAll& light, const Comparison& pairs,
                           double stated) -> std::optional<Fault> {
                           const Apart apart = measure(pairs, again == Again::darker);
                           text += fmt::format("again: {} light: RMS {:.6f} off, {:.3f} stated\n",
                                               light.name, apart.relative(), stated);
                           return std::nullopt;
                       });
    return fault ? fault->detail : text;
}

}  // namespace opaline::tests
