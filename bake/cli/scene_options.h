#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bake/plan/bake_plan.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// What `bake`, `plan` and `sweep` have in common.
struct SceneOptions {
    std::string scene, media;
    double metres_per_unit = 1.0;
    std::string effects = "auto";
    bake::BakeOptions bake;
};

/// The scene, its media, and what does not decide about accuracy: effects, seed, threads, unit.
void add_subject_options(CLI::App& command, SceneOptions& options);

/// The same and every knob.
void add_scene_options(CLI::App& command, SceneOptions& options);

/// `--error`, in place of `--quality`.
void add_error_option(CLI::App& command, SceneOptions& options);

/// The options of the bake with the effects to simulate: none named for `auto`, nor for `all`,
/// which forces every one. Errors: usage, for those that are unknown or that this version does not
/// simulate.
formats::Result<bake::BakeOptions> parse_effects(const SceneOptions& options);

}  // namespace opaline::cli
