#include "tests/runtime/volumes/synthetic_volume.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "formats/opal/cubemap.h"
#include "tests/support/cut_phase.h"

namespace opaline::test {
namespace {

using formats::kBrickSide;
using formats::NodeVoxel;

// Density of a brick's voxels, x fastest.
std::vector<float> voxels_of(const TestVolume& volume, const NodeVoxel& brick) {
    std::vector<float> values;
    for (int z = 0; z < kBrickSide; ++z) {
        for (int y = 0; y < kBrickSide; ++y) {
            for (int x = 0; x < kBrickSide; ++x) {
                values.push_back(volume.density(static_cast<float>(brick[0] * kBrickSide + x),
                                                static_cast<float>(brick[1] * kBrickSide + y),
                                                static_cast<float>(brick[2] * kBrickSide + z)));
            }
        }
    }
    return values;
}

void append_brick(formats::Volumes& volumes, const std::vector<float>& values) {
    const float scale = *std::ranges::max_element(values) / 65535.0f;
    volumes.density_scale.push_back(scale);
    for (const float value : values) {
        volumes.density.push_back(static_cast<std::uint16_t>(std::lround(value / scale)));
    }
}

// The brick's nodes, those that are new appended.
void append_corners(formats::Volumes& volumes, const formats::VolumeRecord& record,
                    const NodeVoxel& brick, std::map<NodeVoxel, std::uint32_t>& known) {
    const auto side = static_cast<int>(record.corners_along_edge());
    const auto spacing = static_cast<int>(record.spacing);
    for (int i = 0; i < side * side * side; ++i) {
        const NodeVoxel node{brick[0] * kBrickSide + spacing * (i % side),
                             brick[1] * kBrickSide + spacing * (i / side % side),
                             brick[2] * kBrickSide + spacing * (i / side / side)};
        const auto [at, is_new] = known.emplace(node, static_cast<std::uint32_t>(known.size()));
        if (is_new) volumes.node.push_back(node);
        volumes.corner.push_back(at->second);
    }
}

// sum_l (2 l + 1) m_l P_l(c), up to the last degree of the terms.
double sum_moments(const TestVolume& volume, double c) {
    const double legendre[] = {1, c, (3 * c * c - 1) / 2, (5 * c * c - 3) * c / 2,
                               ((35 * c * c - 30) * c * c + 3) / 8};
    double sum = 1;
    for (std::size_t l = 1; l * l < volume.single_terms; ++l) {
        sum += (2.0 * static_cast<double>(l) + 1) * static_cast<double>(volume.moment[l]) *
               legendre[l];
    }
    return std::max(0.0, sum);
}

void append_phase(formats::Volumes& volumes, const TestVolume& volume) {
    std::vector<float> table;
    for (std::size_t i = 0; i < formats::kPhaseEntries; ++i) {
        const double c = formats::phase_cosine(static_cast<double>(i));
        table.push_back(
            static_cast<float>(volume.phase ? volume.phase(c) : sum_moments(volume, c)));
    }
    const double integral = formats::integrate_phase_table(table);
    for (const float value : table) {
        volumes.phase.push_back(static_cast<float>(static_cast<double>(value) / integral));
    }
}

}  // namespace

void scatter_forward(TestVolume& volume, double g) {
    const tests::CutPhase phase = tests::make_cut_phase(g);
    volume.moment = phase.moments();
    volume.phase = phase;
}

TestVolume smoke_ball() {
    TestVolume volume;
    volume.extent = {4, 4, 4};
    volume.single_terms = 1;
    volume.density = [](float x, float y, float z) {
        const float r2 = (x - 16) * (x - 16) + (y - 16) * (y - 16) + (z - 16) * (z - 16);
        return std::max(0.0f, 1 - r2 / 200);
    };
    return volume;
}

formats::Volumes make_volumes(std::uint32_t n) {
    formats::Volumes volumes;
    volumes.rows = formats::make_sparse_rows(n, 16);
    return volumes;
}

void add_volume(formats::Volumes& volumes, const TestVolume& volume) {
    formats::VolumeRecord record;
    record.to_world = volume.to_world;
    record.sigma_t = volume.sigma_t;
    record.albedo = volume.albedo;
    record.first_brick = volume.first_brick;
    record.extent = volume.extent;
    record.first_brick_number = static_cast<std::uint32_t>(volumes.density_scale.size());
    record.first_cell = volumes.table.size();
    record.first_corner = volumes.corner.size();
    record.spacing = volume.spacing;
    record.first_node = static_cast<std::uint32_t>(volumes.node.size());
    record.single_terms = volume.single_terms;
    record.multiple_terms = volume.multiple_terms;
    record.bands = volume.bands;
    record.first_row = volumes.rows.view().rows();
    record.first_band_row = static_cast<std::uint32_t>(volumes.rows.detail_scale.size());
    record.first_code = volumes.rows.code16.size();
    record.moment = volume.moment;
    std::map<NodeVoxel, std::uint32_t> known;
    for (std::uint32_t z = 0; z < volume.extent[2]; ++z) {
        for (std::uint32_t y = 0; y < volume.extent[1]; ++y) {
            for (std::uint32_t x = 0; x < volume.extent[0]; ++x) {
                const NodeVoxel brick{volume.first_brick[0] + static_cast<int>(x),
                                      volume.first_brick[1] + static_cast<int>(y),
                                      volume.first_brick[2] + static_cast<int>(z)};
                const std::vector<float> values = voxels_of(volume, brick);
                if (std::ranges::all_of(values, [](float v) { return v == 0; })) {
                    volumes.table.push_back(formats::kNoBrick);
                    continue;
                }
                volumes.table.push_back(record.brick_count++);
                append_brick(volumes, values);
                append_corners(volumes, record, brick, known);
            }
        }
    }
    record.node_count = static_cast<std::uint32_t>(known.size());
    for (std::size_t i = record.first_node; i < volumes.node.size(); ++i) {
        std::vector<formats::SparseRow> rows;
        if (volume.rows) {
            rows = volume.rows(volumes.node[i]);
        } else {
            const std::uint32_t n = volumes.rows.cubemap_size;
            rows.assign(record.terms(), constant_row(n, 0, volume.bands));
            rows.front() = constant_row(n, 1, volume.bands);
        }
        for (const formats::SparseRow& row : rows) {
            formats::append_row(volumes.rows, row);
        }
    }
    append_phase(volumes, volume);
    volumes.records.push_back(record);
}

formats::SparseRow constant_row(std::uint32_t n, float value, std::uint32_t bands) {
    formats::SparseRow row;
    row.bands = bands;
    row.average.assign(std::size_t{6} * bands, value * static_cast<float>(n));
    return row;
}

runtime::LightVector white_light(std::uint32_t n) {
    return runtime::project_cubemap(
        std::vector<formats::Rgb>(formats::cubemap_texels(n), {1, 1, 1}), n);
}

runtime::LightVector texel_light(std::uint32_t n, std::uint32_t texel, formats::Rgb radiance) {
    std::vector<formats::Rgb> map(formats::cubemap_texels(n));
    map[texel] = radiance;
    return runtime::project_cubemap(map, n);
}

}  // namespace opaline::test
