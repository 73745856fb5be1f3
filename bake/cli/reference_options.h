#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/cli/command.h"
#include "bake/cli/picture_options.h"
#include "bake/cli/progress.h"
#include "bake/cli/scene_options.h"
#include "bake/reference/path.h"
#include "bake/scene/orient_bodies.h"
#include "formats/opal/result.h"
#include "formats/scene.h"
#include "runtime/picture/camera.h"

namespace opaline::cli {

/// Whether paths can be traced through anything of the scene; warns of what they leave out. Errors:
/// bad_input (a cloud layer alone), and warnings that count as errors.
void check_traceable(const formats::Scene& scene);

/// The scene's bodies as a bake sees them, with warnings about faults of their meshes.
bake::OrientedBodies close_bodies(const formats::Scene& scene);

/// How it computes.
enum class ReferenceMethod { monte_carlo, path_integration };

/// What textures are looked up over (bake/reference/path_filter.h).
enum class TextureFilter { none, footprint, limited };

/// Of `opaline reference`, as its help says; 0: not given.
struct ReferenceOptions : SceneSource {
    std::string light, output, terms;
    TextureFilter texture_filter = TextureFilter::none;
    CameraOptions camera;
    ReferenceMethod method = ReferenceMethod::monte_carlo;
    bool renormalise = true;
    Option renormalise_option;  ///< tells whether it was given
    double rotate_light = 0, seconds = 0;
    std::uint32_t receivers = 0, samples = 0, max_depth = 0;
    std::uint64_t seed = 0;
    std::optional<float> exposure;  ///< [EV]; nothing: by the picture, 0 of .exr
    unsigned threads = 0;
    ProgressStyle progress = ProgressStyle::automatic;
    std::vector<Option> picture_options;  ///< that say nothing of receivers

    bool by_integration() const { return method == ReferenceMethod::path_integration; }
};

/// `options` must outlive the parsing.
void add_reference_options(const Command& command, ReferenceOptions& options);

/// Where the variance beside OUT.exr or OUT.png goes: OUT.var.exr.
std::string variance_path(const std::string& output);

/// Outputs that are inputs or each other, and options that say nothing of a table or a picture.
/// `inputs` that the scene has besides. Errors: usage.
void check_reference_paths(const ReferenceOptions& options,
                           std::vector<std::filesystem::path> inputs);

// In path_integration.cpp:

void add_path_integration_options(const Command& command, ReferenceOptions& options);

/// Refuses options that mean nothing for the method, and terms that it does not compute.
void check_method(const ReferenceOptions& options, formats::TermSet terms);

/// Computes the picture by path integration, writes it and prints a summary; warns of fidelity
/// "paper". Precondition: check_path_scene. Errors: usage, for --renormalise on with fidelity
/// "paper"; and of writing.
void make_path_picture(const ReferenceOptions& options, const runtime::Camera& camera,
                       const bake::PathSpace& space, const bake::Context& context);

}  // namespace opaline::cli
