#include "formats/opal/copies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "formats/opal/array_cutter.h"
#include "formats/opal/asset.h"
#include "formats/opal/check_rows.h"
#include "formats/opal/layout.h"

namespace opaline::formats {
namespace {

// The primitive whose arrays each primitive has: its own, or its original's.
std::vector<std::uint32_t> find_sources(const AssetView& asset) {
    std::vector<std::uint32_t> source(asset.primitives.size());
    for (std::uint32_t p = 0; p < source.size(); ++p) {
        source[p] = p;
    }
    for (const CopyRecord& copy : asset.copies) {
        source[copy.primitive] = copy.original;
    }
    return source;
}

struct RestoredCounts {
    std::uint64_t vertices = 0, indices = 0, slots = 0, added = 0;
};

RestoredCounts count_restored(const AssetView& stored) {
    RestoredCounts counts;
    for (const std::uint32_t p : find_sources(stored)) {
        counts.vertices += stored.primitives[p].vertex_count;
        counts.indices += stored.primitives[p].index_count;
        counts.slots += stored.slots.empty() ? 0 : stored.slots.count(p);
        counts.added += stored.added.of(p);
    }
    return counts;
}

std::string find_record_fault(const AssetView& stored, std::size_t i,
                              const std::vector<std::uint8_t>& is_copy) {
    const CopyRecord& copy = stored.copies[i];
    if (i > 0 && copy.primitive <= stored.copies[i - 1].primitive) {
        return "it is out of order, or stands twice";
    }
    if (is_copy[copy.original] != 0) return "its original is a copy itself";
    if (stored.primitives[copy.original].shading != Shading::diffuse) {
        return "what its vertices show depends on the view";
    }
    const PrimitiveRecord& record = stored.primitives[copy.primitive];
    if (record.vertex_count != 0 || record.index_count != 0 || stored.added.of(copy.primitive)) {
        return "it has vertices or triangles of its own";
    }
    const Vec3 o = copy.offset;
    return std::isfinite(o.x) && std::isfinite(o.y) && std::isfinite(o.z) && copy.reserved == 0
               ? ""
               : "its offset is not finite, or a value is not one of this version";
}

// Whether arrays have an element of every vertex, or none.
bool are_of_vertices(const AssetView& stored) {
    const std::size_t vertices = stored.position.size();
    const auto fits = [&](std::size_t size) { return size == 0 || size == vertices; };
    return stored.normal.size() == vertices && stored.base_color.size() == vertices &&
           fits(stored.texcoord.size()) && fits(stored.openness.size()) &&
           fits(stored.holes.vertex_alpha.size()) && fits(stored.normal_maps.tangent.size()) &&
           fits(stored.slots.slot.size());
}

bool are_added_of_primitives(const AssetView& stored) {
    const AddedVerticesView& added = stored.added;
    std::uint64_t sum = 0;
    for (const std::uint32_t count : added.count) {
        sum += count;
    }
    return (added.count.empty() || added.count.size() == stored.primitives.size()) &&
           sum == added.vertex.size();
}

// Makes arrays of all primitives of those that are stored, primitive by primitive.
class Restorer {
  public:
    Restorer(AssetView& view, std::span<std::byte> bytes)
        : view_(view),
          stored_(view.primitives),
          source_(find_sources(view)),
          counts_(count_restored(view)),
          cutter_(bytes) {}

    void restore() {
        restore_records();
        move(of_vertices(view_.position));
        of_vertices(view_.normal);
        of_vertices(view_.base_color);
        of_vertices(view_.texcoord);
        of_vertices(view_.openness);
        of_vertices(view_.holes.vertex_alpha);
        of_vertices(view_.normal_maps.tangent);
        const std::span<std::uint32_t> index = cutter_.take<std::uint32_t>(counts_.indices);
        for_parts(
            [](const PrimitiveRecord& p) {
                return Part{p.first_index, p.index_count};
            },
            [&](std::size_t, Part from, std::size_t to) {
                std::ranges::copy(view_.index.subspan(from.first, from.count),
                                  index.begin() + static_cast<std::ptrdiff_t>(to));
            });
        view_.index = index;
        restore_added();
        if (!view_.slots.empty()) restore_slots();
    }

  private:
    struct Part {
        std::size_t first, count;
    };

    // Calls visit(primitive, its part as stored, where it begins).
    template <class PartOf, class Visit>
    void for_parts(const PartOf& part_of, const Visit& visit) {
        std::size_t to = 0;
        for (std::size_t p = 0; p < source_.size(); ++p) {
            const Part from = part_of(stored_[source_[p]]);
            visit(p, from, to);
            to += from.count;
        }
    }
    template <class Visit>
    void for_vertices(const Visit& visit) {
        for_parts(
            [](const PrimitiveRecord& p) {
                return Part{p.first_vertex, p.vertex_count};
            },
            visit);
    }

    void restore_records() {
        const std::span<PrimitiveRecord> records = cutter_.take<PrimitiveRecord>(source_.size());
        std::uint32_t vertex = 0, index = 0;
        for (std::size_t p = 0; p < source_.size(); ++p) {
            records[p] = stored_[source_[p]];
            const PrimitiveRecord& own = stored_[p];
            records[p].node = own.node;
            records[p].mesh = own.mesh;
            records[p].primitive = own.primitive;
            records[p].material = own.material;
            records[p].first_vertex = vertex;
            records[p].first_index = index;
            vertex += records[p].vertex_count;
            index += records[p].index_count;
        }
        view_.primitives = records;
    }

    template <class T>
    std::span<T> of_vertices(std::span<const T>& array) {
        if (array.empty()) return {};
        const std::span<T> all = cutter_.take<T>(counts_.vertices);
        for_vertices([&](std::size_t, Part from, std::size_t to) {
            std::ranges::copy(array.subspan(from.first, from.count),
                              all.begin() + static_cast<std::ptrdiff_t>(to));
        });
        array = all;
        return all;
    }

    void move(std::span<Vec3> position) const {
        for (const CopyRecord& copy : view_.copies) {
            const PrimitiveRecord& p = view_.primitives[copy.primitive];
            for (Vec3& at : position.subspan(p.first_vertex, p.vertex_count)) {
                at = at + copy.offset;
            }
        }
    }

    void restore_added() {
        if (view_.added.empty()) return;
        std::vector<std::size_t> first;
        std::size_t next = 0;
        for (const std::uint32_t count : view_.added.count) {
            first.push_back(next);
            next += count;
        }
        const std::span<std::uint32_t> count = cutter_.take<std::uint32_t>(source_.size());
        const std::span<AddedVertex> all = cutter_.take<AddedVertex>(counts_.added);
        std::size_t to = 0;
        for (std::size_t p = 0; p < source_.size(); ++p) {
            count[p] = view_.added.count[source_[p]];
            std::ranges::copy(view_.added.vertex.subspan(first[source_[p]], count[p]),
                              all.begin() + static_cast<std::ptrdiff_t>(to));
            to += count[p];
        }
        view_.added = {count, all};
    }

    void restore_slots() {
        const SlotsView stored = view_.slots;
        const std::span<std::uint32_t> offset = cutter_.take<std::uint32_t>(source_.size() + 1);
        offset[0] = 0;
        for (std::size_t p = 0; p < source_.size(); ++p) {
            offset[p + 1] = offset[p] + stored.count(source_[p]);
        }
        const std::span<std::uint32_t> slot = cutter_.take<std::uint32_t>(counts_.vertices);
        const std::span<std::uint32_t> vertex = cutter_.take<std::uint32_t>(counts_.slots);
        const std::size_t mixed = stored.mix.empty() ? 0 : counts_.vertices;
        const std::span<SlotMix> mix = cutter_.take<SlotMix>(mixed);
        const std::span<std::uint32_t> place = cutter_.take<std::uint32_t>(mixed);
        std::uint32_t next_place = 0;
        for_vertices([&](std::size_t p, Part from, std::size_t to) {
            const std::uint32_t begin = stored.offset[source_[p]];
            for (std::uint32_t s = 0; s < stored.count(source_[p]); ++s) {
                vertex[offset[p] + s] =
                    static_cast<std::uint32_t>(stored.vertex[begin + s] - from.first + to);
            }
            const std::uint32_t first_place = next_place;
            for (std::size_t v = 0; v < from.count; ++v) {
                slot[to + v] = stored.slot[from.first + v] - begin + offset[p];
                if (mixed == 0) continue;
                mix[to + v] = stored.mix[from.first + v];
                for (std::uint32_t& of : mix[to + v].slot) {
                    of = of - begin + offset[p];
                }
                place[to + v] =
                    stored.place[from.first + v] - stored.place[from.first] + first_place;
                next_place = std::max(next_place, place[to + v] + 1);
            }
        });
        view_.slots = {offset, slot, vertex, mix, place};
    }

    AssetView& view_;
    std::span<const PrimitiveRecord> stored_;
    std::vector<std::uint32_t> source_;
    RestoredCounts counts_;
    ArrayCutter cutter_;
};

}  // namespace

std::uint64_t bytes_of_copies(std::uint64_t vertices, std::uint64_t indices) {
    constexpr std::uint64_t kOfVertex =
        2 * sizeof(Vec3) + sizeof(Rgb) + sizeof(Float2) + sizeof(Openness) + sizeof(float) +
        sizeof(Tangent) + sizeof(AddedVertex) + sizeof(SlotMix) + 3 * sizeof(std::uint32_t);
    return kOfVertex * vertices + sizeof(std::uint32_t) * indices;
}

Fault find_copies_fault(const AssetView& stored, std::uint64_t file_size) {
    const std::string section = "section COPY";
    if (!are_of_vertices(stored) || !are_added_of_primitives(stored)) {
        return {section, "arrays of vertices differ in number"};
    }
    for (std::size_t i = 0; i < stored.primitives.size(); ++i) {
        const PrimitiveRecord& p = stored.primitives[i];
        if (!lies_inside(p.first_vertex, p.vertex_count, stored.position.size()) ||
            !lies_inside(p.first_index, p.index_count, stored.index.size())) {
            return {section + ", primitive " + number_in_fault(i),
                    "its vertices or indices lie outside their arrays"};
        }
    }
    std::vector<std::uint8_t> is_copy(stored.primitives.size());
    for (const CopyRecord& copy : stored.copies) {
        if (copy.primitive >= is_copy.size() || copy.original >= is_copy.size()) {
            return {section, "a primitive does not exist"};
        }
        is_copy[copy.primitive] = 1;
    }
    Fault fault = find_fault_in(section + ", record", stored.copies.size(),
                                [&](auto i) { return find_record_fault(stored, i, is_copy); });
    if (!is_sound(fault)) return fault;
    const RestoredCounts counts = count_restored(stored);
    if (counts.vertices > std::numeric_limits<std::uint32_t>::max() ||
        counts.indices > std::numeric_limits<std::uint32_t>::max() ||
        bytes_of_copies(counts.vertices, counts.indices) >
            kMostBytesOfCopies + kMaxCompressionRatio * file_size) {
        return {section, "its copies have more vertices than a reader takes"};
    }
    return {};
}

std::size_t size_with_copies(const AssetView& stored) {
    const RestoredCounts counts = count_restored(stored);
    const std::size_t primitives = stored.primitives.size();
    const bool has_mixes = !stored.slots.mix.empty();
    const auto of_vertices = [&](auto array) {
        return array.empty() ? 0 : counts.vertices * sizeof(array[0]);
    };
    const std::size_t slots =
        stored.slots.empty()
            ? 0
            : (primitives + 1 + counts.vertices + counts.slots) * sizeof(std::uint32_t) +
                  (has_mixes ? counts.vertices * (sizeof(SlotMix) + sizeof(std::uint32_t)) : 0);
    const std::size_t added = stored.added.empty() ? 0
                                                   : primitives * sizeof(std::uint32_t) +
                                                         counts.added * sizeof(AddedVertex);
    return primitives * sizeof(PrimitiveRecord) + of_vertices(stored.position) +
           of_vertices(stored.normal) + of_vertices(stored.base_color) +
           of_vertices(stored.texcoord) + of_vertices(stored.openness) +
           of_vertices(stored.holes.vertex_alpha) + of_vertices(stored.normal_maps.tangent) +
           counts.indices * sizeof(std::uint32_t) + added + slots;
}

void restore_copies(AssetView& view, std::span<std::byte> bytes) {
    Restorer(view, bytes).restore();
}

std::uint64_t count_restored_vertices(const AssetView& stored) {
    return count_restored(stored).vertices;
}

std::uint32_t count_stored_vertices(const AssetView& restored) {
    std::uint32_t count = restored.receivers();
    for (const CopyRecord& copy : restored.copies) {
        count -= restored.primitives[copy.primitive].vertex_count;
    }
    return count;
}

std::vector<float> spread_to_copies(const AssetView& restored, std::span<const float> stored) {
    if (stored.empty() || restored.copies.empty()) return {stored.begin(), stored.end()};
    const std::vector<std::uint32_t> source = find_sources(restored);
    std::vector<std::size_t> first(source.size());
    std::size_t next = 0;
    for (std::size_t p = 0; p < source.size(); ++p) {
        first[p] = next;
        next += source[p] == p ? restored.primitives[p].vertex_count : 0;
    }
    std::vector<float> all;
    all.reserve(restored.receivers());
    for (std::size_t p = 0; p < source.size(); ++p) {
        const auto own = stored.subspan(first[source[p]], restored.primitives[p].vertex_count);
        all.insert(all.end(), own.begin(), own.end());
    }
    return all;
}

}  // namespace opaline::formats
