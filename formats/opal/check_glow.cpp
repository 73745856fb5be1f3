#include "formats/opal/check_glow.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "formats/opal/half.h"
#include "formats/opal/spherical_harmonics.h"
#include "formats/opal/used_part.h"

namespace opaline::formats {
namespace {

bool is_scale(float x) {
    return x >= 0 && x <= std::numeric_limits<float>::max() / kLargestHalf;
}

std::string find_brick_fault(const GlowView& glow, const GlowRecord& record,
                             const VolumeRecord& volume) {
    const auto bricks = glow.brick.subspan(record.first_brick, record.brick_count);
    for (std::size_t i = 0; i < bricks.size(); ++i) {
        if (bricks[i] >= volume.brick_count || (i > 0 && bricks[i] <= bricks[i - 1])) {
            return "it refers to a brick that its volume does not have, or bricks are out of order";
        }
    }
    return {};
}

std::string find_record_fault(const AssetView& asset, std::size_t i, UsedPart& bricks,
                              UsedPart& values) {
    const GlowView& glow = asset.volumes.glow;
    const GlowRecord& record = glow.record[i];
    if (record.volume >= asset.volumes.records.size() || record.emitter >= asset.emitters.size()) {
        return "its volume or emitter does not exist";
    }
    if (i > 0) {
        const GlowRecord& before = glow.record[i - 1];
        if (std::pair(record.volume, record.emitter) <= std::pair(before.volume, before.emitter)) {
            return "it is out of order, or stands twice";
        }
    }
    if (record.brick_count > 0 && glow.own_of(record.volume) != &record) {
        return "its volume has light of its own from two emitters";
    }
    if ((record.terms != 0 && !is_harmonic_count(record.terms)) || !is_scale(record.value_scale) ||
        !is_scale(record.code_scale)) {
        return "it has " + number_in_fault(record.terms) +
               " terms, or scales below zero or too large; expected 0, 1, 4, 9, 16 or 25 terms";
    }
    const VolumeRecord& volume = asset.volumes.records[record.volume];
    const std::uint64_t count = std::uint64_t{3} * volume.node_count * record.terms;
    if (!bricks.take(record.first_brick, record.brick_count, glow.brick.size()) ||
        !values.take(record.first_value, count, glow.value.size())) {
        return "its bricks or values lie outside their arrays, or overlap with those of another "
               "volume";
    }
    return find_brick_fault(glow, record, volume);
}

}  // namespace

Fault find_glow_fault(const AssetView& asset) {
    UsedPart bricks, values;
    return find_fault_in(
        "section GLOW, record", asset.volumes.glow.record.size(),
        [&](std::size_t i) { return find_record_fault(asset, i, bricks, values); });
}

Fault find_glow_value_fault(const GlowView& glow) {
    const auto bad = std::ranges::find_if_not(glow.value, is_half_finite);
    if (bad == glow.value.end()) return {};
    return {"section GLOW, value " + number_in_fault(bad - glow.value.begin()), "it is not finite"};
}

}  // namespace opaline::formats
