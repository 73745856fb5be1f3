// Volumes whose bytes are not as they were written: nothing may be read out of bounds.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "tests/formats/opal/section_damage.h"
#include "tests/formats/opal/volume_fixture.h"

namespace opaline::formats {
namespace {

TEST(VolumesDamage, EveryTruncationIsRefused) {
    tests::expect_truncations_refused(tests::make_volume_asset());
}

TEST(VolumesDamage, EveryTruncationOfTheSectionIsRefused) {
    tests::expect_section_truncations_refused(tests::make_volume_asset(), kVoluSection);
}

TEST(VolumesDamage, EveryFlippedByteIsFoundByTheFullCheck) {
    tests::expect_flipped_bytes_found(tests::make_volume_asset(), kVoluSection);
}

// Uses everything that a runtime would use; the address sanitizer watches.
void use(const VolumesView& volumes) {
    double sum = 0;
    std::vector<float> dense(cubemap_texels(volumes.rows.cubemap_size));
    for (const float cosine : {-1.0f, 0.3f, 1.0f}) {
        sum += double{eval_phase_table(volumes.phase_of(volumes.records.size() - 1), cosine)};
    }
    for (const VolumeRecord& v : volumes.records) {
        const std::size_t cells = std::size_t{v.extent[0]} * v.extent[1] * v.extent[2];
        for (std::size_t cell = 0; cell < cells; ++cell) {
            const std::uint32_t brick = volumes.table[v.first_cell + cell];
            if (brick == kNoBrick) continue;
            const std::size_t number = v.first_brick_number + brick;
            sum += double{volumes.density_scale[number]};
            for (std::size_t i = 0; i < kBrickVoxels; ++i) {
                sum += volumes.density[number * kBrickVoxels + i];
            }
            for (std::size_t i = 0; i < v.corners_of_brick(); ++i) {
                const std::uint32_t node =
                    volumes.corner[v.first_corner + brick * v.corners_of_brick() + i];
                if (node != kNoNode) sum += volumes.node[v.first_node + node][0];
            }
        }
        for (std::uint32_t row = 0; row < v.rows().rows; ++row) {
            decode_row(volumes.rows, v.rows(), row, v.bands - 1, dense);
            sum += double{dense[row % dense.size()]};
        }
    }
    volatile double used = sum;
    (void)used;
}

TEST(VolumesDamage, ConsistentlyForgedSectionsAreRefusedOrStayInBounds) {
    const auto [refused, accepted, refused_for_values] = tests::forge_section(
        tests::make_volume_asset(), kVoluSection, 48 + 2 * sizeof(VolumeRecord),
        [](const AssetView& asset) { use(asset.volumes); });
    EXPECT_GT(refused, 1000u);
    EXPECT_GT(accepted, 1000u);
    EXPECT_GT(refused_for_values, 1000u);
}

}  // namespace
}  // namespace opaline::formats
