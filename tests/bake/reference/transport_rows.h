#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/bake/reference/reference_support.h"
#include "tests/support/volume_table.h"

namespace opaline::tests {

/// A row of the table of volumes about light that leaves a body or a volume. In the table z is up,
/// here y.
struct TransportRow {
    std::string id, group, quantity, geometry, method;
    float g = 0, albedo = 0, sigma_t = 0, size = 0;
    glm::vec3 start{0}, march{0}, light{0};
    double value = 0, error = 0;

    std::string name() const { return id + " " + geometry + " " + group + " " + quantity; }
};

/// All rows of a group.
inline std::vector<TransportRow> read_transport_rows(const std::string& group) {
    std::vector<TransportRow> rows;
    for (const VolumeRow& r : read_volume_table()) {
        if (r.cell.at("group") != group) continue;
        const auto number = [&](const char* column) {
            return static_cast<float>(r.number_or_zero(column));
        };
        TransportRow row;
        row.id = r.id(), row.group = group, row.quantity = r.cell.at("quantity");
        row.geometry = r.cell.at("geometry"), row.method = r.cell.at("method");
        row.g = number("g"), row.albedo = number("albedo"), row.sigma_t = number("sigma_t");
        row.size = number("size");
        row.start = {number("px"), number("pz"), -number("py")};
        row.march = {number("vx"), number("vz"), -number("vy")};
        row.light = {number("lx"), number("lz"), -number("ly")};
        row.value = r.value();
        row.error = r.number_or_zero("stderr");
        rows.push_back(row);
    }
    return rows;
}

/// The cosine to a direction where it is positive, else 0.
inline formats::Environment make_cosine_sky(glm::vec3 direction) {
    formats::Environment sky;
    sky.width = 256;
    sky.height = 128;
    for (std::uint32_t row = 0; row < sky.height; ++row) {
        for (std::uint32_t column = 0; column < sky.width; ++column) {
            const double polar = std::numbers::pi * (row + 0.5) / sky.height;
            const double turn = 2 * std::numbers::pi * ((column + 0.5) / sky.width - 0.5);
            const glm::dvec3 d(std::sin(polar) * std::cos(turn), std::cos(polar),
                               std::sin(polar) * std::sin(turn));
            const auto c = static_cast<float>(std::max(0.0, glm::dot(d, glm::dvec3(direction))));
            sky.pixel.push_back({c, c, c});
        }
    }
    return sky;
}

/// A disc of light, small against everything, with irradiance 1 facing it.
inline formats::Environment make_distant_light(glm::vec3 direction) {
    formats::DistantDisc disc;
    disc.direction = {direction.x, direction.y, direction.z};
    disc.angular_radius = 1e-3f;
    const auto radiance = static_cast<float>(1 / formats::disc_solid_angle(disc.angular_radius));
    disc.radiance = {radiance, radiance, radiance};
    formats::Environment sky;
    sky.discs.push_back(disc);
    return sky;
}

// By chance one row in 370 is more than 3 standard errors off. For n rows the limit is such that
// one table in 370 exceeds it (Sidak).
inline double limit_for(std::size_t rows) {
    const double one = 1 - std::pow(1 - 1 / 370.0, 1.0 / static_cast<double>(rows));
    double low = 3, high = 8;  // by bisection of erfc
    while (high - low > 1e-6) {
        const double middle = 0.5 * (low + high);
        (std::erfc(middle / std::numbers::sqrt2) > one ? low : high) = middle;
    }
    return low;
}

inline void expect_within(const TransportRow& row, const bake::Moments& m, double limit) {
    const double error = std::hypot(standard_error(m), row.error);
    EXPECT_LT(std::abs(m.mean.x - row.value), limit * error + 2e-6 * row.value)
        << row.name() << " g " << row.g << " albedo " << row.albedo << " sigma_t " << row.sigma_t
        << ": " << m.mean.x << " +- " << error << ", expected " << row.value;
    EXPECT_LT(error, std::max(0.004, 0.03 * row.value)) << row.name() << ": the test says little";
}

/// Weights that leave a slab or volume under a beam, by reciprocity: radiance along the beam under
/// light that is 1 ahead, 1 behind, or the cosine to the beam. `see`: under a sky, what was
/// scattered at most so often.
template <class See>
void expect_escape(const TransportRow& row, double limit, std::uint32_t samples, See&& see) {
    constexpr std::uint32_t kAll = 0xffffffffu;
    if (row.quantity == "exit_unscattered") {
        // The only randomness is whether a path passes: rarely, where that is unlikely.
        const bake::Moments m = see(make_white_sky(), 0);
        EXPECT_NEAR(m.mean.x, row.value, 4 * std::sqrt(row.value / samples) + 2e-6) << row.name();
        return;
    }
    bake::Moments m;
    if (row.quantity == "exit_mean_cos") {
        m = see(make_cosine_sky(row.march), kAll);
        const bake::Moments back = see(make_cosine_sky(-row.march), kAll);
        m.mean -= back.mean;
        m.squares += back.squares;  // of as many samples
    } else {
        m = see(make_half_sky((row.quantity == "exit_forward") == (row.march.y > 0)), kAll);
    }
    expect_within(row, m, limit);
}

}  // namespace opaline::tests
