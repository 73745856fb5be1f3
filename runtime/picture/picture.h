#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/rgb.h"
#include "runtime/clouds/see_layer.h"
#include "runtime/picture/band.h"
#include "runtime/picture/camera.h"

namespace opaline::runtime {

/// What a picture is made of. Both renderers run the same list on the same samples: each sample has
/// a colour and a depth (1 / distance along the view axis; 0: nothing there yet), and every pass
/// composes what it adds with both. Surfaces write colour and depth where they are nearest; the
/// background fills what is left at depth 0. A cloud layer attenuates both and adds its own light,
/// its ground hides what is behind. Volumes scatter light between the eye and the depth and come
/// last: they attenuate the colour and add their own, on both sides of the layer, whose part of the
/// colour the samples keep for them (clouds/see_layer.h).
enum class PicturePass { surfaces, background, layers, volumes };

/// The passes of a picture, in order, by what it has besides surfaces.
std::vector<PicturePass> list_passes(bool background, bool volumes, bool layers = false);

/// What both backends refuse: picture sizes outside [1, kMaxPictureSize], S outside [1, 8], a
/// field of view outside (0, 180), a near plane that is not positive, non-finite numbers.
formats::Status check_camera(const Camera& camera, std::uint32_t supersampling);

/// A rendered image: linear Rec. 709 radiance [W m^-2 sr^-1], finite, >= 0; row-major, row 0 on
/// top: pixel[y * width + x].
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<formats::Rgb> pixel;
};

/// Largest width and height of a picture, in pixels, of either backend.
inline constexpr std::uint32_t kMaxPictureSize = 16384;

/// A black picture. Errors: resource, where there is no memory for it.
formats::Result<Picture> make_picture(std::uint32_t width, std::uint32_t height);

/// A band of samples while its passes run: what is nearest, and the colour so far.
struct Samples {
    Band band;  ///< depth, and the triangle seen
    std::vector<formats::Rgb> color;
    std::vector<LayerSheet> sheet;  ///< of a cloud layer, where volumes need it; else empty

    /// Calls draw(sample, column, row), the last two of the whole grid.
    template <class Draw>
    void for_each(Draw draw) const {
        for (std::uint32_t row = 0; row < band.rows; ++row) {
            for (std::uint32_t column = 0; column < band.columns; ++column) {
                draw(std::size_t{row} * band.columns + column, column, band.first_row + row);
            }
        }
    }
};

/// Rows of samples that a thread works on at once: whole pixels, and few enough that a band stays
/// in the megabytes however wide the picture is.
std::uint32_t rows_of_band(const SampleGrid& grid, std::uint32_t supersampling);

/// Writes the means of each pixel's samples to their place in the picture.
void resolve_samples(const Samples& samples, std::uint32_t supersampling, Picture& picture);

}  // namespace opaline::runtime
