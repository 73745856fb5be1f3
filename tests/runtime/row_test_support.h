#pragma once

#include <random>
#include <set>

#include "formats/opal/cubemap.h"
#include "formats/opal/sparse_rows.h"
#include "runtime/light_vector.h"

namespace opaline::tests {

/// Rows with 0 ... 40 random details and random averages; every length from 0 to 40 occurs.
inline formats::SparseRows random_rows(std::uint32_t n, std::uint32_t code_bits,
                                       std::uint32_t bands, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> value(-1.0f, 1.0f);
    std::uniform_int_distribution<std::uint32_t> pick(0, formats::cubemap_texels(n) - 1);
    formats::SparseRows rows = formats::make_sparse_rows(n, code_bits);
    for (std::uint32_t details = 0; details <= 40; ++details) {
        std::set<std::uint32_t> index;
        while (index.size() < details) {
            const std::uint32_t k = pick(generator);
            if (k % (n * n) != 0) {
                index.insert(k);
            }
        }
        formats::SparseRow row;
        row.bands = bands;
        row.index.assign(index.begin(), index.end());
        for (std::uint32_t i = 0; i < details * bands; ++i) {
            row.value.push_back(value(generator));
        }
        for (std::uint32_t i = 0; i < 6 * bands; ++i) {
            row.average.push_back(value(generator));
        }
        formats::append_row(rows, row);
    }
    return rows;
}

inline formats::RowRange whole_range(const formats::SparseRows& rows, std::uint32_t bands) {
    return {0, rows.view().rows(), bands, 0, 0};
}

inline runtime::LightVector random_light(std::uint32_t n, std::uint32_t seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> value(-1.0f, 1.0f);
    runtime::LightVector light{n, std::vector<float>(std::size_t{4} * formats::cubemap_texels(n))};
    for (std::size_t i = 0; i < light.rgba.size(); ++i) {
        light.rgba[i] = i % 4 == 3 ? 0.0f : value(generator);
    }
    return light;
}

}  // namespace opaline::tests
