#include "bake/physics/mie/angular_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bake/physics/gauss_legendre.h"
#include "bake/physics/phase.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

/// int of the interpolant over the cosine between two angles with values p and q.
double integrate_interval(double from, double p, double to, double q) {
    return cosine_difference(from, to) * (p + q) / 2;
}

/// Value at an angle between two rows.
double interpolate_rows(const AngularTable& table, std::size_t i, double angle) {
    const double t = cosine_difference(table.angle[i], angle) /
                     cosine_difference(table.angle[i], table.angle[i + 1]);
    return std::lerp(table.value[i], table.value[i + 1], std::clamp(t, 0.0, 1.0));
}

/// The interval that an angle within the table lies in.
std::size_t interval_of(const AngularTable& table, double angle) {
    const auto above = std::upper_bound(table.angle.begin() + 1, table.angle.end() - 1, angle);
    return static_cast<std::size_t>(above - table.angle.begin()) - 1;
}

/// Adds weight P_l(cosine) to sum[l] for all l.
void add_polynomials(double cosine, double weight, std::vector<double>& sum) {
    double before = 0, now = weight;
    for (std::size_t l = 0; l < sum.size(); ++l) {
        sum[l] += now;
        const auto degree = static_cast<double>(l);
        const double next = ((2 * degree + 1) * cosine * now - degree * before) / (degree + 1);
        before = now;
        now = next;
    }
}

bool is_between(const AngularTable& table, std::size_t i, std::size_t j, double tolerance) {
    const double width = cosine_difference(table.angle[i], table.angle[j]);
    for (std::size_t k = i + 1; k < j; ++k) {
        const double t = cosine_difference(table.angle[i], table.angle[k]) / width;
        const double line = std::lerp(table.value[i], table.value[j], t);
        if (!(std::abs(line - table.value[k]) <= tolerance * table.value[k])) return false;
    }
    return true;
}

}  // namespace

double cosine_difference(double a, double b) {
    return 2 * std::sin((a + b) / 2) * std::sin((b - a) / 2);
}

double integrate_table(const AngularTable& table) {
    return integrate_within(table, pi);
}

double integrate_within(const AngularTable& table, double angle) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < table.angle.size() && table.angle[i] < angle; ++i) {
        const double to = std::min(angle, table.angle[i + 1]);
        sum +=
            integrate_interval(table.angle[i], table.value[i], to, interpolate_rows(table, i, to));
    }
    return 2 * pi * sum;
}

double integrate_cosine(const AngularTable& table) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < table.angle.size(); ++i) {
        const double p = table.value[i], q = table.value[i + 1];
        const double width = cosine_difference(table.angle[i], table.angle[i + 1]);
        const double middle = std::cos(table.angle[i]) - width / 2;
        sum += width * ((p + q) / 2 * middle + (p - q) * width / 12);
    }
    return 2 * pi * sum;
}

double eval_table(const AngularTable& table, double angle) {
    if (!(angle >= table.angle.front() && angle <= table.angle.back())) return 0;
    return interpolate_rows(table, interval_of(table, angle), angle);
}

void scale_table(AngularTable& table, double factor) {
    for (double& value : table.value) {
        value *= factor;
    }
}

std::vector<double> table_moments(const AngularTable& table, unsigned count) {
    std::vector<double> moments(count, 0.0);
    std::vector<GaussLegendre> rules;  // [n - 2] has n nodes
    for (std::size_t i = 0; i + 1 < table.angle.size(); ++i) {
        const double from = table.angle[i], to = table.angle[i + 1];
        // P_l has l / pi oscillations in a radian; in `turns` radians of phase, turns / 2 + 6 nodes
        // of Gauss leave 1e-10 of an oscillating function.
        const double turns = count * (to - from);
        const auto nodes = static_cast<std::size_t>(turns / 2) + 6;
        while (rules.size() + 2 <= nodes) {
            rules.push_back(make_gauss_legendre(static_cast<int>(rules.size()) + 2));
        }
        const GaussLegendre& rule = rules[nodes - 2];
        const double width = cosine_difference(from, to);
        for (std::size_t k = 0; k < rule.node.size(); ++k) {
            const double t = rule.node[k];
            const double value = std::lerp(table.value[i], table.value[i + 1], t);
            add_polynomials(std::cos(from) - t * width, 2 * pi * width * rule.weight[k] * value,
                            moments);
        }
    }
    return moments;
}

PhaseSeries expand_table(const AngularTable& phase, unsigned degrees) {
    // Parseval: sum of (2 l + 1) lambda_l^2 over all degrees is 8 pi^2 int p^2 over the cosine.
    double rest = 0;
    for (std::size_t i = 0; i + 1 < phase.angle.size(); ++i) {
        const double p = phase.value[i], q = phase.value[i + 1];
        rest += 8 * pi * pi * cosine_difference(phase.angle[i], phase.angle[i + 1]) *
                (p * p + p * q + q * q) / 3;
    }
    PhaseSeries series{table_moments(phase, degrees), 0};
    for (std::size_t l = 0; l < series.lambda.size(); ++l) {
        rest -= static_cast<double>(2 * l + 1) * series.lambda[l] * series.lambda[l];
    }
    series.tail = std::max(0.0, rest);
    return series;
}

std::vector<double> sum_moments(std::span<const double> moments, std::span<const double> angles) {
    std::vector<double> values;
    values.reserve(angles.size());
    for (const double angle : angles) {
        values.push_back(eval_zonal(moments, std::cos(angle)));
    }
    return values;
}

AngularTable thin_table(const AngularTable& table, double tolerance) {
    AngularTable thin;
    const std::size_t last = table.angle.size() - 1;
    for (std::size_t at = 0; at < last;) {
        thin.angle.push_back(table.angle[at]);
        thin.value.push_back(table.value[at]);
        std::size_t next = at + 1;
        while (next < last && is_between(table, at, next + 1, tolerance)) {
            ++next;
        }
        at = next;
    }
    thin.angle.push_back(table.angle[last]);
    thin.value.push_back(table.value[last]);
    return thin;
}

AngularTable cut_table(const AngularTable& table, double from, double to) {
    assert(from < to);
    AngularTable part{{from}, {eval_table(table, from)}};
    for (std::size_t i = 0; i < table.angle.size(); ++i) {
        if (table.angle[i] > from && table.angle[i] < to) {
            part.angle.push_back(table.angle[i]);
            part.value.push_back(table.value[i]);
        }
    }
    part.angle.push_back(to);
    part.value.push_back(eval_table(table, to));
    return part;
}

}  // namespace opaline::bake
