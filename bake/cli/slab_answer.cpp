#include "bake/cli/slab_answer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "bake/cli/machine_limits.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/progress.h"
#include "bake/cli/slab_views.h"
#include "bake/physics/phase_series.h"
#include "bake/physics/slab/column_model.h"
#include "bake/physics/slab/radiance_table.h"
#include "bake/physics/slab/slab_walk.h"
#include "bake/physics/slab/solve_slab.h"
#include "formats/media/read_phase_table.h"

namespace opaline::cli {
namespace {

using Json = nlohmann::ordered_json;

/// The phase function in both forms that the methods ask for.
struct SlabPhase {
    bake::CosineSampler sampler;
    bake::SlabMedium medium;
    bake::AngularTable table;  ///< for views
};

SlabPhase make_slab_phase(const SlabQuestion& options) {
    // For twice the streams, and the peak that those leave.
    const unsigned moments = 4 * options.streams + 1;
    if (options.phase.empty()) {
        return SlabPhase{
            bake::CosineSampler::henyey_greenstein(options.g),
            {bake::expand_henyey_greenstein(options.g, moments).lambda, options.albedo},
            henyey_greenstein_table(options.g)};
    }
    const auto table = require(formats::read_phase_table(options.phase));
    const std::vector<double> cosine(table.cosine.begin(), table.cosine.end());
    const std::vector<double> value(table.value.begin(), table.value.end());
    bake::SlabMedium medium{{1.0}, options.albedo};
    if (options.method != SlabMethod::monte_carlo) {
        medium.moment = bake::expand_phase(table, moments).lambda;
    }
    return SlabPhase{bake::CosineSampler::tabulated(cosine, value), std::move(medium),
                     angular_table(table)};
}

std::string order_name(std::size_t order, bool is_rest) {
    return std::to_string(order) + (is_rest ? "+" : "");
}

Json describe_shares(double reflectance, double transmittance) {
    return {{"reflectance", reflectance},
            {"transmittance", transmittance},
            {"absorptance", std::max(0.0, 1 - reflectance - transmittance)}};
}

Json order_json(const std::string& name, double reflected, double transmitted) {
    return {{"order", name}, {"reflectance", reflected}, {"transmittance", transmitted}};
}

Json solve_by_adding(const SlabQuestion& options, const bake::SlabMedium& medium) {
    const auto solve = [&](unsigned streams, unsigned orders) {
        return bake::solve_slab(medium, {options.optical_depth,
                                         0,
                                         {options.cosine},
                                         static_cast<int>(streams),
                                         orders,
                                         options.eta})
            .front();
    };
    const bake::SlabSolution slab = solve(options.streams, options.orders);
    const bake::SlabFluxes finer = solve(2 * options.streams, 0).total;
    const double r = slab.total.reflectance[0], t = slab.total.transmittance[0];
    Json all = describe_shares(r, t);
    all["mean_reflectance"] = slab.total.mean_reflectance;
    all["mean_transmittance"] = slab.total.mean_transmittance;
    all["numerical_error"] =
        std::max(std::abs(r - finer.reflectance[0]), std::abs(t - finer.transmittance[0]));
    double reflected = r, transmitted = t;
    for (std::size_t n = 0; n < slab.order.size(); ++n) {
        const bake::SlabFluxes& order = slab.order[n];
        all["by_order"].push_back(
            order_json(order_name(n, false), order.reflectance[0], order.transmittance[0]));
        reflected -= order.reflectance[0];
        transmitted -= order.transmittance[0];
    }
    all["by_order"].push_back(
        order_json(order_name(slab.order.size(), true), reflected, transmitted));
    return all;
}

Json solve_by_photons(const SlabQuestion& options, const bake::CosineSampler& phase) {
    require(check_threads(options.threads));
    bake::Context context;
    context.threads = options.threads;
    context.cancel = &catch_interrupts();
    const bake::SlabWalk walk =
        walk_slab(phase,
                  {options.optical_depth, options.albedo, options.cosine, options.photons,
                   options.seed, options.orders + 1, 0, 0, 0, options.eta},
                  context);
    if (walk.photons < options.photons) {
        refuse(formats::make_error(formats::ErrorKind::interrupted, "", "", "interrupted",
                                   "nothing was printed"));
    }
    Json all;
    const auto add = [](Json& to, const char* name, const bake::SlabEstimate& estimate) {
        to[name] = estimate.share;
        to[std::string(name) + "_standard_error"] = estimate.standard_error;
    };
    add(all, "reflectance", walk.reflectance);
    add(all, "transmittance", walk.transmittance);
    add(all, "absorptance", walk.absorptance);
    for (std::size_t n = 0; n <= options.orders; ++n) {
        Json order = {{"order", order_name(n, n == options.orders)}};
        add(order, "reflectance", walk.reflected_order[n]);
        add(order, "transmittance", walk.transmitted_order[n]);
        all["by_order"].push_back(order);
    }
    return all;
}

// Orders 0, 1, 2 and the rest.
Json describe_orders(const bake::OrderShares& shares) {
    double reflected = 0, transmitted = 0;
    Json by_order;
    for (std::size_t n = 0; n < 4; ++n) {
        reflected += shares.reflected[n];
        transmitted += shares.transmitted[n];
        by_order.push_back(
            order_json(order_name(n, n == 3), shares.reflected[n], shares.transmitted[n]));
    }
    Json all = describe_shares(reflected, transmitted);
    all["by_order"] = by_order;
    return all;
}

SlabViews views_of(const SlabQuestion& options, const SlabPhase& phase) {
    return {options.optical_depth, options.cosine, phase.medium, phase.table, options.views};
}

Json solve_by_table(const SlabQuestion& options, const SlabPhase& phase) {
    Json all = describe_orders(bake::eval_slab_table(bake::make_slab_table(phase.medium),
                                                     options.optical_depth, options.cosine));
    if (options.views > 0) {
        all["views"] =
            table_views(views_of(options, phase), bake::make_radiance_table(phase.medium));
    }
    return all;
}

Json solve_by_model(const SlabQuestion& options, const SlabPhase& phase) {
    const bake::SlabMedium& medium = phase.medium;
    const bake::ColumnFit fit =
        bake::fit_column_models(medium, {&options.cosine, 1}, bake::column_fit_depths(),
                                static_cast<int>(options.streams))
            .front();
    const bake::OrderShares shares = bake::eval_column_model(
        fit.model, options.optical_depth, std::exp(-options.optical_depth / options.cosine));
    Json all = describe_orders(shares);
    if (options.views > 0) {
        all["views"] = model_views(views_of(options, phase), shares);
    }
    all["model"] = {{"length", fit.model.length}, {"beta", fit.model.beta},
                    {"c", fit.model.decay},       {"kappa_c", fit.model.extinction},
                    {"t", fit.model.forward},     {"r", fit.model.back}};
    all["fit_error"] = {{"rms_transmittance", fit.rms_transmittance},
                        {"max_transmittance", fit.max_transmittance},
                        {"rms_orders", fit.rms_orders},
                        {"max_orders", fit.max_orders}};
    return all;
}

}  // namespace

Json answer_slab(const SlabQuestion& options) {
    const auto phase = make_slab_phase(options);
    switch (options.method) {
        case SlabMethod::monte_carlo:
            return solve_by_photons(options, phase.sampler);
        case SlabMethod::model:
            return solve_by_model(options, phase);
        case SlabMethod::table:
            return solve_by_table(options, phase);
        case SlabMethod::adding:
            break;
    }
    Json all = solve_by_adding(options, phase.medium);
    if (options.views > 0) {
        all["views"] = solver_views(views_of(options, phase), options.streams);
    }
    return all;
}

}  // namespace opaline::cli
