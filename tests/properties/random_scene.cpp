#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>

#include "tests/properties/things.h"

namespace opaline::tests {
namespace {

// The same numbers from every standard library.
class Chance {
  public:
    explicit Chance(std::uint64_t seed) : engine_(seed) {}
    double even() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
    double even(double low, double high) { return low + (high - low) * even(); }
    bool one_in(int n) { return even() * n < 1; }
    int below(int n) { return static_cast<int>(even() * n); }
    /// Four digits, which are as good and can be read.
    double log_even(double low, double high) {
        return short_number(std::exp(even(std::log(low), std::log(high))));
    }
    template <class T>
    T one_of(std::initializer_list<T> list) {
        return list.begin()[below(static_cast<int>(list.size()))];
    }
    static double short_number(double x) {
        const double unit = std::pow(10.0, std::floor(std::log10(x)) - 3);
        return std::round(x / unit) * unit;
    }

  private:
    std::mt19937_64 engine_;
};

Shape draw_shape(ThingKind kind, bool lossless, Chance& chance) {
    switch (kind) {
        case ThingKind::opaque:
        case ThingKind::metal:
        case ThingKind::coat:
        case ThingKind::lamp:
            if (!lossless && chance.one_in(3)) return chance.one_of({Shape::quad, Shape::triangle});
            return chance.one_of({Shape::box, Shape::ball, Shape::plate});
        case ThingKind::double_sided:
        case ThingKind::pane:
        case ThingKind::sheet:
            return chance.one_of({Shape::quad, Shape::quad, Shape::box, Shape::ball, Shape::plate,
                                  Shape::cup, Shape::triangle});
        case ThingKind::medium:
        case ThingKind::clear:
            if (!lossless && chance.one_in(8)) return chance.one_of({Shape::quad, Shape::triangle});
            return chance.one_of(
                {Shape::box, Shape::box, Shape::ball, Shape::plate, Shape::cup, Shape::shell});
        case ThingKind::core:
        case ThingKind::volume:
        case ThingKind::glow:
        case ThingKind::bulb:
        case ThingKind::copy:
            break;
    }
    return chance.one_of({Shape::box, Shape::ball});
}

Thing random_thing(bool lossless, Chance& chance) {
    Thing t;
    do {
        t = {};
        t.kind = static_cast<ThingKind>(chance.below(static_cast<int>(ThingKind::bulb) + 1));
        // What bodies do to each other goes wrong more often.
        if (chance.one_in(3))
            t.kind = chance.one_of({ThingKind::medium, ThingKind::medium, ThingKind::clear});
        t.shape = draw_shape(t.kind, lossless, chance);
        if (chance.one_in(4)) t.flaw = static_cast<Flaw>(chance.below(7));
        t.place = static_cast<Place>(chance.below(7));
        t.side = chance.below(6);
        t.mirrored = chance.one_in(5);
        if (chance.one_in(2)) t.size = chance.log_even(0.3, 3);
        if (!lossless) t.albedo = chance.one_of({1.0, 0.0, 0.5, 0.999, chance.log_even(0.01, 1)});
        t.depth = chance.log_even(0.01, 100);
        if (chance.one_in(6)) t.depth = chance.log_even(1e-9, 1e9);
        // Walks through deep white volumes take minutes.
        if (t.kind == ThingKind::volume || t.kind == ThingKind::glow) {
            if (t.depth > 30) t.albedo = lossless ? 1 : chance.one_of({0.0, 0.5});
            if (t.depth > 30 && t.albedo == 1) t.depth = 30;
        }
        if (t.kind == ThingKind::glow) t.albedo = 0.5;
        t.g = chance.one_of({0.0, 0.0, 0.3, 0.9, -0.5, 0.99, -0.99});
        t.eta = chance.one_of({1.0, 1.0, 1.3, 1.3, 1.5, 1.5, 2.4, 3.0, 0.6667, 0.3334});
        t.roughness = chance.one_of({0.0, 0.05, 0.3, 0.7, 1.0});
    } while (lossless && absorbs(t));
    return t;
}

}  // namespace

SceneWords random_scene(std::uint64_t seed) {
    Chance chance(seed);
    SceneWords scene;
    const bool lossless = chance.one_in(2);
    // Few things: what goes wrong does so between two.
    const int count = chance.one_in(10) ? 3 + chance.below(10) : 1 + chance.below(2);
    for (int i = 0; i < count; ++i) {
        scene.things.push_back(random_thing(lossless, chance));
    }
    if (chance.one_in(3)) scene.scale = chance.log_even(1e-6, 1e6);
    scene.turned = chance.one_in(3);
    // Farther away floats are coarser than a thousandth of things, which the importer says.
    if (chance.one_in(4)) scene.distance = std::min(1e7, scene.scale * chance.log_even(1, 1e4));
    scene.again = static_cast<Again>(1 + chance.below(static_cast<int>(Again::darker)));
    constexpr int kEachCopied = 6;
    for (std::size_t i = 1; i < scene.things.size(); ++i) {
        if (chance.one_in(kEachCopied)) scene.things[i].kind = ThingKind::copy;
    }
    return scene;
}

}  // namespace opaline::tests
