#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"

namespace opaline::formats {

/// What an `.opal` file holds of stratiform cloud layers; formats/README.md, `CLOU`.

inline constexpr std::uint32_t kMaxLayers = 1;  ///< of a file; layers do not light each other yet
/// Of thickness and ground, along an edge: what every OpenGL 4 takes as a texture.
inline constexpr std::uint32_t kMaxLayerSide = 16384;
inline constexpr std::uint32_t kMaxLayerFrames = 65536;
/// Between frames of thickness [s]: so that times are far below what a double holds.
inline constexpr float kMinFrameSeconds = 1e-3f, kMaxFrameSeconds = 1e9f;
inline constexpr float kMaxLayerLength = 1e9f;      ///< of heights, x, z, sizes [m], wind [m/s]
inline constexpr float kMinLayerSize = 1e-3f;       ///< along x and z [m]
inline constexpr float kMaxLayerExtinction = 1e6f;  ///< of kappa and haze [1/m]

/// What the droplets of a layer do to light of one band. Light that they scatter by less than
/// LayerRecord::peak_angle counts as going straight on: the `rest` is a medium without that forward
/// peak [Bouthors2006]. Droplets absorb nothing.
struct LayerBand {
    float kappa = 0;        ///< extinction [1/m], >= 0
    float peak_weight = 0;  ///< P_f: share of scattered light in the peak, in [0, 1); 0 without one
    float g = 0;            ///< mean cosine, in (-1, 1)
    float reserved = 0;

    /// kappa_S = (1 - P_f) kappa, of the medium without the peak [1/m].
    float rest_kappa() const { return (1 - peak_weight) * kappa; }
};

/// One layer: the space between the height `base` and `base` + thickness(x, z), filled with
/// droplets. Heights and coordinates are the world's [m], +Y is up. Fixed size, stored as is.
struct LayerRecord {
    float base = 0;                 ///< height of the flat lower side
    float ground = 0;               ///< height of the ground, < base
    std::array<float, 2> center{};  ///< x, z at time 0
    /// Along x and z, >= kMinLayerSize; also that of the ground's picture.
    std::array<float, 2> size{};
    std::array<float, 2> wind{};  ///< the layer moves by wind * time [m/s]; the ground stays
    float highest = 0;            ///< thickness of the code 65535, >= 0
    float peak_angle = 0;         ///< theta_f [rad], in [0, pi / 2)
    float haze = 0;               ///< extinction of the air below and above it [1/m], >= 0
    std::uint32_t flags = 0;      ///< kRepeat, kRadiosity, kLoop, kPaper
    /// Of the thickness and of the ground's albedo, along x and z: 1 ... kMaxLayerSide.
    std::uint32_t columns = 0, rows = 0;
    std::uint32_t ground_columns = 0, ground_rows = 0;
    std::uint32_t phase_angles = 0;                   ///< 2 or more
    std::uint32_t glow_angles = 0, glow_events = 0;   ///< both 0 (peak_angle 0), or 2 or more
    std::uint32_t flux_depths = 0, flux_cosines = 0;  ///< 2 or more
    /// All 0: light that was scattered twice or more is left out. Otherwise 2, 2, 1 or more.
    std::uint32_t radiance_depths = 0, radiance_cosines = 0, radiance_modes = 0;
    std::array<LayerBand, 3> band{};
    std::uint64_t first_thickness = 0;  ///< among CloudsView::thickness
    std::uint64_t first_ground = 0;     ///< among CloudsView::ground
    std::uint64_t first_value = 0;      ///< among CloudsView::value
    /// Frames of thickness, 1 ... kMaxLayerFrames: one after another, all of columns x rows codes.
    std::uint32_t frames = 1;
    float frame_seconds = 0;  ///< from one frame to the next [s]; 0 where there is one only

    static constexpr std::uint32_t kRepeat = 1;     ///< goes on beyond its size, over and over
    static constexpr std::uint32_t kRadiosity = 2;  ///< ground and base light each other
    /// The first frame follows on the last one, over and over; else the last one stays.
    static constexpr std::uint32_t kLoop = 4;
    /// The tables hold printed forms of [Bouthors2006]: said of the file, nothing is read
    /// otherwise.
    static constexpr std::uint32_t kPaper = 256;

    bool repeats() const { return (flags & kRepeat) != 0; }
    bool has_radiosity() const { return (flags & kRadiosity) != 0; }
    bool is_paper() const { return (flags & kPaper) != 0; }
    bool loops() const { return (flags & kLoop) != 0; }
    /// Codes of one frame.
    std::size_t frame_count() const { return std::size_t{columns} * rows; }
    /// Codes of all frames.
    std::size_t thickness_count() const { return frame_count() * frames; }
    std::size_t ground_count() const { return std::size_t{ground_columns} * ground_rows; }
    std::size_t glow_count() const { return std::size_t{glow_angles} * glow_events; }
    std::size_t flux_count() const { return std::size_t{flux_depths} * flux_cosines; }
    /// Of one side.
    std::size_t radiance_count() const {
        return std::size_t{radiance_depths} * radiance_modes * radiance_cosines * radiance_cosines;
    }
    /// Of one band: phase, glow, T_1, T_ms, R_1, mean transmittance, radiance of both sides.
    std::size_t band_values() const {
        return phase_angles + glow_count() + 3 * flux_count() + flux_depths + 2 * radiance_count();
    }
    std::size_t value_count() const { return 3 * band_values(); }
};
static_assert(sizeof(LayerRecord) == 176);

/// The tables of one band of a layer. All are functions of kappa_S, not of kappa, and of P_S, the
/// phase function without its peak, which integrates to 1 over the sphere.
struct LayerTables {
    /// log of the whole phase function P [1/sr] at angles pi u^2 (3 - 2 u), u = i / (count - 1);
    /// linear in u between them. P_S = P / (1 - P_f) beyond peak_angle, 0 within.
    std::span<const float> log_phase;
    /// Light scattered by the peak alone, once or more often, per unit of incoming light [1/sr]:
    /// [event * glow_angles + angle], at angles 4 peak_angle s^2, s = i / (glow_angles - 1), for u
    /// = 12 q^2 events on the way, q = j / (glow_events - 1). Linear in s and q; 0 beyond.
    std::span<const float> glow;
    /// Shares of a beam's flux: [depth * flux_cosines + cosine], where the optical depth tau =
    /// kappa_S H has tau / (1 + tau) = i / (flux_depths - 1), and sqrt(cosine) = j / (flux_cosines
    /// - 1). T_ms holds all that is transmitted, T_0 = exp(-tau / cosine) included. By reciprocity
    /// T_ms and 1 - T_ms at the cosine of a view are the radiance under even light of radiance 1.
    std::span<const float> t1, t_ms, r1;
    std::span<const float> mean_t;  ///< [depth]: T of even light over the hemisphere
    /// Radiance of light that was scattered twice or more; empty where it is left out:
    /// [((depth * modes + m) * cosines + view) * cosines + light]. Depths as above; cosine j is
    /// s^2 (3 - 2 s), s = j / (cosines - 1), but at least 1e-3. With phi between the horizontal
    /// directions that both travel in, X = tau / cosine and E the irradiance facing the light,
    /// L = E mu_l (1 - exp(-X_l - X_v)) / (mu_l + mu_v) / pi * sum over m of value cos(m phi).
    std::span<const float> reflected, transmitted;
};

/// All layers of an asset as spans, into the bytes of a file or into `Clouds`. Immutable.
struct CloudsView {
    std::span<const LayerRecord> records;
    /// Codes of thickness: highest * code / 65535 at the centres of columns x rows cells of `size`,
    /// x fastest, rows toward +z; bilinear. Where the layer does not repeat, cells beyond are 0.
    /// Frame after frame: the first one is of time 0, linear in time between two.
    std::span<const std::uint16_t> thickness;
    std::span<const std::array<std::uint8_t, 4>> ground;  ///< sRGB codes of albedo; last byte 255
    std::span<const float> value;                         ///< tables, see tables_of

    bool empty() const { return records.empty(); }
    std::span<const std::uint16_t> thickness_of(const LayerRecord& record) const {
        return thickness.subspan(record.first_thickness, record.thickness_count());
    }
    std::span<const std::array<std::uint8_t, 4>> ground_of(const LayerRecord& record) const {
        return ground.subspan(record.first_ground, record.ground_count());
    }
};

/// `band` in 0..2. Precondition: the record's counts fit the view.
LayerTables tables_of(const CloudsView& clouds, const LayerRecord& record, std::size_t band);

/// Owning twin of `CloudsView`: what the baker builds.
struct Clouds {
    std::vector<LayerRecord> records;
    std::vector<std::uint16_t> thickness;
    std::vector<std::array<std::uint8_t, 4>> ground;
    std::vector<float> value;

    CloudsView view() const { return {records, thickness, ground, value}; }
};

}  // namespace opaline::formats
