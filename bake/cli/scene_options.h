#pragma once

#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "bake/plan/bake_plan.h"
#include "formats/gltf/import_gltf.h"
#include "formats/media/load_clouds.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// A scene and how it is read.
struct SceneSource {
    std::string scene, media;
    formats::ImportOptions import;
};

void add_scene_argument(const Command& command, SceneSource& source);
/// `--allow-path`, as often as wanted.
void add_allow_path_option(const Command& command, SceneSource& source);
/// `--metres-per-unit`, `--smooth-normals`.
void add_unit_options(const Command& command, SceneSource& source);

/// Options common to `bake`, `plan` and `sweep`.
struct SceneOptions : SceneSource {
    std::string effects = "auto";
    std::uint64_t memory_limit = 0;  ///< [bytes]; 0: what the machine has
    bake::BakeOptions bake;
};

/// The scene, its media, and options without influence on accuracy: effects, seed, threads, unit.
void add_subject_options(const Command& command, SceneOptions& options);

/// The same and every knob.
void add_scene_options(const Command& command, SceneOptions& options);

/// `--error`, in place of `--quality`.
void add_error_option(const Command& command, SceneOptions& options);

/// Opens the scene and its media (open_scene). What a bake with these knobs is predicted to need
/// more memory for than there is, is refused before it is built. Errors: also resource.
formats::ImportedScene open_scene(const SceneOptions& options, const bake::Knobs& knobs,
                                  formats::CloudDetail detail);

/// The knobs, with as many receivers at most as fit into memory.
bake::Knobs fit_memory(const SceneOptions& options, const formats::Scene& scene,
                       const bake::Knobs& knobs);

/// The options of the bake with the effects to simulate: none named for `auto`, nor for `all`,
/// which forces every one. Errors: usage, for those that are unknown or that this version does not
/// simulate.
bake::BakeOptions parse_effects(const SceneOptions& options);

}  // namespace opaline::cli
