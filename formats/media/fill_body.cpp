#include "formats/media/fill_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "formats/fill_grid.h"
#include "formats/gltf/report.h"
#include "formats/media/limits.h"

namespace opaline::formats {
namespace {

constexpr int kLinesOfVoxel = 8;  // along x and along y

// The triangles of a material, in double.
struct Body {
    std::vector<std::array<glm::dvec3, 3>> triangle;
    glm::dvec3 low{1e300}, high{-1e300};
};

Body gather_body(const Scene& scene, const std::string& material) {
    Body body;
    for (const Primitive& p : scene.primitives) {
        if (scene.materials[p.material].name != material) continue;
        for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
            std::array<glm::dvec3, 3> corner;
            for (std::size_t c = 0; c < 3; ++c) {
                corner[c] = glm::dvec3(p.position[p.index[i + c]]);
                body.low = glm::min(body.low, corner[c]);
                body.high = glm::max(body.high, corner[c]);
            }
            body.triangle.push_back(corner);
        }
    }
    return body;
}

using Place = std::tuple<double, double, double>;

Place place_of(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

// Edges that triangles do not go along as often one way as the other.
std::size_t count_open_edges(const Body& body) {
    std::map<std::pair<Place, Place>, int> times;
    for (const auto& corner : body.triangle) {
        for (std::size_t i = 0; i < 3; ++i) {
            const Place a = place_of(corner[i]), b = place_of(corner[(i + 1) % 3]);
            if (a < b) {
                ++times[{a, b}];
            } else if (b < a) {
                --times[{b, a}];
            }
        }
    }
    return static_cast<std::size_t>(
        std::ranges::count_if(times, [](const auto& edge) { return edge.second != 0; }));
}

// The number of each triangle's part: those that have a vertex in common hang together.
std::vector<std::size_t> number_parts(const Body& body) {
    std::vector<std::size_t> part(body.triangle.size());
    const auto find = [&](std::size_t triangle) {
        while (part[triangle] != triangle) {
            triangle = part[triangle] = part[part[triangle]];
        }
        return triangle;
    };
    std::map<Place, std::size_t> first;  // triangle at a vertex
    for (std::size_t t = 0; t < body.triangle.size(); ++t) {
        part[t] = t;
        for (const glm::dvec3& corner : body.triangle[t]) {
            const std::size_t other = find(first.emplace(place_of(corner), t).first->second);
            part[find(t)] = other;
        }
    }
    for (std::size_t t = 0; t < part.size(); ++t) {
        part[t] = find(t);
    }
    return part;
}

// What a part encloses, by its triangles and by the lines that cross it [m^3]; its orientation
// decides the sign.
struct PartContent {
    double mesh = 0, lines = 0;

    // Lines miss it, or take it for thicker than it is.
    bool is_lost() const {
        return std::abs(std::abs(lines) - std::abs(mesh)) > 0.5 * std::abs(mesh);
    }
};

// Where lines along z run: kLinesOfVoxel a voxel along each of x and y.
struct Lines {
    glm::dvec3 low{0};  // corner of the box of voxels
    double voxel = 1;
    glm::ivec3 voxels{0};

    int columns() const { return kLinesOfVoxel * voxels.x; }
    int rows() const { return kLinesOfVoxel * voxels.y; }
    double x(int column) const { return low.x + voxel * (column + 0.5) / kLinesOfVoxel; }
    double y(int row) const { return low.y + voxel * (row + 0.5) / kLinesOfVoxel; }
    // The first line at or behind a coordinate.
    static int first_at(double distance, double voxel, int count) {
        const double at = std::ceil(kLinesOfVoxel * distance / voxel - 0.5) - 1;
        return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(count)));
    }
};

// Which side of an edge a line is on: > 0 left of it where it goes up in y. Both triangles of an
// edge find the same number.
double side_of(const glm::dvec3& a, const glm::dvec3& b, double x, double y) {
    const bool swap = place_of(b) < place_of(a);
    const glm::dvec3 &from = swap ? b : a, &to = swap ? a : b;
    const double side = (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
    return swap ? -side : side;
}

// How often a triangle's outline goes around a line, seen from +z: -1, 0 or 1. Sums over closed
// meshes are 0, because each edge counts the same for both its triangles.
int turns_around(const std::array<glm::dvec3, 3>& corner, double x, double y) {
    int turns = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 &a = corner[i], &b = corner[(i + 1) % 3];
        if (a.y <= y && b.y > y) {
            turns += side_of(a, b, x, y) > 0 ? 1 : 0;
        } else if (b.y <= y && a.y > y) {
            turns -= side_of(b, a, x, y) > 0 ? 1 : 0;
        }
    }
    return turns;
}

double height_at(const std::array<glm::dvec3, 3>& corner, double x, double y) {
    const glm::dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const auto [low, high] = std::minmax({corner[0].z, corner[1].z, corner[2].z});
    if (n.z == 0) return low;
    const double z = corner[0].z - (n.x * (x - corner[0].x) + n.y * (y - corner[0].y)) / n.z;
    return std::clamp(z, low, high);
}

// How many lines its triangles' boxes meet, all in all.
double count_meetings(const Body& body, const Lines& lines) {
    double sum = 0;
    for (const auto& [a, b, c] : body.triangle) {
        const glm::dvec3 size = glm::max(a, glm::max(b, c)) - glm::min(a, glm::min(b, c));
        sum +=
            (1 + kLinesOfVoxel * size.x / lines.voxel) * (1 + kLinesOfVoxel * size.y / lines.voxel);
    }
    return sum;
}

struct Crossing {
    std::uint32_t line = 0;
    float turns = 0;
    double z = 0;
};

// Adds to the content of the triangles' parts, whose number `part` has.
std::vector<Crossing> cross_lines(const Body& body, const Lines& lines,
                                  std::span<const std::size_t> part,
                                  std::span<PartContent> content) {
    const double area = lines.voxel * lines.voxel / (kLinesOfVoxel * kLinesOfVoxel);
    std::vector<Crossing> crossings;
    for (std::size_t t = 0; t < body.triangle.size(); ++t) {
        const auto& corner = body.triangle[t];
        PartContent& own = content[part[t]];
        own.mesh += glm::dot(corner[0] - lines.low,
                             glm::cross(corner[1] - lines.low, corner[2] - lines.low)) /
                    6;
        const glm::dvec3 low = glm::min(corner[0], glm::min(corner[1], corner[2])) - lines.low;
        const glm::dvec3 high = glm::max(corner[0], glm::max(corner[1], corner[2])) - lines.low;
        const int last_column = Lines::first_at(high.x, lines.voxel, lines.columns() - 2) + 1;
        const int last_row = Lines::first_at(high.y, lines.voxel, lines.rows() - 2) + 1;
        for (int r = Lines::first_at(low.y, lines.voxel, lines.rows() - 1); r <= last_row; ++r) {
            for (int c = Lines::first_at(low.x, lines.voxel, lines.columns() - 1); c <= last_column;
                 ++c) {
                const double x = lines.x(c), y = lines.y(r);
                if (const int turns = turns_around(corner, x, y); turns != 0) {
                    const double z = height_at(corner, x, y);
                    crossings.push_back({static_cast<std::uint32_t>(r * lines.columns() + c),
                                         static_cast<float>(turns), z});
                    own.lines += area * turns * (z - lines.low.z);
                }
            }
        }
    }
    std::ranges::sort(crossings, [](const Crossing& a, const Crossing& b) {
        return std::tie(a.line, a.z, a.turns) < std::tie(b.line, b.z, b.turns);
    });
    return crossings;
}

// Adds the part [from, to] of a line, in voxels, to what is inside of a column of voxels.
void add_stretch(double from, double to, std::span<float> column) {
    constexpr float kShare = 1.0f / (kLinesOfVoxel * kLinesOfVoxel);
    const auto first = static_cast<int>(std::max(std::floor(from), 0.0));
    const int end = std::min(static_cast<int>(std::ceil(to)), static_cast<int>(column.size()));
    for (int z = first; z < end; ++z) {
        const double inside = std::min(to, z + 1.0) - std::max(from, static_cast<double>(z));
        column[static_cast<std::size_t>(z)] += kShare * static_cast<float>(std::max(inside, 0.0));
    }
}

// The share of each voxel that is inside; z fastest, then x.
std::vector<float> find_inside(std::span<const Crossing> crossings, const Lines& lines) {
    const auto depth = static_cast<std::size_t>(lines.voxels.z);
    std::vector<float> inside(depth * static_cast<std::size_t>(lines.voxels.x) *
                              static_cast<std::size_t>(lines.voxels.y));
    const int columns = lines.columns();
    float turns = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
        const Crossing &here = crossings[i], &next = crossings[i + 1];
        turns += here.turns;
        if (next.line != here.line) {
            turns = 0;
        } else if (turns != 0) {
            const auto along = static_cast<std::size_t>(columns);
            const std::size_t column = here.line % along / kLinesOfVoxel;
            const std::size_t row = here.line / along / kLinesOfVoxel;
            const std::size_t at =
                (row * static_cast<std::size_t>(lines.voxels.x) + column) * depth;
            add_stretch((here.z - lines.low.z) / lines.voxel, (next.z - lines.low.z) / lines.voxel,
                        std::span(inside).subspan(at, depth));
        }
    }
    return inside;
}

float largest_of(Rgb c) {
    return std::max({c.r, c.g, c.b});
}

// `voxels` along the longest edge of a box that is not empty.
Lines lines_of(const Body& body, std::uint32_t voxels) {
    const glm::dvec3 size = body.high - body.low;
    Lines lines;
    lines.low = body.low;
    lines.voxel = std::max({size.x, size.y, size.z}) / voxels;
    if (lines.voxel > 0) {
        lines.voxels = glm::max(glm::ivec3(glm::ceil(size / lines.voxel - 1e-9)), 1);
    }
    return lines;
}

SparseGrid<float> fill_voxels(const Body& body, const Lines& lines,
                              std::span<const std::size_t> part, std::span<PartContent> content) {
    if (!(lines.voxel > 0)) return {};
    const std::vector<float> inside = find_inside(cross_lines(body, lines, part, content), lines);
    SparseGrid<float> grid =
        fill_grid(glm::ivec3(0), lines.voxels - 1, lines.voxel, [&](glm::ivec3 v) {
            const int number = (v.y * lines.voxels.x + v.x) * lines.voxels.z + v.z;
            const float share = inside[static_cast<std::size_t>(number)];
            return static_cast<double>(std::min(share, 1.0f));
        });
    // Voxel 0 has its centre half a voxel from the corner of the box.
    grid.to_scene[3] = glm::dvec4(body.low + 0.5 * lines.voxel, 1);
    return grid;
}

// Nothing where all parts are found.
std::optional<Diagnostic> describe_lost(std::span<const PartContent> content,
                                        const std::string& material, const std::string& file,
                                        const std::string& where) {
    std::size_t parts = 0, lost = 0;
    double whole = 0, missing = 0;
    for (const PartContent& part : content) {
        if (part.mesh == 0) continue;
        ++parts;
        whole += std::abs(part.mesh);
        lost += part.is_lost() ? 1 : 0;
        missing += part.is_lost() ? std::abs(part.mesh) : 0;
    }
    if (lost == 0) return std::nullopt;
    char share[32];
    std::snprintf(share, sizeof share, "%.2g %%", 100 * missing / whole);
    return make_warning(file, where,
                        std::to_string(lost) + " of the " + std::to_string(parts) +
                            " parts of the mesh of material " + gltf::in_quotes(material) +
                            ", with " + share +
                            " of what it encloses, are thinner than an eighth of a voxel in some "
                            "direction: they vanish, or come out too thick",
                        "raise voxels, or give such parts a material of their own");
}

}  // namespace

Result<FilledBody> fill_body(const Scene& scene, const std::string& material, std::uint32_t voxels,
                             const std::string& file, const std::string& where) {
    const auto refuse = [&](std::string fault, std::string remedy) {
        return make_error(ErrorKind::bad_input, file, where, std::move(fault), std::move(remedy));
    };
    const std::string quoted = gltf::in_quotes(material), mesh = "the mesh of material " + quoted;
    const auto own = std::ranges::find(scene.materials, material, &Material::name);
    const Body body = gather_body(scene, material);
    if (own == scene.materials.end() || body.triangle.empty()) {
        return refuse("the scene has no surface of material " + quoted,
                      "name the material of a closed mesh");
    }
    if (!own->medium || own->medium->variation || own->medium->thickness > 0) {
        return refuse("material " + quoted + " has no medium that is alike everywhere",
                      "give it sigma_s and sigma_a, or a preset, under materials");
    }
    if (const std::size_t open = count_open_edges(body); open > 0) {
        return refuse(mesh + " is not closed: " + std::to_string(open) +
                          " edges have no triangle on their other side, or one that faces the "
                          "other way",
                      "close it, weld its vertices, and turn all triangles outward");
    }
    const glm::dvec3 farthest =
        glm::max(glm::abs(scene.origin + body.low), glm::abs(scene.origin + body.high));
    if (!(std::max({farthest.x, farthest.y, farthest.z}) <= media::kMaxVolumeCoordinate)) {
        return refuse(mesh + " reaches beyond 1e9 m from the origin",
                      "check its transform and --metres-per-unit");
    }
    const Lines lines = lines_of(body, voxels);
    // A crossing takes 16 bytes; at most every second meeting is one.
    constexpr double kMostMeetings = 1 << 26;
    if (lines.voxel > 0 && !(count_meetings(body, lines) <= kMostMeetings)) {
        return refuse(mesh + " has too many large triangles, one above the other",
                      "lower voxels, or join parts that overlap");
    }
    const Medium& medium = *own->medium;
    Volume volume;
    volume.name = "volume of material " + quoted;
    const std::vector<std::size_t> part = number_parts(body);
    std::vector<PartContent> content(body.triangle.size());
    volume.density = fill_voxels(body, lines, part, content);
    if (volume.density.empty()) {
        return refuse(mesh + " has no inside, or one that is thinner than an eighth of a voxel",
                      "give it a thickness, turn all parts outward, or give parts that lie far "
                      "apart materials of their own");
    }
    volume.sigma_t = medium.sigma_s + medium.sigma_a;
    const double depth = static_cast<double>(largest_of(volume.sigma_t)) *
                         glm::length(glm::dvec3(volume.density.to_scene[0]));
    if (!(depth <= media::kMaxVoxelDepth)) {
        return refuse(
            "a voxel of material " + quoted + " holds more than a million mean free paths",
            "leave it a body with a surface");
    }
    const auto share = [](float s, float t) { return t > 0 ? std::min(s / t, 1.0f) : 0.0f; };
    volume.albedo = {share(medium.sigma_s.r, volume.sigma_t.r),
                     share(medium.sigma_s.g, volume.sigma_t.g),
                     share(medium.sigma_s.b, volume.sigma_t.b)};
    volume.phase = medium.phase;
    FilledBody filled{std::move(volume), {}};
    if (auto lost = describe_lost(content, material, file, where)) {
        filled.warnings.push_back(std::move(*lost));
    }
    return filled;
}

void remove_surface(Scene& scene, const std::string& material) {
    for (Primitive& p : scene.primitives) {
        if (scene.materials[p.material].name != material) continue;
        Primitive bare;
        bare.node = p.node, bare.mesh = p.mesh, bare.primitive = p.primitive;
        bare.name = p.name;
        bare.material = p.material;
        p = std::move(bare);
    }
    for (Material& m : scene.materials) {
        if (m.name == material) m.medium.reset();
    }
}

}  // namespace opaline::formats
