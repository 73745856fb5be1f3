#include <fmt/core.h>

#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "bake/cli/command.h"
#include "bake/cli/json_output.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/slab_answer.h"
#include "bake/physics/slab/solve_slab.h"
#include "formats/media/limits.h"

namespace opaline::cli {
namespace {

using Json = nlohmann::ordered_json;

struct SlabCommand : SlabQuestion {
    TextFormat format = TextFormat::json;
    Option g_option, phase_option, orders_option, streams_option;
    std::vector<Option> walk_options;
};

/// Photons in a layer without absorption scatter about as often as the layer is thick, and long
/// before they cross it by chance as often as the square of that.
constexpr double kMostWalkDepth = 1e3;
constexpr unsigned kMostStreams = 128, kMostOrders = 64;

void check_slab_options(const SlabCommand& options) {
    const bool by_g = options.g_option.is_given(), by_table = options.phase_option.is_given();
    if (by_g == by_table) {
        refuse_usage("slab", by_g ? "two phase functions" : "no phase function",
                     "give --g or --phase, one of them");
    }
    if (options.method != SlabMethod::monte_carlo) {
        for (const Option& option : options.walk_options) {
            if (option.is_given()) {
                refuse_usage(option.name(), "this method draws no photons",
                             "give it with --method monte-carlo alone");
            }
        }
    } else if (options.streams_option.is_given()) {
        refuse_usage("--streams", "photons have no streams",
                     "leave it out, or give another --method");
    } else if (options.optical_depth > kMostWalkDepth) {
        refuse_usage("--optical-depth",
                     fmt::format("photons take too long above {}", kMostWalkDepth),
                     "use --method adding");
    }
    if (options.views > 0 && options.method == SlabMethod::monte_carlo) {
        refuse_usage("--views", "photons are not counted by direction",
                     "give --method adding, model or table");
    }
    if (options.views > 0 && options.eta != 1) {
        refuse_usage("--eta", "radiance has no boundaries", "leave out --views");
    }
    if (options.method != SlabMethod::model && options.method != SlabMethod::table) return;
    if (options.method == SlabMethod::table && options.streams_option.is_given()) {
        refuse_usage("--streams", "tables have their own number of streams",
                     "leave it out, or give another --method");
    }
    if (options.orders_option.is_given()) {
        refuse_usage("--orders", "this method has the orders 0, 1 and 2 and the rest",
                     "leave it out");
    }
    if (options.eta != 1) {
        refuse_usage("--eta", "this method knows no boundaries", "give 1, or --method adding");
    }
    if (options.albedo != 1) {
        refuse_usage("--albedo", "this method knows no absorption", "give 1, or --method adding");
    }
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

/// Lines of degrees, side, order and radiance.
void print_view_lines(const Json& views) {
    fmt::print("degrees,side,order,radiance\n");
    for (const Json& view : views) {
        for (const char* side : {"reflected", "transmitted"}) {
            for (const Json& order : view[side]) {
                fmt::print("{},{},{},{}\n", view["degrees"].dump(), side,
                           order["order"].get<std::string>(), order["radiance"].dump());
            }
        }
    }
}

int run(const SlabCommand& options) {
    check_slab_options(options);
    const auto answer = answer_slab(options);
    const Json& all = answer;
    if (options.format == TextFormat::csv && options.views > 0) {
        print_view_lines(all["views"]);
    } else if (options.format == TextFormat::csv) {
        print_slab_lines(all);
    } else {
        fmt::print("{}", json_text(all));
    }
    return kExitSuccess;
}

void add_slab_accuracy(const Command& command, SlabCommand& options) {
    options.orders_option =
        command.add("--orders", "N [8]", whole_number(options.orders, 1, kMostOrders),
                    "scattering orders printed apart, from 0 on; the rest is printed as one");
    options.streams_option =
        command.add("--streams", "N [48]", whole_number(options.streams, 1, kMostStreams),
                    "directions a hemisphere of the methods adding and model");
    options.walk_options = {
        command.add("--photons", "N [1000000]", whole_number(options.photons, 1, 1000000000),
                    "paths of the method monte-carlo"),
        add_seed_option(command, options.seed, "of these paths: another gives other noise"),
        command.add("--threads", "T [0]", whole_number(options.threads, 0, 1024),
                    "for these paths, 0: one per core; the result is the same for any number")};
}

}  // namespace

void add_slab_command(Program& program) {
    auto [command, options] = add_command<SlabCommand>(
        program, "slab",
        "Say how much light a plane layer reflects and transmits, by scattering order", run);
    command
        .add("--optical-depth", "T", real_number(options.optical_depth, 0, bake::kMaxSlabDepth),
             "extinction times thickness, 0 to 1e6 (monte-carlo: 1e3)")
        .required();
    command.add("--albedo", "A [1]", real_number(options.albedo, 0, 1),
                "share of the extinction that scatters, 0 to 1; model and table: 1 alone");
    options.g_option = command.add(
        "--g", "G",
        real_number(options.g, -formats::media::kMaxMeanCosine, formats::media::kMaxMeanCosine),
        "mean cosine of a Henyey-Greenstein phase function, -0.99 to 0.99");
    options.phase_option =
        command.add("--phase", "FILE", file_name(options.phase),
                    "a table in its place, as media files name them: lines of a cosine and a "
                    "value, cosines ascending from -1 to 1, values relative");
    constexpr double kLeastCosine = 0.001;
    command.add("--cosine", "MU [1]", real_number(options.cosine, kLeastCosine, 1),
                "between the light and the normal, 0.001 to 1");
    command.add("--eta", "E [1]",
                real_number(options.eta, formats::media::kMinEta, formats::media::kMaxEta),
                "index of the layer over that of both sides, 1/3 to 3: smooth boundaries that "
                "reflect and refract; model and table: 1 alone");
    command.add("--method",
                one_of(options.method, {{"adding", SlabMethod::adding},
                                        {"monte-carlo", SlabMethod::monte_carlo},
                                        {"model", SlabMethod::model},
                                        {"table", SlabMethod::table}}),
                "adding: exact but for a small error, which is printed; monte-carlo: photons, with "
                "standard errors; model: one-dimensional, fitted to adding at this cosine; table: "
                "interpolated as renderers of cloud layers do");
    constexpr unsigned kMostViews = 1000;
    command.add("--views", "N [0]", whole_number(options.views, 0, kMostViews),
                "also print radiance by order at so many angles in the plane of light and normal, "
                "0: none; over that of a white diffuse surface in the same light");
    add_slab_accuracy(command, options);
    add_format_options(
        command, options.format,
        "csv: lines of quantity,order,value; with --views of degrees,side,order,radiance");
    command.footer(
        "Prints the shares of a beam's flux that a layer reflects, transmits and absorbs, all\n"
        "together and by number of scatterings: order 0 is light that goes straight through or "
        "that\n"
        "a boundary reflects. adding also prints the means under even light, and as its numerical\n"
        "error the difference to twice the streams. A peak of the phase function that the streams\n"
        "do not resolve goes straight on. model prints its parameters, lengths in optical depths,\n"
        "and how far it is from adding, as far as it was fitted. Views have degrees from the "
        "normal,\n"
        "above 0 on the side that the light goes to.\n"
        "Example:\n  opaline slab --optical-depth 10 --g 0.85 --cosine 0.5\n"
        "  opaline slab --optical-depth 2 --albedo 0.9 --g 0.75 --method monte-carlo --format csv\n"
        "  opaline slab --optical-depth 5 --albedo 0.99 --g 0.8 --eta 1.4");
}

}  // namespace opaline::cli
