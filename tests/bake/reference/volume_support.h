#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/bake/reference/reference_support.h"
#include "tests/bake/reference/transport_rows.h"
#include "tests/support/volumes.h"

namespace opaline::tests {

inline std::unique_ptr<ReferenceFixture> make_volume_fixture(std::vector<formats::Volume> volumes,
                                                             formats::Environment sky) {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes = std::move(volumes);
    return make_fixture(std::move(scene), std::move(sky));
}

inline bake::Moments look(const ReferenceFixture& fixture, glm::vec3 from, glm::vec3 direction,
                          bake::PathOptions options, std::uint32_t samples) {
    return look(fixture.space(options), from, direction, samples);
}

// The blobs and balls of the table as grids; what voxels of a 16th or 32nd leave is below the
// noise.
inline std::vector<TransportRow> read_volume_transport(const std::string& group) {
    std::vector<TransportRow> rows = read_transport_rows(group);
    std::erase_if(
        rows, [](const TransportRow& r) { return r.geometry != "blob" && r.geometry != "sphere"; });
    return rows;
}

inline std::unique_ptr<ReferenceFixture> make_row_fixture(const TransportRow& row,
                                                          formats::Environment sky) {
    auto grid = row.geometry == "blob" ? make_blob(row.size, row.size / 16)
                                       : make_ball_grid(row.size, row.size / 32);
    return make_volume_fixture({make_volume(std::move(grid), row.sigma_t, row.albedo, row.g)},
                               std::move(sky));
}

inline bake::Moments march_grid(const ReferenceFixture& fixture, const TransportRow& row,
                                bake::PathOptions options, std::uint32_t samples) {
    // From outside: the grid is not cut as sharply as the ball.
    return look(fixture, row.start - row.size * row.march, row.march, options, samples);
}

}  // namespace opaline::tests
