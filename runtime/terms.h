#pragma once

#include <cstddef>
#include <string>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/opal/terms.h"

namespace opaline::runtime {

/// The first primitive of which `terms` takes only one of multiple and single scattering though its
/// rows hold both; asset.primitives.size() if there is none.
std::size_t find_merged(const formats::AssetView& asset, formats::TermSet terms);

/// ok, or bad_input naming that primitive. `file` is for the message.
formats::Status check_terms(const formats::AssetView& asset, formats::TermSet terms,
                            const std::string& file = {});

}  // namespace opaline::runtime
