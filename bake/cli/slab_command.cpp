#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/cli/command.h"
#include "bake/cli/interrupt.h"
#include "bake/cli/json_output.h"
#include "bake/cli/memory_limit.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/scattering/phase_series.h"
#include "bake/slab/fit_column_model.h"
#include "bake/slab/slab_walk.h"
#include "bake/slab/solve_slab.h"
#include "formats/media/limits.h"
#include "formats/media/read_phase_table.h"

namespace opaline::cli {
namespace {

using Json = nlohmann::ordered_json;

enum class SlabMethod { adding, monte_carlo, model };

struct SlabCommand {
    double optical_depth = 0, albedo = 1, g = 0, cosine = 1, eta = 1;
    std::string phase;
    SlabMethod method = SlabMethod::adding;
    unsigned orders = 8, streams = 48, threads = 0;
    std::uint64_t photons = 1000000, seed = 0;
    TextFormat format = TextFormat::json;
    CLI::Option *g_option = nullptr, *phase_option = nullptr, *orders_option = nullptr,
                *streams_option = nullptr;
    std::vector<CLI::Option*> walk_options;
};

/// Photons in a layer without absorption scatter about as often as the layer is thick, and long
/// before they cross it by chance as often as the square of that.
constexpr double kMostWalkDepth = 1e3;
constexpr unsigned kMostStreams = 128, kMostOrders = 64;

formats::Error refuse_slab_option(const std::string& option, std::string fault,
                                  std::string remedy) {
    return formats::make_error(formats::ErrorKind::usage, "", option, std::move(fault),
                               std::move(remedy));
}

formats::Status check_slab_options(const SlabCommand& options) {
    const bool by_g = options.g_option->count() > 0, by_table = options.phase_option->count() > 0;
    if (by_g == by_table) {
        return refuse_slab_option("slab", by_g ? "two phase functions" : "no phase function",
                                  "give --g or --phase, one of them");
    }
    if (options.method != SlabMethod::monte_carlo) {
        for (const CLI::Option* option : options.walk_options) {
            if (option->count() > 0) {
                return refuse_slab_option(option->get_name(), "this method draws no photons",
                                          "give it with --method monte-carlo alone");
            }
        }
    } else if (options.streams_option->count() > 0) {
        return refuse_slab_option("--streams", "photons have no streams",
                                  "leave it out, or give --method adding or model");
    } else if (options.optical_depth > kMostWalkDepth) {
        return refuse_slab_option("--optical-depth",
                                  fmt::format("photons take too long above {}", kMostWalkDepth),
                                  "use --method adding");
    }
    if (options.method != SlabMethod::model) {
        return formats::ok_status();
    }
    if (options.orders_option->count() > 0) {
        return refuse_slab_option("--orders", "the model has the orders 0, 1 and 2 and the rest",
                                  "leave it out");
    }
    if (options.eta != 1) {
        return refuse_slab_option("--eta", "the model knows no boundaries",
                                  "give 1, or --method adding");
    }
    if (options.albedo != 1) {
        return refuse_slab_option("--albedo", "the model knows no absorption",
                                  "give 1, or --method adding");
    }
    return formats::ok_status();
}

/// The phase function in both forms that the methods ask for.
struct SlabPhase {
    bake::CosineSampler sampler;
    bake::SlabMedium medium;
};

formats::Result<SlabPhase> make_slab_phase(const SlabCommand& options) {
    // For twice the streams, and the peak that those leave.
    const unsigned moments = 4 * options.streams + 1;
    if (options.phase.empty()) {
        return SlabPhase{
            bake::CosineSampler::henyey_greenstein(options.g),
            {bake::expand_henyey_greenstein(options.g, moments).lambda, options.albedo}};
    }
    const auto table = formats::read_phase_table(options.phase);
    if (!table) {
        return table.error();
    }
    const std::vector<double> cosine(table->cosine.begin(), table->cosine.end());
    const std::vector<double> value(table->value.begin(), table->value.end());
    bake::SlabMedium medium{{1.0}, options.albedo};
    if (options.method != SlabMethod::monte_carlo) {
        medium.moment = bake::expand_phase(*table, moments).lambda;
    }
    return SlabPhase{bake::CosineSampler::tabulated(cosine, value), std::move(medium)};
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

Json solve_by_adding(const SlabCommand& options, const bake::SlabMedium& medium) {
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

formats::Result<Json> solve_by_photons(const SlabCommand& options,
                                       const bake::CosineSampler& phase) {
    if (auto status = check_threads(options.threads); !status) {
        return std::move(status).error();
    }
    bake::Context context;
    context.threads = options.threads;
    context.cancel = &catch_interrupts();
    const bake::SlabWalk walk =
        walk_slab(phase,
                  {options.optical_depth, options.albedo, options.cosine, options.photons,
                   options.seed, options.orders + 1, 0, 0, 0, options.eta},
                  context);
    if (walk.photons < options.photons) {
        return formats::make_error(formats::ErrorKind::interrupted, "", "", "interrupted",
                                   "nothing was printed");
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

Json solve_by_model(const SlabCommand& options, const bake::SlabMedium& medium) {
    const bake::ColumnFit fit =
        bake::fit_column_models(medium, {&options.cosine, 1}, bake::column_fit_depths(),
                                static_cast<int>(options.streams))
            .front();
    const bake::OrderShares shares = bake::eval_column_model(
        fit.model, options.optical_depth, std::exp(-options.optical_depth / options.cosine));
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
    all["model"] = {{"length", fit.model.length}, {"beta", fit.model.beta},
                    {"c", fit.model.decay},       {"kappa_c", fit.model.extinction},
                    {"t", fit.model.forward},     {"r", fit.model.back}};
    all["fit_error"] = {{"rms_transmittance", fit.rms_transmittance},
                        {"max_transmittance", fit.max_transmittance},
                        {"rms_orders", fit.rms_orders},
                        {"max_orders", fit.max_orders}};
    return all;
}

/// Lines of quantity, order and value; "all" where it is no order's.
void print_slab_lines(const Json& all) {
    fmt::print("quantity,order,value\n");
    const auto print = [](const std::string& prefix, const Json& object, const std::string& order) {
        for (const auto& [name, value] : object.items()) {
            if (value.is_number()) {
                fmt::print("{}{},{},{}\n", prefix, name, order, value.dump());
            }
        }
    };
    print("", all, "all");
    for (const Json& order : all["by_order"]) {
        print("", order, order["order"].get<std::string>());
    }
    for (const char* group : {"model", "fit_error"}) {
        if (all.contains(group)) {
            print(std::string(group) + "_", all[group], "all");
        }
    }
}

int run(const SlabCommand& options) {
    if (const auto status = check_slab_options(options); !status) {
        return report_error(status.error());
    }
    const auto phase = make_slab_phase(options);
    if (!phase) {
        return report_error(phase.error());
    }
    Json all;
    if (options.method == SlabMethod::monte_carlo) {
        const auto walked = solve_by_photons(options, phase->sampler);
        if (!walked) {
            return report_error(walked.error());
        }
        all = *walked;
    } else {
        all = options.method == SlabMethod::adding ? solve_by_adding(options, phase->medium)
                                                   : solve_by_model(options, phase->medium);
    }
    if (options.format == TextFormat::csv) {
        print_slab_lines(all);
    } else {
        fmt::print("{}", json_text(all));
    }
    return kExitSuccess;
}

void add_slab_accuracy(CLI::App& command, SlabCommand& options) {
    options.orders_option =
        command
            .add_option("--orders", options.orders,
                        "scattering orders printed apart, from 0 on; the rest is printed as one")
            ->transform(whole_number(1, kMostOrders))
            ->option_text("N [8]");
    options.streams_option =
        command
            .add_option("--streams", options.streams,
                        "directions a hemisphere of the methods adding and model")
            ->transform(whole_number(1, kMostStreams))
            ->option_text("N [48]");
    options.walk_options = {
        command.add_option("--photons", options.photons, "paths of the method monte-carlo")
            ->transform(whole_number(1, 1000000000))
            ->option_text("N [1000000]"),
        command.add_option("--seed", options.seed, "of these paths: another gives other noise")
            ->transform(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
            ->option_text("S [0]"),
        command
            .add_option("--threads", options.threads,
                        "for these paths, 0: one per core; the result is the same for any number")
            ->transform(whole_number(0, 1024))
            ->option_text("T [0]")};
}

}  // namespace

void add_slab_command(CLI::App& app, Job& job) {
    auto options = std::make_shared<SlabCommand>();
    CLI::App* command = app.add_subcommand(
        "slab", "Say how much light a plane layer reflects and transmits, by scattering order");
    command
        ->add_option("--optical-depth", options->optical_depth,
                     "extinction times thickness, 0 to 1e6 (monte-carlo: 1e3)")
        ->check(real_number(0, bake::kMaxSlabDepth))
        ->required()
        ->option_text("T");
    command
        ->add_option("--albedo", options->albedo,
                     "share of the extinction that scatters, 0 to 1; model: 1 alone")
        ->check(real_number(0, 1))
        ->option_text("A [1]");
    options->g_option =
        command
            ->add_option("--g", options->g,
                         "mean cosine of a Henyey-Greenstein phase function, -0.99 to 0.99")
            ->check(real_number(-formats::media::kMaxMeanCosine, formats::media::kMaxMeanCosine))
            ->option_text("G");
    options->phase_option =
        command
            ->add_option("--phase", options->phase,
                         "a table in its place, as media files name them: lines of a cosine and a "
                         "value, cosines ascending from -1 to 1, values relative")
            ->check(file_name())
            ->option_text("FILE");
    constexpr double kLeastCosine = 0.001;
    command->add_option("--cosine", options->cosine, "between the light and the normal, 0.001 to 1")
        ->check(real_number(kLeastCosine, 1))
        ->option_text("MU [1]");
    command
        ->add_option("--eta", options->eta,
                     "index of the layer over that of both sides, 1/3 to 3: smooth boundaries that "
                     "reflect and refract; model: 1 alone")
        ->check(real_number(formats::media::kMinEta, formats::media::kMaxEta))
        ->option_text("E [1]");
    command
        ->add_option(
            "--method", options->method,
            "adding: exact but for a small error, which is printed; monte-carlo: photons, "
            "with standard errors; model: one-dimensional, fitted to adding at this cosine")
        ->transform(one_of<SlabMethod>({{"adding", SlabMethod::adding},
                                        {"monte-carlo", SlabMethod::monte_carlo},
                                        {"model", SlabMethod::model}}))
        ->option_text("adding|monte-carlo|model [adding]");
    add_slab_accuracy(*command, *options);
    add_format_options(*command, options->format, "csv: lines of quantity,order,value");
    command->footer(
        "Prints the shares of a beam's flux that a layer reflects, transmits and absorbs, all\n"
        "together and by number of scatterings: order 0 is light that goes straight through or "
        "that\n"
        "a boundary reflects. adding also prints the means under even light, and as its numerical\n"
        "error the difference to twice the streams. A peak of the phase function that the streams\n"
        "do not resolve goes straight on. model prints its parameters, lengths in optical depths,\n"
        "and how far it is from adding, as far as it was fitted.\n"
        "Example:\n  opaline slab --optical-depth 10 --g 0.85 --cosine 0.5\n"
        "  opaline slab --optical-depth 2 --albedo 0.9 --g 0.75 --method monte-carlo --format csv\n"
        "  opaline slab --optical-depth 5 --albedo 0.99 --g 0.8 --eta 1.4");
    command->callback([options, &job] { job = [options] { return run(*options); }; });
}

}  // namespace opaline::cli
