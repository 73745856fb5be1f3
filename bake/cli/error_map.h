#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/cli/inputs.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// A picture of numbers at receivers, in place of light: an asset whose surfaces show colours of
/// their own under the light of error_map_light().
struct ErrorMap {
    std::vector<formats::PrimitiveRecord> primitives;
    formats::SparseRows rows;
    std::vector<formats::Rgb> color;

    /// The surfaces of the asset, with the holes they have, and nothing else of it. Refers to both.
    formats::AssetView view_of(const formats::AssetView& asset) const;
};

/// Colours from black for 0 over red and yellow to white for `white` > 0 and more, as the
/// difference of two pictures is shown (view/picture_painter.h), in display values, which are
/// linear along each third. `values`: one for each receiver.
ErrorMap make_error_map(const formats::AssetView& asset, std::span<const float> values,
                        float white);

/// Even light that is dark grey behind the surfaces. The same for all assets.
OpenedLight error_map_light();

/// The errors by receiver that a file holds. Errors: bad_input (damaged, or without any).
formats::Result<std::vector<float>> stored_errors(const OpenedAsset& asset,
                                                  const std::string& path);

}  // namespace opaline::cli
