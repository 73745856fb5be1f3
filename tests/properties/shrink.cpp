#include "tests/properties/shrink.h"

#include <cstddef>
#include <utility>

namespace opaline::tests {
namespace {

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

}  // namespace

SceneWords shrink(SceneWords scene, const Fails& fails) {
    // Each step that succeeds makes it smaller or plainer, so that this ends.
    while (drop_things(scene, fails) || make_plain(scene, fails)) {
    }
    return scene;
}

}  // namespace opaline::tests
