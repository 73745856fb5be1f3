#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/effects/single/light_view.h"
#include "bake/physics/entry.h"

namespace opaline::bake {

/// Padding after the last of ColumnPoints.
constexpr std::size_t kColumnPadding = 8;

/// Interior points and the weights of their light, structure of arrays, with `kColumnPadding`
/// further entries of any finite value.
struct ColumnPoints {
    std::vector<float> x, y, z;                  ///< [m], relative to BodyMesh::centre
    std::array<std::vector<float>, 3> weight{};  ///< per channel; of ColumnMedium::channels
    std::vector<float> importance;  ///< share of the receiver's largest possible light, in [0, 1]
};

/// The medium as look-ups need it.
struct ColumnMedium {
    std::array<float, 3> sigma_t{};  ///< [1/m]
    std::size_t channels = 3;        ///< 3, or 1 if the first stands for all
    float tolerance = 0;             ///< [m] accepted error of a plane
    float throughput = 0;            ///< the largest Ft J at any angle
    Interface<float> boundary;
};

/// Answers of a view for a run of points.
struct ColumnAnswers {
    enum State : std::int32_t { dark, lit, unclear };  ///< unclear: ask look_up
    std::vector<std::int32_t> state;
    std::vector<std::uint32_t> triangle;  ///< where light enters, if lit
    /// weight * throughput * e^{-sigma_t s'} of each channel looked up; 0 unless lit.
    std::array<std::vector<float>, 3> light;
    std::vector<float> distance, throughput, path_ratio;

    void resize(std::size_t points, std::size_t channels);  ///< for runs of up to `points` points
};

/// Looks up points [begin, begin + count), eight at a time. A point is clear in two cases. One: it
/// lies well above or below the obstacles at the four nearest pixels, and the front layer above it
/// is flat up to the tolerance. Two: its light cannot matter; then the nearest pixel decides.
void look_up_columns(const LightView& view, const ColumnPoints& points, std::size_t begin,
                     std::size_t count, const ColumnMedium& medium, ColumnAnswers& answers);

}  // namespace opaline::bake
