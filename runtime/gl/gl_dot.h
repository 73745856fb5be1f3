#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "formats/opal/result.h"
#include "runtime/gl/gl_asset.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/part_lights.h"

namespace opaline::runtime {

/// The compute shader that evaluates <T_k, L>, specialised for one asset's code and index widths.
struct DotPrograms {
    /// For opaque and translucent rows of one band, then of three; made where needed.
    std::array<GlProgram, 4> program;
    std::uint32_t lanes_per_row = 1;
    std::uint32_t rows_per_group = 1;
};

/// Rows that a workgroup of these many lanes a row takes.
std::uint32_t rows_per_group(std::uint32_t lanes_per_row);

/// What one dispatch may see on the current context; `max_block_bytes` 0: the driver's limit.
DotLimits query_dot_limits(std::size_t max_block_bytes, std::uint32_t lanes_per_row);

formats::Result<DotPrograms> make_dot_programs(const GlAsset& asset, std::uint32_t lanes_per_row);

/// Errors: usage (another cube map size than the asset's, not one light for each primitive).
formats::Status check_lights(const PartLights& lights, const GlAsset& asset);

/// Lights as PartLights has them, each a buffer of 6 n n vec4.
struct DotLights {
    std::span<const GlBuffer> light;
    std::span<const std::uint32_t> of_primitive;
};

/// Fills asset.radiance, or asset.product for primitives that need a view.
formats::Status dispatch_dots(const GlAsset& asset, const DotPrograms& programs,
                              const DotLights& lights);

}  // namespace opaline::runtime
