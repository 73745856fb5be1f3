#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"

namespace opaline::runtime {

/// The components of outgoing radiance, as bits of a set: what is left out is black.
enum Term : std::uint32_t {
    kMultipleTerm = 1,  ///< scattered often inside a medium
    kSingleTerm = 2,    ///< scattered once inside a medium
    kSpecularTerm = 4,  ///< mirrored at the surface of a medium
    kDiffuseTerm = 8    ///< reflected by an opaque surface
};
inline constexpr std::uint32_t kAllTerms = 15;

/// The first primitive of which `terms` takes only one of multiple and single scattering though its
/// rows hold both; asset.primitives.size() if there is none.
std::size_t find_merged(const formats::AssetView& asset, std::uint32_t terms);

/// ok, or bad_input naming that primitive. `file` is for the message.
formats::Status check_terms(const formats::AssetView& asset, std::uint32_t terms,
                            const std::string& file = {});

}  // namespace opaline::runtime
