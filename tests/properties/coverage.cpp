#include "tests/properties/coverage.h"

#include "bake/base/context.h"
#include "bake/check/check_model.h"
#include "bake/effects/effects.h"
#include "bake/pipeline/volume_stages.h"
#include "tests/properties/build_scene.h"
#include "tests/properties/shown.h"

namespace opaline::tests {

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

}  // namespace opaline::tests
