#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "formats/opal/result.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {

/// The difference of tested values A from reference values B. The error of an element (pixel or
/// receiver) is the root mean square of its three bands' differences, |a - b| / sqrt(3).
struct Comparison {
    double rmse = 0;           ///< root mean square of the elements' errors
    double relative_rmse = 0;  ///< rmse / root mean square of B; 0 if both are black, infinity if
                               ///< only B is
    double p95 = 0;            ///< 95th percentile of the elements' errors (nearest rank)
    double maximum = 0;        ///< largest error of an element
    std::uint64_t count = 0;   ///< elements compared
};

/// Precondition: equal sizes, at least one element, finite values.
Comparison compare_values(std::span<const formats::Rgb> a, std::span<const formats::Rgb> b);

/// Compares two images (OpenEXR, Radiance, PNG; PNG in linear light, alpha ignored) of equal size,
/// or two relight tables (CSV) with the same set of receivers; told apart by content. `a` is the
/// tested file, `b` the reference; where `b` has standard errors (`opaline reference`), only its
/// receivers are compared.
/// Errors: bad_input for unreadable files, NaN or infinite values, and anything not comparable.
formats::Result<Comparison> compare_files(const std::filesystem::path& a,
                                          const std::filesystem::path& b);

}  // namespace opaline::bake
