#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/scattering/entry.h"
#include "bake/effects/single/light_view.h"

namespace opaline::bake {

/// What ColumnPoints need beyond their last.
constexpr std::size_t kColumnPadding = 8;

/// Interior points and what their light weighs, structure of arrays: `kColumnPadding` more than
/// there are, which may be anything finite.
struct ColumnPoints {
    std::vector<float> x, y, z;                  ///< [m], relative to BodyMesh::centre
    std::array<std::vector<float>, 3> weight{};  ///< per channel; of ColumnMedium::channels
    std::vector<float> importance;  ///< of all light that the receiver can have, in [0, 1]
};

/// What look-ups need of a medium.
struct ColumnMedium {
    std::array<float, 3> sigma_t{};  ///< [1/m]
    std::size_t channels = 3;        ///< that are looked up; or the first, which stands for all
    float tolerance = 0;             ///< [m] that planes may be off
    float throughput = 0;            ///< the largest Ft J at any angle
    Interface<float> boundary;
};

/// What a view says about a run of points.
struct ColumnAnswers {
    enum State : std::int32_t { dark, lit, unclear };  ///< unclear: ask look_up
    std::vector<std::int32_t> state;
    std::vector<std::uint32_t> triangle;  ///< where light enters, if lit
    /// weight * throughput * e^{-sigma_t s'} of each channel looked up; 0 unless lit.
    std::array<std::vector<float>, 3> light;
    std::vector<float> distance, throughput, path_ratio;

    void resize(std::size_t points, std::size_t channels);  ///< room for a run of as many
};

/// Looks points [begin, begin + count) up, eight at once. Clear is a point well above or below the
/// obstacles at the four pixels around it, or beside their plane, above which the front layer lies
/// in one plane to what matters of its light; and a point that cannot be bright whatever the
/// answer: for it the nearest pixel decides.
void look_up_columns(const LightView& view, const ColumnPoints& points, std::size_t begin,
                     std::size_t count, const ColumnMedium& medium, ColumnAnswers& answers);

}  // namespace opaline::bake
