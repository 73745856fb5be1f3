#include "bake/cli/scene_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

#include "bake/base/ordered_parallel.h"
#include "bake/cli/inputs.h"
#include "bake/cli/machine_limits.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/effects/effects.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/pipeline/predict_memory.h"
#include "bake/pipeline/refine_stage.h"
#include "bake/scene/copies.h"
#include "bake/scene/shared_rows.h"
#include "formats/opal/terms.h"

namespace opaline::cli {
namespace {

using bake::Quality;

// "all" or a number. All of the largest cube map are 6 x 128 x 128.
OptionValue coefficients_or_all(std::uint32_t& coefficients) {
    OptionValue number = whole_number(coefficients, 7, 98304);
    return {[&coefficients, take = std::move(number.take)](const std::string& text) {
        if (text == "all") {
            coefficients = bake::kAllCoefficients;
            return std::string();
        }
        const std::string fault = take(text);
        return fault.empty() ? fault : fault + ", nor `all`";
    }};
}

OptionValue folders(std::vector<std::filesystem::path>& to) {
    return {[&to](const std::string& text) {
                std::error_code ignored;
                if (!std::filesystem::is_directory(text, ignored)) {
                    return fmt::format("'{}' is not a folder", shorten(text));
                }
                to.emplace_back(text);
                return std::string();
            },
            OptionValue::Count::repeated};
}

OptionValue refinement(bake::RefineChoice& choice) {
    OptionValue length = number_above(choice.longest_edge, 0, 1e9);
    return {[&choice, take = std::move(length.take)](const std::string& text) {
        using Mode = bake::RefineChoice::Mode;
        if (text == "auto" || text == "off") {
            choice.mode = text == "auto" ? Mode::where_light_changes : Mode::off;
            return std::string();
        }
        choice.mode = Mode::edges;
        const std::string fault = take(text);
        return fault.empty() ? fault : fault + ", nor `auto` nor `off`";
    }};
}

std::string quality_help() {
    std::string text = "cube map size, coefficients:";
    for (const Quality quality :
         {Quality::draft, Quality::preview, Quality::production, Quality::reference}) {
        bake::BakeOptions options;
        options.quality = quality;
        const auto knobs = bake::resolve_knobs(bake::all_effects(), options);
        text +=
            std::string(quality == Quality::draft ? " " : ", ") +
            std::string(bake::quality_name(quality)) + " " + std::to_string(knobs->cubemap_size) +
            ", " +
            (knobs->coefficients == bake::kAllCoefficients ? std::string("all")
                                                           : std::to_string(knobs->coefficients));
    }
    return text;
}

std::string list_effects(const char* separator) {
    std::string names;
    for (const bake::EffectDescriptor& effect : bake::all_effects().effects) {
        if (!effect.help.empty()) {
            names += (names.empty() ? "" : separator) + std::string(effect.name);
        }
    }
    return names;
}

// Of scenes that take seconds before anything else can be said of them, such as a mesh of many
// instances.
void announce_size(const std::string& scene, const formats::SceneCounts& counts) {
    constexpr double kSeconds = 6e-7;  // of a vertex, to be placed and inspected
    const auto vertices = static_cast<double>(counts.vertices);
    if (kSeconds * vertices < 1) return;
    print_note(fmt::format("{}: {:.1f} million vertices: to inspect them takes some {}",
                           printable(scene), 1e-6 * vertices, format_seconds(kSeconds * vertices)));
}

// `check`: whether a scene of such a size fits into memory.
template <class Check>
void share_copies(const SceneOptions& options, const bake::Knobs& knobs,
                  const bake::Context& context, const Check& check, formats::Scene& scene) {
    const bake::ShareReport copies = require(bake::share_copies_for_bake(knobs, context, scene));
    if (copies.given == 0) return;
    require(check(bake::count_memory(bake::count_with(scene, copies.apart))));
    bake::expand_copies(copies.apart, scene);
    if (copies.shared == 0) {
        if (!knobs.simplify) return;
        print_note(fmt::format(
            "{}: none of {} repeated meshes shares the rows of another: what is around them "
            "differs, or there are lamps, volumes or media",
            printable(options.scene), copies.given));
        return;
    }
    print_note(
        fmt::format("{}: {} of {} repeated meshes share the rows of others, and err by some "
                    "{:.1f} % for it",
                    printable(options.scene), copies.shared, copies.given, 100 * copies.error));
}

// Of an effect's knob.
OptionValue knob_value(const bake::KnobSpec& knob, bake::BakeOptions& options) {
    const auto put = [&knob, &options](auto value) {
        options.set(knob, static_cast<double>(value));
    };
    if (knob.words.empty() && knob.allowed.empty()) {
        return knob.whole ? detail::whole_number(static_cast<std::uint64_t>(knob.lowest),
                                                 static_cast<std::uint64_t>(knob.highest), put)
                          : detail::real_number(knob.lowest, knob.highest, put);
    }
    std::vector<std::string> names(knob.words.begin(), knob.words.end());
    for (const double value : knob.allowed) {
        names.push_back(fmt::format("{}", value));
    }
    return detail::one_of(names, [&knob, put](std::size_t i) {
        put(knob.words.empty() ? knob.allowed[i] : static_cast<double>(i));
    });
}

}  // namespace

void add_scene_argument(const Command& command, SceneSource& source) {
    command
        .add("scene", "SCENE", file_name(source.scene),
             "the scene: .gltf or .glb; .vdb for a volume alone; .json for the volumes of a media "
             "file alone")
        .required();
}

void add_allow_path_option(const Command& command, SceneSource& source) {
    command.add("--allow-path", "DIR", folders(source.import.allowed_folders),
                "folder whose files the scene and its media may name too, besides those in their "
                "own folders; may be repeated");
}

void add_unit_options(const Command& command, SceneSource& source) {
    // From a tenth of a nanometre to a light year.
    command.add("--metres-per-unit", "X [1]",
                real_number(source.import.metres_per_unit, 1e-10, 1e16),
                "length of one unit of the scene file");
    command.add("--smooth-normals", "DEGREES [0]", real_number(source.import.smooth_angle, 0, 180),
                "of meshes without NORMAL: smooth across edges of less than this angle; 0: flat, "
                "as glTF says");
}

void add_subject_options(const Command& command, SceneOptions& options) {
    add_scene_argument(command, options);
    command.add("--media", "FILE.json", file_name(options.media),
                "what translucent materials are made of; formats/media/README.md lists the keys");
    add_allow_path_option(command, options);
    command.add(
        "--effects", "auto|all|LIST [auto]", text(options.effects),
        std::string(
            "what to simulate: auto, what the scene calls for; all, everything that concerns it, "
            "however little it adds, and without shortcuts; or a list of effects, of ") +
            "which this version has: " + list_effects(", "));
    add_seed_option(command, options.bake.seed,
                    "of everything random: which receivers the error is measured at");
    add_threads_option(command, options.bake.threads);
    add_unit_options(command, options);
    add_memory_option(command, options.memory_limit);
}

void add_scene_options(const Command& command, SceneOptions& options) {
    add_subject_options(command, options);
    command.add("--quality",
                one_of(options.bake.quality, {{"draft", Quality::draft},
                                              {"preview", Quality::preview},
                                              {"production", Quality::production},
                                              {"reference", Quality::reference}}),
                quality_help());
    command.add("--cubemap", "N",
                one_of(options.bake.cubemap_size,
                       {{"8", 8}, {"16", 16}, {"32", 32}, {"64", 64}, {"128", 128}}),
                "texels along a face of the light's cube map: 8, 16, 32, 64 or 128; default as the "
                "quality says");
    command.add("--coefficients", "M", coefficients_or_all(options.bake.coefficients),
                "wavelet coefficients kept per receiver in the mean over a mesh, 7 or more, or "
                "`all`; default as the quality says");
    options.bake.refine.mode = bake::RefineChoice::Mode::where_light_changes;
    command.add("--refine", "auto|off|MAX_EDGE [auto]", refinement(options.bake.refine),
                "receivers between the vertices of the scene: auto, where its light changes, such "
                "as where shadows end; off, none; or where an edge is longer than so many metres. "
                "They follow on the scene's own vertices in the file");
    command.add("--max-receivers", "N",
                whole_number(options.bake.refine.max_receivers, 1, 1u << 30),
                "where receivers are added, until there are so many; default: as many again as the "
                "scene has at draft, 4000 at least, twice and 20000 at preview, 4 times and 80000 "
                "at production");
    for (const bake::EffectDescriptor& effect : bake::all_effects().effects) {
        for (const bake::KnobSpec* knob : effect.knobs) {
            if (!knob->option.empty()) {
                command.add(std::string(knob->option), std::string(knob->placeholder),
                            knob_value(*knob, options.bake), std::string(knob->help));
            }
        }
    }
    command.add(
        "--simplify", one_of(options.bake.simplify, {{"auto", true}, {"off", false}}),
        "vertices of one place and one normal of a mesh, as unwelded, flat-shaded and "
        "seamed exports have them, share their rows, and where opaque meshes are dense and "
        "smooth most vertices interpolate those of others, and instances of a mesh that are "
        "only moved share rows where their surroundings are alike, each at a third of the "
        "error that --refine leaves: auto; or each has its own: off");
    command.add_flag("--separate-terms", options.bake.separate_terms,
                     "keep " + formats::term_names(formats::TermSet::separable, " and ") +
                         " scattering apart, so that `render --terms` can show each");
}

void add_error_option(const Command& command, SceneOptions& options) {
    command
        .add("--error", "E", real_number(options.bake.error, 1e-4, 0.99),
             "relative RMS error that the file may have, of model and numbers together: the "
             "cheapest model that leaves enough is taken, then a pilot measures what each knob "
             "costs and picks the cheapest; those given stay")
        .excludes(command.find("--quality"));
}

formats::ImportedScene open_scene(const SceneOptions& options, const bake::Knobs& knobs,
                                  formats::CloudDetail detail) {
    bake::Context context;
    context.threads = options.bake.threads;
    const unsigned threads = bake::thread_count(context);
    const std::uint64_t limit =
        options.memory_limit != 0 ? options.memory_limit : available_memory(threads);
    const auto check = [&](const bake::MemoryCounts& counts) {
        return check_memory(options.scene,
                            bake::predict_memory(bake::all_effects(), counts, knobs, threads),
                            limit);
    };
    const auto check_size = [&](const formats::SceneCounts& counts) {
        auto status = check(bake::count_memory(counts));
        if (status) announce_size(options.scene, counts);
        return status;
    };
    formats::ImportOptions wanted = options.import;
    wanted.check_size = check_size;
    wanted.keep_copies = true;
    auto imported = open_scene(options.scene, wanted, options.media, detail);
    require(bake::check_bakeable(imported.scene));
    share_copies(options, knobs, context, check, imported.scene);
    const formats::Slots slots =
        knobs.simplify ? bake::find_slots(imported.scene) : formats::Slots{};
    require(check(bake::count_memory(bake::all_effects(), imported.scene, slots.view(), knobs)));
    require(check_threads(threads));
    return imported;
}

bake::Knobs fit_memory(const SceneOptions& options, const formats::Scene& scene,
                       const bake::Knobs& knobs) {
    bake::Context context;
    context.threads = options.bake.threads;
    const unsigned threads = bake::thread_count(context);
    return bake::fit_refinement(
        bake::all_effects(), scene, knobs, threads,
        options.memory_limit != 0 ? options.memory_limit : available_memory(threads));
}

bake::BakeOptions parse_effects(const SceneOptions& options) {
    // Of later versions; whoever names one should not take it for a slip of the pen.
    constexpr std::array<std::string_view, 1> kLater{"filtering"};
    bake::BakeOptions wanted = options.bake;
    if (options.effects == "auto") return wanted;
    if (options.effects == "all") {
        wanted.simulate_all = true;
        return wanted;
    }
    const auto refuse_name = [](std::string fault) {
        refuse_usage("--effects", std::move(fault),
                     "give auto, all, or some of " + list_effects(","));
    };
    std::stringstream list(options.effects);
    for (std::string name; std::getline(list, name, ',');) {
        const auto& here = bake::all_effects().effects;
        const bool is_here = std::any_of(here.begin(), here.end(), [&](const auto& effect) {
            return effect.name == name && !effect.help.empty();
        });
        if (!is_here) {
            const bool is_later = std::find(kLater.begin(), kLater.end(), name) != kLater.end();
            refuse_name(name == "all" || name == "auto"
                            ? "'" + name + "' stands by itself, not in a list"
                        : is_later ? "this version does not simulate '" + name + "'"
                                   : "there is no effect named '" + name + "'");
        }
        wanted.effects.push_back(name);
    }
    if (wanted.effects.empty()) {
        refuse_name("the list is empty");
    }
    return wanted;
}

}  // namespace opaline::cli
