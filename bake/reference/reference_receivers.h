#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/reference/estimate.h"
#include "bake/reference/path.h"
#include "formats/image/image.h"
#include "formats/opal/result.h"
#include "runtime/picture/camera.h"

namespace opaline::bake {

/// Writes `primitive,vertex,r,g,b,se_r,se_g,se_b`, one line per receiver: mean radiance
/// [W m^-2 sr^-1] and its standard error. `opaline compare` reads it as a relight table.
/// Errors: resource.
formats::Status write_receiver_csv(const std::filesystem::path& path,
                                   std::span<const ReferenceReceiver> receivers,
                                   const Estimate& estimate);

struct ReferenceImage {
    formats::Image mean;      ///< radiance [W m^-2 sr^-1], over the area of each pixel
    formats::Image variance;  ///< of the mean, per channel
    Estimate estimate;
};

/// The image of a pinhole camera; with the background only if all terms are counted. The near plane
/// is ignored. Precondition: fewer than 2^32 pixels. Errors: interrupted.
formats::Result<ReferenceImage> estimate_image(const PathSpace& space,
                                               const runtime::Camera& camera,
                                               const EstimateOptions& options,
                                               const Context& context);

/// Radiance of receivers toward their eyes. Errors: interrupted.
formats::Result<Estimate> estimate_receivers(const PathSpace& space,
                                             std::span<const ReferenceReceiver> receivers,
                                             const EstimateOptions& options,
                                             const Context& context);

/// Their luminance, repeated in all three channels: its variance includes the correlation of the
/// channels. Errors: interrupted.
formats::Result<Estimate> estimate_luminance(const PathSpace& space,
                                             std::span<const ReferenceReceiver> receivers,
                                             const EstimateOptions& options,
                                             const Context& context);

/// `wanted` vertices of the scene, stratified over all primitives and drawn by the seed; all
/// vertices, in order, if there are no more. `eye` [m, world]: point of view; nothing: each along
/// its own normal.
std::vector<ReferenceReceiver> choose_receivers(const ReferenceScene& scene, std::uint32_t wanted,
                                                std::uint64_t seed,
                                                const std::optional<glm::vec3>& eye);

}  // namespace opaline::bake
