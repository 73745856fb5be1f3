#include "bake/cli/slab_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/solve_radiance.h"

namespace opaline::cli {
namespace {

using std::numbers::pi;
using Json = nlohmann::ordered_json;

/// One view, from one side.
struct SlabSide {
    double cosine = 1, azimuth = 0;
    std::size_t index = 0;  ///< of the view
    bool transmitted = false;
};

double turned_by(const SlabViews& slab, const SlabSide& side) {
    const double light = std::acos(slab.cosine);
    const double view = (side.azimuth > 0 ? -1 : 1) * std::acos(side.cosine);
    return side.transmitted ? std::abs(light - view) : pi - std::abs(light + view);
}

double scattered_once(const SlabViews& slab, const SlabSide& side) {
    const double factor = (side.transmitted ? bake::transmitted_once : bake::reflected_once)(
        slab.optical_depth, slab.cosine, side.cosine);
    return slab.medium.albedo * pi / slab.cosine * factor *
           bake::eval_table(slab.phase, turned_by(slab, side));
}

std::vector<double> view_degrees(const SlabViews& slab) {
    std::vector<double> degrees;
    for (unsigned i = 0; i < slab.count; ++i) {
        degrees.push_back(-90 + 180 * (i + 0.5) / slab.count);
    }
    return degrees;
}

// `later`: radiances by name of the orders after the first.
template <class Later>
Json list_views(const SlabViews& slab, Later later) {
    Json views = Json::array();
    const std::vector<double> degrees = view_degrees(slab);
    for (std::size_t i = 0; i < degrees.size(); ++i) {
        Json view{{"degrees", degrees[i]}};
        for (const bool transmitted : {false, true}) {
            const SlabSide side{std::cos(degrees[i] * pi / 180), degrees[i] < 0 ? pi : 0, i,
                                transmitted};
            double all = scattered_once(slab, side);
            Json orders = Json::array();
            orders.push_back({{"order", "1"}, {"radiance", all}});
            for (const auto& [name, radiance] : later(side)) {
                orders.push_back({{"order", name}, {"radiance", radiance}});
                all += radiance;
            }
            orders.push_back({{"order", "all"}, {"radiance", all}});
            view[transmitted ? "transmitted" : "reflected"] = orders;
        }
        views.push_back(view);
    }
    return views;
}

using NamedRadiances = std::vector<std::pair<std::string, double>>;

}  // namespace

Json solver_views(const SlabViews& slab, unsigned streams) {
    bake::SlabRadianceRequest request;
    request.optical_depth = slab.optical_depth;
    request.lights = {slab.cosine};
    for (const double degrees : view_degrees(slab)) {
        request.view.push_back(std::cos(degrees * pi / 180));
    }
    constexpr unsigned kMostModes = 32;
    request.streams = static_cast<int>(streams);
    request.modes = std::min(kMostModes, 2 * streams);
    request.first_order = 2;
    const auto often = bake::solve_slab_radiance(slab.medium, request).front();
    request.first_order = 3;
    const auto rest = bake::solve_slab_radiance(slab.medium, request).front();
    return list_views(slab, [&](const SlabSide& side) {
        const auto from = [&](const bake::SlabRadiance& radiance) {
            return bake::eval_slab_radiance(
                radiance, side.transmitted ? radiance.transmitted : radiance.reflected, side.index,
                0, side.azimuth);
        };
        const double later = from(rest);
        return NamedRadiances{{"2", from(often) - later}, {"3+", later}};
    });
}

Json model_views(const SlabViews& slab, const bake::OrderShares& shares) {
    const auto twice =
        bake::convolve_with_itself(slab.phase, bake::kConvolutionMoments, slab.phase.angle).table;
    return list_views(slab, [&](const SlabSide& side) {
        const double factor = (side.transmitted ? bake::transmitted_twice : bake::reflected_twice)(
            slab.optical_depth, slab.cosine, side.cosine);
        const double depth = side.transmitted ? slab.optical_depth / 2
                                              : (1 - slab.medium.moment[1]) * slab.optical_depth;
        const double rest = side.transmitted ? shares.transmitted[3] : shares.reflected[3];
        return NamedRadiances{
            {"2", pi / slab.cosine * factor * bake::eval_table(twice, turned_by(slab, side))},
            {"3+", rest * bake::spread_profile(depth, side.cosine)}};
    });
}

Json table_views(const SlabViews& slab, const bake::RadianceTable& table) {
    return list_views(slab, [&](const SlabSide& side) {
        return NamedRadiances{
            {"2+", pi / slab.cosine *
                       bake::eval_radiance_table(table, slab.optical_depth, slab.cosine,
                                                 side.cosine, side.azimuth, side.transmitted)}};
    });
}

bake::AngularTable angular_table(const formats::PhaseFunction& table) {
    bake::AngularTable phase;
    for (std::size_t i = table.cosine.size(); i-- > 0;) {
        phase.angle.push_back(
            std::acos(std::clamp(static_cast<double>(table.cosine[i]), -1.0, 1.0)));
        phase.value.push_back(static_cast<double>(table.value[i]));
    }
    bake::scale_table(phase, 1 / bake::integrate_table(phase));
    return phase;
}

bake::AngularTable henyey_greenstein_table(double g) {
    constexpr int kRows = 4000;
    bake::AngularTable phase;
    for (int i = 0; i <= kRows; ++i) {
        const double s = static_cast<double>(i) / kRows;
        const double angle = pi * s * s * (3 - 2 * s), half = std::sin(angle / 2);
        phase.angle.push_back(angle);
        // 1 + g^2 - 2 g cos, without cancellation.
        phase.value.push_back(std::pow((1 - g) * (1 - g) + 4 * g * half * half, -1.5));
    }
    bake::scale_table(phase, 1 / bake::integrate_table(phase));
    return phase;
}

}  // namespace opaline::cli
