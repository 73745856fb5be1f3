#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>

#include "bake/lab/example/example_scenes.h"
#include "formats/opal/atomic_file.h"
#include "formats/vdb/write_vdb.h"

namespace opaline::bake {
namespace {

const Example* find_example(std::string_view name) {
    const std::span<const Example> all = all_examples();
    const auto found = std::ranges::find_if(
        all, [&](const Example& example) { return example.info.name == name; });
    return found == all.end() ? nullptr : &*found;
}

formats::Error no_such_example(std::string_view name) {
    std::string known;
    for (const Example& example : all_examples()) {
        known += (known.empty() ? "" : ", ") + std::string(example.info.name);
    }
    return formats::make_error(formats::ErrorKind::usage, "", "",
                               "there is no example '" + std::string(name) + "'",
                               "choose one of: " + known);
}

// The media file of a scene with a volume.
std::string describe_volume(const ExampleVolume& volume, const std::string& file) {
    const nlohmann::ordered_json phase =
        volume.rms_angle > 0
            ? nlohmann::ordered_json{{"type", "gaussian"}, {"rms_angle", volume.rms_angle}}
            : nlohmann::ordered_json{{"type", "hg"}, {"g", volume.g}};
    nlohmann::ordered_json entry = {
        {"file", file},  {"density", "density"},    {"sigma_t", volume.sigma_t},
        {"unit", "1/m"}, {"albedo", volume.albedo}, {"phase", phase}};
    if (volume.make_temperature != nullptr) {
        entry["temperature"] = "temperature";
        entry["emission_scale"] = volume.emission_scale;
    }
    return nlohmann::ordered_json{{"volumes", nlohmann::ordered_json::array({entry})}}.dump(2) +
           "\n";
}

}  // namespace

formats::Result<std::vector<GltfObject>> make_example(std::string_view name) {
    const Example* const example = find_example(name);
    if (example == nullptr) return no_such_example(name);
    return example->make == nullptr ? std::vector<GltfObject>{} : example->make();
}

formats::Result<std::vector<std::filesystem::path>> write_example(
    std::string_view name, const std::filesystem::path& folder) {
    const Example* const example = find_example(name);
    if (example == nullptr) return no_such_example(name);
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) {
        return formats::make_error(formats::ErrorKind::resource, folder.string(), "",
                                   "cannot create the folder: " + failure.message(),
                                   "choose a folder you may write to");
    }
    const std::string stem(name);
    std::vector<std::filesystem::path> others;
    std::string media = example->media;
    if (example->volume.make != nullptr) {
        const formats::SparseGrid<float> density = example->volume.make();
        const std::filesystem::path file = folder / (stem + ".vdb");
        formats::SparseGrid<float> temperature;
        std::vector<formats::VdbOutputGrid> grids{{"density", &density, true}};
        if (example->volume.make_temperature != nullptr) {
            temperature = example->volume.make_temperature();
            grids.push_back({"temperature", &temperature, true});
        }
        if (auto status = formats::write_vdb(file, grids); !status) {
            return std::move(status).error();
        }
        others.push_back(file);
        media = describe_volume(example->volume, stem + ".vdb");
    }
    const auto make_image =
        example->make_image != nullptr ? example->make_image : example->layer.make_ground;
    if (make_image != nullptr) {
        const std::filesystem::path file = folder / (stem + ".png");
        if (auto status = formats::write_png(file, make_image()); !status) {
            return std::move(status).error();
        }
        others.push_back(file);
    }
    if (example->layer.describe != nullptr) {
        media = example->layer.describe(stem + ".png");
    }
    if (example->make == nullptr) {
        const std::filesystem::path file = folder / (stem + ".json");
        if (auto status = formats::write_file_atomically(file, media); !status) {
            return std::move(status).error();
        }
        others.insert(others.begin(), file);
        return others;
    }
    auto files = write_gltf(
        folder, stem, example->make(), media,
        example->make_lights == nullptr ? std::vector<GltfPointLight>{} : example->make_lights());
    if (files) {
        files->insert(files->end(), others.begin(), others.end());
    }
    return files;
}

}  // namespace opaline::bake
