#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "bake/base/context.h"
#include "bake/cli/command.h"
#include "bake/reference/path.h"
#include "formats/opal/result.h"
#include "runtime/picture/camera.h"

namespace opaline::cli {

/// How `opaline reference` computes.
enum class ReferenceMethod { monte_carlo, path_integration };

/// Options of `--method path-integration`.
struct PathIntegrationOptions {
    ReferenceMethod method = ReferenceMethod::monte_carlo;
    bool renormalise = true;
    Option renormalise_option;  ///< tells whether it was given

    bool is_chosen() const { return method == ReferenceMethod::path_integration; }
};
void add_path_integration_options(const Command& command, PathIntegrationOptions& options);

/// An option of Monte Carlo alone, and whether it was given.
struct MonteCarloOption {
    const char* name = "";
    bool is_given = false;
};

/// Refuses options that mean nothing for the method, and terms that it does not compute.
/// Errors: usage.
void check_method(const PathIntegrationOptions& options,
                  std::span<const MonteCarloOption> monte_carlo, formats::TermSet terms);

/// A picture to write.
struct PathPicture {
    const std::string& output;
    float exposure = 0;
    std::uint32_t rays = 0;  ///< of a pixel; 0: the default
    const runtime::Camera& camera;
};

/// Computes the picture by path integration, writes it and prints a summary; warns of fidelity
/// "paper". Precondition: check_path_scene. Errors: usage, for --renormalise on with fidelity
/// "paper"; and of writing.
void make_path_picture(const PathPicture& picture, const bake::PathSpace& space,
                       const PathIntegrationOptions& options, const bake::Context& context);

}  // namespace opaline::cli
