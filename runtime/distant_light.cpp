#include "runtime/distant_light.h"

#include <algorithm>
#include <utility>

#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "runtime/integrate_discs.h"

namespace opaline::runtime {

using formats::DistantDisc;
using formats::Environment;

namespace {

// What mirrors see of a map that may be negative in places.
Environment without_negative(Environment map) {
    for (formats::Rgb& c : map.pixel) {
        c = {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)};
    }
    return map;
}

// The mean radiance of texels, back from coefficients.
Environment cube_of(std::span<const float> rgb, std::uint32_t n) {
    Environment cube;
    cube.layout = Environment::Layout::cube;
    cube.width = n;
    cube.height = formats::kCubeFaces * n;
    cube.pixel.resize(formats::cubemap_texels(n));
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    const std::size_t size = solid_angle.size();
    std::vector<double> face(size), scratch(size);
    for (std::size_t f = 0; f < formats::kCubeFaces; ++f) {
        for (std::size_t band = 0; band < 3; ++band) {
            for (std::size_t j = 0; j < size; ++j) {
                face[j] = static_cast<double>(rgb[3 * (f * size + j) + band]);
            }
            formats::haar_inverse(std::span<double>(face), n, scratch);
            for (std::size_t j = 0; j < size; ++j) {
                formats::Rgb& pixel = cube.pixel[f * size + j];
                const auto radiance = static_cast<float>(face[j] / solid_angle[j]);
                (band == 0 ? pixel.r : band == 1 ? pixel.g : pixel.b) = radiance;
            }
        }
    }
    return cube;
}

}  // namespace

DistantLight::DistantLight(std::uint32_t n, SpecularNeeds needs) : needs_(std::move(needs)) {
    const std::size_t texels = formats::cubemap_texels(n);
    map_integral_.resize(3 * texels);
    new_integral_.resize(3 * texels);
    with_discs_.resize(3 * texels);
    scratch_.resize(texels);
    vector_ = new_vector_ = {n, std::vector<float>(4 * texels)};
    clear(1);
}

// Sets new_integral_.
void DistantLight::integrate(const MapOfLight& map, MapSampling sampling, const Rotation& rotation,
                             unsigned threads) {
    std::fill(new_integral_.begin(), new_integral_.end(), 0.0);
    if (map.harmonics) {
        integrate_harmonics(*map.harmonics, n(), rotation, threads, new_integral_);
    } else {
        integrate_map(map.pixels, sampling, rotation, threads, new_integral_);
    }
}

// Sets new_vector_ from new_integral_.
void DistantLight::project(const std::vector<DistantDisc>& discs, const Rotation& rotation) {
    std::copy(new_integral_.begin(), new_integral_.end(), with_discs_.begin());
    integrate_discs(discs, n(), rotation, scratch_, with_discs_);
    fill_light_vector(with_discs_, scratch_, new_vector_);
}

void DistantLight::turn(const Rotation& rotation, MapSampling sampling, unsigned threads) {
    integrate(map_, sampling, rotation, threads);
    project(discs_, rotation);
    rotation_ = specular_.rotation = rotation;
    map_integral_.swap(new_integral_);
    std::swap(vector_, new_vector_);
}

void DistantLight::replace_map(MapOfLight map, const std::vector<DistantDisc>& discs,
                               unsigned threads) {
    SpecularLight specular = make_specular_light(map.source, discs, needs_, rotation_, threads);
    integrate(map, MapSampling::full, rotation_, threads);
    project(discs, rotation_);
    map_ = std::move(map);
    if (&discs != &discs_) discs_ = discs;  // nothing, or no more than there were
    specular_ = std::move(specular);
    map_integral_.swap(new_integral_);
    std::swap(vector_, new_vector_);
}

void DistantLight::replace_discs(std::vector<DistantDisc> discs, unsigned threads) {
    SpecularLight specular = make_specular_light(map_.source, discs, needs_, rotation_, threads);
    std::copy(map_integral_.begin(), map_integral_.end(), new_integral_.begin());
    project(discs, rotation_);
    discs_ = std::move(discs);
    specular_ = std::move(specular);
    std::swap(vector_, new_vector_);
}

void DistantLight::set_map(const Environment& map, unsigned threads) {
    replace_map({prepare_map(map, n(), threads), {}, integrate_for_specular(map, needs_, threads)},
                discs_, threads);
}

void DistantLight::set_harmonics(const Harmonics& harmonics, unsigned threads) {
    SpecularSource source;
    if (needs_.any()) {
        source = integrate_for_specular(sample_harmonics(harmonics), needs_, threads);
    }
    replace_map({{}, harmonics, std::move(source)}, discs_, threads);
}

void DistantLight::set_coefficients(std::span<const float> rgb, unsigned threads) {
    const Environment cube = cube_of(rgb, n());
    replace_map({prepare_map(cube, n(), threads),
                 {},
                 integrate_for_specular(without_negative(cube), needs_, threads)},
                discs_, threads);
}

void DistantLight::add_sun(const DistantDisc& sun, unsigned threads) {
    std::vector<DistantDisc> discs = discs_;
    discs.push_back(sun);
    replace_discs(std::move(discs), threads);
}

void DistantLight::set_sun(std::size_t index, const DistantDisc& sun, unsigned threads) {
    std::vector<DistantDisc> discs = discs_;
    discs[index] = sun;
    replace_discs(std::move(discs), threads);
}

void DistantLight::clear(unsigned threads) {
    replace_map({{}, {}, integrate_for_specular({}, needs_, threads)}, {}, threads);
}

}  // namespace opaline::runtime
