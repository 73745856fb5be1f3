#include "bake/reference/estimate.h"

#include <algorithm>

namespace opaline::bake {

void Moments::add(glm::dvec3 sample) {
    groups = std::max(groups, 1.0);
    count += 1;
    const glm::dvec3 deviation = sample - mean;
    mean += deviation / count;
    squares += deviation * (sample - mean);
}

void Moments::merge(const Moments& other) {
    if (other.count == 0) return;
    const double sum = count + other.count;
    const glm::dvec3 deviation = other.mean - mean;
    mean += deviation * (other.count / sum);
    const glm::dvec3 between = deviation * deviation * (count * other.count / sum);
    squares += other.squares + between;
    group_squares += other.group_squares + between;
    groups += other.groups;
    count = sum;
}

glm::dvec3 Moments::variance_of_mean() const {
    if (groups >= kFewGroups) return group_squares / (count * (groups - 1));
    return count > 1 ? squares / (count * (count - 1)) : glm::dvec3(0);
}

}  // namespace opaline::bake
