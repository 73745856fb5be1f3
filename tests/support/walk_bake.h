#pragma once

#include <gtest/gtest.h>

#include <string_view>

#include "tests/support/media_bake.h"

namespace opaline::bake {

inline constexpr double kDipole = static_cast<double>(MultipleModel::dipole);
inline constexpr double kWalked = static_cast<double>(MultipleModel::walks);

/// Bakes of light scattered many times by a model, with as many walks as a test affords.
inline BakeOptions bake_by(double model, double walks = 300000) {
    BakeOptions options = tests::only({"multiple"});
    options.set(kMultipleModel, model);
    options.set(kWalksAround, 1e9);
    options.set(kWalks, walks);
    options.set(kSites, 1500);
    return options;
}

inline const PlanEntry& entry_of(const BakeResult& baked, std::string_view name) {
    const PlanEntry* entry = find_entry(baked.plan, name, 0);
    EXPECT_NE(entry, nullptr) << name;
    return *entry;
}

}  // namespace opaline::bake
