#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "bake/receivers/receiver.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {

struct BounceLight;   // exchange/bounce_light.h
struct DensitySpace;  // transport/density/density_space.h
struct TestLight;     // truth/test_lights.h

/// Where light is asked for, outside of any boundary.
struct LitPoint {
    const Receiver& receiver;
    /// One of many points whose light is averaged, as the samples of a medium: each may be noisy.
    bool is_averaged = false;
};

/// A straight look at whatever surface is there.
struct SurfaceView {
    glm::vec3 origin{0}, direction{0};  ///< [m], clear of the surface it starts at; unit
    std::array<float, 3> weight{};      ///< of what is seen, by band of the rows
    std::span<const float> factor{};    ///< of each row
};

/// Light that arrives at surfaces besides that of the distant environment, or instead of it: light
/// that other surfaces reflect, or that emitters send. Effects that turn irradiance into rows add
/// it to that of the environment. Its directions are not kept: effects take it for diffuse.
struct OtherLight {
    /// Adds E(x), the irradiance per unit of each basis light, to `rows`: `bands` planes of 6 n n
    /// Haar coefficients of T's basis, n = `cubemap_size`. Returns the rays traced. Any thread; the
    /// same bits for the same point. With `environment` false the columns may stand for anything
    /// that is linear, as emitters, and n for any number of columns.
    std::function<std::uint64_t(const LitPoint& point, std::uint32_t cubemap_size,
                                std::span<float> rows)>
        add;
    /// For truths, by a way that shares nothing with `add`: adds the luminance of the irradiance
    /// under each of the lights, the mean of `count` independent samples keyed by `key`.
    using TrueIrradiance = std::function<std::uint64_t(
        const Receiver& at, std::uint64_t key, std::uint32_t count, std::span<double> irradiance)>;
    /// `lights` and the volumes `between` (BakeInputs) must outlive the result. Null: truths leave
    /// the light out.
    std::function<TrueIrradiance(std::span<const TestLight> lights, const DensitySpace* between)>
        make_truth{};
    /// Adds the radiance that views see per unit of each basis light, times their weights and
    /// factors: to `rows`, a row for each factor, `bands` planes each as of `add`. `solid_angle`
    /// [sr]: of what each view stands for. Returns the rays traced. Any thread. Empty: it is not
    /// known what is seen.
    std::function<std::uint64_t(std::span<const SurfaceView> views, double solid_angle,
                                std::uint32_t cubemap_size, std::uint32_t bands,
                                std::span<float> rows)>
        add_seen{};
    /// The same for truths, of one view: adds the luminance of `weight` times the radiance under
    /// each of the lights, by one sample keyed by `key` and `number`.
    using TrueView =
        std::function<std::uint64_t(const Receiver& along, formats::Rgb weight, std::uint64_t key,
                                    std::uint32_t number, std::span<double> luminance)>;
    /// As make_truth; `along`: origin and direction of the view. Empty where `add_seen` is.
    std::function<TrueView(std::span<const TestLight> lights, const DensitySpace* between)>
        make_seen_truth{};
    std::string_view name{};  ///< of what makes it, for reports
    /// 3, or 1 where the three coincide. With 3, rows of all receivers have three bands as well
    /// (RowLayout::coloured).
    std::uint32_t bands = 3;
    bool environment = true;  ///< that of the environment counts, too
    /// By material: 1 where it is not worth the rays. Empty: it is everywhere.
    std::vector<std::uint8_t> unreached{};
    const BounceLight* surfaces = nullptr;  ///< that it comes from; null: from no surfaces

    /// Whether the environment counts; `light` null: nothing else does.
    static bool has_environment(const OtherLight* light) {
        return light == nullptr || light->environment;
    }
};

}  // namespace opaline::bake
