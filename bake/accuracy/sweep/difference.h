#pragma once

#include <span>

#include "formats/image/image.h"
#include "runtime/picture/picture.h"

namespace opaline::bake {

/// The luminance difference of full colour: it covers 98 % of the pixels in which one of `pictures`
/// differs from `truth`, rounded up to 1, 2 or 5 times a power of ten; 1 if none differs. All of
/// one size.
double difference_scale(std::span<const runtime::Picture* const> pictures,
                        const runtime::Picture& truth);

/// Signed difference of luminance over `scale`: white where equal, blue where the picture is
/// darker, vermilion where it is brighter. Two colours of the Okabe-Ito set, distinguishable with
/// any colour vision.
formats::Image8 draw_difference(const runtime::Picture& picture, const runtime::Picture& truth,
                                double scale);

}  // namespace opaline::bake
