#pragma once

#include <map>
#include <numbers>
#include <random>

#include "formats/opal/asset.h"
#include "formats/opal/cubemap.h"

namespace opaline::tests {

/// What a volume of `add_volume` is to be like.
struct VolumeShape {
    std::uint32_t spacing = 4, bands = 1, single_terms = 9, multiple_terms = 4;
    std::uint32_t bricks_along_x = 2;  ///< of a table of one more, whose last cell is empty
};

/// Adds a volume with random density and rows; n is that of the asset's transport.
inline void add_volume(formats::Asset& asset, const VolumeShape& shape) {
    using namespace formats;
    Volumes& volumes = asset.volumes;
    const std::uint32_t n = asset.transport.cubemap_size;
    std::mt19937 generator(11);
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    std::uniform_int_distribution<std::uint32_t> code(0, 65535);
    if (volumes.records.empty()) {
        volumes.rows = make_sparse_rows(n, asset.transport.code_bits);
    }
    VolumeRecord v;
    v.to_world = {0.1f, 0, 0, -1, 0, 0, -0.2f, 2, 0, 0.1f, 0, 0.5f};
    v.sigma_t = {1, 2, 3.5f};
    v.albedo = {0.9f, 1, 0};
    v.first_brick = {-1, 0, 2};
    v.extent = {shape.bricks_along_x + 1, 1, 1};
    v.first_brick_number = static_cast<std::uint32_t>(volumes.density_scale.size());
    v.brick_count = shape.bricks_along_x;
    v.first_cell = volumes.table.size();
    v.first_corner = volumes.corner.size();
    v.spacing = shape.spacing;
    v.first_node = static_cast<std::uint32_t>(volumes.node.size());
    v.single_terms = shape.single_terms;
    v.multiple_terms = shape.multiple_terms;
    v.bands = shape.bands;
    v.first_row = volumes.rows.view().rows();
    v.first_band_row = static_cast<std::uint32_t>(volumes.rows.detail_scale.size());
    v.first_code = volumes.rows.code8.size() + volumes.rows.code16.size();
    v.moment = {1, 0.6f, 0.36f, 0, 0};
    // (1 + c / 2) / (4 pi)
    for (std::size_t i = 0; i < kPhaseEntries; ++i) {
        const double c = phase_cosine(static_cast<double>(i));
        volumes.phase.push_back(static_cast<float>((1 + c / 2) / (4 * std::numbers::pi)));
    }
    std::map<NodeVoxel, std::uint32_t> numbers;
    const auto side = static_cast<std::int32_t>(v.corners_along_edge());
    const auto spacing = static_cast<std::int32_t>(v.spacing);
    for (std::uint32_t b = 0; b < v.brick_count; ++b) {
        // Bricks are numbered against the order of cells.
        volumes.table.push_back(v.brick_count - 1 - b);
        const auto x = v.first_brick[0] + static_cast<std::int32_t>(v.brick_count - 1 - b);
        volumes.density_scale.push_back(1e-4f * uniform(generator));
        for (std::size_t i = 0; i < kBrickVoxels; ++i) {
            volumes.density.push_back(static_cast<std::uint16_t>(code(generator)));
        }
        for (std::int32_t c = 0; c < side * side * side; ++c) {
            if (b == 0 && c == side - 1) {
                volumes.corner.push_back(kNoNode);
                continue;
            }
            const NodeVoxel node{8 * x + spacing * (c % side),
                                 8 * v.first_brick[1] + spacing * (c / side % side),
                                 8 * v.first_brick[2] + spacing * (c / side / side)};
            const auto [at, is_new] = numbers.emplace(node, v.node_count);
            volumes.corner.push_back(at->second);
            if (is_new) {
                volumes.node.push_back(node);
                ++v.node_count;
            }
        }
    }
    volumes.table.push_back(kNoBrick);
    for (std::uint32_t r = 0; r < v.node_count * v.terms(); ++r) {
        SparseRow row;
        row.bands = v.bands;
        for (std::uint32_t i = 1 + r % 7; i < cubemap_texels(n); i += 97) {
            if (i % (n * n) != 0) row.index.push_back(i);
        }
        for (std::size_t i = 0; i < row.index.size() * row.bands; ++i) {
            row.value.push_back(uniform(generator) - 0.5f);
        }
        for (std::size_t i = 0; i < row.bands * std::size_t{6}; ++i) {
            row.average.push_back(uniform(generator));
        }
        append_row(volumes.rows, row);
    }
    volumes.records.push_back(v);
}

/// A sound asset of two volumes and nothing else, n = 8: two bricks with nodes every four voxels
/// and grey rows, one brick with nodes every two and RGB rows of what is unscattered alone.
inline formats::Asset make_volume_asset(std::uint32_t code_bits = 8) {
    formats::Asset asset;
    asset.provenance = R"({"generator":"test"})";
    asset.transport = formats::make_sparse_rows(8, code_bits);
    add_volume(asset, {.multiple_terms = 1});
    add_volume(
        asset,
        {.spacing = 2, .bands = 3, .single_terms = 4, .multiple_terms = 0, .bricks_along_x = 1});
    return asset;
}

}  // namespace opaline::tests
