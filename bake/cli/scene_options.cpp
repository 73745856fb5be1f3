#include "bake/cli/scene_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

#include "bake/base/ordered_parallel.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/effects/effects.h"
#include "bake/pipeline/predict_memory.h"
#include "bake/volumes/plan_volumes.h"
#include "formats/opal/terms.h"

namespace opaline::cli {
namespace {

using bake::Quality;

// "all" or a number; CLI11 hands over the text. All of the largest cube map are 6 x 128 x 128.
std::string parse_coefficients(std::string& text) {
    if (text == "all") {
        text = std::to_string(bake::kAllCoefficients);
        return {};
    }
    const std::string fault = whole_number(7, 98304)(text);
    return fault.empty() ? fault : fault + ", nor `all`";
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

// The option of an effect's knob.
void add_knob_option(CLI::App& command, const bake::KnobSpec& knob, bake::BakeOptions& options) {
    const auto take = [&knob, &options](const double& value) { options.set(knob, value); };
    CLI::Option* const option =
        command.add_option_function<double>(std::string(knob.option), take, std::string(knob.help));
    option->option_text(std::string(knob.placeholder));
    if (!knob.words.empty()) {
        std::vector<std::pair<std::string, int>> words;
        for (const std::string_view word : knob.words) {
            words.emplace_back(word, static_cast<int>(words.size()));
        }
        option->transform(one_of<int>(words));
    } else if (!knob.allowed.empty()) {
        std::vector<std::pair<std::string, int>> names;
        for (const double value : knob.allowed) {
            names.emplace_back(std::to_string(static_cast<int>(value)), static_cast<int>(value));
        }
        option->transform(one_of<int>(names));
    } else if (knob.whole) {
        option->transform(whole_number(static_cast<std::uint64_t>(knob.lowest),
                                       static_cast<std::uint64_t>(knob.highest)));
    } else {
        option->check(real_number(knob.lowest, knob.highest));
    }
}

}  // namespace

void add_allow_path_option(CLI::App& command, std::vector<std::string>& folders) {
    command
        .add_option("--allow-path", folders,
                    "folder whose files the scene and its media may name too, besides those in "
                    "their own folders; may be repeated")
        ->check(CLI::ExistingDirectory)
        ->take_all()
        ->allow_extra_args(false)
        ->option_text("DIR");
}

void add_smooth_normals_option(CLI::App& command, double& degrees) {
    command
        .add_option("--smooth-normals", degrees,
                    "of meshes without NORMAL: smooth across edges of less than this angle; 0: "
                    "flat, as glTF says")
        ->check(real_number(0, 180))
        ->option_text("DEGREES [0]");
}

void add_subject_options(CLI::App& command, SceneOptions& options) {
    command
        .add_option("scene", options.scene,
                    "the scene: .gltf or .glb; .vdb for a volume alone; .json for the volumes of a "
                    "media file alone")
        ->required()
        ->option_text("SCENE");
    command
        .add_option(
            "--media", options.media,
            "what translucent materials are made of; formats/media/README.md lists the keys")
        ->check(file_name())
        ->option_text("FILE.json");
    add_allow_path_option(command, options.allowed_folders);
    command
        .add_option(
            "--effects", options.effects,
            std::string(
                "what to simulate: auto, what the scene calls for; all, everything that concerns "
                "it, however little it adds, and without shortcuts; or a list of effects, of ") +
                "which this version has: " + list_effects(", "))
        ->option_text("auto|all|LIST [auto]");
    add_seed_option(command, options.bake.seed,
                    "of everything random: which receivers the error is measured at");
    add_threads_option(command, options.bake.threads);
    command
        .add_option("--metres-per-unit", options.metres_per_unit,
                    "length of one unit of the scene file")
        ->check(real_number(kLeastUnit, kMostUnit))
        ->option_text("X [1]");
    add_smooth_normals_option(command, options.smooth_normals);
    add_memory_option(command, options.memory_limit);
}

void add_scene_options(CLI::App& command, SceneOptions& options) {
    add_subject_options(command, options);
    command.add_option("--quality", options.bake.quality, quality_help())
        ->transform(one_of<Quality>({{"draft", Quality::draft},
                                     {"preview", Quality::preview},
                                     {"production", Quality::production},
                                     {"reference", Quality::reference}}))
        ->option_text("draft|preview|production|reference [preview]");
    command
        .add_option("--cubemap", options.bake.cubemap_size,
                    "texels along a face of the light's cube map: 8, 16, 32, 64 or 128; default as "
                    "the quality says")
        ->transform(one_of<int>({{"8", 8}, {"16", 16}, {"32", 32}, {"64", 64}, {"128", 128}}))
        ->option_text("N");
    command
        .add_option("--coefficients", options.bake.coefficients,
                    "wavelet coefficients kept per receiver in the mean over a mesh, 7 or more, or "
                    "`all`; default as the quality says")
        ->transform(CLI::Validator(parse_coefficients, ""))
        ->option_text("M");
    for (const bake::EffectDescriptor& effect : bake::all_effects().effects) {
        for (const bake::KnobSpec* knob : effect.knobs) {
            if (!knob->option.empty()) {
                add_knob_option(command, *knob, options.bake);
            }
        }
    }
    command.add_flag("--separate-terms", options.bake.separate_terms,
                     "keep " + formats::term_names(formats::TermSet::separable, " and ") +
                         " scattering apart, so that `render --terms` can show each");
}

void add_error_option(CLI::App& command, SceneOptions& options) {
    command
        .add_option("--error", options.bake.error,
                    "relative RMS error that the file may have, of model and numbers together: the "
                    "cheapest model that leaves enough is taken, then a pilot measures what each "
                    "knob costs and picks the cheapest; those given stay")
        ->check(real_number(1e-4, 0.99))
        ->excludes("--quality")
        ->option_text("E");
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
    auto imported =
        require(open_scene(options.scene,
                           {options.metres_per_unit,
                            {options.allowed_folders.begin(), options.allowed_folders.end()},
                            check_size,
                            options.smooth_normals},
                           options.media, detail));
    require(bake::check_bakeable(imported.scene));
    require(check(bake::count_memory(bake::all_effects(), imported.scene, knobs)));
    require(check_threads(threads));
    return imported;
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
