#include "bake/trace/density/turn_rule.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace opaline::bake {
namespace {

constexpr std::size_t kMoments = 2 * TurnRule::kMost;

// c[0] + c[1] x + ...
using Polynomial = std::vector<double>;

double eval(const Polynomial& p, double x) {
    double value = 0;
    for (std::size_t i = p.size(); i-- > 0;) {
        value = value * x + p[i];
    }
    return value;
}

Polynomial multiply(const Polynomial& a, const Polynomial& b) {
    Polynomial product(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            product[i + j] += a[i] * b[j];
        }
    }
    return product;
}

// int x^k p(x) dx of the measure with the Legendre moments lambda: Legendre's recursion,
// (2 l + 1) x P_l = (l + 1) P_(l+1) + l P_(l-1), applied k times to the moments.
std::array<double, kMoments> power_moments(std::span<const double, kMoments> lambda) {
    std::array<double, kMoments> power{}, now{};
    std::ranges::copy(lambda, now.begin());
    for (std::size_t k = 0; k < kMoments; ++k) {
        power[k] = now[0];
        const std::array<double, kMoments> before = now;
        for (std::size_t l = 0; l + k + 1 < kMoments; ++l) {
            const auto order = static_cast<double>(l);
            now[l] = ((order + 1) * before[l + 1] + (l > 0 ? order * before[l - 1] : 0)) /
                     (2 * order + 1);
        }
    }
    return power;
}

// The root between two places where the polynomial has different signs.
double find_root(const Polynomial& p, double low, double high) {
    const bool rises = eval(p, high) > 0;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        ((eval(p, middle) > 0) == rises ? high : low) = middle;
    }
    return (low + high) / 2;
}

// Roots of a polynomial of degree n, those of the one before between them; fewer if not all are
// within [-1, 1].
std::vector<double> find_roots(const Polynomial& p, const std::vector<double>& before) {
    std::vector<double> ends{-1};
    ends.insert(ends.end(), before.begin(), before.end());
    ends.push_back(1);
    std::vector<double> roots;
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
        if (eval(p, ends[i]) * eval(p, ends[i + 1]) > 0) break;
        roots.push_back(find_root(p, ends[i], ends[i + 1]));
    }
    return roots;
}

}  // namespace

TurnRule make_turn_rule(std::span<const double, kMoments> lambda) {
    const std::array<double, kMoments> moment = power_moments(lambda);
    const auto integrate = [&](const Polynomial& p) {
        double sum = 0;
        for (std::size_t i = 0; i < p.size(); ++i) {
            sum += p[i] * moment[i];
        }
        return sum;
    };
    // Monic orthogonal polynomials p_n: those of a positive measure have squares above 0, and
    // roots within [-1, 1]; these are the cosines.
    constexpr double kLeastSquare = 1e-9;
    Polynomial last, p{1};
    double last_square = 1;
    std::vector<double> cosine;
    while (cosine.size() < TurnRule::kMost) {
        const double square = integrate(multiply(p, p));
        if (!(square > kLeastSquare)) break;
        Polynomial next = multiply(p, {-integrate(multiply({0, 1}, multiply(p, p))) / square, 1});
        for (std::size_t i = 0; i < last.size(); ++i) {
            next[i] -= square / last_square * last[i];
        }
        std::vector<double> roots = find_roots(next, cosine);
        if (roots.size() <= cosine.size()) break;
        cosine = std::move(roots);
        last = std::exchange(p, std::move(next));
        last_square = square;
    }
    TurnRule rule;
    double sum = 0;
    for (const double own : cosine) {
        // The integral of the polynomial that is 1 here and 0 at the other cosines.
        Polynomial lagrange{1};
        for (const double other : cosine) {
            if (other != own) {
                lagrange = multiply(lagrange, {-other / (own - other), 1 / (own - other)});
            }
        }
        sum += integrate(lagrange);
        rule.cosine[rule.count] = static_cast<float>(own);
        rule.below[rule.count] = static_cast<float>(sum);
        ++rule.count;
    }
    rule.below[rule.count - 1] = 1;
    return rule;
}

}  // namespace opaline::bake
