#include "bake/refine/share_copies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "bake/base/frame.h"
#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/receivers/surface_points.h"
#include "bake/receivers/surface_samples.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/refine/met_meshes.h"
#include "bake/scene/base_color.h"
#include "bake/scene/copies.h"
#include "bake/trace/packet_lane.h"
#include "formats/opal/copies.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kRays = RayPacket::kSize;

// Where a mesh is asked: of a small one the rays should cost far less than its rows.
std::size_t count_points(std::size_t vertices) {
    return std::clamp<std::size_t>(vertices / 4, 16, 128);
}

// A ray from an instance: where it starts, of the original, and its cosine with the normal there.
struct Look {
    Receiver from;
    glm::vec3 direction;
    float cosine;
    bool is_open = true;
};

// What it finds.
struct Met {
    bool is_blocked = false;
    glm::vec3 color{0};  // of what blocks it
};

bool may_repeat(const formats::Material& material) {
    return !material.medium && !material.sheet && !material.marble && !is_emissive(material);
}

bool may_repeat(const formats::Scene& scene, const CopiedMesh& mesh) {
    for (std::uint32_t p = mesh.first; p < mesh.first + mesh.count; ++p) {
        if (!may_repeat(scene.materials[scene.primitives[p].material])) return false;
    }
    return true;
}

bool has_light_of_places(const formats::Scene& scene) {
    return !scene.lights.empty() || !scene.volumes.empty() ||
           std::ranges::any_of(scene.primitives, [&](const formats::Primitive& p) {
               return is_emissive(scene.materials[p.material]);
           });
}

// Cosine-distributed, stratified; the same for all instances of the mesh.
std::vector<Look> draw_looks(const formats::Scene& scene, const CopiedMesh& mesh,
                             std::uint64_t seed) {
    std::vector<std::uint32_t> own(mesh.count);
    std::iota(own.begin(), own.end(), mesh.original);
    const AreaTable table = make_area_table(scene, own);
    if (!(table.total() > 0)) return {};
    std::size_t vertices = 0;
    for (const std::uint32_t p : own) {
        vertices += scene.primitives[p].position.size();
    }
    const std::size_t points = count_points(vertices);
    std::vector<Look> looks;
    looks.reserve(points * kRays);
    std::uint32_t number = 0;
    for (const SurfacePoint& point :
         scatter_points(scene, table, points, false, seed, RandomStage::refine_probes)) {
        const Receiver from = make_surface_sample(scene, point, 0).receiver;
        const Frame frame = make_frame(from.normal);
        for (std::uint32_t ray = 0; ray < kRays; ++ray) {
            const auto u =
                random_uniform(seed, RandomStage::refine_probes, number++, mesh.original);
            const std::uint32_t column = ray % 4, row = ray / 4;
            const float x = (static_cast<float>(column) + u[0]) / 4;
            const float y = (static_cast<float>(row) + u[1]) / 4;
            const float azimuth = 2 * std::numbers::pi_v<float> * x, cosine = std::sqrt(1 - y);
            const glm::vec3 way(std::sqrt(y) * std::cos(azimuth), std::sqrt(y) * std::sin(azimuth),
                                cosine);
            looks.push_back({from, frame.to_world(way), cosine, true});
        }
    }
    return looks;
}

// A mesh that rays start from, and where it is.
struct Self {
    std::uint32_t first, count;  // primitives
    glm::vec3 offset;            // [m]

    bool is_met(const PacketHits& hits, std::size_t lane) const {
        return hits.primitive[lane] - first < count && hits.offset[lane] == offset;
    }
};

// Follows the looks of one point from hit to hit, at most 16 of them. `pass(hits, lane)`: whether
// a ray goes on behind that hit, else it ends there.
template <class Pass>
void follow(const RayScene& rays, std::span<const Look> looks, glm::vec3 offset, const Pass& pass) {
    constexpr int kMost = 16;
    RayPacket packet = rays_from(moved(looks[0].from, offset).origin);
    LaneMask lanes{};
    for (std::size_t lane = 0; lane < kRays; ++lane) {
        set_lane(packet, lanes, lane, looks[lane].direction);
    }
    for (int hit = 0; hit < kMost && std::ranges::count(lanes, -1) > 0; ++hit) {
        const PacketHits hits = rays.closest(lanes, packet);
        for (std::size_t lane = 0; lane < kRays; ++lane) {
            if (lanes[lane] == 0) continue;
            if (hits.hit[lane] == 0 || !pass(hits, lane)) {
                lanes[lane] = 0;
                continue;
            }
            packet.tnear[lane] = std::nextafter(hits.distance[lane] + hits.error[lane],
                                                std::numeric_limits<float>::infinity());
        }
    }
}

// Leaves the looks that the mesh itself does not block.
void leave_open(const RayScene& rays, const Self& self, std::vector<Look>& looks) {
    for (std::size_t first = 0; first < looks.size(); first += kRays) {
        const std::span<Look> some = std::span(looks).subspan(first, kRays);
        follow(rays, some, self.offset, [&](const PacketHits& hits, std::size_t lane) {
            some[lane].is_open = !self.is_met(hits, lane);
            return some[lane].is_open;
        });
    }
}

// What others block. Where the mesh seems to block itself, that is rounding: looks are open.
std::vector<Met> look_around(const formats::Scene& scene, const RayScene& rays,
                             std::span<const Look> looks, const Self& self) {
    std::vector<Met> found(looks.size());
    for (std::size_t first = 0; first < looks.size(); first += kRays) {
        follow(rays, looks.subspan(first, kRays), self.offset,
               [&](const PacketHits& hits, std::size_t lane) {
                   if (self.is_met(hits, lane)) return true;
                   const float u = hits.u[lane], v = hits.v[lane];
                   found[first + lane] = {
                       true,
                       base_color(scene, surface_place(scene, hits.primitive[lane],
                                                       hits.first_index[lane], {1 - u - v, u, v}))};
                   return false;
               });
    }
    return found;
}

// As of RefineLimits: half of it suns of all directions, half an even sky, an open receiver has 1.
// `square(ray)`: of what a sun errs by there; `mean(ray)`: what the sky errs by.
template <class Square, class Mean>
double mean_square(std::span<const Look> looks, double most, const Square& square,
                   const Mean& mean) {
    const auto all = static_cast<double>(looks.size());
    double sum = 0;
    for (std::size_t first = 0; first < looks.size() && sum <= most * all; first += kRays) {
        double suns = 0, sky = 0;
        for (std::size_t ray = first; ray < first + kRays; ++ray) {
            if (!looks[ray].is_open) continue;
            suns += 1.5 * static_cast<double>(square(ray) * looks[ray].cosine);
            sky += static_cast<double>(mean(ray));
        }
        sum += 0.5 * (suns + sky * sky / kRays);
    }
    return sum / all;
}

float largest_of(glm::vec3 v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// Of what an instance that sees `a` shows with the rows of one that sees `b`; more than `most`
// where it is.
double difference_of(std::span<const Look> looks, std::span<const Met> a, std::span<const Met> b,
                     double most) {
    const auto light = [](const Met& f) { return f.is_blocked ? f.color : glm::vec3(1); };
    return mean_square(
        looks, most,
        [&](std::size_t i) {
            if (a[i].is_blocked != b[i].is_blocked) return 1.0f;
            const float change = largest_of(a[i].color - b[i].color);
            return change * change;
        },
        [&](std::size_t i) {
            const glm::vec3 change = light(a[i]) - light(b[i]);
            return (change.x + change.y + change.z) / 3;
        });
}

double brightness_of(std::span<const Look> looks, std::span<const Met> seen) {
    const auto is_open = [&](std::size_t i) { return seen[i].is_blocked ? 0.0f : 1.0f; };
    return mean_square(looks, std::numeric_limits<double>::infinity(), is_open, is_open);
}

// A mesh that has rows of its own: its first primitive, and how far it is from the looks [m].
struct Place {
    std::uint32_t first = 0;
    glm::vec3 offset{0};
};

struct Likeness {
    const Place* original = nullptr;  // none: none is like it
    double square = 0;                // of the relative error of its rows
};

// What rays of the meshes with rows of their own find.
class Originals {
  public:
    // `error`: relative, that rows of others may have. `looks` must outlive it.
    Originals(std::span<const Look> looks, double error) : looks_(looks), square_(error * error) {}

    // Of the first ones alone, so that many meshes, all in other surroundings, end soon.
    void add(const Place& place, std::vector<Met> seen) {
        constexpr std::size_t kMost = 64;
        if (all_.size() == kMost) return;
        const double brightness = brightness_of(looks_, seen);
        all_.push_back({place, std::move(seen), brightness});
    }

    // The first one whose rows will do. Valid until the next add().
    Likeness find_like(std::span<const Met> seen) const {
        for (const Original& original : all_) {
            const double most = square_ * original.brightness;
            const double found = difference_of(looks_, seen, original.seen, most);
            if (found <= most) {
                return {&original.place, original.brightness > 0 ? found / original.brightness : 0};
            }
        }
        return {};
    }

  private:
    struct Original {
        Place place;
        std::vector<Met> seen;
        double brightness;
    };
    std::span<const Look> looks_;
    double square_;
    std::vector<Original> all_;
};

void point_at(const Place& original, const CopiedMesh& mesh, formats::Scene& scene) {
    for (std::uint32_t p = 0; p < mesh.count; ++p) {
        scene.primitives[mesh.first + p].copy = {original.first + p, mesh.offset - original.offset};
    }
}

// In a reader of the file.
std::uint64_t bytes_of(const formats::Scene& scene, const CopiedMesh& mesh) {
    std::uint64_t vertices = 0, indices = 0;
    for (std::uint32_t p = 0; p < mesh.count; ++p) {
        vertices += scene.primitives[mesh.original + p].position.size();
        indices += scene.primitives[mesh.original + p].index.size();
    }
    return formats::bytes_of_copies(vertices, indices);
}

}  // namespace

ShareReport share_copies(const RayScene& rays, const ShareLimits& limits, const Context& context,
                         formats::Scene& scene) {
    std::vector<CopiedMesh> meshes = find_copied_meshes(scene);
    ShareReport report{meshes.size(), 0, 0, {}};
    if (has_light_of_places(scene)) {
        report.apart = std::move(meshes);
        return report;
    }
    MetMeshes met(scene);
    std::erase_if(meshes, [&](const CopiedMesh& mesh) {
        if (may_repeat(scene, mesh) && !met.meets_another(mesh)) return false;
        report.apart.push_back(mesh);
        return true;
    });
    std::ranges::stable_sort(meshes, {}, &CopiedMesh::original);
    double squares = 0;
    std::uint64_t bytes = 0;
    for (std::size_t begin = 0, end = 0; begin < meshes.size(); begin = end) {
        while (end < meshes.size() && meshes[end].original == meshes[begin].original)
            ++end;
        const std::span<const CopiedMesh> copies = std::span(meshes).subspan(begin, end - begin);
        const std::uint64_t bytes_each = bytes_of(scene, copies.front());
        std::vector<Look> looks = draw_looks(scene, copies.front(), limits.seed);
        if (looks.empty()) {
            report.apart.insert(report.apart.end(), copies.begin(), copies.end());
            continue;
        }
        const Self self{copies.front().original, copies.front().count, glm::vec3(0)};
        leave_open(rays, self, looks);
        Originals originals(looks, limits.error);
        originals.add({self.first, self.offset}, look_around(scene, rays, looks, self));
        for_each_block_in_order(
            copies.size(), 16, context,
            [&](Range range) {
                std::vector<std::vector<Met>> seen;
                for (std::size_t i = range.begin; i < range.end; ++i) {
                    seen.push_back(look_around(scene, rays, looks,
                                               {self.first, self.count, copies[i].offset}));
                }
                return seen;
            },
            [&](Range range, std::vector<std::vector<Met>>&& seen) {
                for (std::size_t i = range.begin; i < range.end; ++i) {
                    std::vector<Met>& own = seen[i - range.begin];
                    const bool has_room = bytes + bytes_each <= formats::kMostBytesOfCopies;
                    const Likeness like = has_room ? originals.find_like(own) : Likeness{};
                    if (like.original != nullptr) {
                        point_at(*like.original, copies[i], scene);
                        squares += like.square;
                        bytes += bytes_each;
                        ++report.shared;
                        continue;
                    }
                    report.apart.push_back(copies[i]);
                    originals.add({copies[i].first, copies[i].offset}, std::move(own));
                }
            });
    }
    std::ranges::sort(report.apart, {}, &CopiedMesh::first);
    if (report.shared > 0) report.error = std::sqrt(squares / static_cast<double>(report.shared));
    return report;
}

}  // namespace opaline::bake
