#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/trace/embree_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Which bodies fill a point. Of a line from there all triangles count at once, whatever lies on
/// whatever, so faces that lie on one another are told apart.
class BodiesAt {
  public:
    /// All must outlive it. `triangles`: of the whole scene, built with filters.
    BodiesAt(const formats::Scene& scene, const EmbreeScene& triangles);

    /// Of each place in `order()`, the number of its bodies around the point: of three lines the
    /// middle one, since meshes have holes and lines may meet edges.
    void count(glm::vec3 point, std::vector<int>& bodies) const;
    /// The material that fills the point; formats::kNone: it lies in no body.
    std::uint32_t material_at(glm::vec3 point) const;

    /// Materials with a medium, as order_media says.
    std::span<const std::uint32_t> order() const { return order_; }
    /// Nearer faces lie on one another [m]: some steps of float in the largest coordinate.
    float touch() const { return touch_; }

    /// Calls visit(place in order(), whether the line leaves the body there) for each triangle of a
    /// medium within `reach` [m]. Returns how many triangles of other materials are there.
    template <class Visit>
    std::uint32_t visit_crossed(glm::vec3 from, glm::vec3 direction, float reach,
                                Visit&& visit) const {
        std::vector<Crossed> crossed;
        const std::uint32_t others = collect(from, direction, reach, crossed);
        for (const Crossed& c : crossed) {
            visit(c.place, c.leaves);
        }
        return others;
    }

    /// The way from there to the next triangle of any material [m].
    std::optional<float> find_next(glm::vec3 from, glm::vec3 direction) const;

    /// Whether a triangle of a chosen material lies on another triangle of one, by their middles.
    bool has_faces_on_faces(const formats::Scene& scene,
                            const std::vector<std::uint8_t>& is_chosen) const;

  private:
    struct Crossed {
        std::uint32_t geometry, triangle, place;
        bool leaves;
    };
    struct Query;
    std::uint32_t collect(glm::vec3 from, glm::vec3 direction, float reach,
                          std::vector<Crossed>& crossed) const;

    const EmbreeScene* triangles_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> place_;  // by material; formats::kNone: it has no medium
    float touch_;
};

}  // namespace opaline::bake
