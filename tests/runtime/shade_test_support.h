#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "formats/opal/asset.h"
#include "runtime/shade.h"
#include "runtime/view_terms.h"
#include "tests/runtime/row_test_support.h"
#include "tests/support/sky_maps.h"

namespace opaline::tests {

/// Adds a primitive of random rows over n x n texels a face, 41 vertices for each of `copies`,
/// whose normals look in all directions. The record's places and numbers of vertices are set.
inline void add_random_primitive(formats::Asset& asset, std::uint32_t n,
                                 formats::PrimitiveRecord record, std::uint32_t seed,
                                 std::uint32_t copies = 1) {
    formats::SparseRows& rows = asset.transport;
    if (asset.primitives.empty()) rows = formats::make_sparse_rows(n, 8);
    record.first_vertex = static_cast<std::uint32_t>(asset.position.size());
    record.first_row = rows.view().rows();
    record.first_band_row = static_cast<std::uint32_t>(rows.detail_scale.size());
    record.first_code = rows.code8.size();
    for (std::uint32_t k = 0; k < copies * record.terms; ++k) {
        formats::append_rows(rows, random_rows(n, 8, record.bands, seed + k));
    }
    record.vertex_count = (rows.view().rows() - record.first_row) / record.terms;
    asset.primitives.push_back(record);
    for (std::uint32_t v = 0; v < record.vertex_count; ++v) {
        const auto t = static_cast<float>(asset.position.size());
        asset.normal.push_back(
            formats::normalize({std::sin(2 * t), std::cos(3 * t), std::sin(5 * t + 1)}));
        asset.position.push_back(0.5f * asset.normal.back());
        asset.base_color.push_back({0.5f, 0.25f, 1});
    }
}

inline std::vector<formats::Rgb> shaded(const formats::Asset& asset,
                                        const runtime::LightVector& light,
                                        const runtime::ShadeOptions& options = {}) {
    std::vector<formats::Rgb> out(asset.position.size());
    runtime::shade(asset.view(), light, out, options);
    return out;
}

/// Shading has the same bits for any number of threads and wherever it is cut.
inline void expect_same_in_threads_and_ranges(const formats::Asset& asset,
                                              const runtime::LightVector& light,
                                              runtime::ShadeOptions options = {}) {
    options.threads = 1;
    const std::vector<formats::Rgb> one = shaded(asset, light, options);
    for (const unsigned threads : {2u, 5u}) {
        options.threads = threads;
        EXPECT_EQ(shaded(asset, light, options), one);
    }
    for (std::uint32_t first = 0; first < one.size(); first += 7) {
        std::vector<formats::Rgb> part(std::min<std::size_t>(first % 31, one.size() - first));
        runtime::shade_range(asset.view(), light, first, part, options);
        EXPECT_TRUE(std::equal(part.begin(), part.end(), one.begin() + first)) << first;
    }
}

inline formats::Environment even_sky(formats::Rgb radiance) {
    return lat_long_map(64, 32, [radiance](formats::Vec3) { return radiance; });
}

/// A receiver that looks up.
inline runtime::ViewOfReceiver seen_at(float cosine) {
    return {{0, 1, 0}, {std::sqrt(1 - cosine * cosine), cosine, 0}, cosine, false};
}

inline void expect_finite(const std::vector<formats::Rgb>& shaded) {
    for (const formats::Rgb c : shaded) {
        EXPECT_TRUE(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b));
    }
}

}  // namespace opaline::tests
