#pragma once

#include <string>
#include <vector>

#include "formats/opal/asset.h"

namespace opaline::runtime {

/// A script that hands the asset's arrays to the page, as they stand in the file
/// (formats/README.md), with where a camera frames it.
std::string make_asset_script(const formats::AssetView& asset);

/// What the page will not show of an asset, each in words; empty: it shows everything.
std::vector<std::string> left_out_of_page(const formats::AssetView& asset);

}  // namespace opaline::runtime
