#include "bake/reference/volume_space.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace opaline::bake {
namespace {

constexpr float kUnbounded = std::numeric_limits<float>::infinity();
using Grid = formats::SparseGrid<float>;
constexpr int kSide = Grid::kSide;

std::size_t cell_index(const TrackedVolume& v, glm::ivec3 cell) {
    const glm::ivec3 p = cell - v.first;
    return (static_cast<std::size_t>(p.z) * static_cast<std::size_t>(v.extent.y) +
            static_cast<std::size_t>(p.y)) *
               static_cast<std::size_t>(v.extent.x) +
           static_cast<std::size_t>(p.x);
}

// The value between voxels i and i + 1 is bounded by both, so a voxel counts for its own cell and,
// at a cell's lower face, for the cell before it.
void bound_density(TrackedVolume& v) {
    const Grid& grid = v.volume->density;
    v.first = grid.first_brick - 1;
    v.extent = grid.extent + 1;
    v.bound.assign(static_cast<std::size_t>(v.extent.x) * static_cast<std::size_t>(v.extent.y) *
                       static_cast<std::size_t>(v.extent.z),
                   0);
    glm::ivec3 b;
    for (b.z = 0; b.z < grid.extent.z; ++b.z) {
        for (b.y = 0; b.y < grid.extent.y; ++b.y) {
            for (b.x = 0; b.x < grid.extent.x; ++b.x) {
                const glm::ivec3 brick = grid.first_brick + b;
                const std::uint32_t number = grid.brick_at(brick);
                if (number == Grid::kEmpty) continue;
                const std::span<const float> value = grid.brick(number);
                // Corner c of eight: bit set, the cell before this one along that axis.
                std::array<float, 8> most{};
                for (int i = 0; i < static_cast<int>(value.size()); ++i) {
                    const bool low[3] = {i % kSide == 0, i / kSide % kSide == 0,
                                         i / (kSide * kSide) == 0};
                    for (unsigned c = 0; c < 8; ++c) {
                        if ((!(c & 1) || low[0]) && (!(c & 2) || low[1]) && (!(c & 4) || low[2])) {
                            most[c] = std::max(most[c], value[static_cast<std::size_t>(i)]);
                        }
                    }
                }
                for (int c = 0; c < 8; ++c) {
                    float& bound =
                        v.bound[cell_index(v, brick - glm::ivec3(c & 1, c >> 1 & 1, c >> 2))];
                    bound = std::max(bound, most[static_cast<std::size_t>(c)]);
                }
            }
        }
    }
}

// A cell glows if one of the voxels 8 b .. 8 b + 8 does.
GlowingVolume make_glowing_volume(const TrackedVolume& v) {
    GlowingVolume own;
    own.emission = &v.volume->emission;
    own.to_index = v.to_index;
    own.offset = v.offset;
    own.first = own.emission->first_brick - 1;
    own.extent = own.emission->extent + 1;
    glm::ivec3 c;
    for (c.z = 0; c.z < own.extent.z; ++c.z) {
        for (c.y = 0; c.y < own.extent.y; ++c.y) {
            for (c.x = 0; c.x < own.extent.x; ++c.x) {
                bool glows = false;
                constexpr int kVoxels = (kSide + 1) * (kSide + 1) * (kSide + 1);
                for (int i = 0; i < kVoxels && !glows; ++i) {
                    const glm::ivec3 in(i % (kSide + 1), i / (kSide + 1) % (kSide + 1),
                                        i / ((kSide + 1) * (kSide + 1)));
                    glows = own.emission->at(kSide * (own.first + c) + in) != glm::vec3(0);
                }
                own.glows.push_back(glows);
            }
        }
    }
    return own;
}

}  // namespace

VolumeSpace make_volume_space(const formats::Scene& scene) {
    assert(scene.volumes.size() <= formats::kMaxVolumes);
    VolumeSpace space;
    for (const formats::Volume& volume : scene.volumes) {
        TrackedVolume v;
        v.volume = &volume;
        const glm::dmat4 to_index = glm::inverse(volume.density.to_scene);
        v.to_index = glm::mat3(glm::dmat3(to_index));
        v.offset = glm::vec3(glm::dvec3(to_index[3]));
        v.sigma_t = {volume.sigma_t.r, volume.sigma_t.g, volume.sigma_t.b};
        v.phase = make_phase_sampler(volume.phase);
        bound_density(v);
        if (!volume.emission.empty()) {
            space.glowing.push_back(make_glowing_volume(v));
        }
        space.volumes.push_back(std::move(v));
    }
    return space;
}

bool LatticeRay::start(glm::vec3 o, glm::vec3 d, float from, float to, glm::ivec3 lowest,
                       glm::ivec3 count) {
    first = lowest, extent = count, reach = to;
    const glm::vec3 low(first), high(first + extent);
    begin = from;
    for (int a = 0; a < 3; ++a) {
        // A ray along a face: neither a product 0 * inf nor a division by 0.
        if (d[a] == 0) {
            if (!(o[a] >= low[a] && o[a] < high[a])) return false;
            continue;
        }
        const float s = (low[a] - o[a]) / d[a], t = (high[a] - o[a]) / d[a];
        begin = std::max(begin, std::min(s, t));
        reach = std::min(reach, std::max(s, t));
    }
    if (!(begin < reach)) return false;
    const glm::vec3 at = o + begin * d;
    for (int a = 0; a < 3; ++a) {
        const float where = std::clamp(at[a], low[a], high[a]);
        cell[a] =
            std::clamp(static_cast<int>(std::floor(where)), first[a], first[a] + extent[a] - 1);
        step[a] = d[a] > 0 ? 1 : d[a] < 0 ? -1 : 0;
        const auto plane = static_cast<float>(cell[a] + (step[a] > 0 ? 1 : 0));
        next[a] = step[a] == 0 ? kUnbounded : (plane - o[a]) / d[a];
        pitch[a] = step[a] == 0 ? kUnbounded : 1 / std::abs(d[a]);
    }
    find_end();
    return true;
}

void LatticeRay::find_end() {
    end = std::min(reach, std::max(begin, std::min({next.x, next.y, next.z})));
}

bool LatticeRay::advance() {
    const int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
    begin = end;
    cell[axis] += step[axis];
    next[axis] += pitch[axis];
    if (step[axis] == 0 || begin >= reach || cell[axis] < first[axis] ||
        cell[axis] >= first[axis] + extent[axis]) {
        return false;
    }
    find_end();
    return true;
}

VolumeMarch::VolumeMarch(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction, float reach)
    : space_(space), reach_(reach) {
    for (std::size_t i = 0; i < space.volumes.size(); ++i) {
        enter(i, from, direction);
    }
}

void VolumeMarch::enter(std::size_t number, glm::vec3 from, glm::vec3 direction) {
    const TrackedVolume& v = space_.volumes[number];
    Cursor& c = cursor_[number];
    c.origin = v.to_index * from + v.offset;
    c.direction = v.to_index * direction;
    constexpr float kInverse = 1.0f / kSide;
    if (!c.cells.start(kInverse * c.origin, kInverse * c.direction, 0, reach_, v.first, v.extent)) {
        return;
    }
    c.is_done = false;
    settle_in_cell(number);
    skip_empty(number);
}

// The bound of the cell, or of its first voxel where the cell is dense.
void VolumeMarch::settle_in_cell(std::size_t number) {
    constexpr float kDense = 16;  // mean free paths through a cell, by its bound
    const TrackedVolume& v = space_.volumes[number];
    Cursor& c = cursor_[number];
    c.begin = c.cells.begin, c.end = c.cells.end;
    c.bound = v.bound[cell_index(v, c.cells.cell)];
    const float most = std::max({v.sigma_t.x, v.sigma_t.y, v.sigma_t.z});
    c.is_fine = c.bound * most * (c.end - c.begin) > kDense &&
                c.voxels.start(c.origin, c.direction, c.begin, c.end, kSide * c.cells.cell,
                               glm::ivec3(kSide));
    if (c.is_fine) {
        settle_in_voxel(v, c);
    }
}

void VolumeMarch::settle_in_voxel(const TrackedVolume& v, Cursor& c) {
    c.begin = c.voxels.begin, c.end = c.voxels.end;
    c.bound = 0;
    for (int i = 0; i < 8; ++i) {
        c.bound = std::max(
            c.bound, v.volume->density.at(c.voxels.cell + glm::ivec3(i & 1, i >> 1 & 1, i >> 2)));
    }
}

void VolumeMarch::advance(std::size_t number) {
    Cursor& c = cursor_[number];
    if (c.is_fine && c.voxels.advance()) {
        settle_in_voxel(space_.volumes[number], c);
    } else if (c.cells.advance()) {
        settle_in_cell(number);
    } else {
        c.is_done = true;
    }
}

void VolumeMarch::skip_empty(std::size_t number) {
    Cursor& c = cursor_[number];
    while (!c.is_done && (c.end <= at_ || c.bound == 0)) {
        advance(number);
    }
}

std::optional<VolumeSegment> VolumeMarch::next() {
    const std::size_t count = space_.volumes.size();
    for (;;) {
        VolumeSegment segment;
        segment.begin = kUnbounded;
        segment.end = kUnbounded;
        for (std::size_t i = 0; i < count; ++i) {
            if (!cursor_[i].is_done) {
                segment.begin = std::min(segment.begin, std::max(at_, cursor_[i].begin));
            }
        }
        if (!(segment.begin < reach_)) return std::nullopt;
        for (std::size_t i = 0; i < count; ++i) {
            const Cursor& c = cursor_[i];
            if (c.is_done) continue;
            const bool is_inside = c.begin <= segment.begin;
            segment.end = std::min(segment.end, is_inside ? c.end : c.begin);
            if (is_inside) {
                segment.bound[i] = c.bound;
                segment.sigma_t += c.bound * space_.volumes[i].sigma_t;
            }
        }
        at_ = segment.end = std::max(segment.begin, segment.end);
        for (std::size_t i = 0; i < count; ++i) {
            skip_empty(i);
        }
        if (segment.end > segment.begin && segment.sigma_t != glm::vec3(0)) return segment;
    }
}

}  // namespace opaline::bake
