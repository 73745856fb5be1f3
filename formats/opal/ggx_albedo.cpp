#include "formats/opal/ggx_albedo.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace opaline::formats {
namespace {

// Smith's Lambda for the cosine to the macroscopic normal.
double smith_lambda(double cosine, double alpha) {
    const double tan_squared = (1 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1 + alpha * alpha * tan_squared) - 1);
}

}  // namespace

GgxAlbedo integrate_ggx_albedo(double cosine, double alpha, int steps) {
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    const double lambda_v = smith_lambda(cosine, alpha);
    // The view, stretched to where the facets are a hemisphere.
    const double stretch = std::hypot(alpha * sine, cosine);
    const double vx = alpha * sine / stretch, vz = cosine / stretch;
    double of_f0 = 0, of_f90 = 0;
    const int turns = std::max(steps / 4, 4);
    std::vector<double> cosines(
        static_cast<std::size_t>(turns));  // half a turn: mirrored by the other
    for (int j = 0; j < turns; ++j) {
        cosines[static_cast<std::size_t>(j)] = std::cos(std::numbers::pi * (j + 0.5) / turns);
    }
    for (int i = 0; i < steps; ++i) {
        // Height on a spherical cap, uniform in area; finer steps (weight 2 s) toward its rim,
        // where few but steep facets reflect below the horizon.
        const double s = 1 - (i + 0.5) / steps;
        const double z = s * s * (1 + vz) - vz;
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        for (const double cos_phi : cosines) {
            double hx = alpha * (r * cos_phi + vx), hz = z + vz;
            const double hy = alpha * r * std::sqrt(1 - cos_phi * cos_phi);
            const double norm = std::sqrt(hx * hx + hy * hy + hz * hz);
            hx /= norm, hz /= norm;
            const double v_h = sine * hx + cosine * hz;
            const double l_z = 2 * v_h * hz - cosine;
            if (!(l_z > 0)) continue;
            // Height-correlated G2 over G1 of the view.
            const double weight =
                2 * s * (1 + lambda_v) / (1 + lambda_v + smith_lambda(l_z, alpha));
            const double missing = 1 - std::min(v_h, 1.0), squared = missing * missing;
            const double fresnel = squared * squared * missing;
            of_f0 += weight * (1 - fresnel);
            of_f90 += weight * fresnel;
        }
    }
    const double share = 1.0 / (static_cast<double>(steps) * turns);
    return {static_cast<float>(share * of_f0), static_cast<float>(share * of_f90)};
}

std::span<const GgxAlbedo> ggx_albedo_table() {
    static const std::vector<GgxAlbedo> kTable = [] {
        constexpr int kSteps = 64;
        std::vector<GgxAlbedo> table;
        table.reserve(std::size_t{kAlbedoRows} * kAlbedoColumns);
        for (std::uint32_t row = 0; row < kAlbedoRows; ++row) {
            const auto roughness = static_cast<float>(row) / (kAlbedoRows - 1);
            for (std::uint32_t column = 0; column < kAlbedoColumns; ++column) {
                const double root = static_cast<double>(column) / (kAlbedoColumns - 1);
                table.push_back(integrate_ggx_albedo(std::max(root * root, 1e-5),
                                                     static_cast<double>(ggx_alpha(roughness)),
                                                     kSteps));
            }
        }
        return table;
    }();
    return kTable;
}

GgxAlbedo ggx_albedo(float cosine, float roughness) {
    const std::span<const GgxAlbedo> table = ggx_albedo_table();
    const auto position = [](float x, std::uint32_t size) {
        return std::clamp(x, 0.0f, 1.0f) * static_cast<float>(size - 1);
    };
    const float x = position(std::sqrt(std::max(cosine, 0.0f)), kAlbedoColumns);
    const float y = position(roughness, kAlbedoRows);
    const auto column = std::min(static_cast<std::uint32_t>(x), kAlbedoColumns - 2);
    const auto row = std::min(static_cast<std::uint32_t>(y), kAlbedoRows - 2);
    const float s = x - static_cast<float>(column), t = y - static_cast<float>(row);
    const GgxAlbedo* const at = &table[std::size_t{row} * kAlbedoColumns + column];
    const auto mix = [&](float GgxAlbedo::*part) {
        const float upper = (1 - s) * at[0].*part + s * at[1].*part;
        const float lower = (1 - s) * at[kAlbedoColumns].*part + s * at[kAlbedoColumns + 1].*part;
        return (1 - t) * upper + t * lower;
    };
    return {mix(&GgxAlbedo::of_f0), mix(&GgxAlbedo::of_f90)};
}

}  // namespace opaline::formats
