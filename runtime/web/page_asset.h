#pragma once

#include <string>

#include "formats/opal/asset.h"

namespace opaline::runtime {

/// A script that hands the asset's arrays to the page, as they stand in the file
/// (formats/README.md), with where a camera frames it.
std::string make_asset_script(const formats::AssetView& asset);

}  // namespace opaline::runtime
