#include "bake/physics/mie/droplets.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

namespace opaline::bake {
namespace {

constexpr double kWaterDensity = 1000;  // [kg/m^3]
constexpr double kFloor = 0.05;         // of the density of nodes where no cross-section lies
constexpr std::size_t kTableSteps = 4096;

/// n(r) r_n / N0 at r = t r_n.
double relative_density(double gamma, double t) {
    return std::exp((gamma - 1) * std::log(t) - t - std::lgamma(gamma));
}

/// Density of nodes over t = r / r_n: that of the cross-section, t^2 n, by its maximum, and kFloor.
struct NodeDensity {
    double least = 0, most = 0;      // of t
    std::vector<double> cumulative;  // int of the density from `least` to kTableSteps + 1 places

    double step() const { return (most - least) / static_cast<double>(kTableSteps); }
    double total() const { return cumulative.back(); }
};

NodeDensity make_node_density(double gamma) {
    const double spread = 8 * std::sqrt(gamma + 4), top = std::log(gamma + 1);
    NodeDensity density{std::max(0.0, gamma - spread), gamma + 12 + spread, {0}};
    for (std::size_t i = 0; i < kTableSteps; ++i) {
        const double t = density.least + (static_cast<double>(i) + 0.5) * density.step();
        // t^(gamma + 1) e^-t has its maximum at gamma + 1.
        const double weight = std::exp((gamma + 1) * (std::log(t) - top) - t + gamma + 1);
        density.cumulative.push_back(density.total() + density.step() * (weight + kFloor));
    }
    return density;
}

}  // namespace

formats::Status check_droplets(const DropletDistribution& droplets) {
    const auto refuse = [](const char* name, double value, const char* range) {
        return formats::make_error(formats::ErrorKind::usage, "", name,
                                   number_text(value) + " is out of range", range);
    };
    if (!(droplets.density > 0 && std::isfinite(droplets.density))) {
        return refuse("density", droplets.density, "give droplets per cubic metre, above 0");
    }
    if (!(droplets.effective_radius > 0 && std::isfinite(droplets.effective_radius))) {
        return refuse("effective radius", droplets.effective_radius, "give a length above 0");
    }
    if (!(droplets.gamma >= kMinGamma && droplets.gamma <= kMaxGamma)) {
        return refuse("gamma", droplets.gamma, "give a number from 0.1 to 10000");
    }
    return formats::ok_status();
}

double characteristic_radius(const DropletDistribution& droplets) {
    return droplets.effective_radius / (droplets.gamma + 2);
}

double mean_geometric_section(const DropletDistribution& droplets) {
    const double r_n = characteristic_radius(droplets);
    return std::numbers::pi * droplets.gamma * (droplets.gamma + 1) * r_n * r_n;
}

double printed_extinction(const DropletDistribution& droplets) {
    const double r_e = droplets.effective_radius;
    return droplets.density * std::numbers::pi * r_e * r_e;
}

double liquid_water_content(const DropletDistribution& droplets) {
    // <r^3> = r_e <r^2>
    return 4.0 / 3 * kWaterDensity * droplets.density * droplets.effective_radius *
           mean_geometric_section(droplets);
}

double relative_width(const DropletDistribution& droplets) {
    return 1 / std::sqrt(droplets.gamma + 4);
}

RadiusRange radius_range(const DropletDistribution& droplets) {
    const double r_n = characteristic_radius(droplets);
    const NodeDensity density = make_node_density(droplets.gamma);
    return {r_n * density.least, r_n * density.most, r_n * density.total()};
}

std::vector<RadiusNode> place_radii(const DropletDistribution& droplets, unsigned count) {
    assert(count >= 2 && count % 2 == 0);
    const double r_n = characteristic_radius(droplets);
    const NodeDensity density = make_node_density(droplets.gamma);
    std::vector<RadiusNode> nodes;
    nodes.reserve(count);
    std::size_t at = 0;
    // The place of a share of the total, linear between the table's places.
    const auto place = [&](double share) {
        const double wanted = share * density.total();
        while (at + 1 < kTableSteps && density.cumulative[at + 1] < wanted) {
            ++at;
        }
        const double part = (wanted - density.cumulative[at]) /
                            (density.cumulative[at + 1] - density.cumulative[at]);
        return density.least + (static_cast<double>(at) + part) * density.step();
    };
    double from = density.least;
    for (unsigned i = 0; i < count; ++i) {
        const double to = i + 1 == count ? density.most : place((i + 1.0) / count);
        const double t = (from + to) / 2;
        nodes.push_back({r_n * t, (to - from) * relative_density(droplets.gamma, t)});
        from = to;
    }
    return nodes;
}

}  // namespace opaline::bake
