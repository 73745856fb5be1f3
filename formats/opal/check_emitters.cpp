#include "formats/opal/check_emitters.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "formats/opal/check_opal.h"
#include "formats/opal/half.h"
#include "formats/opal/used_part.h"

namespace opaline::formats {
namespace {

constexpr const char* kEmittersSection = "section EMIT";

bool is_bounded(float x) {
    return x >= 0 && x <= std::numeric_limits<float>::max();
}

std::string find_name_fault(const EmittersView& emitters, std::uint32_t i) {
    const std::size_t first = i == 0 ? 0 : emitters.name_end[i - 1], end = emitters.name_end[i];
    if (end <= first || end > emitters.text.size() || end - first > kMaxEmitterName) {
        return "its name is empty, longer than " + number_in_fault(kMaxEmitterName) +
               " bytes, or not in the file";
    }
    const std::string_view name = emitters.name(i);
    if (std::ranges::any_of(name, [](char c) { return c >= 0 && c < ' '; })) {
        return "its name has control characters";
    }
    return find_emitter(emitters, name) != i ? "its name stands twice" : "";
}

std::string find_block_fault(const AssetView& asset, std::size_t i, UsedPart& used) {
    const EmittersView& emitters = asset.emitters;
    const EmitterBlock& block = emitters.block[i];
    if (block.primitive >= asset.primitives.size() || block.emitter >= emitters.size()) {
        return "its primitive or emitter does not exist";
    }
    if (i > 0 && std::pair(block.primitive, block.emitter) <=
                     std::pair(emitters.block[i - 1].primitive, emitters.block[i - 1].emitter)) {
        return "it is out of order, or stands twice";
    }
    if (!is_bounded(block.scale) || block.reserved != 0) {
        return "its scale is below zero or not finite, or it has a value that only later versions "
               "know";
    }
    const PrimitiveRecord& primitive = asset.primitives[block.primitive];
    const std::uint64_t values =
        std::uint64_t{3} * asset.slot_count(block.primitive) * primitive.terms;
    return used.take(block.first_value, values, emitters.value.size())
               ? ""
               : "its values lie outside their array, or overlap with those of another block";
}

std::string find_own_fault(const AssetView& asset, std::size_t i) {
    const EmittersView& emitters = asset.emitters;
    const OwnLight& own = emitters.own[i];
    if (own.primitive >= asset.primitives.size() || own.emitter >= emitters.size()) {
        return "its primitive or emitter does not exist";
    }
    if (i > 0 && own.primitive <= emitters.own[i - 1].primitive) {
        return "it is out of order, or stands twice";
    }
    if (!is_bounded(own.radiance.r) || !is_bounded(own.radiance.g) || !is_bounded(own.radiance.b)) {
        return "its radiance is below zero or not finite";
    }
    return find_image_fault(asset, own.image, own.wrap_u, own.wrap_v);
}

}  // namespace

Fault find_emitters_fault(const AssetView& asset) {
    const EmittersView& emitters = asset.emitters;
    if (emitters.name_end.size() > kMaxEmitters) {
        return {kEmittersSection, "it has " + number_in_fault(emitters.name_end.size()) +
                                      " emitters; expected " + number_in_fault(kMaxEmitters) +
                                      " at most"};
    }
    UsedPart used;
    return find_first_fault(
        [&] {
            return find_fault_in("section EMIT, emitter", emitters.size(), [&](std::size_t i) {
                return find_name_fault(emitters, static_cast<std::uint32_t>(i));
            });
        },
        [&] {
            return find_fault_in("section EMIT, block", emitters.block.size(),
                                 [&](std::size_t i) { return find_block_fault(asset, i, used); });
        },
        [&] {
            return find_fault_in("section EMIT, own light", emitters.own.size(),
                                 [&](std::size_t i) { return find_own_fault(asset, i); });
        });
}

Fault find_emitter_value_fault(const EmittersView& emitters) {
    const auto bad = std::ranges::find_if_not(emitters.value, is_half_finite);
    if (bad == emitters.value.end()) return {};
    return {
        std::string(kEmittersSection) + ", value " + number_in_fault(bad - emitters.value.begin()),
        "it is not finite"};
}

}  // namespace opaline::formats
