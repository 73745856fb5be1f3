#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "runtime/integrate_map.h"
#include "runtime/light_vector.h"
#include "runtime/specular.h"

namespace opaline::runtime {

/// Radiance sum_k c_k Y_k(w) [W m^-2 sr^-1], w in the light's frame, of degrees 0, 1 and 2: Y_k as
/// in formats/opal/spherical_harmonics.h. Negative where the expansion rings.
using Harmonics = std::array<formats::Rgb, 9>;

/// Adds the integral over each of the 6 n n texels, integral[3 j + band] [W m^-2], to 1e-5 of the
/// largest. `threads` 0: all cores; the result has the same bits for any number. Never allocates on
/// one thread.
void integrate_harmonics(const Harmonics& harmonics, std::uint32_t n, const Rotation& rotation,
                         unsigned threads, std::span<double> integral);

/// The radiance as a cube map of 32 x 32 texels a face, in the light's frame, negative values as 0.
formats::Environment sample_harmonics(const Harmonics& harmonics);

/// What shines besides suns, in the light's frame.
struct MapOfLight {
    PreparedMap pixels;
    std::optional<Harmonics> harmonics;  ///< if set, instead of pixels
    SpecularSource source;               ///< what mirrors see of it
};

/// Distant light in the basis of one asset, kept so that each change costs what it changed: a turn
/// neither the map's preparation nor a blur, a sun no map. The functions below give the strong
/// guarantee: they throw nothing but for lack of memory, and then the light is as it was.
class DistantLight {
  public:
    /// Black. n: of the basis.
    DistantLight(std::uint32_t n, SpecularNeeds needs);

    const LightVector& vector() const { return vector_; }
    const SpecularLight& specular() const { return specular_; }
    const SpecularNeeds& needs() const { return needs_; }
    std::uint32_t n() const { return vector_.n; }

    /// `moving` as in integrate_map.h: allocates nothing on one thread.
    void turn(const Rotation& rotation, MapSampling sampling, unsigned threads);
    void set_map(const formats::Environment& map, unsigned threads);
    void set_harmonics(const Harmonics& harmonics, unsigned threads);
    /// 6 n n coefficients of the unturned light, r g b (light_vector.h).
    void set_coefficients(std::span<const float> rgb, unsigned threads);
    void add_sun(const formats::DistantDisc& sun, unsigned threads);
    /// Precondition: there is a sun of that index.
    void set_sun(std::size_t index, const formats::DistantDisc& sun, unsigned threads);
    std::size_t suns() const { return discs_.size(); }
    /// Back to black; the rotation stays.
    void clear(unsigned threads);

  private:
    void integrate(const MapOfLight& map, MapSampling sampling, const Rotation& rotation,
                   unsigned threads);
    void project(const std::vector<formats::DistantDisc>& discs, const Rotation& rotation);
    void replace_map(MapOfLight map, const std::vector<formats::DistantDisc>& discs,
                     unsigned threads);
    void replace_discs(std::vector<formats::DistantDisc> discs, unsigned threads);

    SpecularNeeds needs_;
    Rotation rotation_;
    MapOfLight map_;
    std::vector<formats::DistantDisc> discs_;
    std::vector<double> map_integral_;  // under the rotation
    LightVector vector_;
    SpecularLight specular_;
    // What a change makes before it takes the place of the above; of the same sizes.
    std::vector<double> new_integral_, with_discs_, scratch_;
    LightVector new_vector_;
};

}  // namespace opaline::runtime
