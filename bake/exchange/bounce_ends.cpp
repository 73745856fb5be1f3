#include "bake/exchange/bounce_ends.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace opaline::bake {
namespace {

// First of the random numbers of quarters: those of cells come before.
constexpr std::uint32_t kOfQuarters = 1u << 31;

BounceEnd end_of(const formats::Scene& scene, const PacketHits& hits, std::size_t lane,
                 glm::vec3 direction) {
    return {.direction = direction,
            .distance = hits.distance[lane],
            .error = hits.error[lane],
            .material = hits.material[lane],
            .side = side_of_hit(scene, hits, lane),
            .triangle = triangle_of_hit(hits, lane),
            .is_met = true};
}

// How much the light may change from one end to the other, judged by shape alone.
enum class Change : std::uint8_t { none, other_surface, nothing };

Change change_between(const BounceEnd& a, const BounceEnd& b) {
    constexpr float kBent = 0.8f, kApart = 0.25f;
    if (!a.sends() || !b.sends()) return a.sends() != b.sends() ? Change::nothing : Change::none;
    const glm::vec3 way = b.distance * b.direction - a.distance * a.direction;
    const float apart =
        std::max(std::abs(glm::dot(way, a.side.normal)), std::abs(glm::dot(way, b.side.normal)));
    const bool is_one = a.material == b.material && a.side.behind == b.side.behind &&
                        glm::dot(a.side.normal, b.side.normal) > kBent &&
                        apart < kApart * std::min(a.distance, b.distance);
    return is_one ? Change::none : Change::other_surface;
}

// The largest between the four beside a cell, fewer at the horizon.
Change change_around(std::span<const BounceEnd> ends, std::uint32_t side, std::uint32_t row,
                     std::uint32_t column) {
    std::array<const BounceEnd*, 4> beside{};
    std::size_t count = 0;
    const std::size_t i = std::size_t{row} * side + column;
    if (row > 0) {
        beside[count++] = &ends[i - side];
    }
    if (row + 1 < side) {
        beside[count++] = &ends[i + side];
    }
    if (column > 0) {
        beside[count++] = &ends[i - 1];
    }
    if (column + 1 < side) {
        beside[count++] = &ends[i + 1];
    }
    Change most = Change::none;
    for (std::size_t a = 1; a < count; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
            most = std::max(most, change_between(*beside[a], *beside[b]));
        }
    }
    return most;
}

// Of some, every n-th, so that at most `most` are left.
void append_thinned(std::span<const std::uint32_t> some, std::size_t most,
                    std::vector<std::uint32_t>& to) {
    const std::size_t count = std::min(some.size(), most);
    for (std::size_t k = 0; k < count; ++k) {
        to.push_back(some[(2 * k + 1) * some.size() / (2 * count)]);
    }
}

// Cells to cut: first those at silhouettes. Cells with an even sum of row and column have one list,
// cells with an odd sum another. The four neighbours of a cell are in the other list, so the cell's
// own ray does not influence how much its list is thinned, which keeps the estimate unbiased.
std::vector<std::uint32_t> choose_cells(std::span<const BounceEnd> ends, const BounceGrid& grid) {
    std::array<std::vector<std::uint32_t>, 2> outlines, inner;
    for (std::uint32_t row = 0; row < grid.side; ++row) {
        for (std::uint32_t column = 0; column < grid.side; ++column) {
            const Change change = change_around(ends, grid.side, row, column);
            if (change != Change::none) {
                auto& lists = change == Change::nothing ? outlines : inner;
                lists[(row + column) % 2].push_back(row * grid.side + column);
            }
        }
    }
    std::vector<std::uint32_t> chosen;
    for (std::size_t kind = 0; kind < 2; ++kind) {
        const std::size_t most = grid.most_cut() / 2, before = chosen.size();
        append_thinned(outlines[kind], most, chosen);
        append_thinned(inner[kind], most - (chosen.size() - before), chosen);
    }
    return chosen;
}

// Rays of quarters, traced in packets of cells beside each other.
class QuarterRays {
  public:
    QuarterRays(const formats::Scene& scene, const RayScene& rays, glm::vec3 origin,
                std::vector<BounceEnd>& ends)
        : scene_(scene), rays_(rays), packet_(rays_from(origin)), ends_(ends) {}

    void add(glm::vec3 direction, std::uint32_t quarter) {
        set_lane(packet_, lanes_, count_, direction);
        quarter_[count_] = quarter;
        if (++count_ == RayPacket::kSize) {
            trace();
        }
    }

    std::uint64_t trace() {
        traced_ += count_;
        if (count_ > 0) {
            const PacketHits hits = rays_.closest(lanes_, packet_);
            for (std::size_t lane = 0; lane < count_; ++lane) {
                if (hits.hit[lane] != 0) {
                    ends_.push_back(end_of(scene_, hits, lane, direction_of(packet_, lane)));
                    ends_.back().is_quarter = true;
                    ends_.back().cell = quarter_[lane];
                }
            }
        }
        count_ = 0;
        lanes_.fill(0);
        return traced_;
    }

  private:
    const formats::Scene& scene_;
    const RayScene& rays_;
    RayPacket packet_;
    LaneMask lanes_{};
    std::array<std::uint32_t, RayPacket::kSize> quarter_{};
    std::size_t count_ = 0;
    std::uint64_t traced_ = 0;
    std::vector<BounceEnd>& ends_;
};

// In four: the cell's own ray stays in its quarter.
void cut_cell(const BounceGrid& grid, const Frame& frame, std::uint64_t seed, std::uint64_t key,
              std::uint32_t row, std::uint32_t column, BounceEnd& own, QuarterRays& others) {
    const glm::vec2 place = place_in_cell(grid, seed, key, row, column);
    const std::uint32_t taken = (place.y < 0.5f ? 0u : 2u) + (place.x < 0.5f ? 0u : 1u);
    const std::uint32_t cell = row * grid.side + column;
    const float width = 0.5f / static_cast<float>(grid.side);
    std::array<std::array<float, 4>, 2> u{};
    for (std::uint32_t i = 0; i < 2; ++i) {
        u[i] = random_uniform(seed, RandomStage::bounce_rays, key, kOfQuarters + 2 * cell + i);
    }
    for (std::uint32_t q = 0; q < 4; ++q) {
        const std::uint32_t across = 2 * column + q % 2, along = 2 * row + q / 2;
        const std::uint32_t quarter = along * 2 * grid.side + across;
        if (q == taken) {
            own.is_quarter = true;
            own.cell = quarter;
            continue;
        }
        const glm::vec2 inside{u[q / 2][q % 2 * 2], u[q / 2][q % 2 * 2 + 1]};
        others.add(frame.to_world(to_hemisphere((static_cast<float>(across) + inside.x) * width,
                                                (static_cast<float>(along) + inside.y) * width)),
                   quarter);
    }
}

}  // namespace

std::uint64_t find_bounce_ends(const formats::Scene& scene, const RayScene& rays,
                               const Receiver& at, const BounceGrid& grid, std::uint64_t seed,
                               std::vector<BounceEnd>& ends) {
    ends.assign(grid.count(), {});
    const std::uint64_t traced = trace_bounces(rays, at, grid, seed, [&](const BounceHit& hit) {
        BounceEnd& end = ends[hit.cell] = end_of(scene, hit.hits, hit.lane, hit.direction);
        end.cell = static_cast<std::uint32_t>(hit.cell);
    });
    if (grid.most_cut() == 0 || traced == 0) return traced;
    const Frame frame = make_frame(at.normal);
    const std::uint64_t key = key_of(at);
    QuarterRays others(scene, rays, at.origin, ends);
    for (const std::uint32_t cell : choose_cells(ends, grid)) {
        // A copy: rays of quarters may move the ends.
        BounceEnd own = ends[cell];
        cut_cell(grid, frame, seed, key, cell / grid.side, cell % grid.side, own, others);
        ends[cell] = own;
    }
    return traced + others.trace();
}

}  // namespace opaline::bake
