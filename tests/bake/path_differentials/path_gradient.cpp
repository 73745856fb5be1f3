#include "tests/bake/path_differentials/path_gradient.h"

namespace opaline::bake {
namespace {

/// Smith's Lambda at a cosine, and its change: G1 = 1 / (1 + Lambda).
struct SmithLambda {
    double value = 0, change = 0;
};

SmithLambda smith_lambda(double cosine, double dcosine, double alpha) {
    const double tangent2 = 1 / (cosine * cosine) - 1;
    const double root = std::sqrt(1 + alpha * alpha * tangent2);
    return {(root - 1) / 2, -alpha * alpha * dcosine / (2 * cosine * cosine * cosine * root)};
}

double dln_normal_density(const glm::dvec3& N, const glm::dvec3& dN, const DirectionPair& pair,
                          double alpha) {
    const glm::dvec3 sum = pair.in + pair.out, dsum = pair.din + pair.dout;
    const double length = glm::length(sum);
    const glm::dvec3 h = sum / length, dh = (dsum - h * glm::dot(h, dsum)) / length;
    const double cosine = glm::dot(N, h), dcosine = glm::dot(dN, h) + glm::dot(N, dh);
    const double narrow = alpha * alpha - 1;
    return -4 * cosine * dcosine * narrow / (cosine * cosine * narrow + 1);
}

double cosine_change(const glm::dvec3& N, const glm::dvec3& dN, const glm::dvec3& w,
                     const glm::dvec3& dw) {
    return glm::dot(dN, w) + glm::dot(N, dw);
}

}  // namespace

double dln_microfacet(const glm::dvec3& N, const glm::dvec3& dN, const DirectionPair& pair,
                      double alpha) {
    const double c_i = glm::dot(N, pair.in), dc_i = cosine_change(N, dN, pair.in, pair.din);
    const double c_o = glm::dot(N, pair.out), dc_o = cosine_change(N, dN, pair.out, pair.dout);
    const SmithLambda in = smith_lambda(c_i, dc_i, alpha), out = smith_lambda(c_o, dc_o, alpha);
    return dln_normal_density(N, dN, pair, alpha) -
           (in.change + out.change) / (1 + in.value + out.value) - dc_i / c_i - dc_o / c_o;
}

}  // namespace opaline::bake
