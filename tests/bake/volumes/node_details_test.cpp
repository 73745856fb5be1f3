#include <gtest/gtest.h>

#include <array>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

// Where there is little density, or little light comes out, errors are not seen.
TEST(NodeDetails, NodesThatAreSeenKeepMoreThanThoseAtTheEdge) {
    formats::Scene scene =
        tests::scene_of(tests::make_volume(tests::make_blob(0.5, 1.0 / 6), 4, 0.9f, 0.5f));
    Knobs knobs = tests::small_knobs(Quality::preview, 2);
    knobs.set(kVolumeWalks, 32);
    knobs.set(kVolumeCoefficients, 96);
    knobs.set(kVolumeTerms, 4);
    const formats::Volumes volumes = tests::bake_volumes_of(scene, knobs);
    const formats::VolumeRecord& record = volumes.records[0];
    const NodeLattice lattice = make_node_lattice(scene.volumes[0].density, 2);
    const std::vector<float> density = node_densities(scene.volumes[0].density, lattice);
    std::array<double, 2> details{}, nodes{};
    for (std::uint32_t i = 0; i < record.node_count; ++i) {
        const std::size_t dense = density[i] > 0.2f ? 1 : 0;
        details[dense] += volumes.rows.row_offset[(i + 1) * record.terms()] -
                          volumes.rows.row_offset[i * record.terms()];
        ++nodes[dense];
    }
    ASSERT_GT(nodes[0], 20);
    ASSERT_GT(nodes[1], 20);
    EXPECT_GT(details[1] / nodes[1], 3 * details[0] / nodes[0]);
    EXPECT_LE(details[0] + details[1], (nodes[0] + nodes[1]) * (96 - 6 * record.terms()));
    EXPECT_GT(details[0] + details[1], 0.9 * (nodes[0] + nodes[1]) * (96 - 6 * record.terms()));
}

}  // namespace
}  // namespace opaline::bake
