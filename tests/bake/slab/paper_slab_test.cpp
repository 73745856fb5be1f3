// The layer of [Bouthors2006], whose phase function comes from Mie theory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>

#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/mie/refractive_index.h"
#include "bake/physics/slab/column_model.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/radiance_table.h"
#include "bake/physics/slab/solve_radiance.h"
#include "tests/bake/slab/slab_support.h"
#include "tests/support/cloud_table.h"

namespace opaline::tests {
namespace {

using bake::SlabMedium;
using bake::SlabSolution;

struct PaperCloud {
    bake::DropletOptics optics;
    bake::PeakSplit split;
    SlabMedium full, modified;
};

/// At 550 nm, with the peak cut at 5 degrees.
const PaperCloud& paper_cloud() {
    static const PaperCloud cloud = [] {
        constexpr double kWavelength = 550e-9;
        PaperCloud c;
        const bake::DropletDistribution droplets{
            .density = 3e8, .effective_radius = 7e-6, .gamma = 2};
        c.optics = bake::average_droplets(
                       droplets, kWavelength,
                       bake::refractive_index(bake::Substance::water, kWavelength).value(), {}, {})
                       .value();
        c.split = bake::split_peak(c.optics.phase, 5 * std::numbers::pi / 180);
        c.full = {bake::table_moments(c.optics.phase, 400), 1};
        c.modified = {bake::table_moments(c.split.rest, 400), 1};
        return c;
    }();
    return cloud;
}

/// Orders 0 to 2 and all of a slab, solved once for every case of the table.
const SlabSolution& solved(const CloudRow& row) {
    static std::map<std::tuple<std::string, double, double>, SlabSolution> known;
    const double depth = row.number("kappa_per_m") * row.number("H_m");
    const std::tuple key(row.text("case"), depth, row.number("theta_l_deg"));
    const auto found = known.find(key);
    if (found != known.end()) return found->second;
    const bool modified = row.text("case") == "modified";
    return known[key] = solve_one(modified ? paper_cloud().modified : paper_cloud().full, depth,
                                  cosine_of_degrees(row.number("theta_l_deg")), modified ? 3 : 0,
                                  modified ? 32 : 48);
}

double share_of(const SlabSolution& slab, const std::string& quantity, const std::string& order) {
    const auto side = [&](const bake::SlabFluxes& f) {
        return quantity == "R" ? f.reflectance[0] : f.transmittance[0];
    };
    if (order == "total") return side(slab.total);
    if (order == "3+") {
        return side(slab.total) - side(slab.order[0]) - side(slab.order[1]) - side(slab.order[2]);
    }
    return side(slab.order.at(std::stoul(order)));
}

TEST(CloudTable, EveryRowIsOfAKindThatATestReads) {
    OPALINE_NEEDS_REFERENCE("clouds.csv");
    const std::set<std::string> read{"mie",         "dsd",     "phase", "forward_peak", "slab",
                                     "slab_medium", "slab_hg", "fit",   "appendixB"};
    for (const auto& cell : read_named_table(reference_folder() / "clouds.csv")) {
        EXPECT_TRUE(read.contains(cell.at("kind"))) << CloudRow{cell}.name();
    }
}

TEST(PaperSlab, MediumWithoutItsPeakIsThatOfTheTable) {
    OPALINE_CLOUD_ROWS(rows, "slab_medium");
    for (const CloudRow& row : rows) {
        const std::string& quantity = row.text("quantity");
        if (quantity == "kappa_S_per_m") {
            // As the paper has it: 51 % of pi r_e^2 N0 in the peak.
            EXPECT_NEAR(0.49 * 3e8 * std::numbers::pi * 49e-12, row.value(), 1e-9);
        } else {
            const double value = quantity == "g_S" ? paper_cloud().modified.moment[1]
                                                   : 1 - paper_cloud().split.weight;
            EXPECT_NEAR(value, row.value(), row.error()) << row.name();
        }
    }
}

TEST(PaperSlab, SharesByOrderAreThoseOfTheTable) {
    OPALINE_CLOUD_ROWS(rows, "slab");
    Deviations photons;
    for (const CloudRow& row : rows) {
        const double share = share_of(solved(row), row.text("quantity"), row.text("order"));
        if (row.text("method") != "monte_carlo_1sigma") {
            EXPECT_NEAR(share, row.value(), row.error()) << row.name();
        } else if (row.error() > 0) {
            photons.add(share, row.error(), row.value());
        } else {  // no photon of many thousands left so, or all did
            EXPECT_NEAR(share, row.value(), 1e-4) << row.name();
        }
    }
    if (photons.count > 0) {
        photons.expect_normal(1);
    }
}

TEST(PaperSlab, PeakCountedAsExtinctionChangesTheFluxByLessThan16In10000) {
    const PaperCloud& cloud = paper_cloud();
    for (const double metres : {10.0, 100.0, 300.0}) {
        for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
            const double kappa = 0.0368 * metres;
            const double whole =
                solve_one(cloud.full, kappa, cosine_of_degrees(degrees)).total.reflectance[0];
            const double cut = solve_one(cloud.modified, kappa * (1 - cloud.split.weight),
                                         cosine_of_degrees(degrees), 0, 32)
                                   .total.reflectance[0];
            EXPECT_NEAR(cut, whole, degrees > 70 ? 1.6e-3 : 5e-4) << metres << " " << degrees;
        }
    }
}

// What a renderer has: single scattering by the phase function, and the table for the rest.
TEST(PaperSlab, TablesGiveTheRadianceWithinOnePercentRms) {
    const SlabMedium& medium = paper_cloud().modified;
    const bake::RadianceTable table = make_radiance_table(medium);
    const std::vector<double> degrees = {0, 30, 60, 80};
    bake::SlabRadianceRequest request{0, 0, {}, {}, 48, 32, 2};
    for (const double angle : degrees) {
        request.lights.push_back(cosine_of_degrees(angle));
    }
    const bake::GaussLegendre rule = bake::make_gauss_legendre(10);
    request.view = rule.node;
    for (const double depth : {0.13, 0.61, 2.3, 7.7}) {
        request.optical_depth = depth;
        const auto slab = solve_slab_radiance(medium, request).front();
        for (std::size_t l = 0; l < degrees.size(); ++l) {
            for (const bool below : {false, true}) {
                const double light = request.lights[l];
                double error = 0, size = 0;
                for (std::size_t v = 0; v < rule.node.size(); ++v) {
                    for (int a = 0; a < 24; ++a) {
                        const double view = rule.node[v],
                                     azimuth = std::numbers::pi * (a + 0.5) / 24;
                        const double sines = std::sqrt((1 - light * light) * (1 - view * view));
                        const double cosine =
                            (below ? 1 : -1) * light * view + sines * std::cos(azimuth);
                        const double once = eval_table(paper_cloud().split.rest,
                                                       std::acos(std::clamp(cosine, -1.0, 1.0))) *
                                            (below ? bake::transmitted_once : bake::reflected_once)(
                                                depth, light, view);
                        const double more =
                            light / std::numbers::pi *
                            eval_slab_radiance(slab, below ? slab.transmitted : slab.reflected, v,
                                               l, azimuth);
                        const double off =
                            eval_radiance_table(table, depth, light, view, azimuth, below) - more;
                        error += rule.weight[v] * off * off;
                        size += rule.weight[v] * (once + more) * (once + more);
                    }
                }
                EXPECT_LT(std::sqrt(error / size), 0.01)
                    << depth << " " << degrees[l] << " " << below;
            }
        }
    }
}

TEST(PaperSlab, FittedParametersAreThoseOfTheTable) {
    OPALINE_CLOUD_ROWS(rows, "fit");
    std::vector<double> degrees;
    for (const CloudRow& row : rows) {
        const double angle = row.number_or("theta_l_deg", 0);
        if (std::find(degrees.begin(), degrees.end(), angle) == degrees.end()) {
            degrees.push_back(angle);
        }
    }
    std::vector<double> cosines;
    for (const double angle : degrees) {
        cosines.push_back(cosine_of_degrees(angle));
    }
    const auto fits =
        fit_column_models(paper_cloud().modified, cosines, bake::column_fit_depths(), 24);
    for (const CloudRow& row : rows) {
        const auto at = std::find(degrees.begin(), degrees.end(), row.number_or("theta_l_deg", 0));
        const bake::ColumnFit& fit = fits[static_cast<std::size_t>(at - degrees.begin())];
        const std::map<std::string, double> value = {
            {"L_m", fit.model.length / row.number_or("kappa_per_m", 1)},
            {"beta", fit.model.beta},
            {"c_over_kappaS", fit.model.decay},
            {"kappac_over_kappaS", fit.model.extinction},
            {"t", fit.model.forward},
            {"r", fit.model.back},
            {"rms_Tms", fit.rms_transmittance},
            {"max_Tms", fit.max_transmittance},
            {"rms_orders12", fit.rms_orders},
            {"max_orders12", fit.max_orders}};
        const std::string& quantity = row.text("quantity");
        ASSERT_TRUE(value.contains(quantity)) << row.name();
        // Parameters follow the depths that were chosen, most where one more exponential hardly
        // matters; the errors of the fit follow them more.
        const bool is_error = quantity.starts_with("rms") || quantity.starts_with("max");
        EXPECT_NEAR(value.at(quantity), row.value(),
                    is_error ? 0.1 * row.value() + 2e-4 : 0.02 * row.value())
            << row.name();
    }
}

}  // namespace
}  // namespace opaline::tests
