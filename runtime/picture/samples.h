#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/opal/rgb.h"
#include "runtime/clouds/layer_sheet.h"
#include "runtime/picture/band.h"
#include "runtime/picture/picture.h"

namespace opaline::runtime {

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
