#include "bake/exchange/gather_sites.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>
#include <span>
#include <utility>

namespace opaline::bake {
namespace {

// Sites that are looked at, and of a function of six coefficients.
constexpr std::size_t kNearest = 32, kFewest = 8;

}  // namespace

struct GatherSites::Tree {
    // What nanoflann asks for.
    struct Places {
        std::span<const GatherSite> sites;

        std::size_t kdtree_get_point_count() const { return sites.size(); }
        float kdtree_get_pt(std::size_t i, std::size_t axis) const {
            return sites[i].at.origin[static_cast<glm::length_t>(axis)];
        }
        template <class Box>
        bool kdtree_get_bbox(Box&) const {
            return false;
        }
    };
    using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Places>,
                                                      Places, 3, std::uint32_t>;

    explicit Tree(std::span<const GatherSite> sites) : places{sites}, index(3, places) {}

    Places places;
    Index index;
};

GatherSites::GatherSites(std::vector<GatherSite> sites) : sites_(std::move(sites)) {
    if (!sites_.empty()) {
        tree_ = std::make_unique<const Tree>(sites_);
    }
}
GatherSites::GatherSites() = default;
GatherSites::GatherSites(GatherSites&&) noexcept = default;
GatherSites& GatherSites::operator=(GatherSites&&) noexcept = default;
GatherSites::~GatherSites() = default;

bool GatherSites::weigh(const Receiver& at, float most_noise,
                        std::vector<SiteWeight>& weights) const {
    // RESULTS.md, "Interreflection".
    constexpr float kReach = 0.2f, kLeastFacing = 0.5f;
    weights.clear();
    std::array<std::uint32_t, kNearest> nearest;
    std::array<float, kNearest> square;
    const std::size_t found =
        tree_ ? tree_->index.knnSearch(&at.origin.x, kNearest, nearest.data(), square.data()) : 0;
    if (found < kFewest) return false;
    const float widest = std::sqrt(square[found - 1]);
    std::array<NearSite, kNearest> near;
    std::size_t count = 0;
    for (std::size_t i = 0; i < found; ++i) {
        const GatherSite& site = sites_[nearest[i]];
        const float facing =
            (glm::dot(at.normal, site.at.normal) - kLeastFacing) / (1 - kLeastFacing);
        const float reach = std::min(widest, kReach * site.clearance);
        const float inside = 1 - square[i] / (reach * reach);
        if (inside > 0 && facing > 0) {
            near[count++] = {nearest[i], static_cast<double>(inside * inside * facing * facing),
                             (site.at.origin - at.origin) / widest, site.at.normal, 0};
        }
    }
    if (count < kFewest) return false;
    fit_near_sites(std::span(near).first(count), at.normal, false, weights);
    float noise = 0;
    for (const SiteWeight& w : weights) {
        noise += w.weight * w.weight;
    }
    if (noise > most_noise) {
        weights.clear();
        return false;
    }
    return true;
}

}  // namespace opaline::bake
