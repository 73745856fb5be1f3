#include "runtime/web/page_layer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

#include "runtime/clouds/environment_at.h"
#include "runtime/clouds/light_points.h"
#include "runtime/clouds/shader_layer.h"
#include "runtime/picture/camera.h"
#include "runtime/specular.h"
#include "runtime/volumes/volume_bounds.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

formats::Vec3 centre_of(const formats::AssetView& asset) {
    const BoundingSphere bound = bound_asset(asset);
    return {static_cast<float>(bound.x), static_cast<float>(bound.y), static_cast<float>(bound.z)};
}

void put_floats(DataScript& script, const std::string& name, const std::vector<float>& values) {
    script.put(name, std::span<const float>(values));
}

void put_numbers(DataScript& script, const std::string& name,
                 const std::vector<std::uint32_t>& values) {
    script.put(name, std::span<const std::uint32_t>(values));
}

// Levels after each other, and their sizes.
void put_pictures(DataScript& script, const std::string& name,
                  std::span<const MipLevel<Rgb>> levels) {
    std::vector<float> pixels;
    std::vector<std::uint32_t> sizes;
    for (const MipLevel<Rgb>& level : levels) {
        sizes.insert(sizes.end(), {level.columns, level.rows});
        for (const Rgb pixel : level.value) {
            pixels.insert(pixels.end(), {pixel.r, pixel.g, pixel.b});
        }
    }
    put_floats(script, name, pixels);
    put_numbers(script, name + " sizes", sizes);
}

// Puts both into one array; the second begins at a number of its own.
void put_joined(DataScript& script, const std::string& name,
                const std::vector<std::vector<float>>& parts) {
    std::vector<float> all;
    std::vector<std::uint32_t> first;
    for (const std::vector<float>& part : parts) {
        first.push_back(static_cast<std::uint32_t>(all.size()));
        all.insert(all.end(), part.begin(), part.end());
    }
    put_floats(script, name, all);
    put_numbers(script, name + " first", first);
}

void append_grid(const LayerGrid& grid, std::vector<float>& values) {
    for (const double value : {grid.low_x, grid.low_z, grid.size_x, grid.size_z}) {
        values.push_back(static_cast<float>(value));
    }
}

LayerTurn turn_of(LayerLight light) {
    return {std::move(light.ground_light.cell.value), std::move(light.base_light.cell.value)};
}

float brightest_of(const LayerTurn& turn) {
    float brightest = 0;
    for (const std::vector<Rgb>* grid : {&turn.ground, &turn.base}) {
        for (const Rgb value : *grid) {
            brightest = std::max({brightest, value.r, value.g, value.b});
        }
    }
    return brightest;
}

// The largest difference of `middle` from the mean of both.
float error_between(const LayerTurn& a, const LayerTurn& b, const LayerTurn& middle) {
    LayerTurn difference;
    const auto add = [&](std::vector<Rgb> LayerTurn::*grid) {
        for (std::size_t i = 0; i < (middle.*grid).size(); ++i) {
            const Rgb d = (middle.*grid)[i] + -0.5f * ((a.*grid)[i] + (b.*grid)[i]);
            (difference.*grid).push_back({std::abs(d.r), std::abs(d.g), std::abs(d.b)});
        }
    };
    add(&LayerTurn::ground);
    add(&LayerTurn::base);
    return brightest_of(difference);
}

// `turn`: as the light stands. Halves the step until what lies between is near enough.
template <class Solve>
std::vector<LayerTurn> fill_turns(LayerTurn turn, const Solve& solve) {
    constexpr std::size_t kFirst = 4, kBytesPerCell = 12;  // halves of two grids
    const std::size_t most =
        std::min(kMostTurns, kMostTurnBytes / (kBytesPerCell * turn.ground.size()));
    std::vector<LayerTurn> turns;
    turns.push_back(std::move(turn));
    for (std::size_t i = 1; i < kFirst; ++i) {
        turns.push_back(solve(static_cast<double>(i) / kFirst));
    }
    for (float error = 1; error > kTurnTolerance && 2 * turns.size() <= most;) {
        const std::size_t count = turns.size();
        std::vector<LayerTurn> all;
        float largest = 0, brightest = 0;
        for (std::size_t i = 0; i < count; ++i) {
            LayerTurn middle = solve((static_cast<double>(i) + 0.5) / static_cast<double>(count));
            largest = std::max(largest, error_between(turns[i], turns[(i + 1) % count], middle));
            brightest = std::max(brightest, brightest_of(middle));
            all.push_back(turns[i]);
            all.push_back(std::move(middle));
        }
        turns = std::move(all);
        error = brightest > 0 ? largest / brightest : 0;
    }
    return turns;
}

void put_turns(DataScript& script, const std::string& name, std::span<const LayerTurn> turns,
               std::vector<Rgb> LayerTurn::*grid) {
    std::vector<Rgb> all;
    for (const LayerTurn& turn : turns) {
        all.insert(all.end(), (turn.*grid).begin(), (turn.*grid).end());
    }
    script.put_radiance(name, all);
}

}  // namespace

bool turns_layer(const formats::AssetView& asset) {
    return !specular_needs(asset).any();
}

LightAboveLayer light_above_layer(const formats::AssetView& asset,
                                  const formats::Environment& environment, unsigned threads) {
    LightAboveLayer made;
    const auto light_turned = [&](double share) {
        const auto angle = static_cast<float>(2 * std::numbers::pi * share);
        return light_layers(asset.clouds, environment, rotation_about_y(angle),
                            {.time = 0, .threads = threads});
    };
    made.layer = light_turned(0);
    made.turns = turns_layer(asset);
    // An even sky has no side.
    if (made.turns && !made.layer.sun.empty()) {
        made.turn = fill_turns(turn_of(made.layer),
                               [&](double share) { return turn_of(light_turned(share)); });
    } else {
        made.turn = {turn_of(made.layer)};
    }
    if (!made.turns) {
        made.below =
            environment_at({made.layer, environment, {}}, centre_of(asset), {.threads = threads});
    }
    return made;
}

void put_layer(DataScript& script, const formats::AssetView& asset) {
    const LayerLight light = light_layers(asset.clouds, {}, {}, {.time = 0, .threads = 1});
    const LayerKind kind = layer_kind(light);
    put_numbers(
        script, "layer kind",
        {kind.repeats ? 1u : 0u, kind.modes, kind.glows ? 1u : 0u, turns_layer(asset) ? 1u : 0u});
    put_floats(script, "layer thickness", pack_thickness(light));
    put_joined(script, "layer tables",
               {pack_layer_phase(light), pack_layer_flux(light), pack_layer_glow(light)});
    put_pictures(script, "layer albedo", light.albedo.level);
}

void put_layer_light(DataScript& script, const LightAboveLayer& above) {
    const LayerLight& light = above.layer;
    const ShaderLayer record = make_shader_layer(light);
    script.put_records("layer record", std::span<const ShaderLayer>(&record, 1));
    put_joined(script, "layer suns", {pack_sun_tables(light), pack_sun_flux(light)});
    put_numbers(script, "layer light size",
                {light.ground_light.cell.columns, light.ground_light.cell.rows});
    put_turns(script, "layer ground light", above.turn, &LayerTurn::ground);
    put_turns(script, "layer base light", above.turn, &LayerTurn::base);
    const LayerPlaces places = layer_places(light);
    std::vector<float> values;
    for (const LayerGrid* grid : {&places.field, &places.ground, &places.light}) {
        append_grid(*grid, values);
    }
    values.push_back(static_cast<float>(places.base));
    values.push_back(static_cast<float>(places.ground_height));
    put_floats(script, "layer places", values);
}

bool has_bodies_apart(const formats::AssetView& asset) {
    if (asset.clouds.empty() || (asset.primitives.empty() && asset.volumes.empty())) return false;
    const formats::LayerRecord& record = asset.clouds.records.front();
    const LayerField field = make_layer_field(record, asset.clouds.thickness_of(record), 0);
    return light_points(asset, volume_corners(asset.volumes), field, centre_of(asset))
               .point.size() > 1;
}

}  // namespace opaline::runtime
