#pragma once

#include <span>

#include "formats/image/image.h"
#include "runtime/picture/picture.h"

namespace opaline::bake {

/// Luminance differences that get full colour: large enough for 98 % of the pixels in which one of
/// `pictures` differs from `truth`, rounded up to 1, 2 or 5 times a power of ten; 1 where none
/// does. All of one size.
double difference_scale(std::span<const runtime::Picture* const> pictures,
                        const runtime::Picture& truth);

/// Signed difference of luminance over `scale`: white where equal, blue where the picture is
/// darker, vermilion where it is brighter. Two colours of the set of Okabe and Ito, which people of
/// every colour vision tell apart.
formats::Image8 draw_difference(const runtime::Picture& picture, const runtime::Picture& truth,
                                double scale);

}  // namespace opaline::bake
