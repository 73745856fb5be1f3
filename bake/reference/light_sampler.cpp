#include "bake/reference/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>

namespace opaline::bake {
namespace {

constexpr double kUniformShare = 1.0 / 16;

formats::Vec3 to_vec3(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

float brightness(formats::Rgb c) {
    return c.r + c.g + c.b;
}

// Cells are uniform in longitude and in y: each has the same solid angle.
glm::vec3 cell_direction(float column, float row, float columns, float rows) {
    const float y = 1 - 2 * row / rows, phi = 2 * std::numbers::pi_v<float> * column / columns;
    const float r = std::sqrt(std::max(0.0f, 1 - y * y));
    return {r * std::cos(phi), y, r * std::sin(phi)};
}

// The mean of each cell, smoothed over its neighbours: interpolation of the map carries a pixel's
// light beyond its cell.
std::vector<float> cell_weights(const formats::Environment& map, std::uint32_t columns,
                                std::uint32_t rows) {
    std::vector<float> mean(std::size_t{columns} * rows), spread(mean.size());
    const auto width = static_cast<float>(columns), height = static_cast<float>(rows);
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            for (const float dx : {0.25f, 0.75f}) {
                for (const float dy : {0.25f, 0.75f}) {
                    const glm::vec3 d = cell_direction(static_cast<float>(i) + dx,
                                                       static_cast<float>(j) + dy, width, height);
                    mean[std::size_t{j} * columns + i] +=
                        brightness(formats::sample_map(map, to_vec3(d)));
                }
            }
        }
    }
    for (std::uint32_t j = 0; j < rows; ++j) {
        for (std::uint32_t i = 0; i < columns; ++i) {
            float sum = 0;
            for (const std::uint32_t y : {j > 0 ? j - 1 : j, j, j + 1 < rows ? j + 1 : j}) {
                for (const std::uint32_t x : {(i + columns - 1) % columns, i, (i + 1) % columns}) {
                    sum += mean[std::size_t{y} * columns + x];
                }
            }
            spread[std::size_t{j} * columns + i] = sum + 9 * mean[std::size_t{j} * columns + i];
        }
    }
    return spread;
}

std::pair<std::size_t, std::size_t> cell_of(const LightSampler& light, glm::vec3 d) {
    const float turn = std::atan2(d.z, d.x) / (2 * std::numbers::pi_v<float>);
    const float x = (turn - std::floor(turn)) * static_cast<float>(light.columns);
    const float y = 0.5f * (1 - d.y) * static_cast<float>(light.rows);
    const auto column = std::min(static_cast<std::uint32_t>(std::max(x, 0.0f)), light.columns - 1);
    const auto row = std::min(static_cast<std::uint32_t>(std::max(y, 0.0f)), light.rows - 1);
    return {column, row};
}

bool is_in_disc(const formats::DistantDisc& disc, glm::vec3 d) {
    // Compare chords in double precision, because the cosine of the sun's radius differs from 1 by
    // 1e-5 only.
    const glm::dvec3 axis(disc.direction.x, disc.direction.y, disc.direction.z);
    return glm::length(glm::dvec3(d) - axis) <=
           2 * std::sin(0.5 * static_cast<double>(disc.angular_radius));
}

glm::vec3 sample_disc(const formats::DistantDisc& disc, float u, float v) {
    const glm::vec3 axis(disc.direction.x, disc.direction.y, disc.direction.z);
    // 1 - cos is uniform in [0, 1 - cos r]; computed directly, because 1 - cos would cancel.
    const double s = std::sin(0.5 * static_cast<double>(disc.angular_radius));
    const double drop = 2 * s * s * static_cast<double>(u);
    const auto sine = static_cast<float>(std::sqrt(drop * (2 - drop)));
    const glm::vec3 other = std::abs(axis.x) > 0.5f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 t = glm::normalize(glm::cross(other, axis)), b = glm::cross(axis, t);
    const float phi = 2 * std::numbers::pi_v<float> * v;
    return glm::normalize(static_cast<float>(1 - drop) * axis +
                          sine * (std::cos(phi) * t + std::sin(phi) * b));
}

// Turns weights into cumulative shares of their sum, the last exactly 1; equal shares if all are 0.
void accumulate(std::span<const float> weight, std::span<double> cumulative) {
    double sum = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) {
        sum += static_cast<double>(weight[i]);
        cumulative[i] = sum;
    }
    for (std::size_t i = 0; i < weight.size(); ++i) {
        cumulative[i] = sum > 0 ? cumulative[i] / sum
                                : static_cast<double>(i + 1) / static_cast<double>(weight.size());
    }
    cumulative.back() = 1;
}

std::size_t find_share(std::span<const double> cumulative, double u) {
    const auto above = std::upper_bound(cumulative.begin(), cumulative.end() - 1, u);
    return static_cast<std::size_t>(above - cumulative.begin());
}

double share(std::span<const double> cumulative, std::size_t i) {
    return i == 0 ? cumulative[0] : cumulative[i] - cumulative[i - 1];
}

std::span<const double> row_of(const LightSampler& light, std::size_t row) {
    return std::span(light.column_cumulative).subspan(row * light.columns, light.columns);
}

}  // namespace

LightSampler make_light_sampler(const formats::Environment& environment,
                                const glm::mat3& world_from_light) {
    LightSampler light;
    light.environment = &environment;
    light.world_from_light = world_from_light;
    double map_power = 0, power = 0;
    if (!environment.pixel.empty()) {
        light.columns = std::clamp(2 * environment.width, 64u, 1024u);
        light.rows = light.columns / 2;
        const std::vector<float> weight = cell_weights(environment, light.columns, light.rows);
        light.column_cumulative.resize(weight.size());
        light.row_cumulative.resize(light.rows);
        std::vector<float> row_weight;
        for (std::uint32_t j = 0; j < light.rows; ++j) {
            const auto row =
                std::span(weight).subspan(std::size_t{j} * light.columns, light.columns);
            row_weight.push_back(std::accumulate(row.begin(), row.end(), 0.0f));
            accumulate(row, std::span(light.column_cumulative)
                                .subspan(std::size_t{j} * light.columns, light.columns));
            map_power += static_cast<double>(row_weight.back());
        }
        accumulate(row_weight, light.row_cumulative);
        // Each of a cell's 4 points has weight 9 + 9.
        map_power *= 4 * std::numbers::pi / (72.0 * static_cast<double>(weight.size()));
    }
    power = map_power;
    for (const formats::DistantDisc& disc : environment.discs) {
        light.disc_solid_angle.push_back(formats::disc_solid_angle(disc.angular_radius));
        light.disc_probability.push_back(static_cast<double>(brightness(disc.radiance)) *
                                         light.disc_solid_angle.back());
        power += light.disc_probability.back();
    }
    for (double& p : light.disc_probability) {
        p = power > 0 ? p / power : 0;
    }
    light.map_probability = power > 0 ? map_power / power : 0;
    return light;
}

glm::vec3 eval_light(const LightSampler& light, glm::vec3 direction) {
    const glm::vec3 d = direction * light.world_from_light;  // the inverse is the transpose
    const formats::Rgb map = formats::sample_map(*light.environment, to_vec3(d));
    glm::vec3 radiance(map.r, map.g, map.b);
    for (const formats::DistantDisc& disc : light.environment->discs) {
        if (is_in_disc(disc, d)) {
            radiance += glm::vec3(disc.radiance.r, disc.radiance.g, disc.radiance.b);
        }
    }
    return radiance;
}

glm::vec3 sample_light(const LightSampler& light, RandomStream& random) {
    if (light.map_probability <= 0 && light.disc_probability.empty()) return glm::vec3(0);
    const glm::dvec2 choices(random.next_pair());
    const glm::vec2 place = random.next_pair();
    double choice = choices.x;
    for (std::size_t i = 0; i < light.disc_probability.size(); ++i) {
        if (choice < light.disc_probability[i]) {
            return light.world_from_light *
                   sample_disc(light.environment->discs[i], place.x, place.y);
        }
        choice -= light.disc_probability[i];
    }
    if (light.map_probability <= 0) return glm::vec3(0);
    if (choices.y < kUniformShare) {
        return light.world_from_light * cell_direction(place.x, place.y, 1, 1);
    }
    const std::size_t row = find_share(light.row_cumulative, static_cast<double>(place.x));
    const std::size_t column = find_share(row_of(light, row), static_cast<double>(place.y));
    const glm::vec2 within = random.next_pair();
    const float x = static_cast<float>(column) + within.x;
    const float y = static_cast<float>(row) + within.y;
    return light.world_from_light *
           cell_direction(x, y, static_cast<float>(light.columns), static_cast<float>(light.rows));
}

float pdf_light(const LightSampler& light, glm::vec3 direction) {
    const glm::vec3 d = direction * light.world_from_light;
    double pdf = 0;
    if (light.map_probability > 0) {
        const auto [column, row] = cell_of(light, d);
        const double cells = static_cast<double>(light.columns) * light.rows;
        const double relative =
            share(light.row_cumulative, row) * share(row_of(light, row), column) * cells;
        pdf = light.map_probability * ((1 - kUniformShare) * relative + kUniformShare) /
              (4 * std::numbers::pi);
    }
    for (std::size_t i = 0; i < light.disc_probability.size(); ++i) {
        if (is_in_disc(light.environment->discs[i], d)) {
            pdf += light.disc_probability[i] / light.disc_solid_angle[i];
        }
    }
    return static_cast<float>(pdf);
}

}  // namespace opaline::bake
