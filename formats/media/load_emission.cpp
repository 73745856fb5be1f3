#include "formats/media/load_emission.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "formats/fill_grid.h"
#include "formats/gltf/report.h"
#include "formats/media/limits.h"
#include "formats/media/resampler.h"
#include "formats/spectrum.h"
#include "formats/vdb/limits.h"

namespace opaline::formats {
namespace {

using gltf::in_quotes;

using Color = glm::vec3;
using Emission = SparseGrid<Color>;

// Bricks along each axis: `low` and what follows.
struct BrickBox {
    glm::ivec3 low{0}, extent{0};

    std::size_t cells() const {
        return static_cast<std::size_t>(extent.x) * static_cast<std::size_t>(extent.y) *
               static_cast<std::size_t>(extent.z);
    }
};

template <class T>
BrickBox box_of(const SparseGrid<T>& grid) {
    return {grid.first_brick, grid.extent};
}

BrickBox join(const BrickBox& a, const BrickBox& b) {
    const glm::ivec3 low = glm::min(a.low, b.low);
    return {low, glm::max(a.low + a.extent, b.low + b.extent) - low};
}

// The same grid with a table over `box`, which holds its own.
template <class T>
void widen(SparseGrid<T>& grid, const BrickBox& box) {
    std::vector<std::uint32_t> table;
    table.reserve(box.cells());
    for_bricks(box.low, box.extent,
               [&](glm::ivec3 brick) { table.push_back(grid.brick_at(brick)); });
    grid.first_brick = box.low;
    grid.extent = box.extent;
    grid.table = std::move(table);
}

// Fills a grid over `box` where may_glow(brick); bricks without light are left out.
template <class MayGlow, class Value>
Emission fill_bricks(const BrickBox& box, MayGlow&& may_glow, Value&& value) {
    Emission grid;
    grid.first_brick = box.low;
    grid.extent = box.extent;
    grid.table.reserve(box.cells());
    std::vector<Color> values(Emission::kBrickVoxels);
    for_bricks(box.low, box.extent, [&](glm::ivec3 brick) {
        if (!may_glow(brick)) {
            grid.table.push_back(Emission::kEmpty);
            return;
        }
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = value(voxel_of(brick, static_cast<int>(i)));
        }
        append_brick(values, grid);
    });
    return grid;
}

// The bricks of the density's lattice that a grid reaches; nothing where they are too many.
std::optional<BrickBox> reach_of(const VdbGrid& grid, const glm::dmat4& density_space) {
    const auto corners = grid.is_color ? grid.color.corners() : grid.scalar.corners();
    const glm::dmat4 to_index = glm::inverse(density_space);
    glm::dvec3 low(1e300), high(-1e300);
    for (const glm::dvec3& corner : corners) {
        const glm::dvec3 at(to_index * glm::dvec4(corner, 1));
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    const double most = static_cast<double>(vdb::kMaxIndex);
    if (!(glm::all(glm::greaterThan(low, glm::dvec3(-most))) &&
          glm::all(glm::lessThan(high, glm::dvec3(most))))) {
        return std::nullopt;
    }
    const glm::ivec3 first = Emission::brick_of(glm::ivec3(glm::floor(low)));
    const glm::ivec3 last = Emission::brick_of(glm::ivec3(glm::ceil(high)));
    return BrickBox{first, last - first + 1};
}

// black_body_radiance at 2048 temperatures up to a largest one, linear between them.
class HeatColors {
  public:
    explicit HeatColors(double hottest) : step_(hottest / kSteps) {
        for (int i = 0; i <= kSteps + 1; ++i) {
            const Rgb c = black_body_radiance(i * step_);
            radiance_.emplace_back(c.r, c.g, c.b);
        }
    }
    /// Precondition: 0 <= kelvin <= the largest one.
    Color at(double kelvin) const {
        const double place = step_ > 0 ? kelvin / step_ : 0;
        const auto i = static_cast<std::size_t>(std::clamp(place, 0.0, double{kSteps}));
        const auto f = static_cast<float>(place - static_cast<double>(i));
        return radiance_[i] + f * (radiance_[i + 1] - radiance_[i]);
    }

  private:
    static constexpr int kSteps = 2048;
    double step_;
    std::vector<Color> radiance_;
};

Color to_vec3(Rgb c) {
    return {c.r, c.g, c.b};
}

using Albedos = SparseGrid<glm::vec3>;

// The least and the largest albedo of voxels with density.
struct AlbedoRange {
    glm::vec3 least{1}, most{0};

    void include(glm::vec3 albedo) {
        least = glm::min(least, albedo);
        most = glm::max(most, albedo);
    }
};

float largest_of(const VdbGrid& grid) {
    float most = 0;
    for (const float v : grid.scalar.value) {
        most = std::max(most, v);
    }
    for (const glm::vec3& v : grid.color.value) {
        most = std::max({most, v.x, v.y, v.z});
    }
    return most;
}

// Density times albedo at each voxel.
Albedos scatter(const SparseGrid<float>& density, const Resampler& albedo, AlbedoRange& range) {
    Albedos scattering;
    scattering.first_brick = density.first_brick;
    scattering.extent = density.extent;
    scattering.table = density.table;
    scattering.value.resize(density.value.size());
    for_bricks(density.first_brick, density.extent, [&](glm::ivec3 brick) {
        const std::uint32_t number = density.brick_at(brick);
        for (std::size_t i = 0; number != Albedos::kEmpty && i < Albedos::kBrickVoxels; ++i) {
            const std::size_t at = number * Albedos::kBrickVoxels + i;
            if (!(density.value[at] > 0)) continue;
            const glm::vec3 own = glm::min(albedo.at(voxel_of(brick, static_cast<int>(i))), 1.0f);
            range.include(own);
            scattering.value[at] = density.value[at] * own;
        }
    });
    return scattering;
}

}  // namespace

Rgb black_body_radiance(double kelvin) {
    if (!(kelvin > 0)) return {};
    constexpr double kStep = 5;                   // [nm]
    constexpr double kRadiance = 1.191042972e20;  // 2 h c^2 [W m^-2 sr^-1 nm^-1] at 1 nm
    constexpr double kLumens = 683;               // per watt
    Xyz sum{};
    for (double nm = 360; nm <= 830; nm += kStep) {
        const double power = planck(nm, kelvin);
        const Xyz response = color_matching(nm);
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += kLumens * kRadiance * kStep * power * response[i];
        }
    }
    const std::array<double, 3> c = rec709_of_xyz(sum);
    const auto channel = [](double x) { return static_cast<float>(std::max(0.0, x)); };
    return {channel(c[0]), channel(c[1]), channel(c[2])};
}

Status load_emission(const VolumeEntry& entry, const std::filesystem::path& file,
                     const glm::dmat4& density_space, const VdbReadOptions& reader, Volume& volume,
                     std::vector<Diagnostic>& warnings) {
    const bool is_heat = !entry.temperature.empty();
    const std::string name = is_heat ? entry.temperature : entry.emission;
    if (name.empty()) return ok_status();
    const auto refuse = [&](std::string fault, std::string remedy) {
        return make_error(ErrorKind::bad_input, file.string(), "grid " + in_quotes(name),
                          std::move(fault), std::move(remedy));
    };
    const std::vector<std::string> names{name};
    auto read = read_vdb(file, names, reader);
    if (!read) return std::move(read).error();
    const VdbGrid& grid = read->front();
    warn_of_repairs(file, grid, warnings);
    if (is_heat && grid.is_color) {
        return refuse("it holds colours, not temperatures", "name a grid of one float a voxel");
    }
    const Resampler values(grid, density_space);
    // Only what absorbs glows by its heat.
    const auto reach =
        is_heat ? std::optional(box_of(volume.density)) : reach_of(grid, density_space);
    // Bricks that are looked at are bounded, whatever the file says.
    if (!reach || join(*reach, box_of(volume.density)).cells() > vdb::kMaxTableBricks ||
        (!values.is_same && !is_heat && reach->cells() > vdb::kMaxBricks)) {
        return refuse("it takes too many voxels of the density's size",
                      "write it with the voxels of the density, or cut off what lies far away");
    }
    double hottest = 0;
    if (is_heat) {
        hottest = entry.temperature_scale *
                  static_cast<double>(*std::ranges::max_element(grid.scalar.value));
        if (!(hottest <= media::kMaxTemperature)) {
            return refuse("it is hotter than 100000 K",
                          "give temperature_scale, kelvin for a value of 1");
        }
    }
    warn_of_lost_detail(file, values, warnings);
    const Color sigma_t = to_vec3(volume.sigma_t);
    const Color absorbed = (Color(1) - to_vec3(volume.albedo)) * sigma_t;
    const auto absorption_at = [&](glm::ivec3 voxel) {
        const float density = volume.density.at(voxel);
        return volume.scattering.empty()
                   ? density * absorbed
                   : glm::max(Color(density) - volume.scattering.at(voxel), 0.0f) * sigma_t;
    };
    const HeatColors heat(hottest);
    const auto scale = static_cast<float>(entry.emission_scale);
    float most = 0;
    Emission emission = fill_bricks(
        *reach,
        [&](glm::ivec3 brick) {
            return values.may_reach(brick) &&
                   (!is_heat || volume.density.brick_at(brick) != Emission::kEmpty);
        },
        [&](glm::ivec3 voxel) {
            Color radiance = scale * values.at(voxel);
            if (is_heat) {
                const double kelvin =
                    entry.temperature_scale * static_cast<double>(values.at(voxel).x);
                radiance = scale * absorption_at(voxel) * heat.at(kelvin);
            }
            most = std::max({most, radiance.x, radiance.y, radiance.z});
            return radiance;
        });
    if (!(most <= static_cast<float>(media::kMaxEmission))) {
        return refuse("it sends out more than 1e15 W m^-3 sr^-1", "lower emission_scale");
    }
    if (emission.empty()) {
        warnings.push_back(make_warning(
            file.string(), "grid " + in_quotes(name), "nothing of it is light that can be seen",
            is_heat ? "give temperature_scale, kelvin for a value of 1; only what absorbs glows: "
                      "density above 0, albedo below 1"
                    : "raise emission_scale"));
        return ok_status();
    }
    const BrickBox both = join(box_of(emission), box_of(volume.density));
    widen(emission, both);
    widen(volume.density, both);
    if (!volume.scattering.empty()) widen(volume.scattering, both);
    volume.emission = std::move(emission);
    volume.emitter = file.stem().string();
    return ok_status();
}

Status load_albedo(const VolumeEntry& entry, const std::filesystem::path& file,
                   const glm::dmat4& density_space, const VdbReadOptions& reader, Volume& volume,
                   std::vector<Diagnostic>& warnings) {
    if (entry.albedo_grid.empty()) return ok_status();
    const std::vector<std::string> names{entry.albedo_grid};
    auto read = read_vdb(file, names, reader);
    if (!read) return std::move(read).error();
    const VdbGrid& grid = read->front();
    warn_of_repairs(file, grid, warnings);
    if (!(largest_of(grid) <= 1 + media::kAlbedoRounding)) {
        return make_error(ErrorKind::bad_input, file.string(),
                          "grid " + gltf::in_quotes(entry.albedo_grid), "it holds albedos above 1",
                          "scale it to 0 ... 1");
    }
    const Resampler albedo(grid, density_space);
    warn_of_lost_detail(file, albedo, warnings);
    AlbedoRange range;
    Albedos scattering = scatter(volume.density, albedo, range);
    volume.albedo = {range.most.x, range.most.y, range.most.z};
    if (range.least != range.most) {
        volume.scattering = std::move(scattering);
    }
    return ok_status();
}

}  // namespace opaline::formats
