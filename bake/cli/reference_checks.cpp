#include "bake/cli/reference_checks.h"

#include <algorithm>

#include "bake/cli/messages.h"
#include "bake/reference/reference_scene.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;

// Paths do not know cloud layers.
void check_layers(const formats::Scene& scene) {
    if (scene.layers.empty()) {
        return;
    }
    if (scene.primitives.empty() && scene.volumes.empty()) {
        refuse(make_error(ErrorKind::bad_input, scene.source, "clouds",
                          "the scene is a cloud layer alone, which no paths are traced through",
                          "a bake measures a layer's error itself; opaline slab computes layers by "
                          "photons"));
    }
    require(report_warnings({formats::make_warning(
        scene.source, "clouds", "the cloud layer is left out: no paths are traced through it",
        "compare with a bake without it")}));
}

// A line to a light without an extent is not bent by a smooth boundary, and no path meets such a
// light.
void check_lights(const formats::Scene& scene) {
    const auto bends = [](const formats::Material& m) {
        return m.medium && !bake::is_matched(m.medium->eta) && !bake::has_rough_boundary(*m.medium);
    };
    if (scene.lights.empty() ||
        std::none_of(scene.materials.begin(), scene.materials.end(), bends)) {
        return;
    }
    require(report_warnings(
        {formats::make_warning(scene.source, "KHR_lights_punctual",
                               "light of points, spots and directional lights does not pass smooth "
                               "boundaries that refract: "
                               "bodies are lit by it as far as other surfaces reflect it",
                               "give the light a surface: a small mesh with emissiveFactor")}));
}

}  // namespace

void check_traceable(const formats::Scene& scene) {
    check_layers(scene);
    check_lights(scene);
}

bake::OrientedBodies close_bodies(const formats::Scene& scene) {
    bake::OrientedBodies bodies = bake::orient_bodies(scene);
    for (bake::BodySurface& surface : bodies.surfaces) {
        surface.open_edges = 0;  // paths are counted that are lost there
    }
    require(report_warnings(bake::describe_faults(scene, bodies.surfaces)));
    return bodies;
}

}  // namespace opaline::cli
