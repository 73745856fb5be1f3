#include "bake/scene/weld.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "bake/scene/weld.h"

namespace opaline::bake {
namespace {

using formats::Primitive;

constexpr float kPartOfBody = 1e-6f, kSteps = 4 * 0x1p-23f;
constexpr float kCell = 8;  // tolerances: most searches look into one cell

float tolerance_of(const formats::Scene& scene, const std::vector<bool>& chosen) {
    float smallest = HUGE_VALF, farthest = 0;
    for (const Primitive& p : scene.primitives) {
        if (!chosen[p.material] || p.position.empty()) continue;
        glm::vec3 low = p.position[0], high = low;
        for (const glm::vec3& at : p.position) {
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
        const glm::vec3 far = glm::max(glm::abs(low), glm::abs(high));
        farthest = std::max({farthest, far.x, far.y, far.z});
        const float size = glm::length(high - low);
        smallest = size > 0 ? std::min(smallest, size) : smallest;
    }
    return std::isfinite(smallest) ? std::max(kPartOfBody * smallest, kSteps * farthest) : 0;
}

// Positions that others near them move to, by cell.
class WeldedPlaces {
  public:
    explicit WeldedPlaces(float tolerance) : tolerance_(tolerance) {}

    // The first of those given so far that is within the tolerance; else the position itself.
    glm::vec3 place_of(glm::vec3 at) {
        const glm::vec3 low = cell_of(at - tolerance_), high = cell_of(at + tolerance_);
        glm::vec3 cell;
        std::uint32_t first = formats::kNone;
        for (cell.x = low.x; cell.x <= high.x; ++cell.x) {
            for (cell.y = low.y; cell.y <= high.y; ++cell.y) {
                for (cell.z = low.z; cell.z <= high.z; ++cell.z) {
                    const auto [begin, end] = by_cell_.equal_range(weld_key(cell));
                    for (auto it = begin; it != end; ++it) {
                        if (glm::distance(position_[it->second], at) <= tolerance_) {
                            first = std::min(first, it->second);
                        }
                    }
                }
            }
        }
        if (first != formats::kNone) return position_[first];
        by_cell_.emplace(weld_key(cell_of(at)), static_cast<std::uint32_t>(position_.size()));
        position_.push_back(at);
        return at;
    }

  private:
    // Coordinates are below 2^23 steps of the tolerance, so that cells are exact in floats.
    glm::vec3 cell_of(glm::vec3 at) const { return glm::floor(at / (kCell * tolerance_)); }

    float tolerance_;
    std::vector<glm::vec3> position_;
    std::unordered_multimap<glm::vec3, std::uint32_t, PositionHash> by_cell_;
};

}  // namespace

std::vector<WeldedVertices> weld_seams(const formats::Scene& scene,
                                       const std::vector<bool>& chosen) {
    std::vector<WeldedVertices> welded;
    const float tolerance = tolerance_of(scene, chosen);
    if (!(tolerance > 0)) return welded;
    WeldedPlaces places(tolerance);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& primitive = scene.primitives[p];
        if (!chosen[primitive.material]) continue;
        WeldedVertices moved{p, primitive.position};
        for (glm::vec3& at : moved.position) {
            at = places.place_of(weld_key(at));
        }
        if (moved.position != primitive.position) welded.push_back(std::move(moved));
    }
    return welded;
}

}  // namespace opaline::bake
