#include "runtime/distant_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "formats/opal/spherical_harmonics.h"
#include "runtime/integrate_discs.h"
#include "runtime/parallel.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;

Rgb radiance_at(const Harmonics& harmonics, Vec3 w) {
    std::array<float, 9> value;
    formats::eval_spherical_harmonics(w, value);
    Rgb sum;
    for (std::size_t k = 0; k < value.size(); ++k) {
        sum = sum + value[k] * harmonics[k];
    }
    return sum;
}

}  // namespace

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

void integrate_harmonics(const Harmonics& harmonics, std::uint32_t n, const Rotation& rotation,
                         unsigned threads, std::span<double> integral) {
    // Gauss's two points a side, of as many parts of a texel as make parts of 1 / 16 at most.
    const std::uint32_t parts = std::max(32 / n, 1u), points = 2 * parts;
    const double width = 2.0 / n, part = width / parts, offset = 0.5 / std::sqrt(3.0);
    const auto point_at = [&](std::uint32_t texel, std::uint32_t i) {
        const std::uint32_t number = i / 2;
        return texel * width - 1 + (number + 0.5 + (i % 2 == 0 ? -offset : offset)) * part;
    };
    for_ranges(n, 1, threads, [&](std::uint32_t row, std::uint32_t) {
        for (std::uint32_t column = 0; column < n; ++column) {
            const double u = column * width - 1, v = row * width - 1;
            const double solid_angle = formats::rectangle_solid_angle(u, v, u + width, v + width);
            for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
                std::array<double, 3> sum{};
                double weight = 0;
                for (std::uint32_t i = 0; i < points * points; ++i) {
                    const Vec3 at = formats::cube_position(
                        {face, static_cast<float>(point_at(column, i % points)),
                         static_cast<float>(point_at(row, i / points))});
                    const float shrink = 1 / length(at);
                    const auto density = static_cast<double>(shrink * shrink * shrink);
                    const Rgb c = radiance_at(harmonics, rotation.light_from_world(shrink * at));
                    sum[0] += density * static_cast<double>(c.r);
                    sum[1] += density * static_cast<double>(c.g);
                    sum[2] += density * static_cast<double>(c.b);
                    weight += density;
                }
                double* texel = &integral[((std::size_t{face} * n + row) * n + column) * 3];
                for (std::size_t band = 0; band < 3; ++band) {
                    texel[band] += solid_angle / weight * sum[band];
                }
            }
        }
    });
}

formats::Environment sample_harmonics(const Harmonics& harmonics) {
    constexpr std::uint32_t kSize = 32;
    formats::Environment map;
    map.layout = formats::Environment::Layout::cube;
    map.width = kSize;
    map.height = formats::kCubeFaces * kSize;
    map.pixel.reserve(formats::cubemap_texels(kSize));
    for (std::uint32_t j = 0; j < formats::cubemap_texels(kSize); ++j) {
        const Rgb c = radiance_at(
            harmonics,
            formats::texel_direction(kSize, j / (kSize * kSize), j / kSize % kSize, j % kSize));
        map.pixel.push_back({std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)});
    }
    return map;
}

}  // namespace opaline::runtime
