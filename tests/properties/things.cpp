#include "tests/properties/things.h"

#include <array>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace opaline::tests {
namespace {

constexpr std::array<std::string_view, 14> kKinds{
    "opaque", "metal", "coat",   "double_sided", "pane", "sheet", "medium",
    "clear",  "core",  "volume", "glow",         "lamp", "bulb",  "copy"};
constexpr std::array<std::string_view, 7> kShapes{"box", "ball",  "quad",    "plate",
                                                  "cup", "shell", "triangle"};
constexpr std::array<std::string_view, 7> kFlaws{"whole", "slivers", "twice",     "no_area",
                                                 "flap",  "open",    "inside_out"};
constexpr std::array<std::string_view, 7> kPlaces{"apart",   "face", "edge",  "corner",
                                                  "overlap", "same", "inside"};

constexpr std::array<std::string_view, 9> kAgains{
    "never", "threads", "scaled", "turned", "mirrored", "reordered", "unwelded", "split", "darker"};

template <class Enum, std::size_t N>
Enum read_word(std::istream& in, const std::array<std::string_view, N>& words) {
    std::string word;
    in >> word;
    if (!word.empty() && word.back() == ';') {  // the last word before the first thing
        word.pop_back();
        in.putback(';');
    }
    for (std::size_t i = 0; i < N; ++i) {
        if (words[i] == word) return static_cast<Enum>(i);
    }
    throw std::invalid_argument("'" + word + "' is no word of a scene");
}

}  // namespace

std::string describe(const SceneWords& scene) {
    std::ostringstream out;
    out.precision(10);
    out << scene.scale << ' ' << scene.distance << ' ' << scene.turned;
    if (scene.again != Again::never) out << ' ' << kAgains[static_cast<std::size_t>(scene.again)];
    for (const Thing& t : scene.things) {
        out << "; " << kKinds[static_cast<std::size_t>(t.kind)] << ' '
            << kShapes[static_cast<std::size_t>(t.shape)] << ' '
            << kFlaws[static_cast<std::size_t>(t.flaw)] << ' '
            << kPlaces[static_cast<std::size_t>(t.place)] << ' ' << t.side << ' ' << t.mirrored
            << ' ' << t.size << ' ' << t.albedo << ' ' << t.depth << ' ' << t.g << ' ' << t.eta
            << ' ' << t.roughness;
    }
    return out.str();
}

SceneWords parse_scene(const std::string& text) {
    std::istringstream in(text);
    SceneWords scene;
    in >> scene.scale >> scene.distance >> scene.turned;
    if (in >> std::ws && in.peek() != ';') scene.again = read_word<Again>(in, kAgains);
    for (char semicolon = 0; in >> semicolon;) {
        Thing t;
        t.kind = read_word<ThingKind>(in, kKinds);
        t.shape = read_word<Shape>(in, kShapes);
        t.flaw = read_word<Flaw>(in, kFlaws);
        t.place = read_word<Place>(in, kPlaces);
        in >> t.side >> t.mirrored >> t.size >> t.albedo >> t.depth >> t.g >> t.eta >> t.roughness;
        if (!in) throw std::invalid_argument("a thing has too few numbers: " + text);
        scene.things.push_back(t);
    }
    if (scene.things.empty()) throw std::invalid_argument("a scene of nothing: " + text);
    return scene;
}

bool absorbs(const Thing& thing) {
    const bool is_solid = thing.shape == Shape::box || thing.shape == Shape::ball ||
                          thing.shape == Shape::plate || thing.shape == Shape::cup ||
                          thing.shape == Shape::shell;
    switch (thing.kind) {
        case ThingKind::opaque:
        case ThingKind::metal:
        case ThingKind::coat:
            // Backs are black, and so are cavities.
            if (!is_solid || thing.shape == Shape::shell || thing.flaw == Flaw::open ||
                thing.flaw == Flaw::inside_out || thing.flaw == Flaw::flap)
                return true;
            break;
        case ThingKind::medium:
        case ThingKind::clear:
        case ThingKind::core:
            if (!is_solid || thing.flaw == Flaw::open || thing.flaw == Flaw::flap) return true;
            break;
        case ThingKind::lamp:
        case ThingKind::glow:
        case ThingKind::copy:
            return false;  // in balance with light of radiance 1
        case ThingKind::bulb:
            return true;
        case ThingKind::double_sided:
        case ThingKind::pane:
        case ThingKind::sheet:
        case ThingKind::volume:
            break;
    }
    return thing.albedo < 1;
}

}  // namespace opaline::tests
