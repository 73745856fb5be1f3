#pragma once

#include <span>

#include "bake/base/context.h"
#include "bake/reference/estimate.h"
#include "formats/image/image.h"
#include "formats/opal/result.h"
#include "runtime/picture/camera.h"

namespace opaline::bake {

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

}  // namespace opaline::bake
